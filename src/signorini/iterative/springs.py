# SPDX-License-Identifier: BSD-3-Clause
"""Springs of pairs whose friction bound is known: how forces follow trial forces to first order."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.law.section import FrictionSection


@dataclass(frozen=True, kw_only=True, eq=False)
class PairSprings:
    """Derivative of the forces of pairs in trial forces times a stiffness a row: symmetric, never negative.

    Attributes
    ----------
    normal : (a,) stiffness of the normals
    tangent : (d - 1, d - 1, a) stiffness of the tangents
    """

    normal: Array
    tangent: Array

    @classmethod
    def of(cls, section: FrictionSection, y: Array, bound: Array, stiffness: Array, tied: BoolArray) -> Self:
        """The springs at trial forces y.

        Parameters
        ----------
        section : of the friction of every pair
        y, bound : (d, a) trial forces, (a,) friction bounds
        stiffness : (d, a) that trial forces lose per motion, alike for both tangents
        tied : (a,) pairs that carry any force
        """
        across = np.where(tied, np.eye(len(y) - 1)[:, :, None], section.project(y[1:], bound).slope)
        return cls(normal=stiffness[0] * ((y[0] >= 0) | tied), tangent=stiffness[1:] * across)

    def floored(self, stiffness: Array) -> Self:
        """With some stiffness (d, a) more in every row: bodies which nothing holds yet do not run away."""
        across = stiffness[1:] * np.eye(len(stiffness) - 1)[:, :, None]
        return replace(self, normal=self.normal + stiffness[0], tangent=self.tangent + across)

    def change(self, other: PairSprings) -> float:
        """By how much a stiffness differs at most."""
        pairs = (self.normal, other.normal), (self.tangent, other.tangent)
        return max(float(np.abs(one - two).max(initial=0.0)) for one, two in pairs)

    def forces(self, moved: Array) -> Array:
        """(d, a) Forces of motions (d, a)."""
        across = (self.tangent * moved[1:]).sum(axis=1)
        return np.concatenate([(self.normal * moved[0])[None], across])

    @property
    def each(self) -> Array:
        """(a, d, d) Forces of motions of every pair."""
        d = len(self.tangent) + 1
        made = np.zeros((len(self.normal), d, d))
        made[:, 0, 0] = self.normal
        made[:, 1:, 1:] = self.tangent.transpose(2, 0, 1)
        return made

    def matrix(self) -> sp.csr_array:
        """(d a, d a) Forces of motions."""
        rows = [[sp.diags_array(block) for block in line] for line in self.tangent]
        return sp.csr_array(sp.block_diag([sp.diags_array(self.normal), sp.block_array(rows)]))
