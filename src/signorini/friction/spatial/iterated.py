# SPDX-License-Identifier: BSD-3-Clause
"""The system of a linearised law by GMRES: of many closed pairs the cheaper way, from where the last iterate ended.

The system of `equilibrium` for the problem as posed. Its preconditioner is the interface where every pair sticks,

    [ A   R ]^-1     [ G   R ]
    [ R'  0 ]     =  [ R'  0 ]   nearly,    G = I - W = (I + A)^-1 - R R',

restricted to what is unknown: the compliance of a surface is that of its larger eigenvalues, so that a dozen products
do what a factorisation would, at the cost of a few per cent of one.

References
----------
Saad, Schultz (1986), GMRES, SIAM J. Sci. Stat. Comput. 7:856-869.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.linalg import solve_triangular

from signorini.arrays import Array
from signorini.friction.interface import symmetric_product
from signorini.friction.spatial.equilibrium import Equilibrium, directions, prescribed
from signorini.friction.spatial.law import Tangent

LARGE = 500
"""Unknowns from which a factorisation costs more."""

_MOST = 80  # products; a system that needs more is factorised
_FORWARD = 1e-2  # of what the last iterate lacks: no Newton step deserves more
_SHARP = 1e-14  # of the size of the data


def iterate(equilibrium: Equilibrium, law: Tangent, r: Array, a: Array) -> tuple[Array, Array, Array] | None:
    """Forces r (3n,), rigid motion a (k,) and motions h (3n,) that nearly balance under a linearised law.

    Parameters
    ----------
    equilibrium : the problem as posed
    law : the law of every pair, linear
    r, a : (3n,) and (k,) where the last iterate ended

    Returns
    -------
    r, a, h; None where the iteration does not get there

    Examples
    --------
    >>> from signorini.friction.spatial.law import sticking
    >>> from signorini.friction.spatial.problem import SpatialProblem
    >>> problem = SpatialProblem(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.1]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> r, a, h = iterate(Equilibrium.of(problem), sticking(problem), np.zeros(3), np.zeros(0))
    >>> r.round(9).tolist(), h.tolist()
    ([2.0, -0.4, -0.2], [0.0, 0.0, 0.0])
    """
    problem = equilibrium.problem
    Z, Y, resisting = directions(problem.pairs, law)
    Z, Y, back = sp.csr_array(Z), sp.csr_array(Y.T), sp.csr_array(Y)
    fixed = np.concatenate([np.zeros(problem.pairs), law.fixed.T.ravel()])
    across, A, R, W = resisting > 0, problem.interface.A, problem.interface.R, problem.W
    size = Z.shape[1]

    def lacking(x: Array) -> Array:
        force = Z @ x[:size] + fixed
        motion = equilibrium.moved(force, x[size:])
        return np.concatenate([Y @ motion + resisting * x[:size], equilibrium.lacking(force, x[size:])])

    def product(x: Array) -> Array:
        force = Z @ x[:size]
        motion = symmetric_product(A, force) + R @ x[size:]
        return np.concatenate([Y @ motion + resisting * x[:size], R.T @ force])

    def precondition(y: Array) -> Array:
        motion = back @ np.where(across, 0.0, y[:size])
        force = motion - symmetric_product(W, motion) + R @ y[size:]
        return np.concatenate([np.where(across, y[:size], Y @ force), R.T @ motion])

    start = np.concatenate([_coordinates(law, r, problem.pairs), a])
    error = -lacking(start)
    tolerance = max(_FORWARD * float(np.linalg.norm(error)), _SHARP * problem.scale * np.sqrt(len(error)))
    change = gmres(product, precondition, error, tolerance)
    if change is None:
        return None
    x = start + change
    force = Z @ x[:size] + fixed
    return force, x[size:], prescribed(law, equilibrium.moved(force, x[size:]))


def _coordinates(law: Tangent, r: Array, n: int) -> Array:
    """The unknowns of given forces: normal ones, tangential ones that stick, those across a slip."""
    normal, tangential = r[:n], r[n:].reshape(2, n).T
    stick, one = law.left == 2, law.left == 1
    rest = tangential - law.share * normal[:, None] - law.fixed
    slipping = np.einsum("ni,ni->n", law.tau, rest)
    return np.concatenate([normal[law.closed], rest[stick, 0], rest[stick, 1], slipping[one]])


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
