# SPDX-License-Identifier: BSD-3-Clause
"""Where a method ended: what passes between the methods of the solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun
from signorini.friction.law import UNDECIDED
from signorini.friction.problem import CoulombProblem


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A candidate solution, or what a method has instead.

    Attributes
    ----------
    y : (2n,) the last iterate
    state : (n,) the states it leads to
    residual : `certify` of y; infinite where the method has no candidate
    index : sign of the determinant of the system that gave y, 0 where it is singular
    attempt : how it went
    touched : (n,) pairs that were closed in some of the last states tried, or None
    proof : what proves that there is no equilibrium, or None
    margin : of the proof: of the load on rigid motions the share that nothing takes; of a tree what equilibrium lacks
        in the state that comes nearest to it, of the size of the data
    escape : (2n,) motion along which the bodies run away, or None
    """

    y: Array
    state: IntArray
    residual: float
    index: int
    attempt: MethodRun
    touched: BoolArray | None = None
    proof: Literal["rigid motion", "tree"] | None = None
    margin: float = 0.0
    escape: Array | None = None

    @classmethod
    def without(cls, problem: CoulombProblem, attempt: MethodRun) -> Candidate:
        """A method that ended without a candidate."""
        n = problem.pairs
        return cls(y=np.zeros(2 * n), state=np.full(n, UNDECIDED), residual=np.inf, index=0, attempt=attempt)

    @classmethod
    def nothing(cls) -> Candidate:
        """The solution of a problem without pairs."""
        attempt = MethodRun(method="none", iterations=0, end="certified")
        return cls(y=np.zeros(0), state=np.zeros(0, dtype=np.int64), residual=0.0, index=1, attempt=attempt)
