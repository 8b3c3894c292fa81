# SPDX-License-Identifier: BSD-3-Clause
"""Problems of Coulomb friction in space without finite elements: a punch on a half-space, and hard random ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array

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
