# SPDX-License-Identifier: BSD-3-Clause
"""Compiled numeric phase of a multifrontal factorisation: loops over fronts, and over tiles of large ones.

A front holds k unknowns that it eliminates and r below them. Its k columns live in the factor, (k + r, k) by columns;
its lower right block, (r, r) by columns, is made where it waits for the parent: on one of two stacks, taken in turns
from level to level of the tree, so that a front takes what its children left from one and leaves its own on the other.
What is left of the last fronts is added to the condensed matrix of the interface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel, part
from signorini.linalg._blas import (
    Scratch,
    StoredMatrix,
    potrf,
    scratch,
    syrk,
    trsm,
)
from signorini.linalg._graph import Elimination, Rows
from signorini.linalg.plan import Fronts
from signorini.memory import apart

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


class Tree(NamedTuple):
    """A matrix, the tree of fronts by which it is eliminated, and what that makes.

    Attributes
    ----------
    fronts : in postorder
    K : in its own numbering
    elimination : order of the unknowns, the interface last
    slot : for every unknown of the interface, in order of elimination, its row in the condensed matrix
    made : overwritten
    """

    fronts: Fronts
    K: Rows
    elimination: Elimination
    slot: Int32Array
    made: Factors


class Stacks(NamedTuple):
    """What is left of fronts and waits for their parents, on two stacks, with room to work.

    Attributes
    ----------
    left : the two stacks
    top : (2,) where each ends
    waiting : (2, fronts) the fronts on each
    number : (2,) how many
    local : (n,) where an unknown stands in the front at hand
    target, runs : rows of a child in its parent, and where they begin to follow each other
    s : of BLAS
    """

    left: tuple[Array, Array]
    top: IntArray
    waiting: Int32Array
    number: IntArray
    local: Int32Array
    target: Int32Array
    runs: Int32Array
    s: Scratch


def stacks(fronts: Fronts, n: int, size: tuple[int, int]) -> Stacks:
    """Give empty stacks of a size for fronts of n unknowns."""
    widest = int(fronts.below.max(initial=0))
    left = apart(size[0]), apart(size[1])
    waiting = np.empty((2, len(fronts.parent)), np.int32)
    room = np.empty(n, np.int32), np.empty(widest, np.int32), np.empty(widest + 1, np.int32)
    return Stacks(left, np.zeros(2, np.int64), waiting, np.zeros(2, np.int64), *room, scratch())


def factorise_whole(tree: Tree, size: tuple[int, int]) -> int:
    """Factorise all fronts on stacks of a size; give -1, or the place in the order where a pivot is not positive."""
    number = len(tree.fronts.parent)
    failed = factorise_fronts(tree, 0, number, stacks(tree.fronts, len(tree.elimination.order), size), False)
    if failed < 0:
        add_interface(tree.K, tree.elimination, tree.slot, tree.made.condensed)
    return failed


@kernel(nogil=True)
def factorise_fronts(tree: Tree, begin: int, end: int, stacks: Stacks, alone: bool) -> int:
    """Factorise fronts begin to end; give -1, or the place in the order where a pivot is not positive.

    Parameters
    ----------
    tree : of which they are fronts
    begin, end : with nothing between them whose children are elsewhere than on the stacks
    stacks : what is left waits on
    alone : whether they are subtrees by themselves, of whose roots all that is left waits, too
    """
    fronts, s = tree.fronts, stacks.s
    for t in range(begin, end):
        leaf = _gather(tree, t, stacks)
        a, k, r = sizes(fronts, t)
        own = fronts.side[t]
        columns = tree.made.columns.ctypes.data + 8 * fronts.panel[t]
        top_block, below = StoredMatrix(columns, k + r), StoredMatrix(columns + 8 * k, k + r)
        failed = potrf(k, top_block, s)
        if failed != 0:
            return int(a + failed - 1)
        if r == 0:
            continue
        trsm(s.right, s.transposed, r, k, top_block, below, s)
        left = StoredMatrix(stacks.left[own].ctypes.data + 8 * stacks.top[own], r)
        syrk(r, k, below, s.zero if leaf else s.one, left, s)
        _leave(tree, t, stacks, alone)
    return -1


@part()
def _gather(tree: Tree, t: int, stacks: Stacks) -> bool:
    """Gather front t from K and what its children left; give whether it has no children.

    What its children left goes from the stacks; what it leaves, begun, lies on top.
    """
    fronts, (factor, _, diagonal) = tree.fronts, tree.made
    local, target, waiting = stacks.local, stacks.target, stacks.waiting
    a, k, r = sizes(fronts, t)
    ld = k + r
    panel = factor[fronts.panel[t] : fronts.panel[t + 1]]
    panel[:] = 0.0
    own, other = fronts.side[t], 1 - fronts.side[t]
    left = stacks.left[own][stacks.top[own] : stacks.top[own] + r * r]
    list_below(fronts, t, target)
    for j in range(k):
        local[a + j] = j
    for i in range(r):
        local[target[i]] = k + i
    _add_matrix(tree.K, tree.elimination, a, k, local, panel, ld)
    for j in range(k):
        diagonal[a + j] = panel[j * (ld + 1)]
    leaf = stacks.number[other] == 0 or fronts.parent[waiting[other, stacks.number[other] - 1]] != t
    if not leaf:
        for c in range(r):
            left[c * r + c : (c + 1) * r] = 0.0
    while stacks.number[other] > 0 and fronts.parent[waiting[other, stacks.number[other] - 1]] == t:
        stacks.number[other] -= 1
        child = waiting[other, stacks.number[other]]
        size = fronts.below[child]
        stacks.top[other] -= size * size
        _list_rows(fronts, child, local, target)
        number = _list_runs(target[:size], stacks.runs)
        block = stacks.left[other][stacks.top[other] :]
        _extend_add(block, target[:size], stacks.runs[: number + 1], k, panel, ld, left, r)
    return leaf


@part()
def _leave(tree: Tree, t: int, stacks: Stacks, alone: bool) -> None:
    """Leave what is left of front t on its stack, or add it to the condensed matrix unless it stands alone."""
    fronts = tree.fronts
    own, (_, _, r) = fronts.side[t], sizes(fronts, t)
    if fronts.parent[t] == -1 and not alone:
        left = stacks.left[own][stacks.top[own] : stacks.top[own] + r * r]
        inside = len(tree.elimination.order) - len(tree.slot)
        for u in range(len(tree.slot)):
            stacks.local[inside + u] = tree.slot[u]
        _list_rows(fronts, t, stacks.local, stacks.target)
        add_condensed(left, stacks.target, r, tree.made.condensed)
    else:
        stacks.top[own] += r * r
        stacks.waiting[own, stacks.number[own]] = t
        stacks.number[own] += 1


@part()
def sizes(fronts: Fronts, t: int) -> tuple[int, int, int]:
    """First unknown of a front, how many it eliminates and how many are below it.

    Parameters
    ----------
    fronts, t : which one
    """
    a = np.int64(fronts.unknown[fronts.first[t]])
    return int(a), int(fronts.unknown[fronts.first[t + 1]] - a), int(np.int64(fronts.below[t]))


@part()
def list_below(fronts: Fronts, t: int, below: Int32Array) -> None:
    """List the unknowns below front t.

    Parameters
    ----------
    fronts, t : which one
    below : overwritten, as far as there are any
    """
    at = 0
    for p in range(fronts.begin[t], fronts.begin[t + 1]):
        for u in range(fronts.unknown[fronts.row[p]], fronts.unknown[fronts.row[p] + 1]):
            below[at] = u
            at += 1


@part()
def _list_rows(fronts: Fronts, t: int, local: Int32Array, target: Int32Array) -> None:
    """List where the unknowns below front t stand in its parent."""
    list_below(fronts, t, target)
    for i in range(fronts.below[t]):
        target[i] = local[target[i]]


@part()
def _add_matrix(K: Rows, elimination: Elimination, a: int, k: int, local: Int32Array, panel: Array, ld: int) -> None:
    """Add the entries of K on and below the diagonal to the columns of a front."""
    (indptr, indices, data), (order, place) = K, elimination
    for j in range(k):
        for p in range(indptr[order[a + j]], indptr[order[a + j] + 1]):
            i = place[indices[p]]
            if i >= a + j:
                panel[j * ld + local[i]] += data[p]


@part()
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


@part()
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


@part()
def add_condensed(work: Array, target: Int32Array, r: int, condensed: Array) -> None:
    """Add a lower triangle, (r, r) by columns, to the upper one of the condensed matrix: along its rows.

    Parameters
    ----------
    work, r : the triangle
    target : row of every row of it in the condensed matrix
    """
    for c in range(r):
        v = target[c]
        for i in range(c, r):
            u = target[i]
            if v <= u:
                condensed[v, u] += work[c * r + i]
            else:
                condensed[u, v] += work[c * r + i]


@kernel(nogil=True)
def add_interface(K: Rows, elimination: Elimination, slot: Int32Array, condensed: Array) -> None:
    """Add K_cc to the condensed matrix and mirror its upper triangle.

    Parameters
    ----------
    K, elimination, slot : see `Tree`
    condensed : (m, m), its upper triangle without K_cc
    """
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
