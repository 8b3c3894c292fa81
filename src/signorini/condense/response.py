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

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.condense.body_blocks import BodyBlocks
from signorini.interface.active import FreeBodies
from signorini.linalg._dense_tiles import mirror
from signorini.linalg.elsewhere import is_elsewhere
from signorini.linalg.plan import Plans
from signorini.linalg.protocol import Factorisation, Reduced
from signorini.linalg.registry import factorise
from signorini.linalg.system import bordered
from signorini.sparse_rows import chosen_rows, seen_by, transposed

Travel = Callable[[Array], Array]
"""Rigid motion (k,) beyond given relative displacements (d a,) of the pairs."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Response(ABC):
    """How the bodies answer loads and the forces of the pairs; springs hold what nothing but contact resists.

    Attributes
    ----------
    factorisation : of the bodies, with what is kept last
    B : (d a, m) relative displacements of the pairs in terms of the displacements that forces are found to cause
    rigid : (m, k) rigid motions of those that nothing but contact resists
    """

    factorisation: Factorisation
    B: sp.csr_array
    rigid: Array

    @property
    def room(self) -> Array | None:
        """(d a, d a) Whose upper triangle and diagonal the first to ask may have for itself; None where is none."""
        return None

    @property
    def motions(self) -> Array:
        """(d a, k) Rigid motions as the pairs see them."""
        return seen_by(self.B, self.rigid)

    @abstractmethod
    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) on the free displacements onto what is kept."""

    @abstractmethod
    def moved(self, load: Array) -> Array:
        """(d a,) Relative displacements of the pairs under a condensed load alone."""

    @abstractmethod
    def resultant(self, load: Array) -> Array:
        """(k,) Work of a condensed load on the rigid motions."""

    @abstractmethod
    def compliance(self) -> Array:
        """Relative displacements of the pairs per force, (d a, d a), symmetric to the last digit; a new array."""

    @abstractmethod
    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """(z,) Free displacements under a reduced load, forces r (d a,) and the rigid motion that ``travel`` finds."""

    def travelled(self, x: Array, travel: Travel) -> Array:
        """Displacements x, (m,), and the rigid motion beyond them."""
        return x + self.rigid @ travel(seen_by(self.B, x)) if self.rigid.shape[1] else x

    def among(self, rows: BoolArray) -> Self:
        """This response with some of the (d a,) rows alone."""
        return replace(self, B=chosen_rows(self.B, rows))

    def moving(self, ways: Array) -> Self:
        """This response where of the k rigid motions only some combinations (k, m) occur, springs hold the others."""
        return replace(self, rigid=self.rigid @ ways)


@dataclass(frozen=True, kw_only=True, eq=False)
class ByNodes(Response):
    """The displacements of the contact nodes are kept.

    Attributes
    ----------
    parts : the condensed bodies
    """

    parts: BodyBlocks

    @property
    def room(self) -> Array | None:
        """What a body with as many dofs as the pairs have leaves of its factor."""
        rows = self.B.shape[0]
        return next((own.upper.T for own in self.parts.blocks if len(own.dofs) == rows), None)

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) onto the contact dofs."""
        return self.factorisation.reduce(f)

    def moved(self, load: Array) -> Array:
        """(d a,) What the bodies yield to a condensed load."""
        moved: Array = self.B @ self.parts.solve(load)
        return moved

    def resultant(self, load: Array) -> Array:
        """(k,) Work of a condensed load on the rigid motions."""
        return self.rigid.T @ load

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a), of all bodies together."""
        return self.parts.compliance(self.B)

    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """Displacements of the contact nodes under the reduced load and r, and travel, then all that follow them."""
        return reduced.expand(self.travelled(self.parts.solve(reduced.load + transposed(self.B) @ r), travel))


