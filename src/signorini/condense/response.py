# SPDX-License-Identifier: BSD-3-Clause
"""How the bodies answer loads and forces of the pairs, through what their factorisation keeps: contact nodes or pairs.

Contact nodes are always possible: see `condense.body_blocks`. Or the forces of the pairs are kept, as a border

    [ K   B^T ]
    [ B    0  ]    which condenses to    -B K^-1 B^T:

the compliance of the pairs comes straight out of the factorisation. No dense matrix of the contact nodes of a body is
inverted, and where meshes do not match fewer unknowns are kept. The contact nodes are eliminated like any others.

Either way springs hold what nothing but contact resists, with as many forces as there are rigid motions, so that under
balanced loads they carry nothing: what the bodies answer to those is right but for a rigid motion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.condense.body_blocks import BodyBlocks
from signorini.interface.active import FreeBodies
from signorini.linalg.border import bordered
from signorini.linalg.protocol import Factorisation, Reduced
from signorini.linalg.registry import factorise


class Response(Protocol):
    """How the bodies answer loads and the forces of the pairs; springs hold what nothing but contact resists."""

    @property
    def factorisation(self) -> Factorisation:
        """Of the bodies, with what is kept last."""

    @property
    def motions(self) -> Array:
        """(d a, k) Relative displacements of the pairs under the rigid motions that nothing but contact resists."""

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) on the free displacements onto what is kept."""

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements of the pairs under a condensed load alone."""

    def resultant(self, load: Array) -> Array:
        """(k,) Work of a condensed load on the rigid motions."""

    def compliance(self) -> Array:
        """Relative displacements of the pairs per force, (d a, d a), symmetric to the last digit; a new array."""

    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """Free displacements (z,) under a load, forces r (d a,) of the pairs and the rigid motion of `travel`.

        Parameters
        ----------
        reduced : a load, see `reduce`
        r : (d a,) forces of the pairs
        travel : finds the rigid motion
        """

    def among(self, rows: BoolArray) -> Self:
        """This response with some of the (d a,) rows alone."""

    def moving(self, ways: Array) -> Self:
        """This response where of the k rigid motions only some combinations (k, m) occur, springs hold the others."""


Travel = Callable[[Array], Array]
"""Rigid motion (k,) beyond given relative displacements (d a,) of the pairs."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ByNodes:
    """The displacements of the contact nodes are kept.

    Attributes
    ----------
    parts : the condensed bodies
    B : (d a, m) relative displacements of the pairs in terms of the contact dofs
    rigid : (m, k) rigid motions of those
    """

    factorisation: Factorisation
    parts: BodyBlocks
    B: sp.csr_array
    rigid: Array

    @property
    def motions(self) -> Array:
        """(d a, k) Rigid motions as the pairs see them."""
        seen: Array = self.B @ self.rigid
        return seen

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) onto the contact dofs."""
        return self.factorisation.reduce(f)

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements under a condensed load alone."""
        moved: Array = self.B @ self.parts.solve(load)
        return moved

    def resultant(self, load: Array) -> Array:
        """(k,) Work of a condensed load on the rigid motions."""
        return self.rigid.T @ load

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a)."""
        return self.parts.compliance(self.B)

    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """Free displacements (z,).

        Parameters
        ----------
        reduced, r, travel : see `Response`
        """
        moved = self.parts.solve(reduced.load + self.B.T @ r)
        if self.rigid.shape[1]:
            moved += self.rigid @ travel(self.B @ moved)
        return reduced.expand(moved)

    def among(self, rows: BoolArray) -> ByNodes:
        """This response with some rows (d a,) alone."""
        return replace(self, B=self.B[rows])

    def moving(self, ways: Array) -> ByNodes:
        """This response with some rigid motions alone."""
        return replace(self, rigid=self.rigid @ ways)


@dataclass(frozen=True, kw_only=True, eq=False)
class ByPairs:
    """The forces of the pairs are kept, with the opposite sign.

    A condensed load is the displacements that it causes, with the opposite sign, and its resultants.

    Attributes
    ----------
    rows : (d a,) those of the pairs that the law is asked of among all kept
    B : (d a, z) their relative displacements in terms of the free displacements
    rigid : (z, k) rigid motions of those
    """

    factorisation: Factorisation
    rows: IntArray
    B: sp.csr_array
    rigid: Array

    @property
    def motions(self) -> Array:
        """(d a, k) Rigid motions as the pairs see them."""
        seen: Array = self.B @ self.rigid
        return seen

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,)."""
        m = self.factorisation.m
        reduced = self.factorisation.reduce(np.concatenate([f, np.zeros(m)]))
        load = np.concatenate([reduced.load, self.rigid.T @ f])
        return Reduced(load, lambda kept: reduced.expand(kept)[:-m])

    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements under a condensed load alone."""
        return -load[self.rows]

    def resultant(self, load: Array) -> Array:
        """(k,) Work of a condensed load on the rigid motions."""
        return load[self.factorisation.m :]

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a)."""
        condensed = self.factorisation.schur()
        return -(condensed if len(self.rows) == len(condensed) else condensed[np.ix_(self.rows, self.rows)])

    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """Free displacements (z,).

        Parameters
        ----------
        reduced, r, travel : see `Response`
        """
        kept = np.zeros(self.factorisation.m)
        kept[self.rows] = -r
        z = reduced.expand(kept)
        return z + self.rigid @ travel(self.B @ z) if self.rigid.shape[1] else z

    def among(self, rows: BoolArray) -> ByPairs:
        """This response with some rows (d a,) alone."""
        return replace(self, rows=self.rows[rows], B=self.B[rows])

    def moving(self, ways: Array) -> ByPairs:
        """This response with some rigid motions alone."""
        return replace(self, rigid=self.rigid @ ways)


