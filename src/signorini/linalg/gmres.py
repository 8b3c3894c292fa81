# SPDX-License-Identifier: BSD-3-Clause
"""GMRES with the preconditioner on the right, without restarts: for systems that a few dozen products solve.

References
----------
Saad, Schultz (1986), GMRES, SIAM J. Sci. Stat. Comput. 7:856-869.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import solve_triangular

from signorini.arrays import Array

_MOST = 80  # products; a system that needs more is factorised


def gmres(
    product: Callable[[Array], Array], precondition: Callable[[Array], Array], rhs: Array, tolerance: float
) -> Array | None:
    """Solve ``M x = rhs`` to a residual, with the preconditioner on the right; None where it takes too long.

    Examples
    --------
    >>> M = np.array([[2.0, 1.0], [0.0, 3.0]])
    >>> gmres(lambda x: M @ x, lambda y: y, np.array([3.0, 3.0]), 1e-12).round(12).tolist()
    [1.0, 1.0]
    """
    first = float(np.linalg.norm(rhs))
    if first <= tolerance:
        return np.zeros_like(rhs)
    basis, images = np.empty((_MOST + 1, len(rhs))), np.empty((_MOST, len(rhs)))
    basis[0] = rhs / first
    triangle, turned = np.zeros((_MOST, _MOST)), np.zeros(_MOST + 1)
    turned[0] = first
    rotations: list[tuple[float, float]] = []
    for j in range(_MOST):
        images[j] = precondition(basis[j])
        new, Q = product(images[j]), basis[: j + 1]
        column = np.zeros(j + 2)
        for _ in range(2):
            part = Q @ new
            new = new - part @ Q
            column[: j + 1] += part
        column[j + 1] = beyond = float(np.linalg.norm(new))
        _rotate(column, rotations)
        if not 0.0 < column[j] < np.inf:
            return None
        cosine, sine = rotations[j]
        triangle[: j + 1, j] = column[: j + 1]
        turned[j], turned[j + 1] = cosine * turned[j], -sine * turned[j]
        if abs(turned[j + 1]) <= tolerance:
            y = solve_triangular(triangle[: j + 1, : j + 1], turned[: j + 1], check_finite=False)
            return np.asarray(y @ images[: j + 1], dtype=np.float64)
        if beyond <= 1e-14 * first:
            return None
        basis[j + 1] = new / beyond
    return None


def _rotate(column: Array, rotations: list[tuple[float, float]]) -> None:
    """Turn a new column of the Hessenberg matrix by the rotations before it, and by one more that clears its end."""
    values: list[float] = column.tolist()
    for i, (cosine, sine) in enumerate(rotations):
        values[i], values[i + 1] = cosine * values[i] + sine * values[i + 1], cosine * values[i + 1] - sine * values[i]
    length = float(np.hypot(values[-2], values[-1]))
    rotations.append((values[-2] / length, values[-1] / length) if length > 0.0 else (1.0, 0.0))
    values[-2:] = [length, 0.0]
    column[:] = values
