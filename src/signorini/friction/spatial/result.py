# SPDX-License-Identifier: BSD-3-Clause
"""What the solver of the spatial Coulomb problem answers, and how it got there."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array
from signorini.friction.result import ContactAnswer


@dataclass(frozen=True, kw_only=True)
class SpatialResult(ContactAnswer):
    """The answer, in the scaled units of the problem.

    Attributes
    ----------
    outcome : ``"solved"`` (certified), ``"no_equilibrium"`` (proved) or ``"not_found"``
    gap : (n,) gap >= 0; NaN unless solved, like the following three
    slip : (n, 2) slip increment along the tangents
    normal_force : (n,) >= 0, pressing
    tangential_force : (n, 2) on body 1
    state : (n,) OPEN, STICK or SLIP; UNDECIDED (-1) unless solved
    y : (3n,) ``r - h``, a start for the next load; NaN unless solved
    trace : the methods tried, in order
    residual : largest violation of equilibrium and resultants relative to scale, see `certify`; the least that was
        found where not solved
    escape : (3n,) motion of the pairs, largest entry 1, along which the loads carry the bodies away, or None
    message : the same in words
    """

    y: Array


@dataclass(frozen=True, kw_only=True)
class LimitLoad:
    """How far a load could be raised from a base load.

    Attributes
    ----------
    factor : largest part of the way from the base to the full load with a certified solution; 1 where all of it has one
    beyond : smallest part tried without one; infinite where none failed
    result : the solution at ``factor``
    closed, sticking : number of pairs closed, and sticking, there; few of them sticking speak for a limit load
    """

    factor: float
    beyond: float
    result: SpatialResult
    closed: int
    sticking: int

    @property
    def message(self) -> str:
        """The same in words."""
        return (
            f"certified up to {self.factor:.4g} of the load; there {self.sticking} of {self.closed} closed pairs stick"
        )
