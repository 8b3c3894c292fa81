# SPDX-License-Identifier: BSD-3-Clause
"""What derivatives cost beside the history that they go back through, in the plane.

    python -m benchmarks.derivatives [--names NAME ...] [--page]     (--page writes docs/derivatives.md)

Medians of CPU seconds on one thread. The path is all of a prepared model's solve with its tape; a derivative is one
output by friction, interference, every load, every modulus and the gap of every node: the first one, which reads the
tape and pairs tilted sides anew for their moduli, and every further one. By a Poisson's ratio, and by a shape that
moves every node: a derivative of the peak pressure by that alone, with what is assembled anew for it.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np

import signorini as sg
from benchmarks import page
from signorini.blas_threads import one_thread
from signorini.derivative.derivative import Derivative
from signorini.derivative.taped_history import TapedHistory
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.engine.tape import Tape
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.outputs import Output

_PAGE = Path(__file__).parent.parent / "docs" / "derivatives.md"
_HEAD = (
    "problem",
    "unknowns",
    "pairs",
    "points",
    "path, s",
    "first, ms",
    "peak pressure, ms",
    "dissipation, ms",
    "of the path",
    "by a Poisson's ratio, ms",
    "by a shape, ms",
)
_REPEATS = 3
_LARGE = 200_000  # unknowns, from which on everything is measured once


def problems() -> Iterator[tuple[str, sg.Model]]:
    """A fretting pad, one and three cycles; the paper's cylinder pressed, let go and pressed again."""
    fretting = sg.read(Path(__file__).parent.parent / "examples" / "fretting.toml")
    for cycles in (1, 3):
        steps = [replace(step, repeat=cycles) if step.repeat > 1 else step for step in fretting.steps]
        yield f"fretting, {cycles} cycle{'s' if cycles > 1 else ''}", replace(fretting, steps=steps)
    again = [sg.Step(name=f"to {factor:g}", scale={"cut": factor}) for factor in (1.0, 0.3, 0.8)]
    for refine in (12, 24):
        yield f"cylinder / {refine}, three steps", zhu_cylinder(refine=refine, steps=again)
    yield "cylinder / 24, no friction", zhu_cylinder(refine=24, friction=0.0)
    yield "cylinder / 80, three steps", zhu_cylinder(refine=80, steps=again)


def seconds(work: Callable[[], object], repeats: int = _REPEATS) -> float:
    """CPU seconds, the median of several runs."""
    taken = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return median(taken)


def by_all(history: TapedHistory, output: Output) -> None:
    """One output by everything but Poisson's ratios and shapes."""
    derivative = Derivative(history, output)
    for found in (derivative.load, derivative.E, derivative.gap, derivative.interference):
        for name in found:
            assert found[name] is not None
    for contact in history.prepared.model.contacts:
        assert not contact.law.coefficient or derivative.friction[contact.label] is not None


@one_thread()
def row(name: str, model: sg.Model) -> list[str]:
    """A line of the table."""
    prepared = prepare(model).keeping()
    contact = model.contacts[0].label

    def path() -> Tape:
        tape = Tape()
        solve_prepared(prepared, tape=tape)
        return tape

    unknowns = prepared.constraints.transform.shape[1]
    repeats = _REPEATS if unknowns < _LARGE else 1
    tape = path()
    of_path = seconds(path, repeats)
    outputs = (sg.pressure(contact).peak, sg.dissipation())
    by_all(TapedHistory(tape, model), outputs[0])  # what is compiled first
    first = seconds(lambda: by_all(TapedHistory(tape, model), outputs[0]), repeats)
    history = TapedHistory(tape, model)
    by_all(history, outputs[0])
    taken = [seconds(lambda output=output: by_all(history, output), repeats) for output in outputs]
    body, points = model.bodies[-1].name, model.mesh.points
    motion = points @ np.random.default_rng(0).standard_normal((points.shape[1],) * 2)  # straight sides stay straight
    Derivative(history, outputs[0]).shape(motion)  # what is compiled first
    taken += [
        seconds(lambda: Derivative(history, outputs[0]).nu[body], 1),  # what it changes at once is kept
        seconds(lambda: Derivative(history, outputs[0]).shape(motion), repeats),
    ]
    system = history.view.points[-1].system
    return [
        name,
        f"{unknowns}",
        f"{system.pairs}",
        f"{len(history.view.points)}",
        f"{of_path:.2f}",
        *(f"{1e3 * part:.0f}" for part in (first, *taken[:2])),
        f"{100.0 * taken[0] / of_path:.0f} %, {100.0 * taken[1] / of_path:.0f} %",
        *(f"{1e3 * part:.0f}, {100.0 * part / of_path:.0f} %" for part in taken[2:]),
    ]


def main() -> None:
    """Measure and print, or write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--names", nargs="+", help="problems whose names hold one of these words; all by default")
    parser.add_argument("--page", action="store_true", help="write docs/derivatives.md")
    options = parser.parse_args()
    rows = []
    for name, model in problems():
        if not options.names or any(word in name for word in options.names):
            rows.append(row(name, model))
            print(" | ".join(rows[-1]), flush=True)
    if options.page:
        page.write("price", page.table(_HEAD, rows), _PAGE)


if __name__ == "__main__":
    main()
