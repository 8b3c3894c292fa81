# SPDX-License-Identifier: BSD-3-Clause
"""The compiled loop of Lemke's method: many pivots of a condensed tableau, its updates delayed and applied together.

A pivot is a rank-one update, which streams the whole tableau through the memory. Here the tableau is ``T - U V`` with
the columns of U and the rows of V from the last few pivots: a pivot needs one column, one row and the values, and
``T - U V`` is formed by one matrix product when U is full. The last column of T, the values, is always up to date.
"""

from __future__ import annotations

import math

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.lcp.delayed import DOUBT, MORE, RAY, SOLVED, DelayedTableau, Tolerances


@part()
def blocking(column: Array, rhs: Array, tolerances: Tolerances, rows: IntArray) -> tuple[int, float]:
    """Write the rows that stop the entering variable first, ties included; returns their number and the step.

    Parameters
    ----------
    column, rhs : (n,) rates at which the basic variables fall, and their values
    tolerances : of rates and ties
    rows : (n,) filled from the front
    """
    largest, highest = 1.0, tolerances.size
    for i in range(len(column)):
        largest = max(largest, abs(column[i]))
        highest = max(highest, abs(rhs[i]))
    least = tolerances.pivot * largest
    step = math.inf
    for i in range(len(column)):
        if column[i] > least and rhs[i] < step * column[i]:
            step = max(rhs[i], 0.0) / column[i]
    count = 0
    for i in range(len(column)):
        rate = column[i]
        if rate > least and max(rhs[i], 0.0) - step * rate <= tolerances.tie * highest * min(1.0, rate):
            rows[count] = i
            count += 1
    return count, step


@kernel(brief=True)
def least_lexicographic(tableau: DelayedTableau, used: int, rates: Array, count: int, tolerance: float) -> int:
    """Row of the basis inverse that, over its rate, is lexicographically least.

    Column j of the basis inverse is the column of w_j, a unit vector where w_j is basic.

    Parameters
    ----------
    tableau : with the candidates in front of its ``rows``
    used : columns of U in use
    rates : (n,) what every row is divided by
    count : number of candidates
    tolerance : entries closer than it count as equal
    """
    T, U, V, basic, _, column_of, _, rows = tableau
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


@part()
def current_column(tableau: DelayedTableau, used: int, at: int) -> None:
    """Write column ``at`` of ``T - U V`` into column ``used`` of U, those before it of the tableau in use."""
    T, U, V = tableau.T, tableau.U, tableau.V
    for i in range(len(T)):
        U[i, used] = T[i, at]
    for delayed in range(used):
        factor = V[delayed, at]
        if factor != 0.0:
            for i in range(len(T)):
                U[i, used] -= factor * U[i, delayed]


@part()
def exchange_delayed(tableau: DelayedTableau, used: int, row: int, at: int) -> None:
    """Pivot on an entry of ``T - U V``, whose column is in U; V receives its row.

    Parameters
    ----------
    tableau : edited in place
    used : the column of U, and the row of V, of this pivot
    row, at : of the entry
    """
    T, U, V = tableau.T, tableau.U, tableau.V
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


@kernel(brief=True, nogil=True)
def walk(
    tableau: DelayedTableau, entering: int, limit: int, theta_stays: bool, tolerances: Tolerances
) -> tuple[int, int, int, int]:
    """Pivot along the complementary path until U is full or there is something to say.

    Parameters
    ----------
    tableau : edited in place, U and V not yet in use
    entering : the variable that enters first
    limit : of pivots
    theta_stays : whether the tie of the first pivot is to be broken without theta
    tolerances : of rates and ties

    Returns
    -------
    reason, entering, row, pivots : why it returned, the variable to enter next, the row of theta in doubt, pivots done
    """
    T, U, V, basic, nonbasic, column_of, row_of, rows = tableau
    n = len(T)
    theta = 2 * n
    for used in range(min(V.shape[0], limit)):
        at = column_of[entering]
        current_column(tableau, used, at)
        column, rhs = U[:, used], T[:, n + 1]
        count, step = blocking(column, rhs, tolerances, rows)
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
                row = least_lexicographic(tableau, used, column, kept, tolerances.tie)
            elif max(rhs[row], 0.0) > step * column[row]:
                return DOUBT, entering, row, used
        exchange_delayed(tableau, used, row, at)
        left = basic[row]
        basic[row], nonbasic[at] = entering, left
        row_of[entering], row_of[left] = row, -1
        column_of[entering], column_of[left] = -1, at
        if left == theta:
            return SOLVED, left, row, used + 1
        entering = left + n if left < n else left - n
    return MORE, entering, -1, min(V.shape[0], limit)