@dataclass(frozen=True, kw_only=True, eq=False)
class ByPairs(Response):
    """The forces of the pairs are kept, with the opposite sign; B and the rigid motions are of all free displacements.

    A condensed load is the displacements that it causes, with the opposite sign, and its resultants.

    Attributes
    ----------
    rows : (d a,) those of the pairs that the law is asked of among all kept
    left : (m, m) what the factorisation has left, below the diagonal; above it there is room for something else
    diagonal : (m,) of it
    """

    rows: IntArray
    left: Array
    diagonal: Array

    @property
    def room(self) -> Array | None:
        """What lies above the diagonal of what the factorisation has left, and says the same."""
        return self.left if len(self.rows) == len(self.left) else None

    def reduce(self, f: Array) -> Reduced:
        """Condense loads (z,) to what they move, and their resultants."""
        m, work = self.factorisation.m, self.rigid.T @ f
        if not isinstance(f, np.ndarray):  # it is on ranks, without the border, and so is what it moves
            there = self.factorisation.reduce(f)
            return Reduced(np.concatenate([there.load, work]), there.expand)
        reduced = self.factorisation.reduce(np.concatenate([f, np.zeros((m, *f.shape[1:]))]))
        return Reduced(np.concatenate([reduced.load, work]), lambda kept: reduced.expand(kept)[:-m])

    def moved(self, load: Array) -> Array:
        """(d a,) Part of the condensed load."""
        return -load[self.rows]

    def resultant(self, load: Array) -> Array:
        """(k,) Part of the condensed load."""
        return load[self.factorisation.m :]

    def compliance(self) -> Array:
        """Relative displacements per force, (d a, d a): what the factorisation has left."""
        all_rows = len(self.rows) == len(self.left)
        X = -(self.left if all_rows else self.left[np.ix_(self.rows, self.rows)])
        X[np.diag_indices_from(X)] = -self.diagonal[self.rows]
        mirror(X, 0, len(X))
        return X

    def displacement(self, reduced: Reduced, r: Array, travel: Travel) -> Array:
        """Free displacements under the reduced load and the forces r that are kept, and travel."""
        kept = np.zeros((self.factorisation.m, *r.shape[1:]))
        kept[self.rows] = -r
        return self.travelled(reduced.expand(kept), travel)

    def among(self, rows: BoolArray) -> Self:
        """This response with some of the (d a,) rows alone."""
        return replace(super().among(rows), rows=self.rows[rows])


def keep_pairs(
    bodies: FreeBodies, *, at: Array, rigid: Array, stiffness: float, backend: str, plans: Plans | None = None
) -> ByPairs:
    """Factorise bodies that are not tied.

    Parameters
    ----------
    bodies : with the pairs that the law is asked of
    at : (a, d) where the pairs are
    rigid : (z, k) rigid motions that supports do not resist
    stiffness : of the size of the data, force per length, of the springs where nothing deforms
    backend : of the factorisation, "auto" or a name
    plans : see :func:`signorini.linalg.registry.factorise`

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
    K, B, nodes, points = bodies[:4]
    m, n = B.shape
    order: dict[str, Any] = {"plans": plans}
    if not is_elsewhere(K):  # there nobody asks where unknowns are
        pair = len(points) + np.tile(np.arange(len(at)), m // max(1, len(at)))
        order |= {"nodes": np.concatenate([nodes, pair]), "points": np.concatenate([points, at])}
    K = bordered(held_by_springs(K, rigid, stiffness), B)
    factorisation = factorise(K, np.arange(n, n + m), backend=backend, **order)
    left, factorisation = factorisation.parted()
    kept = {"left": left, "diagonal": left.diagonal().copy()}
    return ByPairs(factorisation=factorisation, rows=np.arange(m), B=B, rigid=rigid, **kept)


def held_by_springs(K: Any, rigid: Array, stiffness: float) -> Any:
    """K with a spring on one dof for each rigid motion, dofs that are far apart.

    Parameters
    ----------
    K, rigid, stiffness : as of `keep_pairs`
    """
    if not rigid.shape[1]:
        return K
    if is_elsewhere(K):
        return K.held_by_springs(rigid, stiffness)
    basis = scipy.linalg.qr(rigid, mode="economic")[0]
    dofs = scipy.linalg.qr(basis.T, mode="economic", pivoting=True)[2][: rigid.shape[1]]
    springs = np.zeros(K.shape[0])
    springs[dofs] = K.diagonal().mean() if K.nnz else stiffness
    held = K.copy()
    held.setdiag(K.diagonal() + springs)  # keeps the pattern, which a sum would thin out
    return held
