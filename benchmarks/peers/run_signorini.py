# SPDX-License-Identifier: BSD-3-Clause
"""Run signorini on the cylinder, in a process of its own.

python -m benchmarks.peers.run_signorini REFINE FRICTION BACKEND [cold | plain]
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from typing import Any

import numpy as np

from benchmarks.page import KEEP_MEMORY, peak_memory, thread_environment
from benchmarks.peers.case import Case
from benchmarks.peers.result import Result
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.fem.stiffness import reduced_stiffness
from signorini.gallery.cylinder import zhu_cylinder
from signorini.linalg import factorise

REPEATS, LONG = 5, 10.0


def run(case: Case, refine: int, friction: float, backend: str, *, cold: bool = False, threads: int = 1) -> Result:
    """Warm: medians after one small solve. Cold: all of a first process, which finds no compiled code on disk."""
    found = _measured(threads, refine, friction, backend, *(["cold"] if cold else []))
    pressure = np.interp(case.points[case.arc_nodes, 0], found["x"], found["pressure"])
    return Result(
        code=f"signorini, {backend}",
        input_seconds=found["input_seconds"],
        assembly_seconds=found["assembly_seconds"],
        solve_seconds=found["solve_seconds"],
        wall_seconds=found["wall_seconds"],
        iterations=found["iterations"],
        memory=found["memory"],
        pressure=pressure,
    )


def plain(refine: int, backend: str, threads: int) -> tuple[float, float]:
    """Seconds of the CPU and on the wall of one linear solve with the same matrix, its contact nodes fixed."""
    found = _measured(threads, refine, 0.0, backend, "plain")
    return found["solve_seconds"], found["wall_seconds"]


def _measured(threads: int, *arguments: object) -> dict[str, Any]:
    """What a process of its own measures; one that is cold finds nothing compiled."""
    with tempfile.TemporaryDirectory() as nothing:
        cold = {"NUMBA_CACHE_DIR": nothing} if "cold" in arguments else {}
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.peers.run_signorini", *map(str, arguments)],
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, **thread_environment(threads), **KEEP_MEMORY, **cold},
            check=True,
        )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def _plain(refine: int, backend: str) -> dict[str, float]:
    """Medians of linear solves of the matrix of the cylinder, its contact nodes fixed."""
    prepared = prepare(zhu_cylinder(refine=refine))
    T = prepared.constraints.transform
    kept = np.flatnonzero(np.bincount((prepared.interface.B @ T).indices, minlength=T.shape[1]) == 0)
    K = reduced_stiffness(prepared.K, T)[kept][:, kept]
    nodes, load = prepared.constraints.nodes[kept], np.ones(len(kept))
    seconds: list[tuple[float, float]] = []
    for _ in range(REPEATS + 1):  # the first one loads the library
        begin, wall = time.process_time(), time.perf_counter()
        factorise(K, [], nodes=nodes, backend=backend).reduce(load).expand(np.empty(0))
        seconds.append((time.process_time() - begin, time.perf_counter() - wall))
    cpu, walls = zip(*seconds[1:], strict=True)
    return {"solve_seconds": statistics.median(cpu), "wall_seconds": statistics.median(walls)}


def main() -> None:
    refine, friction, backend = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
    cold = "cold" in sys.argv[4:]
    if "plain" in sys.argv[4:]:
        print(json.dumps(_plain(refine, backend)))
        return
    if not cold:
        solve_prepared(prepare(zhu_cylinder(friction=friction, refine=2), backend=backend))
    history = None
    seconds: list[tuple[float, float, float]] = []
    walls: list[float] = []
    while not seconds or (not cold and len(seconds) < REPEATS and sum(map(sum, seconds)) < LONG):
        history = None  # the next repeat finds the memory as this one found it
        start = time.process_time()
        model = zhu_cylinder(friction=friction, refine=refine)
        made, begun = time.process_time(), time.perf_counter()
        clock = Clock(timer=time.process_time)
        history = solve_prepared(prepare(model, backend=backend, clock=clock))
        whole = time.process_time() - made
        walls.append(time.perf_counter() - begun)
        assembly = clock.seconds["assembly"]
        seconds.append((made - start, assembly, whole - assembly))
    assert history is not None
    contact = history.last.contacts[0]
    order = np.argsort(contact.points[:, 0])
    print(
        json.dumps(
            {
                "input_seconds": statistics.median(s[0] for s in seconds),
                "assembly_seconds": statistics.median(s[1] for s in seconds),
                "solve_seconds": statistics.median(s[2] for s in seconds),
                "wall_seconds": statistics.median(walls),
                "iterations": sum(history.last.iterations),
                "memory": peak_memory(),
                "x": contact.points[order, 0].tolist(),
                "pressure": contact.pressure[order].tolist(),
            }
        )
    )


if __name__ == "__main__":
    main()
