# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of symmetric histories on smooth cones, to both sides, beside differences of the whole program.

    python -m benchmarks.symmetric_cones [FIRST] [LAST]     (numbers of the models, 0 and 60 where none are given)

A crowned block that is pressed, squeezed from both sides and back; a load that is larger on one of them breaks its
symmetry, so that what pairs did together they do one after the other. A line for each model: the largest difference of
a derivative of the peak pressure, a force, a traction or the dissipation to one of its sides, as a part of the larger
one, or why there is none. Differences are of answers to that side alone, in the best of three steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

import signorini as sg
from benchmarks.random_cones import survey
from signorini.arrays import Array
from signorini.derivative.functionals import value
from signorini.model.outputs import Output
from tests.derivative.symmetric import squeezed_in_space

_STEPS = (1e-5, 1e-6, 1e-7)  # of differences: rounding tells in the shortest, what pairs do next in the longest


def limits(outputs: Sequence[Output], model_at: Callable[[float], sg.Model], step: float, here: float = 1.0) -> Array:
    """(m, 2) Derivatives of outputs to both sides of a number, of models beside it alone: its answer may be another.

    Parameters
    ----------
    outputs : m of them
    model_at : the model of a number
    step : of the number
    here : the number
    """

    def one_sided(way: float) -> Array:
        views = [sg.solve(model_at(here + way * part * step), tape=True)._taped.view for part in (1, 2, 4)]
        one, two, four = (np.array([value(output, view) for output in outputs]) for view in views)
        return np.asarray(way * (2.0 * (two - one) - 0.5 * (four - two)) / step)  # to second order

    return np.column_stack([one_sided(-1.0), one_sided(1.0)])


def difference(seed: int) -> tuple[float, str]:
    """How far differences are from derivatives, at most, as a part of the larger one, and of which output.

    Parameters
    ----------
    seed : of the model

    Raises
    ------
    InputError
        Where a derivative is refused.
    """
    solution = sg.solve(squeezed_in_space(seed, facets=0), tape=True)
    node = int(solution.steps[-1].contacts[0].node[0])
    peak, across = sg.pressure("joint").peak, sg.force("joint", along=(0, 1, 0))
    outputs = (peak, across, sg.dissipation(), sg.traction("joint")[node, 0])
    found = np.array([solution.derivative(output).sides("load.one") for output in outputs])
    best = np.full(len(outputs), np.inf)
    for step in _STEPS:
        wanted = limits(outputs, lambda one: squeezed_in_space(seed, one, facets=0), step)
        size = np.maximum(np.maximum(np.abs(wanted), np.abs(found)).max(axis=1), np.finfo(float).tiny)
        best = np.minimum(best, np.abs(found - wanted).max(axis=1) / size)
    return float(best.max()), repr(outputs[int(best.argmax())])


def main() -> None:
    """Print a line for each model, and how many agree."""
    survey(__doc__.splitlines()[0], difference)


if __name__ == "__main__":
    main()
