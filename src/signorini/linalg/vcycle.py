# SPDX-License-Identifier: BSD-3-Clause
"""The V-cycle of algebraic multigrid, on matrices made elsewhere.

Levels may be in single precision: a cycle is an approximation anyway, and what it takes is the time of reading them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from signorini.arrays import Array, RealArray
from signorini.linalg._sweeps import prolong, restrict, sweep_back, sweep_from_zero
from signorini.linalg.symmetric_blocks import SymmetricBlocks


@dataclass(frozen=True, kw_only=True, eq=False)
class MultigridLevel:
    """A symmetric matrix and the way to the next coarser one.

    Attributes
    ----------
    A : (m, m), in blocks (d, d)
    P : (m, k) from the next level, in blocks (BSR); its transpose leads there
    inverses : (m / d, d, d) of the blocks on the diagonal of A, in the precision of what A has before it, like P
    """

    A: SymmetricBlocks
    P: Any
    inverses: RealArray


@dataclass(frozen=True, kw_only=True, eq=False)
class VCycle:
    """A V-cycle from zero, Gauss-Seidel by blocks forward on the way down and backward, its transpose, on the way up.

    Attributes
    ----------
    levels : all but the coarsest, the finest first
    coarsest : solves on the coarsest level, symmetric
    unit : of A, in which the levels are: single precision knows no stiffness of 1e40
    """

    levels: tuple[MultigridLevel, ...]
    coarsest: Callable[[Array], Array]
    unit: float = 1.0

    def __call__(self, b: Array) -> Array:
        """An approximate solution x of ``A x = b``, symmetric in b."""
        size = float(np.abs(b).max(initial=0.0)) or 1.0
        return self._descend(0, b / size).astype(np.float64, copy=False) * (size / self.unit)

    def _descend(self, depth: int, b: RealArray) -> RealArray:
        if depth == len(self.levels):
            return self.coarsest(np.asarray(b, dtype=np.float64))
        level = self.levels[depth]
        A, P, e = level.A, level.P, level.P.blocksize[1]
        precision = A.lower.dtype
        block, given = A.size * (0,), b.reshape(-1, A.size).astype(precision, copy=False)
        x, left = sweep_from_zero(block, A.indptr, A.indices, A.lower, level.inverses, given)
        coarse = np.zeros((P.shape[1] // e, e), precision)
        restrict(block, P.indptr, P.indices, P.data, left, coarse)
        found = self._descend(depth + 1, coarse.ravel())
        prolong(block, P.indptr, P.indices, P.data, found.reshape(-1, e).astype(precision, copy=False), x)
        sweep_back(block, A.indptr, A.indices, A.lower, level.inverses, given, x)
        return x.ravel()
