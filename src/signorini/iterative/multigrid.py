# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation for elastic bodies and the springs of their contacts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack

from signorini.arrays import Array, IntArray, SingleArray
from signorini.iterative._spring_sums import add_springs
from signorini.iterative.aggregation import CoarsenedMatrix, aggregated
from signorini.iterative.springs import PairSprings
from signorini.linalg.symmetric_blocks import SymmetricBlocks
from signorini.linalg.vcycle import MultigridLevel, VCycle

_COARSEST_BLOCKS = 100  # blocks that are solved for directly
_FREE_MOTION = 1e-13  # of the largest stiffness: motions that nothing resists


@dataclass(frozen=True, kw_only=True, eq=False)
class SprungLevel:
    """A level to whose stiffness springs of contacts are added in place, at the few nodes that contacts move.

    What is read in every cycle is in single precision; the diagonal is not, since its blocks are inverted, of which
    some have motions that nothing resists.

    Attributes
    ----------
    level : the stiffness with the pattern of all springs, and the way to the next coarser level
    nodes : (c,) blocks on the diagonal that springs are added to
    own : (k,) those before the diagonal
    bodies : (k, d, d) what the bodies alone have there
    held : (c, d, d) and on the diagonal
    """

    level: MultigridLevel
    nodes: IntArray
    own: IntArray
    bodies: SingleArray
    held: Array

    def spring(self, motions: Any, springs: Array) -> None:
        """Put springs in place of those before.

        Parameters
        ----------
        motions : of a pairs, in blocks
        springs : (a, d, d) of every pair
        """
        A = self.level.A
        A.lower[self.own], A.diagonal[self.nodes] = self.bodies, self.held
        parts = motions.indptr, motions.indices, motions.data
        pair, block = (size * (0,) for size in motions.blocksize)
        add_springs(pair, block, parts, springs, (A.indptr, A.indices), A.lower, A.diagonal)
        self.level.inverses[self.nodes] = _inverses(A.diagonal[self.nodes])


class Multigrid:
    """Smoothed aggregation of the bodies alone, to which the springs of contacts are added on every level.

    No coarse motion then reaches across a contact, so that the same ones serve whether it sticks or slips, and new
    springs, at the nodes of contacts alone, cost less than an iteration. Made with the springs of one state they would
    take five times the iterations in another, and making them takes as long as twenty.

    Parameters
    ----------
    K : (n, n) stiffness
    near_null : (n, k) motions that hardly need a force: rigid ones
    B : (d a, n) motions of all pairs between which there may be springs, direction by direction
    """

    def __init__(self, K: SymmetricBlocks, near_null: Array, B: sp.csr_array) -> None:
        self._K, self._near_null, self._B = K, near_null, B
        self._unit = float(K.diagonal.max(initial=0.0)) or 1.0
        self._seen: tuple[sp.csr_array, list[Any]] | None = None

    def under(self, B: sp.csr_array, springs: PairSprings) -> VCycle:
        """The cycle for the bodies and springs between them; it serves until there are others.

        Parameters
        ----------
        B : motions of the pairs, all or some of them
        springs : of these pairs
        """
        each, (sprung, coarsest) = springs.each / self._unit, self._made
        *moved, last = self._motions(B)
        for level, motions in zip(sprung, moved, strict=True):
            level.spring(motions, each)
        count = np.arange(len(each) + 1)
        pairs = sp.bsr_array((each, count[:-1], count), shape=(last.shape[0], last.shape[0]))
        whole = coarsest + (last.T @ (pairs @ last)).toarray()
        inverse = _inverse(whole)
        levels = tuple(level.level for level in sprung)
        return VCycle(levels=levels, coarsest=lambda b: np.asarray(inverse @ b), unit=self._unit)

    def _motions(self, B: sp.csr_array) -> list[Any]:
        """Motions of the pairs in terms of the unknowns of every level, the finest first, in blocks of a pair."""
        if self._seen is None or self._seen[0] is not B:
            self._seen = B, _on_levels(B, self._K.size, [each.level.P for each in self._made[0]])
        return self._seen[1]

    @cached_property
    def _made(self) -> tuple[list[SprungLevel], Array]:
        """Levels with room for springs but the coarsest, the finest first; and the coarsest of the bodies alone."""
        levels, coarsest = aggregated(self._K, self._near_null, _COARSEST_BLOCKS)
        motions = _on_levels(self._B, self._K.size, [each.P for each in levels])
        made = [_sprung(level, moved, self._unit) for level, moved in zip(levels, motions[:-1], strict=True)]
        return made, coarsest.whole.toarray() / self._unit


