# SPDX-License-Identifier: BSD-3-Clause
"""What a solver of the law of contact answers for its pairs, and how it got there."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.outcome import Outcome


@dataclass(frozen=True, kw_only=True)
class ContactAnswer:
    """The answer, in the units of the problem; those of a `ContactProblem` are scaled.

    Attributes
    ----------
    outcome : SOLVED (certified), NO_EQUILIBRIUM (proved) or NOT_FOUND
    h, r : (d, n) motions (gap >= 0, slip increments) and forces (normal >= 0 pressing, tangential on body 1) of the
        pairs; unless solved the last iterate, or NaN
    state : (n,) OPEN, STICK, and SLIP_PLUS (in the plane: tangential force +mu p, slip <= 0) or SLIP_MINUS, in space
        SLIP; UNDECIDED (-1) unless solved
    trace : the methods tried, in order
    residual : largest violation of equilibrium and resultants relative to scale, see `certify`; the least that was
        found where not solved
    escape : (d n,) rigid motion of the pairs, largest entry 1, along which the loads carry the bodies away, or None
    index : in the plane, sign of the determinant in the state found (+1 or -1; -1 proves two more solutions); 0 where
        the state leaves a motion or a force undetermined, None where it was not asked for
    message : the answer in words
    """

    outcome: Outcome
    h: Array
    r: Array
    state: IntArray
    trace: tuple[MethodRun, ...]
    residual: float
    message: str
    escape: Array | None = None
    index: int | None = None

    @property
    def solved(self) -> bool:
        """Whether a certified solution was found."""
        return self.outcome is Outcome.SOLVED

    @property
    def method(self) -> str:
        """The method that gave the answer, ``"none"`` where nothing was tried."""
        return self.trace[-1].method if self.trace else "none"

    @property
    def y(self) -> Array:
        """(d, n) ``r - h``, a start for the next load."""
        return self.r - self.h

    @property
    def gap(self) -> Array:
        """(n,) Gap."""
        return self.h[0]

    @property
    def slip(self) -> Array:
        """(d - 1, n) Slip increment."""
        return self.h[1:]

    @property
    def normal_force(self) -> Array:
        """(n,) Normal force."""
        return self.r[0]

    @property
    def tangential_force(self) -> Array:
        """(d - 1, n) Tangential force."""
        return self.r[1:]
