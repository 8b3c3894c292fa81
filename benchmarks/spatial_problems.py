# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb friction in space without finite elements: a punch on a half-space, hard random problems, a residual."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.friction.problem import ContactProblem

POISSON = 0.3


def half_space_compliance(points: Array, cell: float) -> Array:
    """(3n, 3n) Displacement per point force on a half-space, E = 1; n normals, n first and n second tangents.

    A point's own displacement is that of the same force spread over a disc with the area of its cell, at the centre.

    Parameters
    ----------
    points : (n, 2) on the surface, length
    cell : area of a cell

    References
    ----------
    Johnson (1985), Contact Mechanics, sections 3.2 (Boussinesq) and 3.6 (Cerruti).
    """
    n, nu = len(points), POISSON
    d = points[:, None] - points
    off = 1.0 - np.eye(n)
    s = np.hypot(d[..., 0], d[..., 1]) + np.eye(n)
    own = 2.0 / np.sqrt(cell / np.pi) * np.eye(n)
    inverse = off / s + own
    A = np.empty((3, n, 3, n))
    A[0, :, 0] = (1 - nu**2) / np.pi * inverse
    for i in (0, 1):
        A[0, :, 1 + i] = (1 - 2 * nu) * (1 + nu) / (2 * np.pi) * off * d[..., i] / s**2
        A[1 + i, :, 0] = -A[0, :, 1 + i]
        for j in (0, 1):
            A[1 + i, :, 1 + j] = (1 + nu) / np.pi * nu * off * d[..., i] * d[..., j] / s**3
        A[1 + i, :, 1 + i] += (1 + nu) / np.pi * ((1 - nu) * inverse + 0.5 * nu * own)
    return A.reshape(3 * n, 3 * n)


def punch(side: int, *, push: tuple[float, float] = (0.075, 0.05), turn: float = 0.075) -> tuple[Array, Array]:
    """Compliance A (3n, 3n) and motion c (3n,) of a curved punch pressed into a half-space, pushed aside and turned.

    Parameters
    ----------
    side : points along a side of the square -1 <= x, y <= 1; n = side^2
    push, turn : tangential motion, and rotation about the normal

    Examples
    --------
    >>> A, c = punch(3)
    >>> A.shape, c[:9].min()
    ((27, 27), np.float64(-0.25))
    """
    line = np.linspace(-1.0, 1.0, side)
    x = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    gap = 0.5 * (x**2).sum(axis=1) - 0.25
    slip = np.array(push) + turn * np.column_stack([-x[:, 1], x[:, 0]])
    return half_space_compliance(x, (2.0 / (side - 1)) ** 2), np.concatenate([gap, slip[:, 0], slip[:, 1]])


def hard_random(gap: float = 1.0) -> Iterator[tuple[float, float, Array, Array]]:
    """72 problems with A = H H' of random H: 10 and 30 pairs, rank 1.5, 2, 3 a pair, friction 0.3, 1, 2, four of each.

    Parameters
    ----------
    gap : size of random gaps beside ``c = H v``; with 0 the motion -v leaves none, and a solution is only just there

    Yields
    ------
    rank a pair, friction, A (3n, 3n), c (3n,)
    """
    for pairs in (10, 30):
        for rank in (1.5, 2.0, 3.0):
            for friction in (0.3, 1.0, 2.0):
                for seed in range(4):
                    rng = np.random.default_rng([pairs, int(2 * rank), int(10 * friction), seed])
                    H = rng.normal(size=(3 * pairs, int(rank * pairs)))
                    c = H @ rng.normal(size=H.shape[1])
                    c[:pairs] += gap * np.abs(rng.normal(size=pairs))
                    yield rank, friction, H @ H.T, c


