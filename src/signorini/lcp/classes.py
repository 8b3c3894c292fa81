# SPDX-License-Identifier: BSD-3-Clause
"""Classes of matrices: what can be decided, at what cost, and where only a hint is possible."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.errors import InputError

LARGEST_EXACT = 20  # rows: tests that take 2^n steps are offered up to it
ROUNDING_TOL = 1e-12  # of the largest entry or eigenvalue: less counts as 0
SMALLEST_PIVOT = 1e-13  # of the largest entry of a Schur complement: less counts as 0


def is_symmetric(M: Any) -> bool:
    """Whether ``|M_ij - M_ji| <= 1e-12 max|M|``. Cost: n^2, or the nonzeros.

    >>> is_symmetric([[1.0, 2.0], [2.0, 3.0]])
    True
    """
    if sp.issparse(M):
        return bool(abs(M - M.T).max() <= ROUNDING_TOL * abs(M).max())
    A = _square(M)
    return bool(np.abs(A - A.T).max(initial=0.0) <= ROUNDING_TOL * np.abs(A).max(initial=0.0))


def is_positive_definite(M: Any) -> bool:
    """Whether x'Mx > 0 for all x, by a Cholesky factorisation of the symmetric part. Cost: n^3 / 3.

    >>> is_positive_definite([[1.0, -5.0], [5.0, 1.0]])
    True
    """
    A = _square(M)
    try:
        la.cholesky(_unit_diagonal(A + A.T), check_finite=False)
    except la.LinAlgError:
        return False
    return True


def is_positive_semidefinite(M: Any) -> bool:
    """Whether x'Mx >= 0 for all x (M is monotone), by the least eigenvalue of ``M + M'``. Cost: about 4 n^3 / 3.

    >>> is_positive_semidefinite([[0.0, 1.0], [-1.0, 0.0]])
    True
    """
    A = _square(M)
    values = la.eigvalsh(_unit_diagonal(A + A.T), check_finite=False)
    return bool(values[0] >= -ROUNDING_TOL * len(A) * max(1.0, float(np.abs(values).max())))


def is_z(M: Any) -> bool:
    """Whether all off-diagonal entries are <= 0. Cost: n^2, or the nonzeros.

    >>> is_z([[2.0, -1.0], [0.0, 1.0]])
    True
    """
    if sp.issparse(M):
        entries = M.tocoo()
        return bool((entries.data[entries.row != entries.col] <= 0).all())
    A = _square(M)
    return bool((A[~np.eye(len(A), dtype=bool)] <= 0).all())


def is_k(M: Any) -> bool:
    """Whether M is a K-matrix (a nonsingular M-matrix: Z and P): Z with ``M x = 1`` solved by an x > 0. Cost: n^3.

    References
    ----------
    Berman, Plemmons (1994), Nonnegative Matrices in the Mathematical Sciences, theorem 6.2.3, condition I27.

    Examples
    --------
    >>> is_k([[2.0, -1.0], [-1.0, 2.0]]), is_k([[1.0, -2.0], [-2.0, 1.0]])
    (True, False)
    """
    A = _square(M)
    if not is_z(A):
        return False
    try:
        return bool((np.linalg.solve(A, np.ones(len(A))) > 0).all())
    except np.linalg.LinAlgError:
        return False


def is_p(M: Any) -> bool:
    """Whether all principal minors are positive, exactly (up to rounding). Cost: about 2^n: n <= 20 only.

    The recursive test of Tsatsomeros and Li: M is P where M_11 > 0 and both the rest of M and the Schur complement of
    M_11 are P. A P-matrix gives every LCP exactly one solution.

    Raises
    ------
    InputError
        For n > 20; the problem is co-NP-complete, and no cheap exact test is known.

    References
    ----------
    Tsatsomeros, Li (2000), A recursive test for P-matrices, BIT 40:410-414.

    Examples
    --------
    >>> is_p([[1.0, 2, 0], [0, 1, 2], [2, 0, 1]]), is_p([[1.0, -3], [-3, 1]])
    (True, False)
    """
    A = _small(M, "P")
    stack = A[None]
    while stack.shape[1]:
        if not (stack[:, 0, 0] > SMALLEST_PIVOT * np.abs(stack).max(axis=(1, 2), initial=0.0)).all():
            return False
        rest = stack[:, 1:, 1:]
        schur = rest - stack[:, 1:, :1] * stack[:, :1, 1:] / stack[:, :1, :1]
        stack = np.concatenate([rest, schur])
    return True


def is_copositive_plus(M: Any) -> bool:
    """Whether x'Mx >= 0 for x >= 0, and ``(M + M') x = 0`` where x'Mx = 0. Cost: 2^n in general, n <= 20 only.

    Monotone matrices are recognised first, at any size. Otherwise every principal block B of ``M + M'`` is tested
    (Gaddum, Kaplan): copositive where no block has an eigenvector v > 0 of a negative eigenvalue.

    Raises
    ------
    InputError
        For n > 20 where M is not monotone.

    References
    ----------
    Cottle, Pang, Stone (1992), section 3.8; Kaplan (2000), A test for copositive matrices, Linear Algebra Appl. 313.

    Examples
    --------
    >>> is_copositive_plus([[1.0, 2.0], [2.0, 1.0]]), is_copositive_plus([[0.0, 1.0], [1.0, 0.0]])
    (True, False)
    """
    A = _square(M)
    if is_positive_semidefinite(A):
        return True
    S = _unit_diagonal(_small(A, "copositive plus") + A.T)
    for code in range(1, 2 ** len(S)):
        chosen = np.flatnonzero(code >> np.arange(len(S)) & 1)
        values, vectors = la.eigh(S[np.ix_(chosen, chosen)])
        for value, v in zip(values, vectors.T, strict=True):
            positive = bool((v > ROUNDING_TOL).all() or (v < -ROUNDING_TOL).all())
            if positive and value < -ROUNDING_TOL:
                return False
            if positive and abs(value) <= ROUNDING_TOL and np.abs(S[:, chosen] @ v).max() > 1e3 * ROUNDING_TOL:
                return False
    return True


def _square(M: Any) -> Array:
    A = np.asarray(M.toarray() if sp.issparse(M) else M, dtype=float)
    if A.ndim != 2 or A.shape[0] != A.shape[1]:
        raise InputError(f"has shape {A.shape}; expected a square matrix", where=("M",))
    return A


def _small(M: Any, what: str) -> Array:
    A = _square(M)
    if len(A) > LARGEST_EXACT:
        raise InputError(
            f"has n = {len(A)}; the exact test for {what} takes about 2^n steps and is offered to n = {LARGEST_EXACT}",
            where=("M",),
        )
    return A


def _unit_diagonal(S: Array) -> Array:
    """Symmetric scaling, which changes no class: unit diagonal where it is positive."""
    diagonal = np.diag(S)
    scale = 1.0 / np.sqrt(np.where(diagonal > 0, diagonal, np.abs(S).max(initial=0.0) or 1.0))
    return S * scale[:, None] * scale