def _on_levels(B: sp.csr_array, d: int, prolongations: list[Any]) -> list[Any]:
    """Motions of the pairs, (d a, n), in terms of the unknowns of every level, in blocks, pair by pair."""
    a = B.shape[0] // d
    rows = (np.arange(a)[:, None] + a * np.arange(d)).ravel()
    motions = [sp.bsr_array(sp.csr_array(B[rows]), blocksize=(d, d))]
    for P in prolongations:
        motions.append(sp.bsr_array(motions[-1] @ P))
    return motions


def _sprung(level: CoarsenedMatrix, motions: Any, unit: float) -> SprungLevel:
    """A level with room for springs between all nodes that a pair moves.

    Parameters
    ----------
    level : of the bodies alone
    motions : of the pairs, in blocks
    unit : of what the level has of both
    """
    A, m = level.A, len(level.A.diagonal)
    ones, count = np.ones(len(motions.indices)), len(motions.indptr) - 1
    seen = sp.csr_array((ones, motions.indices, motions.indptr), shape=(count, m))
    nodes = np.unique(motions.indices)
    far = float(len(A.indices) + 1)
    between = sp.csr_array(sp.tril(seen.T @ seen, -1))
    between.data[:] = far
    number = sp.csr_array((np.arange(1.0, far), A.indices, A.indptr), shape=(m, m))
    both = sp.csr_array(number + between)  # numbers of blocks of A, from 1 on, and where springs may be
    both.sort_indices()
    lower = np.zeros((both.nnz, A.size, A.size), np.float32)
    lower[both.data % far > 0.0] = A.lower / unit
    own = np.flatnonzero(both.data >= far)
    indptr, indices = (each.astype(np.int32, copy=False) for each in (both.indptr, both.indices))
    diagonal = A.diagonal / unit
    made = SymmetricBlocks(indptr=indptr, indices=indices, lower=lower, diagonal=diagonal)
    return SprungLevel(
        level=MultigridLevel(A=made, P=level.P.astype(np.float32), inverses=_inverses(diagonal)),
        nodes=nodes,
        own=own,
        bodies=lower[own],
        held=diagonal[nodes],
    )


def _inverses(blocks: Array) -> SingleArray:
    """(m, d, d) Of symmetric blocks, of motions that something resists."""
    return np.asarray(np.linalg.pinv(blocks, rcond=_FREE_MOTION, hermitian=True), dtype=np.float32)


def _inverse(A: Array) -> Array:
    """(n, n) Of a positive semidefinite matrix; none of motions that nothing resists.

    By a factorisation with pivots, which takes half of the time of eigenvalues; these tell what is resisted a little.
    """
    factor, order, rank, _ = lapack.dpstrf(A, tol=_FREE_MOTION * A.diagonal().max(initial=0.0), lower=1)
    if rank < len(A):
        found = np.linalg.pinv(A, rcond=_FREE_MOTION, hermitian=True)
        return np.asarray(0.5 * (found + found.T))
    part = np.tril(lapack.dpotri(factor, lower=1)[0])
    made = np.empty(A.shape)
    made[np.ix_(order - 1, order - 1)] = part + np.tril(part, -1).T
    return made
