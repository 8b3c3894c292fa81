# SPDX-License-Identifier: BSD-3-Clause
"""The order of elimination: nested dissection of the interior nodes, the interface last."""

from __future__ import annotations

import itertools

import numpy as np
import pymetis

from signorini.arrays import Array, Int32Array
from signorini.linalg._dissection import dissect
from signorini.linalg._graph import subgraph
from signorini.linalg.system import NodeGraph

ORDERED_BY_METIS = 4096
"""Nodes up to which METIS orders though their places are known: at most ten milliseconds more, and by size alone, so
that an answer has the same digits whatever has been compiled before."""


def nested_dissection(graph: NodeGraph) -> Int32Array:
    """Order the interior nodes so that few entries fill in.

    Where the places of the nodes are known, by cuts across them (`_dissection`), which on meshes is several times
    faster than METIS at about the same fill (`benchmarks/ordering.py`); otherwise by METIS, and small graphs too: it
    takes milliseconds, and a first run need not compile the cuts.

    Returns
    -------
    (interior,) array : the nodes in their order of elimination

    References
    ----------
    George (1973), Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10:345.
    Karypis, Kumar (1998), A fast and high quality multilevel scheme for partitioning irregular graphs, SIAM J. Sci.
    Comput. 20:359.
    """
    inside = subgraph(graph.edges, graph.interior)
    if len(inside.indices) == 0:
        return np.arange(graph.interior, dtype=np.int32)
    if graph.points is not None and graph.interior > ORDERED_BY_METIS:
        axes, diagonals = _directions(graph.points[: graph.interior])
        along = np.argsort(np.concatenate([axes, diagonals]), axis=1, kind="stable").astype(np.int32)
        return dissect(inside, along, len(axes))
    order, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(*inside))
    return np.asarray(order, dtype=np.int32)


def _directions(points: Array) -> tuple[Array, Array]:
    """Coordinates along the axes, and along the diagonals of the planes of two axes."""
    axes = points.T
    pairs = list(itertools.combinations(axes, 2))
    diagonals = [x + sign * y for x, y in pairs for sign in (1.0, -1.0)]
    return axes, np.array(diagonals).reshape(-1, len(points))


def unknowns(graph: NodeGraph, nodes: Int32Array) -> Int32Array:
    """List the unknowns of some nodes, node by node."""
    size = graph.start[nodes + 1] - graph.start[nodes]
    ends = np.cumsum(size)
    total = int(ends[-1]) if len(ends) else 0
    offset = np.repeat(graph.start[nodes] - (ends - size), size)
    return graph.member[offset + np.arange(total)]
