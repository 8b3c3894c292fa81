# SPDX-License-Identifier: BSD-3-Clause
"""The pieces of the piecewise linear equation, their walls, and the columns that a pair has in each.

A pair's state is a piece of its plane (y_n, y_t); each has a few walls ``a_n y_n + a_t y_t >= a``, in slots::

    open         0: -y_n >= 0
    stick        0: mu y_n - y_t >= 0,  1: mu y_n + y_t >= 0;  2 j, 2 j + 1: the same for branch j of the bound
    slip s       0: y_n >= kink,  1: s y_t - mu y_n >= start,  2: -y_n >= -next kink
    without friction, or dragged by its support: as slip, without 1

with start, slope mu and the kinks of the branch of the bound (`law.bound`) that it slips on: in Coulomb's
law there is one, start and kink are 0 and the next kink is nowhere, and the pieces are cones.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.law.bound import SIGN, FrictionBound
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

LOWER, EDGE, UPPER = 0, 1, 2
"""Slots of a slipping pair."""


def placed(state: IntArray, bound: FrictionBound, closed: IntArray) -> tuple[Array, Array]:
    """Coefficients (a_n, a_t) of the walls of every pair, (slots, 2, n), of length 1 or 0 for none, and a, (slots, n).

    Parameters
    ----------
    state : (n,) codes with their branch
    bound : of the friction
    closed : (n,) as in `PairLaw.closed`

    Examples
    --------
    >>> placed(np.array([SLIP_MINUS]), FrictionBound.of([0.75]), np.array([UNDECIDED]))[0].tolist()
    [[[1.0], [0.0]], [[-0.6], [-0.8]]]
    >>> wall, a = placed(np.array([SLIP_MINUS + 2]), FrictionBound.of([0.75], limit=1.5), np.array([UNDECIDED]))
    >>> wall[:3, :, 0].tolist(), a[:3, 0].tolist()
    ([[1.0, 0.0], [-0.0, -1.0], [0.0, 0.0]], [2.0, 1.5, 0.0])
    """
    count = bound.branches
    wall = np.zeros((2 if count == 1 else max(3, 2 * count), 2, len(state)))
    offset = np.zeros((len(wall), len(state)))
    wall[LOWER, 0] = np.where(state == OPEN, -1.0, 1.0)
    free = closed == UNDECIDED
    stick, slip = free & (state == STICK), state > STICK
    for j in range(count):
        has = stick & np.isfinite(bound.kinks[j])
        for slot, sign in ((2 * j, 1.0), (2 * j + 1, -1.0)):
            wall[slot, 0, has], wall[slot, 1, has] = bound.slopes[j, has], -sign
            offset[slot, has] = -bound.starts[j, has]
    if count > 1:
        own = np.flatnonzero(slip)
        branch = (state[own] - SLIP_PLUS) // 2
        offset[LOWER, own] = bound.kinks[branch, own]
        following = bound.kinks[branch + 1, own]
        more = own[np.isfinite(following)]
        wall[UPPER, 0, more], offset[UPPER, more] = -1.0, -following[np.isfinite(following)]
    slip = slip & free
    sign = SIGN[state[slip]]
    wall[EDGE, 0, slip] = -np.abs(bound.slope(state)[slip])
    wall[EDGE, 1, slip], offset[EDGE, slip] = sign, np.abs(bound.start(state)[slip])
    length = np.hypot(wall[:, 0], wall[:, 1])
    length = np.where(length > 0, length, 1.0)
    return wall / length[:, None], offset / length


def beyond(state: int, slot: int, y_t: float, closed: int) -> tuple[int, int]:
    """The state on the other side of wall ``slot`` of a pair's piece, and which wall of that state it is.

    Parameters
    ----------
    state, slot : code of the piece, and the wall
    y_t : tangential part of the point where it is crossed, whose sign an open pair that closes slips with
    closed : state of the pair wherever it is closed, UNDECIDED where y decides

    Examples
    --------
    >>> beyond(STICK, 1, -0.3, UNDECIDED) == (SLIP_MINUS, 1), beyond(OPEN, 0, 0.2, UNDECIDED) == (SLIP_PLUS, 0)
    (True, True)
    """
    if state == OPEN:
        return (closed if closed != UNDECIDED else SLIP_PLUS if y_t >= 0 else SLIP_MINUS), LOWER
    if state == STICK:
        return SLIP_PLUS + slot, EDGE
    if slot == EDGE:
        return STICK, state - SLIP_PLUS
    if slot == UPPER:
        return state + 2, LOWER
    return (OPEN, LOWER) if state <= SLIP_MINUS else (state - 2, UPPER)


def jacobian(G: Array, W: Array, slope: Array, state: IntArray) -> Array:
    """(2n, 2n) matrix J of ``G h(y) - W r(y) = J y + constant`` while every pair keeps its state.

    Parameters
    ----------
    G, W : (2n, 2n) of the problem
    slope : (n,) of the branch that a pair slips on, >= 0: mu in Coulomb's law
    state : (n,) codes with their branch
    """
    n = len(state)
    J = np.empty((2 * n, 2 * n), order="F")
    for i in range(n):
        J[:, [i, n + i]] = columns(G, W, slope[i], int(state[i]), i)
    return J


def columns(G: Array, W: Array, slope: float, state: int, i: int) -> Array:
    """(2n, 2) columns of J that belong to pair i.

    Parameters
    ----------
    G, W : (2n, 2n) of the problem
    slope, state : of the pair, as of `jacobian`

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
    signed = SIGN[state] * slope
    return np.stack([signed * (G[:, n + i] - W[:, n + i]) - W[:, i], -G[:, n + i]], axis=1)


def constant(G: Array, W: Array, bound: FrictionBound, state: IntArray) -> Array:
    """(2n,) What of ``G h(y) - W r(y)`` does not depend on y: the friction that slipping pairs carry at no pressure.

    Parameters
    ----------
    G, W : (2n, 2n) of the problem
    bound, state : of the friction, and (n,) codes with their branch
    """
    n = len(state)
    given = bound.start(state)
    acting = np.flatnonzero(given)
    return np.asarray((G[:, n + acting] - W[:, n + acting]) @ given[acting], dtype=np.float64)
