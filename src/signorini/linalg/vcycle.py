# SPDX-License-Identifier: BSD-3-Clause
"""The V-cycle of algebraic multigrid, on matrices made elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from signorini.arrays import Array
from signorini.linalg._sweeps import prolong, restrict, sweep_back, sweep_from_zero
from signorini.linalg.symmetric_blocks import SymmetricBlocks


@dataclass(frozen=True, kw_only=True, eq=False)
class MultigridLevel:
    """A symmetric matrix and the way to the next coarser one.

    Attributes
    ----------
    A : (m, m), in blocks (d, d)
    P : (m, k) from the next level, in blocks (BSR); its transpose leads there
    inverses : (m / d, d, d) of the blocks on the diagonal of A
    """

    A: SymmetricBlocks
    P: Any
    inverses: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class VCycle:
    """A V-cycle from zero, Gauss-Seidel by blocks forward on the way down and backward, its transpose, on the way up.

    Attributes
    ----------
    levels : all but the coarsest, the finest first
    coarsest : solves on the coarsest level, symmetric
    """

    levels: tuple[MultigridLevel, ...]
    coarsest: Callable[[Array], Array]

    def __call__(self, b: Array) -> Array:
        """An approximate solution x of ``A x = b``, symmetric in b."""
        return self._descend(0, b)

    def _descend(self, depth: int, b: Array) -> Array:
        if depth == len(self.levels):
            return self.coarsest(b)
        level = self.levels[depth]
        A, P, e = level.A, level.P, level.P.blocksize[1]
        block, given = A.size * (0,), b.reshape(-1, A.size)
        x, left = sweep_from_zero(block, A.indptr, A.indices, A.lower, level.inverses, given)
        coarse = np.zeros((P.shape[1] // e, e))
        restrict(block, P.indptr, P.indices, P.data, left, coarse)
        found = self._descend(depth + 1, coarse.ravel())
        prolong(block, P.indptr, P.indices, P.data, found.reshape(-1, e), x)
        sweep_back(block, A.indptr, A.indices, A.lower, level.inverses, given, x)
        return x.ravel()
