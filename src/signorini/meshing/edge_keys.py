# SPDX-License-Identifier: BSD-3-Clause
"""Edges of triangles and tetrahedra as single numbers, and tables by them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import IntArray
from signorini.model.mesh import EDGES

SIMPLEX_EDGES = {2: ((0, 1),), 3: ((0, 1), (1, 2), (2, 0)), 4: EDGES["tetra10"]}
"""Edges of a simplex by the number of its corners, in the order of its middle nodes."""

_SHIFT = 32  # bits for the number of a node: the key of an edge holds two


def edge_keys(simplices: IntArray) -> IntArray:
    """(m, e) One number for every edge of simplices (m, corners).

    >>> keys = edge_keys(np.array([[2, 0, 1]]))
    >>> edge_ends(keys[0]).tolist()
    [[0, 2], [0, 1], [1, 2]]
    """
    first, second = np.array(SIMPLEX_EDGES[simplices.shape[1]]).T
    return edge_key(simplices[:, first], simplices[:, second])


def edge_key(one: IntArray, other: IntArray) -> IntArray:
    """The numbers of edges between corners, whichever end comes first."""
    key: IntArray = (np.minimum(one, other) << _SHIFT) | np.maximum(one, other)
    return key


def edge_ends(keys: IntArray) -> IntArray:
    """(..., 2) Corners at the ends of edges, the smaller number first."""
    return np.stack([keys >> _SHIFT, keys & ((1 << _SHIFT) - 1)], axis=-1)


def merged(known: tuple[IntArray, NDArray[Any]], more: tuple[IntArray, NDArray[Any]]) -> tuple[IntArray, NDArray[Any]]:
    """Two tables of keys, ascending, and values as one."""
    keys = np.concatenate([known[0], more[0]])
    order = np.argsort(keys, kind="stable")
    return keys[order], np.concatenate([known[1], more[1]])[order]
