# SPDX-License-Identifier: BSD-3-Clause
"""The V-cycle of algebraic multigrid, on matrices made elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from signorini.arrays import Array
from signorini.linalg._sweeps import sweep_back, sweep_from_zero


@dataclass(frozen=True, kw_only=True, eq=False)
class MultigridLevel:
    """A symmetric matrix and the way to the next coarser one.

    Attributes
    ----------
    A : (m, m) in blocks (BSR), columns sorted
    P, R : (m, k) and (k, m), from the next level and to it
    inverses : (m / d, d, d) of the blocks on the diagonal of A
    """

    A: Any
    P: Any
    R: Any
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
        A, d = level.A, level.A.blocksize[0]
        matrix = d * (0,), A.indptr, A.indices, A.data, level.inverses
        blocks, left = sweep_from_zero(*matrix, b.reshape(-1, d))
        x: Array = blocks.ravel()
        x += level.P @ self._descend(depth + 1, level.R @ left.ravel())
        sweep_back(*matrix, b.reshape(-1, d), x.reshape(-1, d))
        return x
