# SPDX-License-Identifier: BSD-3-Clause
"""The order of elimination: nested dissection of the interior nodes, the interface last."""

from __future__ import annotations

import itertools
from functools import partial
from typing import NamedTuple

import numpy as np
import pymetis

from signorini.arrays import Array, Int32Array
from signorini.cores import number_of_threads
from signorini.crew import Crew
from signorini.linalg._dissection import AXES_SIZE, LEAF_SIZE, dissect
from signorini.linalg._graph import Graph, induced, subgraph
from signorini.linalg.system import NodeGraph

SHARED_PIECE = 20_000
"""Nodes above which a piece is cut by itself, so that threads share what it leaves: tens of milliseconds of one."""


def nested_dissection(graph: NodeGraph) -> Int32Array:
    """Order the interior nodes so that few entries fill in.

    Where the places of the nodes are known, by cuts across them (`_dissection`), which on meshes is several times
    faster than METIS at about the same fill (`benchmarks/ordering.py`); otherwise by METIS.

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
    if graph.points is not None:
        axes, diagonals = _directions(graph.points[: graph.interior])
        with Crew(number_of_threads() if graph.interior > SHARED_PIECE else 1) as crew:
            sorts = [partial(np.argsort, direction, kind="stable") for direction in (*axes, *diagonals)]
            return _dissected(inside, np.array(crew.each(sorts), dtype=np.int32), len(axes), crew)
    edges = (part.astype(np.int64) for part in inside)  # METIS's own integers: others it reads one by one
    order, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(*edges))
    return np.asarray(order, dtype=np.int32)


class _Piece(NamedTuple):
    """A part of a graph that is dissected by itself.

    Attributes
    ----------
    begin : place of its first vertex in the order
    vertices : of the whole graph, ascending
    graph, along : see `dissect`, in numbers of its own
    """

    begin: int
    vertices: Int32Array
    graph: Graph
    along: Int32Array


def _dissected(graph: Graph, along: Int32Array, first: int, crew: Crew) -> Int32Array:
    """What `dissect` gives, by pieces side by side: large ones are cut once and are two pieces then."""
    count = len(graph.indptr) - 1
    order = np.empty(count, np.int32)
    pieces = [_Piece(0, np.arange(count, dtype=np.int32), graph, along)]
    while pieces:
        found = crew.each([partial(_cut, piece, first, order) for piece in pieces])
        pieces = list(itertools.chain.from_iterable(found))
    return order


def _cut(piece: _Piece, first: int, order: Int32Array) -> list[_Piece]:
    """Cut a large piece once, and give what it leaves; order the vertices of others.

    Parameters
    ----------
    piece, first : what is cut; see `dissect`
    order : overwritten where the piece stands in it
    """
    count = len(piece.vertices)
    large = count > SHARED_PIECE
    own, ends = dissect(piece.graph, piece.along, first, count - 1 if large else LEAF_SIZE)
    order[piece.begin : piece.begin + count] = piece.vertices[own]
    left = []
    for low in np.flatnonzero(ends).tolist() if large else []:
        members = np.sort(own[low : ends[low]])
        number = np.full(count, -1, np.int32)
        number[members] = np.arange(len(members), dtype=np.int32)
        along = piece.along if count > AXES_SIZE else piece.along[:first]
        along = np.ascontiguousarray(number[along[:, low : ends[low]]])
        graph = induced(piece.graph, members, number)
        left.append(_Piece(piece.begin + low, piece.vertices[members], graph, along))
    return left


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
