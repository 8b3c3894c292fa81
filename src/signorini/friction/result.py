# SPDX-License-Identifier: BSD-3-Clause
"""What the solver of the Coulomb problem answers, and how it got there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun

Outcome = Literal["solved", "no_equilibrium", "not_found"]


@dataclass(frozen=True, kw_only=True)
class ContactAnswer:
    """What the solvers of the plane and of the spatial problem answer alike, in the scaled units of the problem.

    Attributes
    ----------
    outcome : ``"solved"`` (certified), ``"no_equilibrium"`` (proved) or ``"not_found"``
    gap, slip, normal_force, tangential_force : of the pairs; NaN unless solved
    state : (n,) codes of :mod:`signorini.law.states`; UNDECIDED (-1) unless solved
    trace : the methods tried, in order
    residual : largest violation of equilibrium and resultants relative to scale, see `certify`
    escape : motion of the pairs, largest entry 1, along which the loads carry the bodies away, or None
    message : the same in words
    """

    outcome: Outcome
    gap: Array
    slip: Array
    normal_force: Array
    tangential_force: Array
    state: IntArray
    trace: tuple[MethodRun, ...]
    residual: float
    escape: Array | None = None
    message: str

    @property
    def solved(self) -> bool:
        """Whether a certified solution was found."""
        return self.outcome == "solved"

    @property
    def method(self) -> str:
        """The method that gave the answer, ``"none"`` where nothing was tried."""
        return self.trace[-1].method if self.trace else "none"


@dataclass(frozen=True, kw_only=True)
class CoulombResult(ContactAnswer):
    """The answer, in the scaled units of the problem.

    Attributes
    ----------
    outcome : ``"solved"`` (certified), ``"no_equilibrium"`` (proved) or ``"not_found"``
    gap, slip : (n,) gap >= 0 and slip increment; NaN unless solved
    normal_force, tangential_force : (n,) normal force >= 0 pressing, tangential force on body 1; NaN unless solved
    state : (n,) OPEN, STICK, SLIP_PLUS (tangential force +mu p, slip <= 0), SLIP_MINUS; UNDECIDED (-1) unless solved
    trace : the methods tried, in order
    residual : largest violation of equilibrium and resultants relative to scale, see `certify`; infinite unless solved
    escape : (2n,) motion of the pairs, largest entry 1, along which the loads carry the bodies away, or None
    index : sign of the determinant in the state found (+1 or -1; -1 proves two more solutions); 0 where the state
        leaves a motion or a force undetermined, None unless solved
    message : the same in words
    """

    index: int | None = None
