# SPDX-License-Identifier: BSD-3-Clause
"""Where a method ended: what passes between the methods of the solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Self

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun
from signorini.friction.problem import ContactProblem


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A candidate solution, or what a method has instead.

    Attributes
    ----------
    y : (d, n) the last iterate, or the best
    residual : `certify` of y; infinite where the method has no candidate
    attempt : how it went
    index : in the plane, sign of the determinant of the system that gave y, 0 where it is singular; None where unknown
    touched : (n,) pairs that were closed in some of the last states tried, or None
    proof : what proves that there is no equilibrium, or None
    margin : of the proof: of the load on rigid motions the share that nothing takes; of a tree what equilibrium lacks
        in the state that comes nearest to it, of the size of the data
    escape : (d n,) motion along which the bodies run away, or None
    """

    y: Array
    residual: float
    attempt: MethodRun
    index: int | None = None
    touched: BoolArray | None = None
    proof: Literal["rigid motion", "tree"] | None = None
    margin: float = 0.0
    escape: Array | None = None

    @classmethod
    def without(cls, problem: ContactProblem, attempt: MethodRun) -> Self:
        """A method that ended without a candidate."""
        return cls(y=np.zeros((problem.directions, problem.pairs)), residual=np.inf, attempt=attempt)


@dataclass(frozen=True, kw_only=True)
class NewtonEnd(Candidate):
    """Where Newton's method ended.

    Attributes
    ----------
    force, rigid : (d, n) and (k,) forces and rigid motion of the iterate
    state : in the plane by states, (n,) those that y leads to
    converged : whether the law is obeyed to the tolerance, with the layer where there is one
    """

    force: Array
    rigid: Array
    state: IntArray | None = None
    converged: bool