def keep_pairs(bodies: FreeBodies, *, at: Array, rigid: Array, stiffness: float, backend: str) -> ByPairs:
    """Factorise bodies that are not tied.

    Parameters
    ----------
    bodies : with the pairs that the law is asked of
    at : (a, d) where the pairs are
    rigid : (z, k) rigid motions that supports do not resist
    stiffness : of the size of the data, force per length, of the springs where nothing deforms
    backend : of the factorisation, "auto" or a name

    Raises
    ------
    NotPositiveDefinite
        If anything else moves without resistance.

    Examples
    --------
    Two nodes on springs of stiffness 4 and 16, and the distance between them:

    >>> K, B = sp.csr_array(np.diag([4.0, 16.0])), sp.csr_array(np.array([[1.0, -1.0]]))
    >>> bodies = FreeBodies(K, B, nodes=np.array([0, 1]), points=np.zeros((2, 1)))
    >>> kept = keep_pairs(bodies, at=np.zeros((1, 1)), rigid=np.zeros((2, 0)), stiffness=1.0, backend="auto")
    >>> kept.compliance().tolist(), kept.moved(kept.reduce(np.array([1.0, 0.0])).load).tolist()
    ([[0.3125]], [0.25])
    """
    K, B, nodes, points = bodies
    m, n = B.shape
    pair = len(points) + np.tile(np.arange(len(at)), m // max(1, len(at)))
    factorisation = factorise(
        bordered(_held(K, rigid, stiffness), B),
        np.arange(n, n + m),
        nodes=np.concatenate([nodes, pair]),
        points=np.concatenate([points, at]),
        backend=backend,
    )
    return ByPairs(factorisation=factorisation, rows=np.arange(m), B=B, rigid=rigid)


def _held(K: sp.csr_array, rigid: Array, stiffness: float) -> sp.csr_array:
    """K with a spring on one dof for each rigid motion, dofs that are far apart."""
    if not rigid.shape[1]:
        return K
    basis = scipy.linalg.qr(rigid, mode="economic")[0]
    dofs = scipy.linalg.qr(basis.T, mode="economic", pivoting=True)[2][: rigid.shape[1]]
    springs = np.zeros(K.shape[0])
    springs[dofs] = K.diagonal().mean() if K.nnz else stiffness
    return sp.csr_array(K + sp.diags_array(springs))
