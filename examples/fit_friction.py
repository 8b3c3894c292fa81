# SPDX-License-Identifier: BSD-3-Clause
"""Friction and Young's modulus from a measured fretting loop, with the standard deviations that its noise leaves.

    python examples/fit_friction.py [FOLDER]

A cylinder on a flat specimen (``fretting.toml`` beside it) is pushed there and back; the motion of the pad is measured
at points of the loop, here by the program itself with known values and noise. Gauss-Newton's method takes the
derivatives of every point through all events of the path; a step to where the pad would slide off is refused and
halved. Writes fit_friction.png (default: docs/figures).
"""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import signorini as sg
from signorini.arrays import Array
from signorini.derivative.function import AnswerFunction
from signorini.model.outputs import Displacement

POINTS = 20
PUSH = 360.0  # N per mm: 0.95 of what the friction that is looked for holds
TRUE, START = np.array([0.6, 90e3]), np.array([1.0, 40e3])
HALVINGS = 20


@dataclass(frozen=True)
class Fit:
    """What a loop says: friction and modulus, their standard deviations, the number of solves, the motions."""

    found: Array
    deviation: Array
    solves: int
    motion: Array


def loop(points: int = POINTS) -> tuple[sg.Model, list[Displacement]]:
    """The pad pushed once there and back, and its motion at points of that; the path is exact between them."""
    model = sg.read(Path(__file__).with_name("fretting.toml"))
    at = tuple(np.linspace(0.0, 1.0, points + 1)[1:-1])
    loads = [replace(load, force=(PUSH, None)) if load.name == "push" else load for load in model.loads]
    steps = [*model.steps[:2], replace(model.steps[2], repeat=1, at=at)]
    pad = sg.displacement(int(model.mesh.nodes_of("pad.cut")[0]), along=(1.0, 0.0))
    begin = len(model.steps) - 1
    return replace(model, loads=loads, steps=steps), [pad.after(begin + part) for part in (*at, 1.0)]


def fit(function: AnswerFunction, measured: Array, *, start: Array = START, tolerance: float = 1e-10) -> Fit:
    """Gauss-Newton's method in the inverses of both, in which the motion of a pad is nearly linear."""
    x, solves, best, step = 1.0 / start, 0, None, np.zeros(2)
    for _ in range(HALVINGS):
        try:
            motion, solves = function.values(1.0 / x), solves + 1
        except sg.SolveFailed:
            motion = None
        if motion is None or (best is not None and np.linalg.norm(motion - measured) >= best[0]):
            if best is None or np.linalg.norm(step / best[1]) < tolerance:
                break
            step = step / 2.0
        else:
            jacobian = function.jacobian(1.0 / x) * -(x**-2)
            best = np.linalg.norm(motion - measured), x, jacobian, motion
            step = np.linalg.lstsq(jacobian * x, measured - motion, rcond=None)[0] * x
            if np.linalg.norm(step / x) < tolerance:
                break
        x = best[1] + step
    rest, x, jacobian, motion = best
    variance = rest**2 / (len(measured) - 2) * np.linalg.inv((jacobian * x).T @ (jacobian * x))
    return Fit(found=1.0 / x, deviation=np.sqrt(np.diag(variance)) / x, solves=solves, motion=motion)


def main(folder: Path) -> None:
    """Fit with and without noise, print and draw."""
    model, outputs = loop()
    function = sg.prepare(model).function(["friction.contact", "E.specimen"], outputs)
    motion = function.values(TRUE)
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    push = np.interp(np.linspace(0, 1, POINTS + 1)[1:], np.linspace(0, 1, 5), [1.0, 0.0, -1.0, 0.0, 1.0])
    for noise in (0.0, 0.01, 0.03):
        rng = np.random.default_rng(3)
        measured = motion + 0.5 * noise * np.ptp(motion) * rng.standard_normal(len(motion))
        found = fit(function, measured)
        (mu, E), (of_mu, of_E) = found.found, found.deviation
        print(f"noise {noise:4.0%}: friction {mu:.4f} +- {of_mu:.4f}, E {E:.0f} +- {of_E:.0f}, {found.solves} solves")
    axes.plot(1e3 * measured, PUSH * push, "o", ms=4, color="#c4451c", label="measured, noise 3 %")
    axes.plot(
        1e3 * found.motion, PUSH * push, "-", color="#1b4f8a", label=f"fitted: $\\mu$ {mu:.2f}, E {E / 1e3:.0f} GPa"
    )
    axes.set_xlabel("motion of the pad, micrometres")
    axes.set_ylabel("push, N / mm")
    axes.legend(frameon=False)
    figure.savefig(folder / "fit_friction.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/figures"))
