# SPDX-License-Identifier: BSD-3-Clause
"""The law of a pair in one unknown: ``y = r - h``, force minus relative motion, two numbers a pair.

Because a pair never presses and gapes at once, and never has friction to spare while it slips, y tells both::

    p = max(y_n, 0)      gap  = max(-y_n, 0)
    r_t = clip(y_t, -F(p), F(p))      slip = r_t - y_t

with F the bound of the friction, ``mu p`` in Coulomb's law (see `law.bound` for others). Every y obeys the
law; what is left to solve is equilibrium, one piecewise linear equation in y with four pieces a pair, or two more for
every further branch of F.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.law.bound import FrictionBound
from signorini.law.states import OPEN as OPEN
from signorini.law.states import SLIP_MINUS as SLIP_MINUS
from signorini.law.states import SLIP_PLUS as SLIP_PLUS
from signorini.law.states import STICK as STICK
from signorini.law.states import UNDECIDED as UNDECIDED

STATE_NAMES = ("open", "stick", "slip, friction +", "slip, friction -")


def split(y: Array, friction: Array | FrictionBound) -> tuple[Array, Array]:
    """Motion h = (gap, slip increment) and force r = (normal, tangential) of y.

    Parameters
    ----------
    y : (2n,) n normals, then n tangents
    friction : the bound F; or (n,) mu >= 0, finite, of Coulomb's law

    Returns
    -------
    h, r : (2n,) with ``y = r - h``

    Examples
    --------
    >>> h, r = split(np.array([2.0, -3.0, 1.5, 4.0]), np.array([0.5, 0.5]))
    >>> h.tolist(), r.tolist()
    ([0.0, 3.0, -0.5, -4.0], [2.0, 0.0, 1.0, 0.0])
    """
    n = len(y) // 2
    pressure = np.maximum(y[:n], 0.0)
    bound = friction.at(pressure) if isinstance(friction, FrictionBound) else friction * pressure
    r = np.concatenate([pressure, np.clip(y[n:], -bound, bound)])
    return r - y, r


def states(y: Array, friction: Array | FrictionBound, closed: IntArray) -> IntArray:
    """The piece of each pair's plane that y lies in; slip codes with their branch, see `FrictionBound`.

    Parameters
    ----------
    y : (2n,)
    friction : the bound F, or (n,) mu
    closed : (n,) the state that a pair takes wherever it is closed, or UNDECIDED where y_t decides

    Examples
    --------
    >>> states(np.array([2.0, -3.0, 0.5, 4.0]), np.array([0.5, 0.5]), np.array([UNDECIDED, UNDECIDED])).tolist()
    [1, 0]
    """
    n = len(y) // 2
    y_n, y_t = y[:n], y[n:]
    most = friction.at(y_n) if isinstance(friction, FrictionBound) else friction * y_n
    state = np.where(np.abs(y_t) <= most, STICK, np.where(y_t >= 0, SLIP_PLUS, SLIP_MINUS))
    state = np.where(closed == UNDECIDED, state, closed)
    state = np.where(y_n <= 0, OPEN, state).astype(np.int64)
    return friction.coded(state, y_n) if isinstance(friction, FrictionBound) else state


def closed_states(friction: Array, locked: BoolArray, b_t: Array) -> IntArray:
    """What a closed pair can only be: slip without friction, slip as its support drags it.

    A locked pair (its tangential motion is that of its supports, whatever the forces) slips by b_t, known beforehand,
    and friction opposes it. UNDECIDED everywhere else.

    Examples
    --------
    >>> closed_states(np.array([0.0, 0.3, 0.3]), np.array([False, True, False]), np.full(3, 0.1)).tolist()
    [2, 3, -1]
    """
    closed = np.full(len(friction), UNDECIDED)
    closed[locked] = np.where(b_t[locked] > 0, SLIP_MINUS, SLIP_PLUS)
    closed[friction == 0] = SLIP_PLUS
    return closed.astype(np.int64)
