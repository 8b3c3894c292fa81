# SPDX-License-Identifier: BSD-3-Clause
"""The cones of the piecewise linear equation, their walls, and the columns that a pair has in each.

A pair's state is a cone of its plane (y_n, y_t); each cone has at most two walls ``a_n y_n + a_t y_t >= 0``::

    open         -y_n >= 0
    stick        mu y_n - y_t >= 0  and  mu y_n + y_t >= 0
    slip s       y_n >= 0           and  s y_t - mu y_n >= 0
    without friction, or dragged by its support: y_n >= 0 alone
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED


def walls(state: IntArray, mu: Array, closed: IntArray) -> Array:
    """(2, n, 2) coefficients (a_n, a_t) of the first and second wall of every pair; zeros where there is none.

    Scaled to length 1.

    Examples
    --------
    >>> walls(np.array([SLIP_MINUS]), np.array([0.75]), np.array([UNDECIDED])).tolist()
    [[[1.0, 0.0]], [[-0.6, -0.8]]]
    """
    wall = np.zeros((2, len(state), 2))
    wall[0, :, 0] = np.where(state == OPEN, -1.0, 1.0)
    free = closed == UNDECIDED
    stick, slip = free & (state == STICK), free & ((state == SLIP_PLUS) | (state == SLIP_MINUS))
    wall[:, stick, 0] = mu[stick]
    wall[0, stick, 1], wall[1, stick, 1] = -1.0, 1.0
    wall[1, slip, 0] = -mu[slip]
    wall[1, slip, 1] = np.where(state[slip] == SLIP_PLUS, 1.0, -1.0)
    length = np.hypot(wall[:, :, :1], wall[:, :, 1:])
    return np.asarray(wall / np.where(length > 0, length, 1.0), dtype=np.float64)


def beyond(state: int, slot: int, y_t: float, closed: int) -> tuple[int, int]:
    """The state on the other side of wall ``slot`` of a pair's cone, and which wall of that state it is.

    Examples
    --------
    >>> beyond(STICK, 1, -0.3, UNDECIDED) == (SLIP_MINUS, 1), beyond(OPEN, 0, 0.2, UNDECIDED) == (SLIP_PLUS, 0)
    (True, True)
    """
    if state == OPEN:
        return (closed if closed != UNDECIDED else SLIP_PLUS if y_t >= 0 else SLIP_MINUS), 0
    if closed != UNDECIDED or (state != STICK and slot == 0):
        return OPEN, 0
    if state == STICK:
        return (SLIP_PLUS, 1) if slot == 0 else (SLIP_MINUS, 1)
    return STICK, 0 if state == SLIP_PLUS else 1


def jacobian(G: Array, W: Array, mu: Array, state: IntArray) -> Array:
    """(2n, 2n) matrix J of ``G h(y) - W r(y) = J y`` while every pair keeps its state."""
    n = len(state)
    J = np.empty((2 * n, 2 * n), order="F")
    for i in range(n):
        J[:, [i, n + i]] = columns(G, W, mu[i], int(state[i]), i)
    return J


def columns(G: Array, W: Array, mu: float, state: int, i: int) -> Array:
    """(2n, 2) columns of J that belong to pair i.

    Examples
    --------
    >>> columns(np.diag([0.5, 0.5]), np.diag([0.5, 0.5]), 0.2, SLIP_PLUS, 0).tolist()
    [[-0.5, -0.0], [0.0, -0.5]]
    """
    n = len(G) // 2
    if state == OPEN:
        return -G[:, [i, n + i]]
    if state == STICK:
        return -W[:, [i, n + i]]
    slope = mu if state == SLIP_PLUS else -mu
    return np.stack([slope * (G[:, n + i] - W[:, n + i]) - W[:, i], -G[:, n + i]], axis=1)
