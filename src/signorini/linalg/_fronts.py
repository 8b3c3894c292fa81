# SPDX-License-Identifier: BSD-3-Clause
"""Compiled numeric phase: the whole multifrontal factorisation, and the solves, as one loop over the fronts each.

A front holds k unknowns that it eliminates and r below them. Its k columns live in the factor, (k + r, k) by columns;
its lower right block, (r, r) by columns, is made where it waits for the parent: on one of two stacks, taken in turns
from level to level of the tree, so that a front takes what its children left from one and leaves its own on the other.
What is left of the last fronts is added to the condensed matrix of the interface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from signorini.arrays import Array, Int32Array
from signorini.linalg._blas import Scratch, StoredMatrix, gemm, potrf, set_threads, syrk, trsm
from signorini.linalg._graph import Elimination, Rows
from signorini.linalg.plan import Fronts

SHARED_WORK = 1e9  # operations from which threads share what a front leaves: tens of milliseconds of one thread
TILE = 64  # rows and columns that are mirrored at a time, so that they stay in the cache


class Factors(NamedTuple):
    """What a factorisation makes.

    Attributes
    ----------
    columns : of all fronts, one behind the other
    condensed : (m, m) of the interface, zero on entry
    diagonal : of K inside, in order of elimination
    """

    columns: Array
    condensed: Array
    diagonal: Array


@njit(cache=True)
def factorise_fronts(
    fronts: Fronts,
    K: Rows,
    elimination: Elimination,
    slot: Int32Array,
    made: Factors,
    stacks: tuple[Array, Array],
    threads: int,
    s: Scratch,
) -> int:
    """Factorise; give -1, or the place in the order of elimination where a pivot is not positive.

    Parameters
    ----------
    fronts : in postorder
    K : in its own numbering
    elimination : order of the unknowns, the interface last
    slot : for every unknown of the interface, in order of elimination, its row in the condensed matrix
    made : overwritten
    stacks : what waits for parents
    threads : of BLAS where much is left of a front; in small ones they cost more than they give, and what eliminates
        its own unknowns has other last digits with every number of threads
    s : of BLAS
    """
    (order, _), (factor, condensed, diagonal) = elimination, made
    inside = len(order) - len(slot)
    widest = fronts.below.max() if len(fronts.below) else 0
    local = np.empty(len(order), np.int32)
    target, runs = np.empty(widest, np.int32), np.empty(widest + 1, np.int32)
    waiting = np.empty((2, len(fronts.parent)), np.int32)
    count, top = np.zeros(2, np.int64), np.zeros(2, np.int64)
    for t in range(len(fronts.parent)):
        a = fronts.unknown[fronts.first[t]]
        k, r = fronts.unknown[fronts.first[t + 1]] - a, fronts.below[t]
        ld = k + r
        panel = factor[fronts.panel[t] : fronts.panel[t + 1]]
        panel[:] = 0.0
        own, other = fronts.side[t], 1 - fronts.side[t]
        left = stacks[own][top[own] : top[own] + r * r]
        _list_below(fronts, t, target)
        for j in range(k):
            local[a + j] = j
        for i in range(r):
            local[target[i]] = k + i
        _add_matrix(K, elimination, a, k, local, panel, ld)
        for j in range(k):
            diagonal[a + j] = panel[j * (ld + 1)]
        leaf = count[other] == 0 or fronts.parent[waiting[other, count[other] - 1]] != t
        if not leaf:
            for c in range(r):
                left[c * r + c : (c + 1) * r] = 0.0
        while count[other] > 0 and fronts.parent[waiting[other, count[other] - 1]] == t:
            count[other] -= 1
            child = waiting[other, count[other]]
            size = fronts.below[child]
            top[other] -= size * size
            _list_rows(fronts, child, local, target)
            number = _list_runs(target[:size], runs)
            _extend_add(stacks[other][top[other] :], target[:size], runs[: number + 1], k, panel, ld, left, r)
        top_block, below = StoredMatrix(panel.ctypes.data, ld), StoredMatrix(panel.ctypes.data + 8 * k, ld)
        failed = potrf(k, top_block, s)
        if failed != 0:
            return int(a + failed - 1)
        if r == 0:
            continue
        trsm(True, True, r, k, top_block, below, s)
        many = threads > 1 and k * float(r) * r > SHARED_WORK
        if many:
            set_threads(threads)
        syrk(r, k, below, not leaf, StoredMatrix(left.ctypes.data, r), s)
        if many:
            set_threads(1)
        if fronts.parent[t] == -1:
            for u in range(len(slot)):
                local[inside + u] = slot[u]
            _list_rows(fronts, t, local, target)
            _add_condensed(left, target, r, condensed)
        else:
            top[own] += r * r
            waiting[own, count[own]] = t
            count[own] += 1
    _add_interface(K, elimination, slot, condensed)
    return -1


@njit(cache=True)
def _list_below(fronts: Fronts, t: int, below: Int32Array) -> None:
    """List the unknowns below front t."""
    at = 0
    for p in range(fronts.begin[t], fronts.begin[t + 1]):
        for u in range(fronts.unknown[fronts.row[p]], fronts.unknown[fronts.row[p] + 1]):
            below[at] = u
            at += 1


@njit(cache=True)
def _list_rows(fronts: Fronts, t: int, local: Int32Array, target: Int32Array) -> None:
    """List where the unknowns below front t stand in its parent."""
    _list_below(fronts, t, target)
    for i in range(fronts.below[t]):
        target[i] = local[target[i]]


@njit(cache=True)
def _add_matrix(K: Rows, elimination: Elimination, a: int, k: int, local: Int32Array, panel: Array, ld: int) -> None:
    """Add the entries of K on and below the diagonal to the columns of a front."""
    (indptr, indices, data), (order, place) = K, elimination
    for j in range(k):
        for p in range(indptr[order[a + j]], indptr[order[a + j] + 1]):
            i = place[indices[p]]
            if i >= a + j:
                panel[j * ld + local[i]] += data[p]


@njit(cache=True)
def _list_runs(target: Int32Array, runs: Int32Array) -> int:
    """List where rows that stand one below the other in the parent begin; gives how many runs there are."""
    size = len(target)
    number = 0
    for i in range(size):
        if i == 0 or target[i] != target[i - 1] + 1:
            runs[number] = i
            number += 1
    runs[number] = size
    return number


@njit(cache=True)
def _extend_add(
    left: Array, target: Int32Array, runs: Int32Array, k: int, panel: Array, ld: int, work: Array, r: int
) -> None:
    """Add what is left of a child, the lower triangle of a matrix by columns, to its parent, run by run."""
    size, number = len(target), len(runs) - 1
    for own in range(number):
        for c in range(runs[own], runs[own + 1]):
            j = target[c]
            column = panel[j * ld : (j + 1) * ld] if j < k else work[(j - k) * r : (j - k + 1) * r]
            skipped = 0 if j < k else k
            for run in range(own, number):
                first = max(c, runs[run])
                rows = left[c * size + first : c * size + runs[run + 1]]
                at = target[first] - skipped
                sums = column[at : at + len(rows)]
                for i in range(len(rows)):
                    sums[i] += rows[i]


@njit(cache=True)
def _add_condensed(work: Array, target: Int32Array, r: int, condensed: Array) -> None:
    """Add a lower triangle, (r, r) by columns, to the upper one of the condensed matrix: along its rows."""
    for c in range(r):
        v = target[c]
        for i in range(c, r):
            u = target[i]
            if v <= u:
                condensed[v, u] += work[c * r + i]
            else:
                condensed[u, v] += work[c * r + i]


@njit(cache=True)
def _add_interface(K: Rows, elimination: Elimination, slot: Int32Array, condensed: Array) -> None:
    """Add K_cc to the condensed matrix and mirror its upper triangle."""
    (indptr, indices, data), (order, place) = K, elimination
    inside = len(order) - len(slot)
    for u in range(len(slot)):
        row = order[inside + u]
        for p in range(indptr[row], indptr[row + 1]):
            i = place[indices[p]]
            if i >= inside and slot[i - inside] <= slot[u]:
                condensed[slot[i - inside], slot[u]] += data[p]
    m = len(slot)
    for first in range(0, m, TILE):
        for begin in range(0, first + 1, TILE):
            for u in range(first, min(first + TILE, m)):
                for v in range(begin, min(begin + TILE, u)):
                    condensed[u, v] = condensed[v, u]


@njit(cache=True)
def _any(y: Array, start: int, end: int) -> bool:
    """Whether any row of y has an entry other than zero there."""
    for c in range(len(y)):
        for u in range(start, end):
            if y[c, u] != 0.0:
                return True
    return False


@njit(cache=True)
def forward(fronts: Fronts, factor: Array, y: Array, work: Array, s: Scratch) -> None:
    """Overwrite the inside of y, (k, n) with one load per row, by ``L_ii^-1 y``; the interface gathers what is left.

    Fronts that neither a load nor anything eliminated before reaches are passed over: most loads act on a surface.

    Parameters
    ----------
    fronts, factor : as factorised
    y : overwritten
    work : k numbers for every unknown below the largest front
    s : of BLAS
    """
    columns, n = y.shape
    rows = np.empty(fronts.below.max() if len(fronts.below) else 0, np.int32)
    for t in range(len(fronts.parent)):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        r = fronts.below[t]
        if not _any(y, a, a + k):
            continue
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(work.ctypes.data, r)
        trsm(False, False, k, columns, own, x, s)
        if r == 0:
            continue
        gemm(False, r, columns, k, below, x, False, gathered, s)
        _list_below(fronts, t, rows)
        for c in range(columns):
            for i in range(r):
                y[c, rows[i]] += work[c * r + i]


@njit(cache=True)
def backward(fronts: Fronts, factor: Array, y: Array, work: Array, s: Scratch) -> None:
    """Overwrite the inside of y, (k, n) with one load per row, by ``L_ii^-T (y_i - L_ci^T y_c)``.

    Parameters
    ----------
    fronts, factor, y, work, s : see `forward`
    """
    columns, n = y.shape
    rows = np.empty(fronts.below.max() if len(fronts.below) else 0, np.int32)
    for t in range(len(fronts.parent) - 1, -1, -1):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        r = fronts.below[t]
        top = factor.ctypes.data + 8 * fronts.panel[t]
        own, below = StoredMatrix(top, k + r), StoredMatrix(top + 8 * k, k + r)
        x, gathered = StoredMatrix(y.ctypes.data + 8 * a, n), StoredMatrix(work.ctypes.data, r)
        if r > 0:
            _list_below(fronts, t, rows)
            for c in range(columns):
                for i in range(r):
                    work[c * r + i] = y[c, rows[i]]
            gemm(True, k, columns, r, below, gathered, True, x, s)
        trsm(False, True, k, columns, own, x, s)


@njit(cache=True)
def pivots(fronts: Fronts, factor: Array) -> Array:
    """Give the squared diagonal of the factor: the pivots in their order of elimination."""
    pivot = np.empty(fronts.unknown[fronts.first[-1]])
    for t in range(len(fronts.parent)):
        a = fronts.unknown[fronts.first[t]]
        k = fronts.unknown[fronts.first[t + 1]] - a
        for j in range(k):
            pivot[a + j] = factor[fronts.panel[t] + j * (k + fronts.below[t] + 1)] ** 2
    return pivot
