# SPDX-License-Identifier: BSD-3-Clause
"""Free displacements in equal blocks, one a node, as sparse block matrices and multigrid want them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Blocks:
    """Where every free displacement goes; what supports hold at a node stays as an unknown that nothing moves.

    Attributes
    ----------
    size : unknowns a block, d
    count : blocks
    place : (z,) of every free displacement among the ``size * count`` unknowns
    """

    size: int
    count: int
    place: IntArray

    def spread(self, values: Array) -> Array:
        """Values (z, ...) of free displacements on all unknowns, zero elsewhere."""
        result = np.zeros((self.size * self.count, *values.shape[1:]))
        result[self.place] = values
        return result

    def columns(self, B: sp.csr_array) -> sp.csr_array:
        """Rows (m, z) in terms of all unknowns."""
        shape = (B.shape[0], self.size * self.count)
        return sp.csr_array((B.data, self.place[B.indices], B.indptr), shape=shape)

    def matrix(self, K: sp.csr_array) -> sp.bsr_array:
        """A symmetric matrix (z, z) in blocks, ones of its size on the diagonal of the padding."""
        d, n = self.size, self.size * self.count
        K = _with_places(K)
        order = np.argsort(self.place)
        K = K if (np.diff(order) == 1).all() else sp.csr_array(K[order])
        counts = np.zeros(n + 1, dtype=np.int64)
        counts[self.place[order] + 1] = np.diff(K.indptr)
        whole = sp.csr_array((K.data, self.place[K.indices], np.cumsum(counts)), shape=(n, n))
        blocks = sp.bsr_array(whole, blocksize=(d, d))
        rows = np.repeat(np.arange(self.count), np.diff(blocks.indptr))
        own = np.flatnonzero(blocks.indices == rows)  # one a row, in order
        across = np.setdiff1d(np.arange(n), self.place)  # the padding
        blocks.data[own[across // d], across % d, across % d] = whole.diagonal().sum() / len(self.place)
        return blocks


def _with_places(K: sp.csr_array) -> sp.csr_array:
    """K with zeros stored on the diagonal of empty rows: of obstacles and rigid bodies, which are not stiff."""
    bare = np.flatnonzero(np.diff(K.indptr) == 0)
    if not len(bare):
        return K
    entries = K.tocoo()
    rows, columns = np.append(entries.row, bare), np.append(entries.col, bare)
    return sp.csr_array((np.append(entries.data, np.zeros(len(bare))), (rows, columns)), shape=K.shape)


def make_blocks(nodes: IntArray, axis: IntArray, size: int) -> Blocks:
    """Number the unknowns by node, then by axis.

    Parameters
    ----------
    nodes : (z,) node of every free displacement
    axis : (z,) its direction, 0 .. size - 1

    Examples
    --------
    >>> make_blocks(np.array([3, 7, 7]), np.array([1, 0, 1]), 2).place
    array([1, 2, 3])
    """
    known, index = np.unique(nodes, return_inverse=True)
    return Blocks(size=size, count=len(known), place=size * index + axis)
