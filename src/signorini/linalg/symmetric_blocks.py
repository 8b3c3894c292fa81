# SPDX-License-Identifier: BSD-3-Clause
"""A symmetric sparse matrix in blocks, of which the lower half is kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, Int32Array, IntArray, RealArray
from signorini.linalg._lower_half import count_before, gather
from signorini.linalg._sweeps import product, with_lanes


@dataclass(frozen=True, kw_only=True, eq=False)
class SymmetricBlocks:
    """A symmetric matrix in blocks (d, d): half of the memory of a whole one, and products that read half as much.

    Attributes
    ----------
    indptr, indices : (m + 1,), (k,) columns of the blocks before the diagonal, row by row, ascending
    lower : (k, d, d) those blocks
    diagonal : (m, d, d) blocks on the diagonal

    Examples
    --------
    >>> A = SymmetricBlocks.of(sp.bsr_array(np.array([[2.0, -1.0], [-1.0, 3.0]]), blocksize=(1, 1)))
    >>> A.lower.ravel().tolist(), (A @ np.array([1.0, 3.0])).tolist()
    ([-1.0], [-1.0, 8.0])
    """

    indptr: Int32Array
    indices: Int32Array
    lower: RealArray
    diagonal: Array

    @staticmethod
    def of(A: Any) -> SymmetricBlocks:
        """The lower half of a symmetric matrix in blocks (BSR), whatever the order of its columns."""
        whole = A if A.has_sorted_indices else A.sorted_indices()
        m, d = whole.shape[0] // whole.blocksize[0], whole.blocksize[0]
        rows = np.repeat(np.arange(m, dtype=np.int32), np.diff(whole.indptr))
        before = whole.indices < rows
        indptr = np.zeros(m + 1, dtype=np.int32)
        np.cumsum(np.bincount(rows[before], minlength=m), out=indptr[1:])
        own = whole.indices == rows
        diagonal = np.zeros((m, d, d))
        diagonal[rows[own]] = whole.data[own]
        indices = whole.indices[before].astype(np.int32, copy=False)
        return SymmetricBlocks(indptr=indptr, indices=indices, lower=whole.data[before], diagonal=diagonal)

    @staticmethod
    def gathered(K: sp.csr_array, place: IntArray, count: int, size: int) -> SymmetricBlocks:
        """A symmetric matrix (z, z) whose unknowns go to other places, in blocks; what is nobody's place is zero.

        Parameters
        ----------
        K : by rows
        place : (z,) of every unknown among ``count * size``
        count, size : rows of blocks, and rows of a block

        Examples
        --------
        >>> K = sp.csr_array(np.array([[2.0, -1.0], [-1.0, 3.0]]))
        >>> SymmetricBlocks.gathered(K, np.array([3, 0]), 2, 2).whole.toarray().tolist()
        [[3.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 2.0]]
        """
        node, axis = (place // size).astype(np.int32), (place % size).astype(np.int32)
        order = np.argsort(place)
        begin = np.searchsorted(node[order], np.arange(count + 1))
        ends = np.zeros(count + 1, dtype=np.int32)
        count_before(K.indptr, K.indices, node, order, begin, ends)
        np.cumsum(ends, out=ends)
        columns, lower = np.empty(ends[-1], np.int32), np.zeros((ends[-1], size, size))
        made = SymmetricBlocks(indptr=ends, indices=columns, lower=lower, diagonal=np.zeros((count, size, size)))
        gather((K.indptr, K.indices, K.data), (node, axis, order, begin), ends, columns, lower, made.diagonal)
        return made

    @property
    def size(self) -> int:
        """Rows of a block, d."""
        return self.diagonal.shape[1]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        n = self.diagonal.shape[0] * self.size
        return n, n

    @property
    def below(self) -> sp.bsr_array:
        """The blocks before the diagonal as a matrix; nothing is copied."""
        return sp.bsr_array((self.lower, self.indices, self.indptr), shape=self.shape)

    @property
    def on_diagonal(self) -> sp.bsr_array:
        """The blocks on the diagonal as a matrix; nothing is copied."""
        places = np.arange(len(self.diagonal) + 1, dtype=np.int32)
        return sp.bsr_array((self.diagonal, places[:-1], places), shape=self.shape)

    @property
    def whole(self) -> sp.csr_array:
        """The matrix with both halves."""
        below = self.below
        return sp.csr_array(below + below.T + self.on_diagonal)

    def __matmul__(self, x: Array) -> Array:
        """``A x``, (n,)."""
        d = self.size
        given = with_lanes(x.reshape(-1, d).astype(self.lower.dtype, copy=False))
        moved = product(d * (0,), self.indptr, self.indices, self.lower, self.diagonal, given)
        return np.asarray(moved[:, :d].ravel(), dtype=np.float64)