def from_compliance(
    A: ArrayLike, c: ArrayLike, friction: ArrayLike, *, facets: int = 0
) -> tuple[ContactProblem, Array]:
    """The problem ``u = A r + c`` of bodies that supports hold, in its image form.

    With X = D^.5 A D^.5 the image form is ``W = X (I + X)^-1``, ``b = (I + X)^-1 D^.5 c``; it exists for any
    positive semidefinite A. D is 3 over the trace of a pair's block.

    Parameters
    ----------
    A : (3n, 3n) symmetric positive semidefinite compliance, ordered as in `ContactProblem`, length per force
    c : (3n,) motion of the pairs under the loads, gaps included, length
    friction, facets : see `ContactProblem`

    Returns
    -------
    problem, root : root (3n,) holds the square roots of D: ``u = h / root``, forces ``r root``

    Examples
    --------
    >>> problem, root = from_compliance(4.0 * np.eye(3), [-1.0, 0.0, 0.0], [0.3])
    >>> problem.W.diagonal().tolist(), problem.b.tolist(), root.tolist()
    ([0.5, 0.5, 0.5], [-0.25, 0.0, 0.0], [0.5, 0.5, 0.5])
    """
    compliance, offset = np.asarray(A, dtype=np.float64), np.asarray(c, dtype=np.float64)
    if compliance.shape != (len(offset), len(offset)) or len(offset) % 3:
        raise InputError(f"has shape {compliance.shape}, c {offset.shape}; expected (3n, 3n) and (3n,)", where=("A",))
    trace = compliance.diagonal().reshape(3, -1).sum(axis=0)
    if not (trace > 0).all():
        raise InputError(f"pair {int(np.argmin(trace))} has no positive compliance in any direction", where=("A",))
    root = np.tile(np.sqrt(3.0 / trace), 3)
    X = root[:, None] * compliance * root
    softened = np.linalg.solve(X + np.eye(len(X)), np.column_stack([X, root * offset]))
    W, b = softened[:, :-1], softened[:, -1]
    problem = ContactProblem.of(
        W=(W + W.T) / 2,
        b=b,
        friction=np.asarray(friction, dtype=np.float64),
        motions=np.zeros((len(offset), 0)),
        scale=float(np.abs(b).max(initial=0.0)),
        facets=facets,
    )
    return problem, root


def natural_residual(motion: Array, force: Array, friction: ArrayLike, stiffness: ArrayLike) -> float:
    """Residual of motions and forces of n pairs as a cone complementarity problem, relative to the forces.

    With De Saxce's motion ``u~ = u + mu |u_t| n`` Coulomb's law with a circular cone K reads ``K contains r, K*
    contains u~, r . u~ = 0``; the residual is ``|r - P_K(r - rho u~)| / |r|``.

    Parameters
    ----------
    motion, force : (3, n) normals, first and second tangents
    friction : mu, (n,) or a number
    stiffness : rho > 0, (n,) or a number, force per length

    References
    ----------
    De Saxce, Feng (1998), Mathematical and Computer Modelling 28:225-245. Acary, Bremond, Huber (2018), in: Advanced
    Topics in Nonsmooth Dynamics, section 6.

    Examples
    --------
    >>> natural_residual(np.array([[0.0], [-2.0], [0.0]]), np.array([[1.0], [0.5], [0.0]]), 0.5, 1.0)
    0.0
    """
    u, r, rho = motion.reshape(3, -1), force.reshape(3, -1), np.asarray(stiffness, dtype=np.float64)
    mu = np.asarray(friction, dtype=np.float64) * np.ones(u.shape[1])
    x = r - rho * u
    x[0] -= rho * mu * np.hypot(u[1], u[2])
    length = np.hypot(x[1], x[2])
    outside = length > mu * x[0]
    pressing = np.where(outside, np.maximum(x[0] + mu * length, 0.0) / (1.0 + mu**2), x[0])
    share = np.where(outside, mu * pressing / np.where(length > 0, length, 1.0), 1.0)
    nearest = np.array([pressing, share * x[1], share * x[2]])
    size = float(np.linalg.norm(r))
    return float(np.linalg.norm(r - nearest)) / (size if size > 0 else 1.0)
