# SPDX-License-Identifier: BSD-3-Clause
"""Rates of motions and forces at a state of a history, or why there are none: what the plane and space both answer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from signorini.arrays import Array, IntArray
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import PROGRAM_TOL

MARGIN = 1e-6
"""Of the data: what every state must lack for a proof that there are no rates; rates that are accepted lack 1e-9."""

RUNAWAY_RATE = 1e6
"""Of the data: rates larger than that are none that equilibrium goes on with."""

RATE_TOL = 1e-9
"""Of the largest rate: one below it is none, and what rates may lack of the law."""

RAY = "ray termination"

_KINK_WIDTH = 1e-2  # of the first kink of a bound: what counts as zero beside it
_DATA_ROUNDING = 1e-14  # of the data


@dataclass(frozen=True, kw_only=True)
class Rates:
    """Rates in one state of the pairs, per unit of the load parameter.

    Attributes
    ----------
    state : (n,) from here on
    h, r : (d, n)
    """

    state: IntArray
    h: Array
    r: Array

    @cached_property
    def size(self) -> float:
        """The largest of them, which tolerances refer to."""
        return float(max(np.abs(self.h).max(initial=0.0), np.abs(self.r).max(initial=0.0))) or 1.0


@dataclass(frozen=True, kw_only=True)
class NoRates:
    """Why there are no rates, or why none were found.

    Attributes
    ----------
    proof : in words
    proved : False where the search ended without an answer
    margin : of a proof: what rates lack at least, of the data; 0 where it is strong evidence alone
    """

    proof: str
    proved: bool
    margin: float = 0.0


def widths_of_zero(problem: ContactProblem, width: float) -> Array:
    """(n,) Of a gap, a force or the friction to spare: a kink at small pressures is told from the corner."""
    rounding = _DATA_ROUNDING * (problem.scale or 1.0)
    return np.minimum(width, np.maximum(_KINK_WIDTH * problem.pieces.kinks[1], rounding))


def refused(words: str, margin: float) -> NoRates:
    """No rates were found and every state lacks at least the margin: a proof where that is more than rounding.

    >>> refused("nothing moves", 0.25)
    NoRates(proof='nothing moves: what comes nearest lacks 0.25 of the data', proved=True, margin=0.25)
    >>> refused("nothing moves", 1e-9).proved
    False
    """
    if margin <= MARGIN:
        return NoRates(proof=f"{words}, but what comes nearest lacks {margin:.1g} of the data: no proof", proved=False)
    return NoRates(proof=f"{words}: what comes nearest lacks {margin:.2g} of the data", proved=True, margin=margin)


def evidence(ending: str, combinations: str) -> NoRates:
    """Too many combinations to try: a ray of Lemke's method stands alone.

    >>> evidence("Lemke's method: ray termination", "2^40 combinations").proved
    True
    """
    words = f"{ending}; {combinations} are too many to try"
    ray = ending.endswith(RAY)
    return NoRates(proof=f"{words}: strong evidence, no proof" if ray else words, proved=ray)


def least_lacking(
    rows: Array, right: Array, low: Array, high: Array, *, pivots: int | None = None
) -> tuple[float, Array, int]:
    """The least t >= 0 with ``rows x <= right + t`` and ``low <= x <= high``, its x, and the pivots that it took.

    Whether t vanishes is what is asked. Posed so, and with motions that have an end, it always has an answer, whose t
    is the margin of a proof. Without an end answers of 1e7 times the data came up where bodies nearly roll, and the
    simplex method went round for ever.

    Parameters
    ----------
    rows, right : (m, N) and (m,), relative to the data
    low, high : (N,) finite
    pivots : most of the linear program; t is NaN where they were not enough
    """
    size = len(low)
    found = scipy.optimize.linprog(
        np.append(np.zeros(size), 1.0),
        A_ub=np.column_stack([rows, -np.ones(len(rows))]),
        b_ub=right,
        bounds=np.column_stack([np.append(low, 0.0), np.append(high, np.inf)]),
        method="highs",
        options=PROGRAM_TOL if pivots is None else PROGRAM_TOL | {"maxiter": pivots},
    )
    if found.status != 0:
        return float("nan"), np.zeros(size), int(found.nit)
    return float(found.fun), np.asarray(found.x[:size], dtype=np.float64), int(found.nit)
