# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation: a hierarchy of smaller matrices made from the entries of a symmetric positive definite one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.lcp.kernels import aggregate, compiled, sweeps
from signorini.lcp.linear import Inverse, factorised


@dataclass(frozen=True, kw_only=True)
class Level:
    """One matrix of the hierarchy.

    Attributes
    ----------
    A : (n, n) CSR array
    P : (n, coarse n) CSR array >= 0 for a Z-matrix, None on the coarsest level
    inverse : solves with A on the coarsest level
    """

    A: Any
    P: Any | None
    inverse: Inverse | None

    def relax(self, q: Array, z: Array, *, lower: float, backwards: bool, count: int = 1) -> None:
        """Gauss-Seidel sweeps for ``A z + q = 0`` in place, kept above ``lower``."""
        A = self.A
        compiled(sweeps)(A.indptr, A.indices, A.data, q, z, 1.0, lower, count, backwards)


def hierarchy(A: Any, *, coarsest: int = 300, strength: float = 0.08) -> list[Level]:
    """Levels from fine to coarse, each the Galerkin product of the one before.

    Parameters
    ----------
    A : (n, n) CSR array, symmetric, positive diagonal
    coarsest : size at which a level is factorised
    strength : neighbours couple where ``|A_ij| > strength sqrt(A_ii A_jj)``

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """
    levels = []
    while A.shape[0] > coarsest:
        P = _prolongation(A, strength)
        if P.shape[1] > 0.7 * A.shape[0]:
            break
        levels.append(Level(A=A, P=P, inverse=None))
        A = (P.T @ A @ P).tocsr()
        A.sort_indices()
    return [*levels, Level(A=A, P=None, inverse=factorised(A.tocsc()))]


def truncated(levels: list[Level], free: BoolArray) -> list[Level]:
    """The hierarchy of ``A x = r`` for the free unknowns alone, the others held at 0, with the prolongations given.

    What is prolonged to unknowns that are held is cut off on the finest level, and the coarser matrices are made anew:
    without that, coarse corrections carry from one side of a narrow contact to the other.

    References
    ----------
    Kornhuber (1994), Monotone multigrid methods for elliptic variational inequalities I, Numer. Math. 69:167-184.
    """
    kept = sp.diags_array(free.astype(float))
    A = (kept @ levels[0].A @ kept + sp.diags_array((~free).astype(float))).tocsr()
    cut: list[Level] = []
    for level in levels:
        A.sort_indices()
        if level.P is None:
            break
        P = level.P if cut else (kept @ level.P).tocsr()
        cut.append(Level(A=A, P=P, inverse=None))
        A = (P.T @ A @ P).tocsr()
        A = (A + sp.diags_array((A.diagonal() <= 0).astype(float))).tocsr()  # where nothing is left
    return [*cut, Level(A=A, P=None, inverse=factorised(A.tocsc()))]


def v_cycle(levels: list[Level], r: Array) -> Array:
    """Approximate solution of ``A x = r``: a symmetric positive definite map of r."""
    level = levels[0]
    if level.P is None:
        return r / level.A.diagonal() if level.inverse is None else level.inverse(r)
    x = np.zeros(len(r))
    level.relax(-r, x, lower=-np.inf, backwards=False)
    x += level.P @ v_cycle(levels[1:], level.P.T @ (r - level.A @ x))
    level.relax(-r, x, lower=-np.inf, backwards=True)
    return x


def _prolongation(A: Any, strength: float) -> Any:
    """Piecewise constants on aggregates, smoothed by one damped Jacobi step."""
    n = A.shape[0]
    root = np.sqrt(A.diagonal())
    graph = A.tocoo()
    strong = np.abs(graph.data) > strength * root[graph.row] * root[graph.col]
    pattern = sp.csr_array((np.ones(strong.sum()), (graph.row[strong], graph.col[strong])), shape=(n, n))
    label = np.full(n, -1, dtype=np.int64)
    groups = compiled(aggregate)(pattern.indptr, pattern.indices, label)
    constant = sp.csr_array((np.ones(n), (np.arange(n), label)), shape=(n, groups))
    return (constant - sp.diags_array(2.0 / 3.0 / A.diagonal()) @ (A @ constant)).tocsr()
