# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops over graphs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.compilation import kernel, part


class Graph(NamedTuple):
    """Neighbours of every vertex; a named tuple, because compiled loops read it.

    Attributes
    ----------
    indptr, indices : those of v are ``indices[indptr[v]:indptr[v + 1]]``
    """

    indptr: Int32Array
    indices: Int32Array


class Rows(NamedTuple):
    """A sparse matrix by rows; the columns of a row need not be sorted.

    Attributes
    ----------
    indptr, indices, data : row i has the entries ``data[k]`` in columns ``indices[k]``, indptr[i] <= k < indptr[i + 1]
    """

    indptr: Int32Array
    indices: Int32Array
    data: Array

    @property
    def graph(self) -> Graph:
        """The pattern."""
        return Graph(self.indptr, self.indices)


class Elimination(NamedTuple):
    """An order of elimination.

    Attributes
    ----------
    order : (n,) what is eliminated first, second, ...
    place : (n,) the inverse: when each is eliminated
    """

    order: Int32Array
    place: Int32Array


@kernel(nogil=True)
def quotient_rows(
    graph: Graph, start: Int32Array, member: Int32Array, group: Int32Array, groups: tuple[int, int]
) -> Graph:
    """Merge the vertices of some groups that follow each other: their rows of the graph of the groups, without loops.

    Parameters
    ----------
    graph : of n vertices
    start, member : the vertices of the k-th of these groups are ``member[start[k]:start[k + 1]]``
    group : (n,) the group of every vertex
    groups : the first of these groups, and how many there are of all
    """
    (indptr, indices), (first, every), count = graph, groups, len(start) - 1
    mark = np.full(every, -1, np.int32)
    rows = np.zeros(count + 1, np.int32)
    columns = np.empty(max(16, len(indices) // 4), np.int32)
    top = 0
    for k in range(count):
        mark[first + k] = k
        begin, end = 0, 0
        for v in range(start[k], start[k + 1]):
            before, length = begin, end - begin
            begin, end = indptr[member[v]], indptr[member[v] + 1]
            same = end - begin == length
            for p in range(length if same else 0):
                same &= indices[before + p] == indices[begin + p]
            if same:  # as unknowns of a node mostly have: nothing new
                continue
            for p in range(begin, end):
                h = group[indices[p]]
                if mark[h] != k:
                    mark[h] = k
                    if top == len(columns):
                        longer = np.empty(2 * top, np.int32)
                        for q in range(top):
                            longer[q] = columns[q]
                        columns = longer
                    columns[top] = h
                    top += 1
        rows[k + 1] = top
    return Graph(rows, columns[:top].copy())


@kernel()
def both_ways(graph: Graph) -> Graph:
    """Complete a graph of which some edges lead one way only; the same graph where none does."""
    indptr, indices = graph
    count = len(indptr) - 1
    back = np.zeros(count + 1, np.int32)
    for p in range(len(indices)):
        back[indices[p] + 1] += 1
    for v in range(count):
        back[v + 1] += back[v]
    top = back[:-1].copy()
    source = np.empty(len(indices), np.int32)
    for v in range(count):
        for p in range(indptr[v], indptr[v + 1]):
            source[top[indices[p]]] = v
            top[indices[p]] += 1
    mark = np.full(count, -1, np.int32)
    rows = np.zeros(count + 1, np.int32)
    columns = np.empty(2 * len(indices), np.int32)
    here = 0
    for v in range(count):
        for p in range(indptr[v], indptr[v + 1]):
            mark[indices[p]] = v
            columns[here] = indices[p]
            here += 1
        for p in range(back[v], back[v + 1]):
            if mark[source[p]] != v:
                columns[here] = source[p]
                here += 1
        rows[v + 1] = here
    return graph if here == len(indices) else Graph(rows, columns[:here].copy())


@kernel()
def subgraph(graph: Graph, count: int) -> Graph:
    """Keep the first `count` vertices and the edges between them."""
    indptr, indices = graph
    rows = np.zeros(count + 1, np.int32)
    columns = np.empty(indptr[count], np.int32)
    top = 0
    for v in range(count):
        for p in range(indptr[v], indptr[v + 1]):
            if indices[p] < count:
                columns[top] = indices[p]
                top += 1
        rows[v + 1] = top
    return Graph(rows, columns[:top].copy())


@kernel(nogil=True)
def induced(graph: Graph, members: Int32Array, number: Int32Array) -> Graph:
    """Keep some vertices, numbered anew, and the edges between them.

    Parameters
    ----------
    graph : of n vertices
    members : which ones, in their new order
    number : (n,) their new numbers, -1 for the others
    """
    indptr, indices = graph
    rows = np.zeros(len(members) + 1, np.int32)
    most = 0
    for v in members:
        most += indptr[v + 1] - indptr[v]
    columns = np.empty(most, np.int32)
    top = 0
    for i in range(len(members)):
        for p in range(indptr[members[i]], indptr[members[i] + 1]):
            if number[indices[p]] >= 0:
                columns[top] = number[indices[p]]
                top += 1
        rows[i + 1] = top
    return Graph(rows, columns[:top])


@part()
def sort_lists(begin: IntArray, entry: Int32Array, vertices: int) -> None:
    """Sort every list ``entry[begin[s]:begin[s + 1]]`` of vertices: by buckets, in linear time."""
    first = np.zeros(vertices + 1, np.int64)
    for p in range(len(entry)):
        first[entry[p] + 1] += 1
    for v in range(vertices):
        first[v + 1] += first[v]
    owner = np.empty(len(entry), np.int32)
    for s in range(len(begin) - 1):
        for p in range(begin[s], begin[s + 1]):
            owner[first[entry[p]]] = s
            first[entry[p]] += 1
    top = begin.copy()
    p = 0
    for v in range(vertices):
        while p < first[v]:
            entry[top[owner[p]]] = v
            top[owner[p]] += 1
            p += 1
