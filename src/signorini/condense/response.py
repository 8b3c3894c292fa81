# SPDX-License-Identifier: BSD-3-Clause
"""How the bodies answer loads and forces of the pairs, through what their factorisation keeps: contact nodes or pairs.

Contact nodes are always possible: see :mod:`signorini.condense.parts`. Where supports hold all bodies K can be
factorised as a whole, and what is kept may be the forces of the pairs,

    [ K   B^T ]
    [ B    0  ]    which condenses to    -B K^-1 B^T:

the compliance of the pairs comes straight out of the factorisation. No dense matrix of the contact nodes of a body is
inverted, and where meshes do not match fewer unknowns are kept. The contact nodes are eliminated like any others.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.condense.parts import Parts
from signorini.linalg.border import bordered
from signorini.linalg.protocol import Factorisation, Reduced
from signorini.linalg.registry import factorise


class Response(Protocol):
    """How the bodies answer loads and the forces of the pairs; springs hold what nothing but contact resists."""

    @property
    def factorisation(self) -> Factorisation:
        """Of the bodies, with what is kept last."""

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) on the free displacements onto what is kept."""

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements of the pairs under a condensed load alone."""

    def answer(self, load: Array, r: Array) -> Array:
        """What is kept, under a condensed load and forces r (d a,) of the pairs: for `Reduced.expand`."""

    def compliance(self) -> Array:
        """Relative displacements of the pairs per force, (d a, d a), symmetric to the last digit; a new array."""

    def among(self, rows: BoolArray) -> Self:
        """The same with some of the (d a,) rows alone."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ByNodes:
    """The displacements of the contact nodes are kept.

    Attributes
    ----------
    parts : the condensed bodies
    B : (d a, m) relative displacements of the pairs in terms of the contact dofs
    """

    factorisation: Factorisation
    parts: Parts
    B: sp.csr_array

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) onto the contact dofs."""
        return self.factorisation.reduce(f)

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements under a condensed load alone."""
        moved: Array = self.B @ self.parts.solve(load)
        return moved

    def answer(self, load: Array, r: Array) -> Array:
        """Displacements (m,) of the contact dofs."""
        return self.parts.solve(load + self.B.T @ r)

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a)."""
        return self.parts.compliance(self.B)

    def among(self, rows: BoolArray) -> ByNodes:
        """The same with some rows alone."""
        return replace(self, B=self.B[rows])


@dataclass(frozen=True, kw_only=True, eq=False)
class ByPairs:
    """The forces of the pairs are kept, with the opposite sign.

    Attributes
    ----------
    rows : (d a,) those of the pairs that the law is asked of among all kept
    """

    factorisation: Factorisation
    rows: IntArray

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,): what is left are the displacements that they cause, with the opposite sign."""
        m = self.factorisation.m
        reduced = self.factorisation.reduce(np.concatenate([f, np.zeros(m)]))
        return Reduced(reduced.load, lambda kept: reduced.expand(kept)[:-m])

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements under a condensed load alone."""
        return -load[self.rows]

    def answer(self, load: Array, r: Array) -> Array:
        """The forces of all pairs kept, with the opposite sign."""
        kept = np.zeros_like(load)
        kept[self.rows] = -r
        return kept

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a)."""
        condensed = self.factorisation.schur()
        return -(condensed if len(self.rows) == len(condensed) else condensed[np.ix_(self.rows, self.rows)])

    def among(self, rows: BoolArray) -> ByPairs:
        """The same with some rows alone."""
        return replace(self, rows=self.rows[rows])


def keep_pairs(K: sp.csr_array, B: sp.csr_array, nodes: IntArray, points: Array, *, at: Array, backend: str) -> ByPairs:
    """Factorise bodies that supports hold.

    Parameters
    ----------
    K : (z, z) stiffness of the free displacements
    B : (d a, z) relative displacements of the pairs in terms of them
    nodes : (z,) node of each free displacement
    points : (nodes, d) where the nodes are
    at : (a, d) where the pairs are
    backend : of the factorisation, "auto" or a name

    Raises
    ------
    NotPositiveDefinite
        If anything moves without resistance.

    Examples
    --------
    Two nodes on springs of stiffness 4 and 16, and the distance between them:

    >>> kept = keep_pairs(
    ...     sp.csr_array(np.diag([4.0, 16.0])),
    ...     sp.csr_array(np.array([[1.0, -1.0]])),
    ...     np.array([0, 1]),
    ...     np.zeros((2, 1)),
    ...     at=np.zeros((1, 1)),
    ...     backend="auto",
    ... )
    >>> kept.compliance().tolist(), kept.moved(kept.reduce(np.array([1.0, 0.0])).load).tolist()
    ([[0.3125]], [0.25])
    """
    m, n = B.shape
    pair = len(points) + np.tile(np.arange(len(at)), m // max(1, len(at)))
    factorisation = factorise(
        bordered(K, B),
        np.arange(n, n + m),
        nodes=np.concatenate([nodes, pair]),
        points=np.concatenate([points, at]),
        backend=backend,
    )
    return ByPairs(factorisation=factorisation, rows=np.arange(m))
