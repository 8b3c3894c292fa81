# SPDX-License-Identifier: BSD-3-Clause
"""The law of contact with a known friction bound, Tresca's: the projection on its forces, and its slope.

Forces and motions are (d, a): the normal in the first row, tangents below, one column a pair.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK


def project(y: Array, bound: Array, tied: BoolArray) -> Array:
    """Forces nearest to y: a normal that presses, a tangent no longer than the bound.

    Parameters
    ----------
    y : (d, a) trial forces
    bound : (a,) of friction, force; may be infinite
    tied : (a,) pairs that carry any force

    Examples
    --------
    >>> project(np.array([[2.0, -1.0], [3.0, 0.5]]), np.array([1.0, 1.0]), np.array([False, False])).tolist()
    [[2.0, 0.0], [1.0, 0.5]]
    """
    r = y * np.concatenate([np.ones((1, y.shape[1])), np.broadcast_to(_share(y, bound), (len(y) - 1, y.shape[1]))])
    r[0] = np.maximum(r[0], 0.0)
    return np.where(tied, y, r)


def states(y: Array, bound: Array, tied: BoolArray) -> IntArray:
    """(a,) What each pair does, codes of :mod:`signorini.law.states`; without friction a closed pair slips."""
    stick = (np.linalg.norm(y[1:], axis=0) <= bound) & (bound > 0)
    slip = np.where(y[1] >= 0, SLIP_PLUS, SLIP_MINUS) if len(y) == 2 else SLIP_PLUS
    found = np.where(y[0] <= 0, OPEN, np.where(stick, STICK, slip))
    return np.where(tied, STICK, found).astype(np.int64)


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


def slope(y: Array, bound: Array, tied: BoolArray, stiffness: Array, floor: float) -> Slope:
    """The slope at y.

    Parameters
    ----------
    stiffness : (d, a) that trial forces lose per motion, the same for both tangents
    floor : part of it that every row keeps, so that bodies which nothing holds yet do not run away
    """
    size = np.linalg.norm(y[1:], axis=0)
    tau = np.divide(y[1:], size, out=np.zeros_like(y[1:]), where=size > 0)
    slips = (size > bound) & ~tied
    share = np.where(tied, 1.0, _share(y, bound))
    one = np.eye(len(tau))[:, :, None]
    across = share * (one - np.where(slips, 1.0, 0.0) * tau[:, None] * tau[None, :])
    closed = np.where((y[0] >= 0) | tied, 1.0, 0.0)
    return Slope(normal=stiffness[0] * (closed + floor), tangent=stiffness[1:] * (across + floor * one))


def _share(y: Array, bound: Array) -> Array:
    """(a,) Part of the tangential trial force that friction carries."""
    size = np.linalg.norm(y[1:], axis=0)
    return np.divide(bound, size, out=np.where(bound > 0, 1.0, 0.0), where=size > bound)
