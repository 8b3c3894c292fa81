# SPDX-License-Identifier: BSD-3-Clause
"""What the method of multipliers asks of the bodies that it presses: all of them, or the part that a rank has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.iterative.springs import PairSprings
from signorini.law.bound import Bound


@dataclass(frozen=True, kw_only=True, eq=False)
class IncrementLoad:
    """What an increment asks.

    Attributes
    ----------
    f : (b,) forces; where nobody has put them into blocks yet, (z,)
    offset : (d, a) relative displacements without z, length
    bound : of the friction forces of a pairs
    force, length : sizes of the data
    floating : whether contact alone holds a body
    tolerance : of the sizes of the data: equilibrium, gaps that should be closed, forces that should have settled
    rounds : most of them
    most : conjugate gradients that they may take in all
    """

    f: Array
    offset: Array
    bound: Bound
    force: float
    length: float
    floating: bool
    tolerance: float
    rounds: int
    most: float = np.inf


class PressedBodies(Protocol):
    """Stiffness K and pairs B of bodies, or of the part of them that is here: b displacements and a pairs."""

    @property
    def tied(self) -> BoolArray:
        """(a,) Pairs that neither slip nor open."""

    @property
    def moves(self) -> BoolArray:
        """(d, a) Rows of B that see anything."""

    @property
    def stiffness(self) -> Array:
        """(a,) D of the springs that trial forces are made with, force per length."""

    @property
    def compliance(self) -> Array:
        """(d, a) Of the interface, length per force."""

    @property
    def patience(self) -> int:
        """Rounds after which an increment is given up whose residual has not halved."""

    @property
    def aim(self) -> float:
        """Residual down to which rounds go on that need not, as long as it falls."""

    @property
    def whole(self) -> bool:
        """Whether all bodies are here and multigrid serves, so that Newton's method on all at once is tried."""

    def internal(self, z: Array) -> Array:
        """(b,) Forces K z of displacements z, (b,)."""

    def seen(self, z: Array) -> Array:
        """(d, a) Motions B z of the pairs."""

    def pushed(self, forces: Array) -> Array:
        """(b,) Forces B' r on the bodies of forces (d, a) of the pairs."""

    def resultants(self, forces: Array) -> Array:
        """(k,) Work of forces (b,) on the rigid motions of all parts, of all bodies together."""

    def total(self, values: Any) -> Any:
        """Numbers of this part, summed over all parts."""

    def most(self, value: float) -> float:
        """The largest over all parts; not a number where that of any is none."""

    def preconditioner_under(self, springs: PairSprings) -> Any:
        """What makes `solved` fast under springs in the pairs, and under some that differ little."""

    def solved(self, springs: PairSprings, preconditioner: Any, g: Array, residual: float) -> tuple[Array, int]:
        """Displacements under forces g, (b,), with springs in the pairs, nearly; and the iterations that it took.

        Parameters
        ----------
        springs : of the pairs
        preconditioner : of `preconditioner_under`
        g : forces
        residual : what may be left of them
        """
