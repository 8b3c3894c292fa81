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
from signorini.linalg._block_rows import lanes
from signorini.linalg._sweeps import product, prolong, restrict, sweep_back, sweep_from_zero, with_lanes
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
    """Cycles from zero, Gauss-Seidel by blocks forward on the way down and backward, its transpose, on the way up.

    A coarser level is gone to twice, y = M b and M A y with the V-cycle M from there, and what is taken of both is
    Chebyshev's polynomial of degree two in M A. Where a V-cycle leaves much, as of thin plates, whose bending few
    coarse motions know, it takes half the iterations; elsewhere a tenth fewer, for a tenth more time each.

    Attributes
    ----------
    levels : all but the coarsest, the finest first
    coarsest : solves on the coarsest level, symmetric
    unit : of A, in which the levels are: single precision knows no stiffness of 1e40

    References
    ----------
    Axelsson, Vassilevski (1990), Algebraic multilevel preconditioning methods II, SIAM J. Numer. Anal. 27:1569-1590.
    """

    levels: tuple[MultigridLevel, ...]
    coarsest: Callable[[Array], Array]
    unit: float = 1.0

    def __call__(self, b: Array) -> Array:
        """An approximate solution x of ``A x = b``, symmetric in b."""
        size = float(np.abs(b).max(initial=0.0)) or 1.0
        if not self.levels:
            return self.coarsest(b / size) * (size / self.unit)
        d, precision = self.levels[0].A.size, self.levels[0].A.lower.dtype
        x = self._descend(0, with_lanes((b / size).reshape(-1, d).astype(precision, copy=False)))
        return x[:, :d].ravel().astype(np.float64, copy=False) * (size / self.unit)

    def _twice(self, depth: int, b: RealArray) -> RealArray:
        """On a coarser level, of right sides (m, lanes(d)) and solutions like them."""
        if depth == len(self.levels):
            e = self.levels[-1].P.blocksize[1]
            found = self.coarsest(np.asarray(b[:, :e], dtype=np.float64).ravel())
            return with_lanes(found.reshape(-1, e).astype(b.dtype, copy=False))
        A, x = self.levels[depth].A, self._descend(depth, b)
        left = product(A.size * (0,), A.indptr, A.indices, A.lower, A.diagonal, x)
        return _FIRST * x + _SECOND * self._descend(depth, left)

    def _descend(self, depth: int, b: RealArray) -> RealArray:
        """A V-cycle from a level, of right sides (m, lanes(d)) and solutions like them."""
        level = self.levels[depth]
        A, P = level.A, level.P
        block, coarse_block = A.size * (0,), P.blocksize[1] * (0,)
        x, left = sweep_from_zero(block, A.indptr, A.indices, A.lower, level.inverses, b)
        coarse = np.zeros((P.shape[1] // len(coarse_block), lanes(len(coarse_block))), b.dtype)
        restrict(block, coarse_block, P.indptr, P.indices, P.data, left, coarse)
        prolong(block, coarse_block, P.indptr, P.indices, P.data, self._twice(depth + 1, coarse), x)
        sweep_back(block, A.indptr, A.indices, A.lower, level.inverses, b, x)
        return x


def _shares(least: float) -> tuple[float, float]:
    """``c, e`` of ``c M b + e M A M b``: for eigenvalues t of M A from a least one to 1 it leaves the least.

    That is ``1 - c t - e t^2 = T(m - s t) / T(m)`` with ``T(x) = 2 x^2 - 1``, ``s = 2 / (1 - least)`` and
    ``m = s (1 + least) / 2``.
    """
    slope = 2.0 / (1.0 - least)
    shift = slope * (1.0 + least) / 2.0
    most = 2.0 * shift**2 - 1.0
    return 4.0 * shift * slope / most, -2.0 * slope**2 / most


_FIRST, _SECOND = _shares(0.4)  # an eigenvalue of good V-cycles; with less those of thin plates take as many iterations
