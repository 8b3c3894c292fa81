# SPDX-License-Identifier: BSD-3-Clause
"""The plan of a multifrontal factorisation: the order, the fronts, and what they will cost.

Unknowns of a node stay together, so that trees and fronts are those of the node graph, d times smaller.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, Int32Array, IntArray
from signorini.linalg import _symbolic
from signorini.linalg._graph import Elimination
from signorini.linalg.ordering import nested_dissection, unknowns
from signorini.linalg.system import NodeGraph, System, node_graph

SHARED_WORK = 3e9
"""Multiplications and additions from which threads share a factorisation: two tenths of a second of one thread.

Below it two gain a twentieth of a solve, and tasks cost one thread a quarter of the factorisation."""

BRANCHES = 32
"""Threads take subtrees of at most this part of all work: enough for some sixteen threads."""

SMALLEST_BRANCH = 1e-3
"""Part of all work of subtrees below which handing them to a thread is not worth it: they are joined by the next."""

RELAX = (8, 0.8, 24, 0.3, 0.05)
"""When supernodes are joined though zeros are stored for it; see `_symbolic.supernodes`. Found by measurement."""


class Fronts(NamedTuple):
    """The fronts in postorder; a named tuple, because compiled loops read it.

    Attributes
    ----------
    first : (s + 1,) first node of every front, in the order of elimination
    unknown : (g + 1,) first unknown of every node, in the order of elimination
    begin, row : the nodes below front s are ``row[begin[s]:begin[s + 1]]``
    below : (s,) how many unknowns they have
    parent : (s,) the front that receives what is left of a front; -1: the interface
    panel : (s + 1,) where the columns of every front begin in the factor
    side : (s,) the stack on which what is left of a front waits, other than that of its parent
    """

    first: Int32Array
    unknown: Int32Array
    begin: IntArray
    row: Int32Array
    below: Int32Array
    parent: Int32Array
    panel: IntArray
    side: Int32Array


@dataclass(frozen=True, kw_only=True)
class Part:
    """Fronts that follow each other: subtrees that one thread eliminates, or one front that threads share.

    Attributes
    ----------
    begin, end : the fronts
    branch : whether they are subtrees, which need nothing of what is before them
    work : multiplications and additions
    """

    begin: int
    end: int
    branch: bool
    work: float


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Everything that depends on the pattern alone.

    Attributes
    ----------
    order : (n,) unknowns in their order of elimination, the interface last
    fronts : see `Fronts`
    parts : the fronts by parts, the same for any number of threads
    stacks : entries that wait for their parents, and those made, at the worst time on each of two stacks
    widest : unknowns below the largest front
    nnz_factor : entries of the factor
    flops : multiplications and additions of the factorisation
    peak_bytes : factor, stacks and condensed matrix together
    """

    order: Int32Array
    fronts: Fronts
    parts: tuple[Part, ...]
    stacks: tuple[int, int]
    widest: int
    nnz_factor: int
    flops: float
    peak_bytes: int


def analyse(system: System) -> Plan:
    """Plan the factorisation of a system."""
    graph = node_graph(system)
    elimination = _postordered(graph, nested_dissection(graph))
    order, arguments = elimination.order, (graph.edges, elimination)
    parent = _symbolic.elimination_tree(*arguments, graph.interior)
    count = _symbolic.column_counts(*arguments, parent)
    first = _symbolic.supernodes(parent, count, RELAX)
    begin, row, parent = _symbolic.front_rows(*arguments, first, count)

    size = (graph.start[1:] - graph.start[:-1])[order]
    unknown = _offsets(size).astype(np.int32)
    below = np.diff(_offsets(size[row])[begin])
    width = np.diff(unknown[first]).astype(np.int64)
    panel = _offsets(width * (width + below))
    side = _symbolic.sides(parent)
    stacks = _symbolic.stack_peaks(parent, side, below**2)
    work = width**3 / 3 + width**2 * below + width * below.astype(np.float64) ** 2
    return Plan(
        order=unknowns(graph, order),
        fronts=Fronts(first, unknown, begin, row, below.astype(np.int32), parent, panel, side),
        parts=tuple(_parts(parent, work)),
        stacks=stacks,
        widest=int(below.max(initial=0)),
        nnz_factor=int((width * (width + 1) // 2 + width * below).sum()),
        flops=float(work.sum()),
        peak_bytes=8 * (int(panel[-1]) + sum(stacks) + system.m**2),
    )


def _parts(parent: Int32Array, work: Array) -> Iterator[Part]:
    """Part the fronts, of which every one has a parent and its work, into branches and the fronts above them."""
    number, whole = len(parent), float(work.sum())
    if whole <= SHARED_WORK:
        yield Part(begin=0, end=number, branch=True, work=whole)
        return
    total = _symbolic.subtree_sums(parent, work)
    light = total <= whole / BRANCHES
    begin, gathered = 0, 0.0
    for t in np.flatnonzero(~light | (parent == -1) | ~light[parent]).tolist():
        gathered += float(total[t]) if light[t] else 0.0
        if light[t] and gathered <= SMALLEST_BRANCH * whole and t + 1 < number:
            continue
        end = t + 1 if light[t] else t
        if begin < end:
            yield Part(begin=begin, end=end, branch=True, work=gathered)
        if not light[t]:
            yield Part(begin=t, end=t + 1, branch=False, work=float(work[t]))
        begin, gathered = t + 1, 0.0


class Plans:
    """Plans of systems that are factorised again and again with other entries: each pattern is analysed once."""

    def __init__(self) -> None:
        self._last: tuple[System, Plan] | None = None

    def of(self, system: System) -> Plan:
        """The plan of a system; that of the last one where the pattern, the interface and the nodes are those."""
        if self._last is None or not _alike(self._last[0], system):
            self._last = replace(system, rows=system.rows._replace(data=np.zeros(0))), analyse(system)
        return self._last[1]


def _alike(one: System, other: System) -> bool:
    """Whether two systems have the same pattern, interface and nodes."""
    first, second = one.rows, other.rows
    pairs = ((first.indptr, second.indptr), (first.indices, second.indices))
    return all(np.array_equal(*pair) for pair in (*pairs, (one.interface, other.interface), (one.nodes, other.nodes)))


def _postordered(graph: NodeGraph, nodes: Int32Array) -> Elimination:
    """Order the nodes by a postorder of the tree of a given order."""
    order = np.arange(len(graph.start) - 1, dtype=np.int32)
    order[: graph.interior] = nodes
    place = np.empty_like(order)
    place[order] = np.arange(len(order), dtype=np.int32)
    parent = _symbolic.elimination_tree(graph.edges, Elimination(order, place), graph.interior)
    order[: graph.interior] = order[_symbolic.postorder(parent)]
    place[order] = np.arange(len(order), dtype=np.int32)
    return Elimination(order, place)


def _offsets(size: IntArray | Int32Array) -> IntArray:
    return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(size, dtype=np.int64)])
