# SPDX-License-Identifier: BSD-3-Clause
"""Free displacements in equal blocks, one a node, as sparse block matrices and multigrid want them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.linalg.symmetric_blocks import SymmetricBlocks


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

    def matrix(self, K: sp.csr_array) -> SymmetricBlocks:
        """A symmetric matrix (z, z) in blocks, ones of its size on the diagonal of the padding."""
        d, n = self.size, self.size * self.count
        blocks = SymmetricBlocks.gathered(K, self.place, self.count, d)
        across = np.setdiff1d(np.arange(n), self.place)  # the padding
        blocks.diagonal[across // d, across % d, across % d] = K.diagonal().sum() / len(self.place)
        return blocks


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
