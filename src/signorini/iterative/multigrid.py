# SPDX-License-Identifier: BSD-3-Clause
"""Conjugate gradients with smoothed aggregation for elastic bodies and the springs of their contacts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pyamg
import scipy.sparse as sp

from signorini.arrays import Array

_SMALLEST = 100  # blocks that are solved for directly
_FORWARD = ("block_gauss_seidel", {"sweep": "forward"})  # down, and backward up again: together symmetric
_BACKWARD = ("block_gauss_seidel", {"sweep": "backward"})
_WORSE = 3.0  # iterations a digit beyond half as many again as with a fresh hierarchy: worth a new one
_MOST = 400  # iterations


class Preconditioner:
    """A V-cycle for ``K + B' H B``, renewed only when the contact has changed so much that iterations pay for it.

    Parameters
    ----------
    K : (n, n) stiffness in blocks of a node
    near_null : (n, k) motions that hardly need a force: rigid ones

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """

    def __init__(self, K: sp.bsr_array, near_null: Array) -> None:
        self._K, self._near_null = K, near_null
        self._cycle: Cycle | None = None
        self._fresh = self._last = 0.0
        self._stale = True
        self.builds = 0

    def changed(self) -> None:
        """Say that the springs are no longer those of the hierarchy."""
        self._stale = True

    def solve(
        self, springs: Callable[[], sp.csr_array], apply: Any, g: Array, *, tolerance: float
    ) -> tuple[Array, int]:
        """Solve ``(K + B' H B) x = g`` to a relative residual; x and the number of iterations.

        Parameters
        ----------
        springs : gives B' H B, (n, n), where it is needed
        apply : (n,) to (n,), the whole matrix
        """
        if self._cycle is None or (self._stale and self._last > 1.5 * self._fresh + _WORSE):
            self._cycle = self._build(springs())
        x, iterations, digits = conjugate_gradients(apply, self._cycle, g, tolerance)
        rate = iterations / max(digits, 0.1)
        if self._fresh == 0.0:
            self._fresh = rate
        self._last = rate
        return x, iterations

    def _build(self, springs: sp.csr_array) -> Cycle:
        size = self._K.blocksize
        A = sp.bsr_array(self._K + sp.bsr_array(springs, blocksize=size), blocksize=size)
        self._fresh, self._stale = 0.0, False
        self.builds += 1
        return Cycle(
            pyamg.smoothed_aggregation_solver(
                sp.bsr_matrix(A),
                B=self._near_null,
                strength=("symmetric", {"theta": 0.0}),
                improve_candidates=None,
                presmoother=_FORWARD,
                postsmoother=_BACKWARD,
                max_coarse=_SMALLEST,
            )
        )


class Cycle:
    """A symmetric V-cycle from zero. That of PyAMG also computes the residual before and after, two products more.

    In single precision neither products nor smoothing take less time.
    """

    def __init__(self, hierarchy: Any) -> None:
        self._levels = hierarchy.levels
        self._coarsest = hierarchy.coarse_solver

    def __call__(self, b: Array) -> Array:
        """An approximate solution x of ``A x = b``, symmetric in b."""
        return self._descend(0, b)

    def _descend(self, depth: int, b: Array) -> Array:
        level = self._levels[depth]
        if depth == len(self._levels) - 1:
            return np.asarray(self._coarsest(level.A, b), dtype=np.float64)
        x = np.zeros_like(b)
        level.presmoother(level.A, x, b)
        x += level.P @ self._descend(depth + 1, level.R @ (b - level.A @ x))
        level.postsmoother(level.A, x, b)
        return x


def conjugate_gradients(
    apply: Callable[[Array], Array], precondition: Callable[[Array], Array], g: Array, tolerance: float
) -> tuple[Array, int, float]:
    """Preconditioned conjugate gradients from zero: x, iterations, and the digits that the residual lost.

    Examples
    --------
    >>> x, iterations, _ = conjugate_gradients(lambda v: 2.0 * v, lambda v: v, np.array([2.0, 4.0]), 1e-12)
    >>> x.tolist(), iterations
    ([1.0, 2.0], 1)
    """
    x, residual = np.zeros_like(g), g.copy()
    first = float(np.linalg.norm(g))
    left = first
    direction, old = np.zeros_like(g), 1.0
    for count in range(1, _MOST + 1):
        z = precondition(residual)
        new = float(residual @ z)
        direction = z + (new / old if count > 1 else 0.0) * direction
        forces = apply(direction)
        step = new / float(direction @ forces)
        x += step * direction
        residual -= step * forces
        old, left = new, float(np.linalg.norm(residual))
        if left <= tolerance * first:
            break
    return x, count, float(np.log10(first / max(left, 1e-300)))
