# SPDX-License-Identifier: BSD-3-Clause
"""What threads give: seconds on the wall and of the CPU with one and more of them, and what more would give on paper.

A large model is prepared and solved with every number of threads in turn; medians of three. The numbers that come out
are the same to the last bit, which is asserted.

On paper: one thread does every job that threads share by itself, one after the other, and each is timed, as is all that
is not shared. Then so many threads take the jobs as they do in a solve: always the first one whose needs are done. With
any number of them what is left is the critical path. Amdahl's law, with the serial part measured; what threads take
from each other, the bandwidth of the memory above all, is not in it.

usage: python -m benchmarks.threads [--small]
"""

from __future__ import annotations

import heapq
import json
import os
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any, NamedTuple, TypeVar
from unittest import mock

import numpy as np

from benchmarks import command, page
from signorini.clock import Clock
from signorini.cores import physical_cores, threads
from signorini.crew import Crew, Job
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.model import Model

T = TypeVar("T")
REPEATS = 3  # whose median is told
MANY = 16  # threads of the machine on paper


class Section(NamedTuple):
    """Jobs that threads share: what each took, and which it needs."""

    seconds: list[float]
    needs: list[tuple[int, ...]]


def makespan(section: Section, number: int) -> float:
    """Seconds until so many threads are done, each taking the first job whose needs are.

    >>> makespan(Section([3.0, 1.0, 1.0, 1.0], [(), (), (), (1, 2)]), 2)
    3.0
    """
    missing = [len(needs) for needs in section.needs]
    ready = [job for job, left in enumerate(missing) if not left]
    running: list[tuple[float, int]] = []
    now = 0.0
    while ready or running:
        while ready and len(running) < number:
            job = heapq.heappop(ready)
            heapq.heappush(running, (now + section.seconds[job], job))
        now, done = heapq.heappop(running)
        for job, needs in enumerate(section.needs[done + 1 :], done + 1):
            if done in needs:
                missing[job] -= 1
                if not missing[job]:
                    heapq.heappush(ready, job)
    return now


@contextmanager
def noted() -> Iterator[list[Section]]:
    """Let one thread do what several would share, and note how long every job takes."""
    found: list[Section] = []

    class Alone(Crew):
        def __init__(self, number: int) -> None:
            super().__init__(1)
            self.threads = number

        def each(self, calls: Sequence[Callable[[], T]]) -> list[T]:
            timed = [command.cpu(call) for call in calls]
            found.append(Section([seconds for seconds, _ in timed], [()] * len(timed)))
            return [result for _, result in timed]

        def finish(self, jobs: Sequence[Job]) -> None:
            found.append(Section([command.cpu(job.call)[0] for job in jobs], [job.needs for job in jobs]))

    users = [module for name, module in sys.modules.items() if name.startswith("signorini") and hasattr(module, "Crew")]
    with ExitStack() as stack:
        for module in users:
            stack.enter_context(mock.patch.object(module, "Crew", Alone))
        yield found


def models(small: bool) -> dict[str, Model]:
    """What is solved: name to model."""
    plane, space = ((24,), 8) if small else ((36, 80), 27)
    found = {f"cylinder / {refine}": zhu_cylinder(refine=refine) for refine in plane}
    return found | {f"two cubes, {space} cells an edge": cubes(space)}


def measure(model: Model) -> dict[int, dict[str, float]]:
    """Medians of seconds by number of threads: of the factorisation and of everything on the wall, of it of the CPU."""
    taken: dict[int, list[dict[str, float]]] = {}
    first = None
    solve_prepared(prepare(model))
    for _ in range(REPEATS):
        for number in (1, max(2, physical_cores())):
            clock, begin, cpu = Clock(timer=time.perf_counter), time.perf_counter(), time.process_time()
            with threads(number):
                history = solve_prepared(prepare(model, clock=clock))
            whole, cpu = time.perf_counter() - begin, time.process_time() - cpu
            run = {"factorisation": clock.seconds["factorisation"], "all": whole, "CPU": cpu}
            taken.setdefault(number, []).append(run)
            first = history.last.displacement if first is None else first
            assert np.array_equal(first, history.last.displacement)
    return {
        number: {name: statistics.median(run[name] for run in runs) for name in runs[0]}
        for number, runs in taken.items()
    }


def row(name: str, dofs: int, found: dict[int, dict[str, float]]) -> list[object]:
    """Times of one and several threads, and their ratios."""
    one, many = min(found), max(found)
    cells: list[object] = [name, dofs]
    for what in ("factorisation", "all", "CPU"):
        ratio = found[one][what] / found[many][what]
        cells += [*(page.seconds(found[number][what]) for number in (one, many)), f"{ratio:.2f}"]
    return cells


def paper(name: str, model: Model) -> list[object]:
    """Which part is not shared, how long the critical path of the others is, and how much faster more threads are."""
    with threads(MANY), noted() as sections:
        whole, _ = command.cpu(lambda: solve_prepared(prepare(model)))
    shared = sum(sum(section.seconds) for section in sections)
    alone = whole - shared
    after = {number: sum(makespan(section, number) for section in sections) for number in (2, 4, MANY, 10**6)}
    ratios = [f"{whole / (alone + after[number]):.2f}" for number in after]
    return [name, f"{100 * alone / whole:.0f}", f"{100 * after[10**6] / whole:.0f}", *ratios]


def main() -> None:
    parser = command.parser(__doc__, dry=True)
    parser.add_argument("--small", action="store_true", help="sizes that take seconds")
    parser.add_argument("--one", action="store_true", help="measure in this process")
    options = parser.parse_args()
    if options.one:
        rows: list[dict[str, Any]] = []
        for name, model in models(options.small).items():
            rows.append({"row": row(name, model.number_of_dofs, measure(model)), "paper": paper(name, model)})
        print(json.dumps(rows))
        return
    load = os.getloadavg()[0]
    found = page.measured("benchmarks.threads", *(["--small"] if options.small else []))
    many = max(2, physical_cores())
    head = ["model", "unknowns"]
    for what in ("factorisation s", "all s", "all CPU s"):
        head += [f"{what}: 1 thread", f"{many} threads", "ratio"]
    on_paper = ["on paper", "not shared %", "critical path %", "2 threads", "4", f"{MANY}", "any number"]
    note = f"Seconds on the wall unless of the CPU, medians of {REPEATS}, {page.machine()}, load {load:.1f} before."
    tables = page.table(head, [each["row"] for each in found]), page.table(on_paper, [each["paper"] for each in found])
    command.publish(options, "threads", "\n\n".join([*tables, note]))


if __name__ == "__main__":
    main()
