# SPDX-License-Identifier: BSD-3-Clause
"""Other solutions in space, by search: Newton's method from many states and directions of slip."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array
from signorini.friction.several import distinct
from signorini.friction.spatial.equilibrium import Equilibrium
from signorini.friction.spatial.law import tangent
from signorini.friction.spatial.newton import newton
from signorini.friction.spatial.problem import SpatialProblem

_DIRECTIONS = 8
_FEW, _GUESSES = 10, (100, 24)  # at random: for so few pairs, and for more
_FAR = 1e3  # of the friction: a pair that slips


def search_solutions(problem: SpatialProblem, *, seed: int = 0) -> list[Array]:
    """Solutions y that Newton's method finds from different starts; there may be more.

    It starts with all pairs sticking, open, or slipping in one of eight directions, then with states and directions at
    random.

    Parameters
    ----------
    seed : of random states and directions

    Returns
    -------
    list of (3n,) ``y = r - h``, each certified

    Examples
    --------
    One pair of much friction: it sticks, slips, or is open, and all three are in equilibrium.

    >>> W = np.linalg.inv(np.array([[3.0, -1.0, 0.0], [-1.0, 3.0, 0.0], [0.0, 0.0, 2.0]]))
    >>> b = W @ [-1.0, 2.5, 0.0]
    >>> problem = SpatialProblem.of(W=W, b=b, friction=[3.0], motions=np.zeros((3, 0)), scale=1.0)
    >>> sorted(round(float(y[0]), 6) for y in search_solutions(problem))
    [-0.166667, 0.5, 1.0]
    """
    equilibrium, rng = Equilibrium.of(problem), np.random.default_rng(seed)
    ends = (newton(equilibrium, tangent(problem, start)) for start in _starts(problem, rng))
    return distinct((end.y for end in ends if end.residual <= 1e-10), problem.scale)


def _starts(problem: SpatialProblem, rng: np.random.Generator) -> Iterator[Array]:
    """(3n,) y of states: normal part 1 where a pair presses, tangential part far along the friction where it slips."""
    n = problem.pairs
    one, none = np.ones(n), np.zeros(n)
    yield np.concatenate([one, none, none])
    yield np.concatenate([-one, none, none])
    for angle in 2.0 * np.pi / _DIRECTIONS * np.arange(_DIRECTIONS):
        yield np.concatenate([one, _FAR * np.cos(angle) * one, _FAR * np.sin(angle) * one])
    for _ in range(_GUESSES[n > _FEW]):
        state, angle = rng.integers(0, 3, n), rng.uniform(0.0, 2.0 * np.pi, n)
        slip = np.where(state == 2, _FAR, 0.0)
        yield np.concatenate([np.where(state == 0, -1.0, 1.0), slip * np.cos(angle), slip * np.sin(angle)])
