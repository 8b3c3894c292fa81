# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation for elastic bodies and the springs of their contacts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.linalg.vcycle import MultigridLevel, VCycle

_COARSEST_BLOCKS = 100  # blocks that are solved for directly
_FREE_MOTION = 1e-13  # of the largest stiffness: motions that nothing resists


@dataclass(frozen=True, kw_only=True, eq=False)
class SprungLevel:
    """A level to whose stiffness springs of contacts are added in place, at the few nodes that contacts move.

    Attributes
    ----------
    level : the stiffness with the pattern of all springs, and the way to the next coarser level
    nodes : (c,) blocks that contacts move, in order
    own : (k,) blocks of the matrix in their rows
    keys : (k,) which those are, ascending: row times the number of blocks of the level, and column
    bodies : (k, d, d) what the bodies alone have there
    down : (d c, e) prolongation to the unknowns of these nodes from those of the next level that they see
    """

    level: MultigridLevel
    nodes: IntArray
    own: IntArray
    keys: IntArray
    bodies: Array
    down: sp.csr_array

    def spring(self, added: sp.csr_array) -> None:
        """Put springs (d c, d c) between the nodes in place of those before."""
        A, d = self.level.A, self.level.A.blocksize[0]
        A.data[self.own] = self.bodies
        blocks = sp.bsr_array(added, blocksize=(d, d))
        rows = np.repeat(np.arange(len(self.nodes)), np.diff(blocks.indptr))
        places = np.searchsorted(self.keys, _keys(self.nodes[rows], self.nodes[blocks.indices], A))
        np.add.at(A.data, self.own[places], blocks.data)
        diagonal = self.own[np.searchsorted(self.keys, _keys(self.nodes, self.nodes, A))]
        self.level.inverses[self.nodes] = np.linalg.pinv(A.data[diagonal], rcond=_FREE_MOTION, hermitian=True)


class Multigrid:
    """Smoothed aggregation of the bodies alone, to which the springs of contacts are added on every level.

    No coarse motion then reaches across a contact, so that the same ones serve whether it sticks or slips, and new
    springs, at the nodes of contacts alone, cost less than an iteration. Made with the springs of one state they would
    take five times the iterations in another, and making them takes as long as twenty.

    Parameters
    ----------
    K : (n, n) stiffness in blocks of a node
    near_null : (n, k) motions that hardly need a force: rigid ones
    B : (m, n) motions of the pairs between which there may be springs

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """

    def __init__(self, K: sp.bsr_array, near_null: Array, B: sp.csr_array) -> None:
        self._K, self._near_null, self._B = K, near_null, B

    def under(self, springs: sp.csr_array) -> VCycle:
        """The cycle for the bodies and springs (n, n) between them; it serves until there are others.

        Parameters
        ----------
        springs : ``B' S B``, symmetric, never negative
        """
        sprung, seen = self._sprung
        added = sp.csr_array(springs[self._moved][:, self._moved])
        for each in sprung:
            each.spring(added)
            added = sp.csr_array(each.down.T @ added @ each.down)
        whole = self._levels[-1].A.toarray()
        whole[np.ix_(seen, seen)] += added.toarray()
        inverse = np.linalg.pinv(whole, rcond=_FREE_MOTION, hermitian=True)
        return VCycle(levels=tuple(each.level for each in sprung), coarsest=lambda b: np.asarray(inverse @ b))

    @cached_property
    def _moved(self) -> IntArray:
        """Unknowns of the nodes that contacts move."""
        return _unknowns(np.unique(self._B.indices // self._K.blocksize[0]), self._K.blocksize[0])

    @cached_property
    def _levels(self) -> list[Any]:
        """Levels of the bodies alone, the finest first."""
        import pyamg  # takes longer to load than most models to solve directly

        with _repeatable():
            made = pyamg.smoothed_aggregation_solver(
                sp.bsr_matrix(self._K),
                B=self._near_null,
                strength=("symmetric", {"theta": 0.0}),
                improve_candidates=None,
                max_coarse=_COARSEST_BLOCKS,
            )
        return list(made.levels)

    @cached_property
    def _sprung(self) -> tuple[list[SprungLevel], IntArray]:
        """All levels but the coarsest, and the unknowns of that one which contacts move."""
        made, moved = [], self._moved
        motions = abs(self._B[:, moved])
        for level in self._levels[:-1]:
            each, moved = _sprung(level, moved, sp.csr_array(motions.T @ motions))
            motions = sp.csr_array(motions @ abs(each.down))
            made.append(each)
        return made, moved


def _sprung(level: Any, moved: IntArray, pattern: sp.csr_array) -> tuple[SprungLevel, IntArray]:
    """A level of multigrid and the unknowns of the next one that contacts move.

    Parameters
    ----------
    level : of the bodies alone
    moved : (d c,) unknowns of its own that contacts move, whole blocks
    pattern : (d c, d c) where springs may be between them
    """
    from pyamg.util.utils import get_block_diag

    d = level.A.blocksize[0]
    nodes, whole = moved[::d] // d, level.A.sorted_indices()
    rows = _rows_of(whole, nodes)
    keys, bodies = _keys(np.repeat(nodes, np.diff(whole.indptr)[nodes]), whole.indices[rows], whole), whole.data[rows]
    springs = sp.coo_array(sp.bsr_array(pattern, blocksize=(d, d)).tocsr())
    far = sp.csr_matrix((np.ones(springs.nnz), (moved[springs.row], moved[springs.col])), shape=whole.shape)
    both = sp.bsr_matrix(whole + far.tobsr(blocksize=(d, d)))
    both.sort_indices()
    own = _rows_of(both, nodes)
    all_keys = _keys(np.repeat(nodes, np.diff(both.indptr)[nodes]), both.indices[own], both)
    both.data[own] = 0.0
    both.data[own[np.searchsorted(all_keys, keys)]] = bodies
    down = sp.csr_array(level.P.tocsr()[moved])
    seen = _unknowns(np.unique(down.indices // level.P.blocksize[1]), level.P.blocksize[1])
    inverses = get_block_diag(both, d, inv_flag=True)
    made = SprungLevel(
        level=MultigridLevel(A=both, P=level.P, R=level.P.T.tobsr(), inverses=inverses),
        nodes=nodes,
        own=own,
        keys=all_keys,
        bodies=both.data[own],
        down=sp.csr_array(down[:, seen]),
    )
    return made, seen


def _unknowns(nodes: IntArray, d: int) -> IntArray:
    return (d * nodes[:, None] + np.arange(d)).ravel()


def _rows_of(A: Any, nodes: IntArray) -> IntArray:
    """Numbers of the blocks in rows of blocks."""
    counts = np.diff(A.indptr)[nodes]
    return np.repeat(A.indptr[nodes] - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())


def _keys(rows: IntArray, columns: IntArray, A: Any) -> IntArray:
    return rows.astype(np.int64) * (A.shape[0] // A.blocksize[0]) + columns


@contextmanager
def _repeatable() -> Iterator[None]:
    """PyAMG starts from vectors of NumPy's global generator: the same ones every time, and it is put back."""
    before = np.random.get_state()  # noqa: NPY002
    np.random.seed(0)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002
