# SPDX-License-Identifier: BSD-3-Clause
"""Edges of two sides of a mesh of the plane that are halved alike, so that their nodes go on belonging together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.arrays import IntArray
from signorini.meshing.edge_keys import edge_ends, edge_key, edge_keys

NO_TWINS: IntArray = np.empty((0, 4), np.int64)


def twin_edges(cells: IntArray, pairs: IntArray) -> IntArray:
    """Both ends of edges, and those of their twins in the same order, (k, 4); every edge and its twin both ways round.

    Parameters
    ----------
    cells : (m, 3) corners of triangles
    pairs : (n, 2) corners that belong together, each on one side once

    Examples
    --------
    Left and right edge of a square of two triangles:

    >>> twin_edges(np.array([[0, 1, 2], [1, 3, 2]]), np.array([[0, 1], [2, 3]])).tolist()
    [[0, 2, 1, 3], [1, 3, 0, 2]]
    """
    keys = np.unique(edge_keys(cells))
    partner = np.full(int(max(cells.max(), pairs.max(initial=0))) + 1, -1)
    partner[pairs[:, 0]] = pairs[:, 1]
    ends = edge_ends(keys)
    other = partner[ends]
    there = (other >= 0).all(axis=1) & np.isin(edge_key(*other.T), keys)
    rows = np.hstack([ends[there], other[there]])
    return np.vstack([rows, rows[:, [2, 3, 0, 1]]])


def with_twins(keys: IntArray, twins: IntArray) -> IntArray:
    """Edges with their twins, and with the twins of these.

    Parameters
    ----------
    keys : of edges
    twins : (k, 4), see `twin_edges`
    """
    own, other = edge_key(*twins[:, :2].T), edge_key(*twins[:, 2:].T)
    count = -1
    while len(twins) and count != len(keys):
        count = len(keys)
        keys = np.union1d(keys, other[np.isin(own, keys)])
    return keys


def halved_twins(twins: IntArray, corner: Callable[[IntArray], IntArray]) -> IntArray:
    """Twins where both edges are halved as their halves.

    Parameters
    ----------
    twins : (k, 4), see `twin_edges`
    corner : in the middles of edges, -1 of those that are not halved
    """
    if not len(twins):
        return twins
    middle, other = (corner(edge_key(*twins[:, ends].T)) for ends in ([0, 1], [2, 3]))
    halved = middle >= 0
    own, middles = twins[halved], np.column_stack([middle, other])[halved]
    firsts = np.column_stack([own[:, 0], middles[:, 0], own[:, 2], middles[:, 1]])
    seconds = np.column_stack([middles[:, 0], own[:, 1], middles[:, 1], own[:, 3]])
    return np.vstack([twins[~halved], firsts, seconds])
