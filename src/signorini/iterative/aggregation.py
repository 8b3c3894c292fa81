# SPDX-License-Identifier: BSD-3-Clause
"""Ever coarser matrices of a symmetric one by smoothed aggregation, of which no step needs the whole matrix."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigvalsh_tridiagonal

from signorini.arrays import Array
from signorini.iterative._galerkin import mirrored, restrict_half
from signorini.linalg._block_rows import lanes
from signorini.linalg.symmetric_blocks import SymmetricBlocks

_DAMPING = 4.0 / 3.0  # over the largest eigenvalue: of the step of Jacobi's method that smooths a prolongation
_EIGENVALUE_STEPS = 10  # of Lanczos: its estimate is a few hundredths too low, which the damping leaves room for


class CoarsenedMatrix(NamedTuple):
    """A matrix and the way to the next coarser one, ``P' A P``.

    Attributes
    ----------
    A : (n, n)
    P : (n, k) in blocks (BSR)
    """

    A: SymmetricBlocks
    P: Any


def aggregated(
    A: SymmetricBlocks, near_null: Array, coarsest: int
) -> tuple[tuple[CoarsenedMatrix, ...], SymmetricBlocks]:
    """A matrix and coarser ones, the finest first, and the coarsest.

    Parameters
    ----------
    A : positive semidefinite
    near_null : (n, k) motions that hardly need a force
    coarsest : blocks that need not be fewer

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """
    levels, blocks = [], len(A.diagonal)
    while blocks > coarsest:
        P, near_null = _prolongation(A, near_null)
        levels.append(CoarsenedMatrix(A, P))
        A = _coarser(A, P)
        blocks = len(A.diagonal)
    return tuple(levels), A


def largest_eigenvalue(A: SymmetricBlocks) -> float:
    """Of ``D^-1 A``, D the diagonal of A, nearly and from below; 1 where A has none.

    Examples
    --------
    >>> A = SymmetricBlocks.of(sp.bsr_array(np.array([[2.0, -1.0], [-1.0, 2.0]]), blocksize=(1, 1)))
    >>> round(largest_eigenvalue(A), 12)
    1.5
    """
    root = np.sqrt(_inverse_diagonal(A)).ravel()
    v = np.random.default_rng(0).standard_normal(A.shape[0]) * (root > 0.0)
    before = np.zeros_like(v)
    alpha: list[float] = []
    beta = [0.0]
    size = float(np.linalg.norm(v))
    while size > 0.0 and len(alpha) < _EIGENVALUE_STEPS:
        v /= size
        w = root * (A @ (root * v)) - beta[-1] * before
        alpha.append(float(w @ v))
        w -= alpha[-1] * v
        before, v, size = v, w, float(np.linalg.norm(w))
        beta.append(size)
        size = size if size > 1e-8 * abs(alpha[0]) else 0.0  # beyond an invariant subspace there is rounding alone
    if not alpha:
        return 1.0
    return float(eigvalsh_tridiagonal(np.array(alpha), np.array(beta[1 : len(alpha)])).max())


def _inverse_diagonal(A: SymmetricBlocks) -> Array:
    """(m, d) One over the diagonal, 0 where nothing is positive."""
    diagonal = np.diagonal(A.diagonal, axis1=1, axis2=2)
    return np.divide(1.0, diagonal, out=np.zeros(diagonal.shape), where=diagonal > 0.0)


def _prolongation(A: SymmetricBlocks, near_null: Array) -> tuple[Any, Array]:
    """From aggregates of nodes, each with the motions that hardly need a force; and what those are on the next level.

    The motions of an aggregate end abruptly at its edge: a step of Jacobi's method smooths them.
    """
    from pyamg.aggregation import standard_aggregation  # takes longer to load than most models to solve directly
    from pyamg.aggregation.tentative import fit_candidates

    T, coarse = fit_candidates(standard_aggregation(_graph(A))[0], near_null)
    T = sp.bsr_array(T)
    below = A.below
    smooth = sp.bsr_array(below @ T + below.T @ T + A.on_diagonal @ T)
    scale = _DAMPING / largest_eigenvalue(A) * _inverse_diagonal(A)
    smooth.data *= np.repeat(scale, np.diff(smooth.indptr), axis=0)[:, :, None]
    P = sp.bsr_array(T - smooth)
    P.sort_indices()
    return P, coarse


def _graph(A: SymmetricBlocks) -> Any:
    """Which blocks are joined by an entry."""
    m = len(A.diagonal)
    below = sp.csr_matrix((np.ones(len(A.indices), np.int8), A.indices, A.indptr), shape=(m, m))
    return sp.csr_matrix(below + below.T + sp.eye(m, dtype=np.int8))


def _coarser(A: SymmetricBlocks, P: Any) -> SymmetricBlocks:
    """``P' A P``."""
    d, e = P.blocksize
    m, size = P.shape[0] // d, P.shape[1] // e
    reached = sp.csr_matrix((np.ones(len(P.indices), np.int32), P.indices, P.indptr), shape=(m, size))
    joined = sp.csr_array(reached.T @ sp.csr_matrix(_graph(A) @ reached))
    joined.sort_indices()
    ends, columns = (each.astype(np.int32, copy=False) for each in (joined.indptr, joined.indices))
    rows = np.zeros((e * len(columns), lanes(e)))
    fine = A.indptr, A.indices, A.lower, A.diagonal
    restrict_half(d * (0,), e * (0,), lanes(e) * (0,), fine, (P.indptr, P.indices, P.data), (ends, columns), rows)
    blocks = rows.reshape(-1, e, lanes(e))[:, :, :e]
    row = np.repeat(np.arange(size), np.diff(ends))
    own, before = np.flatnonzero(columns == row), np.flatnonzero(columns < row)
    across = mirrored((ends, columns))
    indptr = np.zeros(size + 1, np.int32)
    np.cumsum(np.bincount(row[before], minlength=size), out=indptr[1:])
    lower, diagonal = (blocks[each] + blocks[across[each]].transpose(0, 2, 1) for each in (before, own))
    return SymmetricBlocks(indptr=indptr, indices=columns[before], lower=lower, diagonal=diagonal)
