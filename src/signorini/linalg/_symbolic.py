# SPDX-License-Identifier: BSD-3-Clause
"""Compiled symbolic phase: elimination tree, postorder, supernodes and the rows of every front.

Vertices are nodes, numbered in their order of elimination. The first `interior`
of them are eliminated, the others only appear as rows; a tree ends where only those are left.

References
----------
Liu (1990), The role of elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11:134.
Ashcraft, Grimes (1989), The influence of relaxed supernode partitions on the multifrontal method, ACM TOMS 15:291.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel
from signorini.linalg._graph import Elimination, Graph, sort_lists


@kernel()
def elimination_tree(graph: Graph, elimination: Elimination, interior: int) -> Int32Array:
    """Give the parent of every interior vertex, -1 where none is left inside (Liu's path compression).

    Parameters
    ----------
    graph, elimination : of the nodes, and their order
    interior : how many are eliminated
    """
    (indptr, indices), (order, place) = graph, elimination
    parent = np.full(interior, -1, np.int32)
    ancestor = np.full(interior, -1, np.int32)
    for i in range(interior):
        for p in range(indptr[order[i]], indptr[order[i] + 1]):
            k = place[indices[p]]
            while k < i and k != -1:
                up = ancestor[k]
                ancestor[k] = i
                if up == -1:
                    parent[k] = i
                k = up
    return parent


@kernel()
def postorder(parent: Int32Array) -> Int32Array:
    """List the vertices of the forest so that every subtree is contiguous and ends with its root."""
    count = len(parent)
    child = np.full(count, -1, np.int32)
    sibling = np.full(count, -1, np.int32)
    for j in range(count - 1, -1, -1):
        if parent[j] != -1:
            sibling[j] = child[parent[j]]
            child[parent[j]] = j
    post = np.empty(count, np.int32)
    stack = np.empty(count, np.int32)
    done = 0
    for root in range(count):
        if parent[root] != -1:
            continue
        stack[0] = root
        top = 0
        while top >= 0:
            v = stack[top]
            if child[v] == -1:
                post[done] = v
                done += 1
                top -= 1
            else:
                top += 1
                stack[top] = child[v]
                child[v] = sibling[child[v]]
    return post


@kernel()
def column_counts(graph: Graph, elimination: Elimination, parent: Int32Array) -> Int32Array:
    """Count the vertices in every column of the factor, its own included, by walking the row subtrees.

    Parameters
    ----------
    graph, elimination : of the nodes, and their order
    parent : of every interior vertex
    """
    (indptr, indices), (order, place) = graph, elimination
    interior = len(parent)
    count = np.ones(interior, np.int32)
    mark = np.full(interior, -1, np.int32)
    for i in range(len(order)):
        if i < interior:
            mark[i] = i
        for p in range(indptr[order[i]], indptr[order[i] + 1]):
            k = place[indices[p]]
            if k >= i:
                continue
            while k != -1 and k < interior and mark[k] != i:
                count[k] += 1
                mark[k] = i
                k = parent[k]
    return count


@kernel()
def supernodes(parent: Int32Array, count: Int32Array, relax: tuple[int, float, int, float, float]) -> Int32Array:
    """Join columns of equal structure, then parents with children where few zeros are stored for it.

    Parameters
    ----------
    parent, count : of a postordered forest
    relax : (a, p, b, q, r): join when at most a columns result with a share p of zeros, b with q, any number with r

    Returns
    -------
    (ns + 1,) array : the first column of every supernode
    """
    columns = len(parent)
    first = np.empty(columns + 1, np.int32)
    below = np.empty(columns, np.int32)
    zeros = np.zeros(columns, np.float64)
    top = -1
    start = 0
    for j in range(columns):
        if j + 1 < columns and parent[j] == j + 1 and count[j] == count[j + 1] + 1:
            continue
        begin, end, rows, lost = start, j + 1, count[j] - 1, 0.0
        start = end
        while top >= 0 and begin <= parent[begin - 1] < end:
            width_child, width = begin - first[top], end - begin
            more = zeros[top] + lost + width_child * float(width + rows - below[top])
            wide = width_child + width
            share = more / (0.5 * wide * (wide + 1) + float(wide) * rows)
            if not (
                share <= relax[4]
                or (wide <= relax[0] and share <= relax[1])
                or (wide <= relax[2] and share <= relax[3])
            ):
                break
            begin, lost = first[top], more
            top -= 1
        top += 1
        first[top], below[top], zeros[top] = begin, rows, lost
    first[top + 1] = columns
    return first[: top + 2].copy()


@kernel()
def front_rows(
    graph: Graph, elimination: Elimination, first: Int32Array, count: Int32Array
) -> tuple[IntArray, Int32Array, Int32Array]:
    """Give the rows below every supernode, sorted, and the supernode that they join next (-1: the interface).

    Parameters
    ----------
    graph, elimination : of the nodes, and their order
    first : (s + 1,) first column of every supernode
    count : vertices in every column
    """
    (indptr, indices), (order, place) = graph, elimination
    total = len(first) - 1
    interior = first[total]
    begin = np.zeros(total + 1, np.int64)
    of = np.empty(interior, np.int32)
    for s in range(total):
        begin[s + 1] = begin[s] + count[first[s + 1] - 1] - 1
        for j in range(first[s], first[s + 1]):
            of[j] = s
    rows = np.empty(begin[total], np.int32)
    parent = np.full(total, -1, np.int32)
    child = np.full(total, -1, np.int32)
    sibling = np.full(total, -1, np.int32)
    mark = np.full(len(order), -1, np.int32)
    for s in range(total):
        top = begin[s]
        end = first[s + 1]
        for j in range(first[s], end):
            for p in range(indptr[order[j]], indptr[order[j] + 1]):
                i = place[indices[p]]
                if i >= end and mark[i] != s:
                    mark[i] = s
                    rows[top] = i
                    top += 1
        c = child[s]
        while c != -1:
            for p in range(begin[c], begin[c + 1]):
                i = rows[p]
                if i >= end and mark[i] != s:
                    mark[i] = s
                    rows[top] = i
                    top += 1
            c = sibling[c]
        next_one = interior
        for p in range(begin[s], top):
            next_one = min(next_one, rows[p])
        if next_one < interior:
            parent[s] = of[next_one]
            sibling[s] = child[parent[s]]
            child[parent[s]] = s
    sort_lists(begin, rows, len(order))
    return begin, rows, parent


@kernel()
def sides(parent: Int32Array) -> Int32Array:
    """Give 0 or 1 in turns from the roots of a postordered forest down."""
    side = np.zeros(len(parent), np.int32)
    for s in range(len(parent) - 1, -1, -1):
        if parent[s] != -1:
            side[s] = 1 - side[parent[s]]
    return side


@kernel()
def stack_peaks(parent: Int32Array, side: Int32Array, size: IntArray) -> tuple[int, int]:
    """Give the largest number of entries on either stack: what waits for its parent, and what is just made.

    Parameters
    ----------
    parent, side : (s,) of every front: where it goes, and the stack it waits on
    size : (s,) entries that wait
    """
    waiting = np.empty((2, len(parent)), np.int32)
    count, now, peak = np.zeros(2, np.int64), np.zeros(2, np.int64), np.zeros(2, np.int64)
    for s in range(len(parent)):
        own, other = side[s], 1 - side[s]
        now[own] += size[s]
        peak[own] = max(peak[own], now[own])
        while count[other] > 0 and parent[waiting[other, count[other] - 1]] == s:
            count[other] -= 1
            now[other] -= size[waiting[other, count[other]]]
        if parent[s] != -1:
            waiting[own, count[own]] = s
            count[own] += 1
        else:
            now[own] -= size[s]
    return int(peak[0]), int(peak[1])


@kernel()
def subtree_sums(parent: Int32Array, work: Array) -> Array:
    """Give the work of the subtree below every front, its own included.

    Parameters
    ----------
    parent : of a postordered forest
    work : (s,) of every front
    """
    total = work.copy()
    for t in range(len(parent)):
        if parent[t] != -1:
            total[parent[t]] += total[t]
    return total
