# SPDX-License-Identifier: BSD-3-Clause
"""The law of contact with friction bounds that are known, Tresca's, and with ties: the projection on its forces.

Forces and motions are (d, a): the normal in the first row, tangents below, one column a pair.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.law.section import FrictionSection
from signorini.law.states import OPEN, SLIP, SLIP_MINUS, SLIP_PLUS, STICK


@dataclass(frozen=True, kw_only=True, eq=False)
class Slope:
    """``d project / d y`` times a stiffness a row: symmetric, block by block, never negative.

    Attributes
    ----------
    normal : (a,) stiffness of the normals
    tangent : (d - 1, d - 1, a) stiffness of the tangents
    """

    normal: Array
    tangent: Array

    def change(self, other: Slope) -> float:
        """By how much a stiffness differs at most."""
        pairs = (self.normal, other.normal), (self.tangent, other.tangent)
        return max(float(np.abs(one - two).max(initial=0.0)) for one, two in pairs)

    def matrix(self) -> sp.csr_array:
        """(d a, d a) Forces of motions."""
        rows = [[sp.diags_array(block) for block in line] for line in self.tangent]
        return sp.csr_array(sp.block_diag([sp.diags_array(self.normal), sp.block_array(rows)]))


@dataclass(frozen=True, kw_only=True, eq=False)
class BoundedLaw:
    """The law of pairs under friction bounds, (a,) forces that may be infinite, which every method takes.

    Attributes
    ----------
    section : of the friction of every pair
    tied : (a,) pairs that carry any force

    Examples
    --------
    >>> law = BoundedLaw(section=FrictionSection.round(1, 2), tied=np.array([False, False]))
    >>> law.project(np.array([[2.0, -1.0], [3.0, 0.5]]), np.array([1.0, 1.0])).tolist()
    [[2.0, 0.0], [1.0, 0.5]]
    """

    section: FrictionSection
    tied: BoolArray

    def project(self, y: Array, bound: Array) -> Array:
        """(d, a) Forces nearest to trial forces y, (d, a): a normal that presses, a tangent within its section."""
        r = np.empty_like(y)
        r[0] = np.maximum(y[0], 0.0)
        r[1:] = self.section.nearest(y[1:], bound)
        return np.where(self.tied, y, r)

    def states(self, y: Array, bound: Array) -> IntArray:
        """(a,) What each pair does, codes of :mod:`signorini.law.states`; without friction a closed pair slips."""
        stick = self.section.project(y[1:], bound).inside
        slip = np.where(y[1] >= 0, SLIP_PLUS, SLIP_MINUS) if len(y) == 2 else SLIP
        found = np.where(y[0] <= 0, OPEN, np.where(stick, STICK, slip))
        return np.where(self.tied, STICK, found).astype(np.int64)

    def slope(self, y: Array, bound: Array, stiffness: Array, floor: float) -> Slope:
        """The slope at trial forces y, (d, a).

        Parameters
        ----------
        y, bound : (d, a) trial forces, (a,) friction bounds
        stiffness : (d, a) that trial forces lose per motion, alike for both tangents
        floor : part of it that every row keeps, so that bodies which nothing holds yet do not run away
        """
        one = np.eye(len(y) - 1)[:, :, None]
        across = np.where(self.tied, one, self.section.project(y[1:], bound).slope)
        closed = np.where((y[0] >= 0) | self.tied, 1.0, 0.0)
        return Slope(normal=stiffness[0] * (closed + floor), tangent=stiffness[1:] * (across + floor * one))
