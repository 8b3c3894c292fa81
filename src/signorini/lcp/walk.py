# SPDX-License-Identifier: BSD-3-Clause
"""The compiled loop of Lemke's method: many pivots of a condensed tableau, its updates delayed and applied together.

A pivot is a rank-one update, which streams the whole tableau through the memory. Here the tableau is ``T - U V`` with
the columns of U and the rows of V from the last few pivots: a pivot needs one column, one row and the values, and
``T - U V`` is formed by one matrix product when U is full. The last column of T, the values, is always up to date.
"""

from __future__ import annotations

import math
from typing import Any

from numba import njit

from signorini.arrays import Array, IntArray
from signorini.lcp.reason import DOUBT, MORE, RAY, SOLVED


def blocking(
    column: Array, rhs: Array, pivot_tolerance: float, tie_tolerance: float, size: float, rows: IntArray
) -> tuple[int, float]:
    """Write the rows that stop the entering variable first, ties included; returns their number and the step.

    Parameters
    ----------
    column, rhs : (n,) rates at which the basic variables fall, and their values
    pivot_tolerance : rates below it, relative to the largest, do not count
    tie_tolerance, size : values left over below their product, less at small rates, are ties
    rows : (n,) filled from the front
    """
    largest, highest = 1.0, size
    for i in range(len(column)):
        largest = max(largest, abs(column[i]))
        highest = max(highest, abs(rhs[i]))
    least = pivot_tolerance * largest
    step = math.inf
    for i in range(len(column)):
        if column[i] > least and rhs[i] < step * column[i]:
            step = max(rhs[i], 0.0) / column[i]
    count = 0
    for i in range(len(column)):
        rate = column[i]
        if rate > least and max(rhs[i], 0.0) - step * rate <= tie_tolerance * highest * min(1.0, rate):
            rows[count] = i
            count += 1
    return count, step


def least_lexicographic(
    T: Array,
    U: Array,
    V: Array,
    used: int,
    basic: IntArray,
    column_of: IntArray,
    rates: Array,
    rows: IntArray,
    count: int,
    tolerance: float,
) -> int:
    """Row, of the first ``count`` in rows, whose row of the basis inverse over its rate is lexicographically least.

    Column j of the basis inverse is the column of w_j, a unit vector where w_j is basic. Entries closer than the
    tolerance count as equal.
    """
    for j in range(len(T)):
        if count == 1:
            break
        at = column_of[j]
        lowest = math.inf
        for turn in range(2):  # the least entry, then the rows that have it
            kept = 0
            for k in range(count):
                i = rows[k]
                entry = 1.0 if basic[i] == j else 0.0
                if at >= 0:
                    entry = T[i, at]
                    for delayed in range(used):
                        entry -= U[i, delayed] * V[delayed, at]
                entry /= rates[i]
                if turn == 0:
                    lowest = min(lowest, entry)
                elif entry <= lowest + tolerance:
                    rows[kept] = i
                    kept += 1
        count = kept if kept > 0 else count
    return rows[0]


def current_column(T: Array, U: Array, V: Array, used: int, at: int) -> None:
    """Write column ``at`` of ``T - U V`` into column ``used`` of U."""
    for i in range(len(T)):
        U[i, used] = T[i, at]
    for delayed in range(used):
        factor = V[delayed, at]
        if factor != 0.0:
            for i in range(len(T)):
                U[i, used] -= factor * U[i, delayed]


def exchange_delayed(T: Array, U: Array, V: Array, used: int, row: int, at: int) -> None:
    """Pivot on entry (row, at) of ``T - U V``, whose column is in column ``used`` of U; V receives its row there."""
    n, m = T.shape
    column, fresh = U[:, used], V[used]
    pivot = column[row]
    for j in range(m):
        fresh[j] = T[row, j]
    for delayed in range(used):
        factor = U[row, delayed]
        if factor != 0.0:
            for j in range(m):
                fresh[j] -= factor * V[delayed, j]
        U[row, delayed] = 0.0
        V[delayed, at] = 0.0
    for j in range(m):
        fresh[j] /= pivot
        T[row, j] = fresh[j]
    column[row] = 0.0
    step = fresh[m - 1]
    for i in range(n):
        T[i, m - 1] -= step * column[i]
        T[i, at] = -column[i] / pivot
    T[row, at] = 1.0 / pivot
    fresh[m - 1] = fresh[at] = 0.0


def walk(
    T: Array,
    U: Array,
    V: Array,
    basic: IntArray,
    nonbasic: IntArray,
    column_of: IntArray,
    row_of: IntArray,
    rows: IntArray,
    entering: int,
    limit: int,
    theta_stays: bool,
    pivot_tolerance: float,
    tie_tolerance: float,
    size: float,
) -> tuple[int, int, int, int]:
    """Pivot along the complementary path until U is full or there is something to say.

    Parameters
    ----------
    T : (n, n + 2) Fortran-ordered tableau, the values in its last column
    U, V : (n, k) Fortran-ordered and (k, n + 2), not yet in use
    basic, nonbasic, column_of, row_of : see ``Tableau``
    rows : (n,) to work in
    entering : the variable that enters first
    limit : of pivots
    theta_stays : whether the tie of the first pivot is to be broken without theta
    pivot_tolerance, tie_tolerance, size : see ``blocking``

    Returns
    -------
    reason, entering, row, pivots : why it returned, the variable to enter next, the row of theta in doubt, pivots done
    """
    n = len(T)
    theta = 2 * n
    for used in range(min(V.shape[0], limit)):
        at = column_of[entering]
        _current_column(T, U, V, used, at)
        column, rhs = U[:, used], T[:, n + 1]
        count, step = _blocking(column, rhs, pivot_tolerance, tie_tolerance, size, rows)
        if count == 0:
            return RAY, entering, -1, used
        row = rows[0]
        if count > 1:
            row = row_of[theta]
            kept = 0
            for k in range(count):
                if rows[k] != row:
                    rows[kept] = rows[k]
                    kept += 1
            if kept == count or (theta_stays and used == 0):  # kept < count where theta is tied
                row = _least_lexicographic(T, U, V, used, basic, column_of, column, rows, kept, tie_tolerance)
            elif max(rhs[row], 0.0) > step * column[row]:
                return DOUBT, entering, row, used
        _exchange_delayed(T, U, V, used, row, at)
        left = basic[row]
        basic[row], nonbasic[at] = entering, left
        row_of[entering], row_of[left] = row, -1
        column_of[entering], column_of[left] = -1, at
        if left == theta:
            return SOLVED, left, row, used + 1
        entering = left + n if left < n else left - n
    return MORE, entering, -1, min(V.shape[0], limit)


_blocking: Any = njit(blocking, cache=True)
_least_lexicographic: Any = njit(least_lexicographic, cache=True)
_current_column: Any = njit(current_column, cache=True)
_exchange_delayed: Any = njit(exchange_delayed, cache=True)

machine_walk: Any = njit(walk, cache=True, nogil=True)
"""The machine code of the loop."""
