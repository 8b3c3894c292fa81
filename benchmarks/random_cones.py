# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of random histories on smooth cones in space beside differences of the whole program.

    python -m benchmarks.random_cones [FIRST] [LAST]     (numbers of the models, 0 and 60 where none are given)

A block above a rigid plane or on another block, pressed and pulled in steps whose increments end at events. A line for
each: the largest difference of a derivative of the peak pressure, the force or the dissipation, by friction and by a
load, as a part of it, or why there is none. Differences are of steps that change no state.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace

import numpy as np

import signorini as sg
from signorini.derivative.derivative import Derivative
from signorini.derivative.functionals import value
from signorini.derivative.taped_history import TapedHistory
from signorini.engine.solve import solve
from signorini.engine.tape import Tape

OUTPUTS = (sg.pressure("joint").peak, sg.force("joint", along=(1.0, 0.2, 0.3)), sg.dissipation())
"""What is differentiated."""

PARAMETERS = ("friction.joint", "load.pull")
"""By what."""

_STEPS = (1e-6, 1e-7, 1e-8)  # of differences: the longest that changes no state


def random_model(seed: int) -> sg.Model:
    """A block that is pressed askew and pulled to and fro, on a plane or on another block.

    Parameters
    ----------
    seed : of the random numbers
    """
    some = np.random.default_rng(seed)
    nx, ny = (int(k) for k in some.integers(2, 5, 2))
    below = some.random() < 0.3
    foot = 1.0 if below else 0.0
    block = sg.box(x=np.linspace(0, 1, nx), y=np.linspace(0, 1.2, ny), z=[foot, foot + 0.7])
    x, y, z = block.points.T
    tilt = some.uniform(-1, 1, 4)
    gap = 0.008 * (tilt[0] * x + tilt[1] * y + tilt[2] * x * y)
    gap += 0.01 * abs(tilt[3]) * ((x - some.random()) ** 2 + (y - some.random()) ** 2)
    gap -= gap.min() - 0.002
    block = replace(block, points=np.column_stack([x, y, z + (foot + 0.7 - z) / 0.7 * gap]))
    mesh, side, other = block, "", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1))
    bodies, supports = [sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))], []
    if below:
        base = sg.box(x=np.linspace(-0.2, 1.2, nx), y=np.linspace(-0.2, 1.4, ny + 1), z=[0.0, 1.0])
        mesh, side, other = sg.join({"block": block, "base": base}), "block.", "base.top"
        bodies.append(sg.Body("base", sg.Elastic(E=float(some.uniform(500, 3000)), nu=0.25)))
        supports.append(sg.Support("base.bottom", u=(0, 0, 0)))
    supports.append(sg.Support(f"{side}top", u=(0, 0, -0.03), name="down"))
    pull_x, pull_y, across = some.uniform(-20, 20, 3)
    steps = [sg.Step(scale={"down": 1.0, "pull": some.uniform(0, 0.7), "across": some.uniform(0, 0.3)})]
    for _ in range(int(some.integers(1, 3))):
        pulled, pushed = (float(some.uniform(-1, 1)) for _ in range(2))
        steps.append(sg.Step(scale={"pull": pulled, "across": pushed, "down": float(some.uniform(0.7, 1.1))}))
    return sg.Model(
        mesh,
        bodies=bodies,
        supports=supports,
        loads=[
            sg.Load(f"{side}right", traction=(pull_x, pull_y, 0.0), name="pull"),
            sg.Load(f"{side}back", traction=(0.3 * across, across, 0.0), name="across"),
        ],
        contacts=[sg.Contact(f"{side}bottom", other, friction=float(some.uniform(0.1, 0.5)), name="joint")],
        steps=steps,
    )


def changed(model: sg.Model, parameter: str, by: float) -> sg.Model:
    """The model with a parameter, one of `PARAMETERS`, that is larger by some number."""
    if parameter == "load.pull":
        first, *others = model.loads
        assert first.traction is not None
        pulled = replace(first, traction=tuple((1.0 + by) * part for part in first.traction))
        return replace(model, loads=[pulled, *others])
    (joint,) = model.contacts
    assert isinstance(joint.friction, float)
    return replace(model, contacts=[replace(joint, friction=joint.friction + by)])


def taped(model: sg.Model) -> TapedHistory:
    """A model's history with its tape."""
    tape = Tape()
    solve(model, tape=tape)
    return TapedHistory(tape, model)


def states(history: TapedHistory) -> list[tuple[int, tuple[int, ...], int, tuple[int, ...]]]:
    """What every point of a history goes through: leg, acting pairs, number of trials, states."""
    return [
        (
            point.leg,
            tuple(point.acting.tolist()),
            len(point.trials),
            () if point.states.tangent is None else tuple(point.states.tangent.left.tolist()),
        )
        for point in history.view.points
    ]


def differences(seed: int) -> dict[tuple[str, str], float]:
    """By parameter and output, how far differences of two runs are from the derivative, as a part of the larger one.

    Parameters
    ----------
    seed : of the model
    """
    model, found = random_model(seed), {}
    here = taped(model)
    for parameter in PARAMETERS:
        for step in _STEPS:
            low, high = (taped(changed(model, parameter, by)) for by in (-step, step))
            if states(low) == states(here) == states(high):
                break
        for output in OUTPUTS:
            wanted = (value(output, high.view) - value(output, low.view)) / (2.0 * step)
            derivative = Derivative(here, output)
            size = max(abs(wanted), 1e-3 * abs(derivative.value))
            found[parameter, repr(output)] = abs(derivative.by(parameter) - wanted) / (size or 1.0)
    return found


def survey(words: str, difference: Callable[[int], tuple[float, str]]) -> None:
    """Print a line for each model, and how many agree.

    Parameters
    ----------
    words : what is surveyed
    difference : the largest one of a model, and what has it
    """
    parser = argparse.ArgumentParser(description=words)
    parser.add_argument("first", type=int, nargs="?", default=0, help="number of the first model")
    parser.add_argument("last", type=int, nargs="?", default=60, help="number behind the last")
    options = parser.parse_args()
    worst, refused = [0.0], 0
    for seed in range(options.first, options.last):
        try:
            lost, what = difference(seed)
        except sg.InputError as error:
            refused += 1
            print(f"{seed:4d}  refused: {error}", flush=True)
            continue
        worst.append(lost)
        print(f"{seed:4d}  {lost:.1e}  {what}", flush=True)
    print(f"{len(worst) - 1} models, the largest difference {max(worst):.1e}; {refused} refused")


def largest(seed: int) -> tuple[float, str]:
    """The largest of the differences of a model, and the output and parameter that have it."""
    (parameter, output), lost = max(differences(seed).items(), key=lambda one: one[1])
    return lost, f"{output} by {parameter}"


def main() -> None:
    """Print a line for each model, and how many agree."""
    survey(__doc__.splitlines()[0], largest)


if __name__ == "__main__":
    main()
