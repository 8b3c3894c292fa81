# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of nested dissection by geometry: cuts across the plane or space, then refined on the graph.

A piece is cut where the sweep of a plane along one of some directions meets the fewest vertices. Vertices of one side
that touch the other separate them; the separator is then improved by moves of single vertices.

References
----------
Gilbert, Miller, Teng (1998), Geometric mesh partitioning, SIAM J. Sci. Comput. 19:2091.
Fiduccia, Mattheyses (1982), A linear-time heuristic for improving network partitions, Proc. 19th Design Automation
Conference, 175; Hendrickson, Rothberg (1998), Improving the run time and quality of nested dissection ordering, SIAM J.
Sci. Comput. 20:468: the moves of a vertex separator.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Int32Array, IntArray
from signorini.compilation import kernel, part
from signorini.linalg._graph import Graph

LEAF_SIZE = 8  # vertices: pieces up to it are not cut
ROUGH_SIZE = 30  # vertices: pieces up to it are cut, but the cut is not refined, which would gain less than it takes
AXES_SIZE = 2000  # vertices: pieces up to it are cut along the first directions only
CUT_SHARE = 0.25  # of a piece: what a cut leaves on either side at least
MOVES_SHARE = 0.7  # of a piece: up to which moves make a side grow
IMBALANCE = 0.3  # share by which a cut that leaves nothing on one side may be thinner than one through the middle
MAX_PASSES, PATIENCE = 8, 200  # passes of moves; moves in vain, and a quarter of the separator, before a pass ends
GAINS = 20  # buckets of moves: they shorten the separator by 1, 0, -1, ...

NEAR_SIDE, FAR_SIDE, SEPARATOR = 0, 1, 2


class Moves(NamedTuple):
    """What a pass keeps: for both directions of a move the gains, and the vertices in buckets of equal gain.

    Attributes
    ----------
    gain : (2, n) by how much the separator shortens when a vertex of it moves to that side
    locked : (n,) the pass in which a vertex has moved last
    head : (2, GAINS) newest entry of every bucket, -1 where empty
    vertex, older : the entries; entries whose vertex has left or has another gain by now are passed over
    moved, before : the vertices that moved, in their order, and where they were
    used : (2,) entries and moves so far
    """

    gain: Int32Array
    locked: Int32Array
    head: IntArray
    vertex: Int32Array
    older: Int32Array
    moved: Int32Array
    before: Int32Array
    used: IntArray


@kernel(nogil=True)
def dissect(graph: Graph, along: Int32Array, first: int, whole: int) -> tuple[Int32Array, Int32Array]:
    """Order the vertices of a graph so that few entries fill in; give the order, and where each of its pieces ends.

    Parameters
    ----------
    graph : of n vertices, without loops
    along : (k, n) the vertices in their order along every direction; overwritten by that in every piece
    first : how many of the directions are for pieces of any size; the others for `AXES_SIZE` ones
    whole : vertices of pieces that are not cut: up to it
    """
    # of an index with a sign Numba asks whether it counts from the end: sweeps take a fifth longer
    graph = Graph(graph.indptr.view(np.uint32), graph.indices.view(np.uint32))
    directions, n = along.shape
    order, ends = np.empty(n, np.int32), np.zeros(n, np.int32)
    label, place = np.zeros(n, np.int32), np.empty((n, 2), np.int32)
    separator, other = np.empty(n, np.int32), np.empty(n, np.int32)
    difference = np.empty((4, n + 2), np.int32)
    entries, room = 4 * n + 1024, 3 * n
    moves = Moves(
        np.zeros((2, n), np.int32), np.zeros(n, np.int32), np.empty((2, GAINS), np.int64), np.empty(entries, np.int32),
        np.empty(entries, np.int32), np.empty(room, np.int32), np.empty(room, np.int32), np.zeros(2, np.int64),
    )  # fmt: skip
    waiting, left = np.empty((2, n + 2), np.int64), 1  # a list of Python's takes longer to compile
    waiting[0, 0], waiting[1, 0] = 0, n
    sides = np.empty(2, np.int64)
    base, passed = 1, 0
    while left > 0:
        left -= 1
        low, high = waiting[0, left], waiting[1, left]
        size = high - low
        if size <= whole:
            _copy(along[0, low:high], order[low:high])
            if size > 0:
                ends[low] = high
            continue
        for v in along[0, low:high]:
            label[v] = base
        many = directions if size > AXES_SIZE else first
        chosen, cut, thinner = _cheapest(graph, along, low, high, many, label, place, difference)
        base += 1
        count = _separate(graph, along[chosen, low:high], cut, thinner, label, base, separator)
        sides[NEAR_SIDE], sides[FAR_SIDE] = cut, size - cut
        sides[thinner] -= count
        for _ in range(MAX_PASSES if size > ROUGH_SIZE else 0):
            passed += 1
            shorter = _refine(graph, label, base, sides, separator, count, moves, passed)
            if shorter == count:
                break
            count = shorter
        _copy(separator[:count], order[high - count : high])
        near = 0
        for k in range(many):
            near = _partition(along[k, low:high], label, base, other)
        waiting[0, left], waiting[1, left] = low, low + near
        waiting[0, left + 1], waiting[1, left + 1] = low + near, high - count
        left += 2
        base += 3
    return order, ends


@part()
def _copy(source: Int32Array, target: Int32Array) -> None:
    """Element by element: the assignment of a slice takes seconds to compile, for the words of its errors."""
    for i in range(len(source)):
        target[i] = source[i]


@part()
def _cheapest(
    graph: Graph,
    along: Int32Array,
    low: int,
    high: int,
    many: int,
    label: Int32Array,
    place: Int32Array,
    change: Int32Array,
) -> tuple[int, int, int]:
    """The best cut of a piece along the first directions: the direction, the vertices before it, the thinner side."""
    best, chosen = np.inf, 0
    cut, thinner = 0, NEAR_SIDE
    for first in range(0, many, 2):
        second = min(first + 1, many - 1)
        _sweep(graph, along[first, low:high], along[second, low:high], label, place, change)
        for k in range(first, second + 1):
            cost, where, side = _best_cut(high - low, change[2 * (k - first) : 2 * (k - first) + 2])
            if cost < best:
                best, chosen, cut, thinner = cost, k, where, side
    return chosen, cut, thinner


@part()
def _sweep(
    graph: Graph, one: Int32Array, two: Int32Array, label: Int32Array, place: Int32Array, change: Int32Array
) -> None:
    """How the separators of both sides change from cut to cut of a piece, sorted along two directions: (4, .), by rows.

    A vertex with neighbours beyond the cut is in the separator of its side: for all cuts between it and its farthest
    neighbour, so that differences sum up to the sizes of the separators at all cuts. Neighbours are looked at once for
    both directions, and of a whole graph in its own order, in which they lie together.
    """
    indptr, indices = graph
    size = len(one)
    mine = label[one[0]]
    change[:, : size + 2] = 0
    for q in range(size):
        place[np.uint32(one[q]), 0] = place[np.uint32(two[q]), 1] = q
    for q in range(size):
        v = np.uint32(q) if size == len(label) else np.uint32(one[q])
        here, there = place[v, 0], place[v, 1]
        last = begin = here
        end = start = there
        for p in range(indptr[v], indptr[v + np.uint32(1)]):
            w = indices[p]
            if label[w] == mine:
                at, across = place[w, 0], place[w, 1]
                last, begin = max(last, at), min(begin, at)
                end, start = max(end, across), min(start, across)
        _count(change[:2], here, last, begin)
        _count(change[2:], there, end, start)


@part()
def _count(change: Int32Array, here: int, last: int, begin: int) -> None:
    """Count a vertex in the separators of the cuts between it and its neighbours, from ``begin`` to ``last``."""
    change[NEAR_SIDE, np.uint32(here + 1)] += 1
    change[NEAR_SIDE, np.uint32(last + 1)] -= 1
    change[FAR_SIDE, np.uint32(begin + 1)] += 1
    change[FAR_SIDE, np.uint32(here + 1)] -= 1


@part()
def _best_cut(size: int, change: Int32Array) -> tuple[float, int, int]:
    """Where a piece is cut best along a direction: the cost, the vertices before it, the thinner side."""
    least = max(1, int(CUT_SHARE * size))
    best, cut, side = np.inf, least, NEAR_SIDE
    near = far = 0
    for k in range(size - least + 1):
        near += change[NEAR_SIDE, k]
        far += change[FAR_SIDE, k]
        if k >= least:
            cost = min(near, far) * (1.0 + IMBALANCE * abs(1.0 - 2.0 * k / size))
            if cost < best:
                best, cut, side = cost, k, NEAR_SIDE if near < far or (near == far and 2 * k >= size) else FAR_SIDE
    return best, cut, side


@part()
def _separate(
    graph: Graph, line: Int32Array, cut: int, thinner: int, label: Int32Array, base: int, separator: Int32Array
) -> int:
    """Label a piece by the sides of its cut and by the separator, which is listed; gives its size."""
    indptr, indices = graph
    for q in range(len(line)):
        label[line[q]] = base + (NEAR_SIDE if q < cut else FAR_SIDE)
    count = 0
    for v in line[:cut] if thinner == NEAR_SIDE else line[cut:]:
        for p in range(indptr[v], indptr[v + 1]):
            if label[indices[p]] == base + 1 - thinner:
                separator[count] = v
                count += 1
                break
    for v in separator[:count]:
        label[v] = base + SEPARATOR
    return count


@part()
def _partition(line: Int32Array, label: Int32Array, base: int, other: Int32Array) -> int:
    """Bring the near side of a piece to the front and the far one behind it, in their order; gives the near size."""
    near = far = 0
    for v in line:
        if label[v] == base + NEAR_SIDE:
            line[near] = v
            near += 1
        elif label[v] == base + FAR_SIDE:
            other[far] = v
            far += 1
    _copy(other[:far], line[near : near + far])
    return near


@part()
def _refine(
    graph: Graph,
    label: Int32Array,
    base: int,
    sides: IntArray,
    separator: Int32Array,
    count: int,
    moves: Moves,
    stamp: int,
) -> int:
    """Shorten a separator by one pass of moves; lists it anew and gives its size."""
    kept = _pass(graph, label, base, sides, separator[:count], moves, stamp)
    left = 0
    for k in range(count + kept):
        v = separator[k] if k < count else moves.moved[k - count]
        if label[v] == base + SEPARATOR and moves.locked[v] != -stamp:
            separator[left] = v
            left += 1
            moves.locked[v] = -stamp
    return left


@part()
def _pass(
    graph: Graph, label: Int32Array, base: int, sides: IntArray, separator: Int32Array, moves: Moves, stamp: int
) -> int:
    """Move vertices out of the separator, best first and each once; undo what came after the best; gives what is kept.

    A vertex that moves to one side draws its neighbours on the other one into the separator.
    """
    moves.head[:] = -1
    moves.used[:] = 0
    for v in separator:
        _enter(graph, label, base, v, moves)
    current = best = len(separator)
    most = int(MOVES_SHARE * (sides[NEAR_SIDE] + sides[FAR_SIDE] + current))
    near, kept, vain, patience = sides[NEAR_SIDE], 0, 0, PATIENCE + current // 4
    far = sides[FAR_SIDE]
    while vain < patience:
        v, side = _next_move(label, base, sides, most, moves, stamp)
        if v < 0:
            break
        current += _move(graph, label, base, v, side, sides, moves, stamp)
        if current < best or (current == best and abs(sides[NEAR_SIDE] - sides[FAR_SIDE]) < abs(near - far)):
            kept, best, near, far, vain = moves.used[1], current, sides[NEAR_SIDE], sides[FAR_SIDE], 0
        else:
            vain += 1
    for k in range(moves.used[1] - 1, kept - 1, -1):
        label[moves.moved[k]] = moves.before[k]
    sides[NEAR_SIDE], sides[FAR_SIDE] = near, far
    return kept


@part()
def _next_move(label: Int32Array, base: int, sides: IntArray, most: int, moves: Moves, stamp: int) -> tuple[int, int]:
    """The vertex whose move gains most, the smaller side first, and where it goes; -1 where nothing may move."""
    lighter = NEAR_SIDE if sides[NEAR_SIDE] <= sides[FAR_SIDE] else FAR_SIDE
    for level in range(GAINS):
        for side in (lighter, 1 - lighter):
            if sides[side] >= most:
                continue
            while moves.head[side, level] >= 0:
                entry = moves.head[side, level]
                v = moves.vertex[entry]
                moves.head[side, level] = moves.older[entry]
                current = label[v] == base + SEPARATOR and moves.locked[v] != stamp
                if current and _level(moves.gain[side, v]) == level:
                    return v, side
    return -1, NEAR_SIDE


@part()
def _move(
    graph: Graph, label: Int32Array, base: int, v: int, side: int, sides: IntArray, moves: Moves, stamp: int
) -> int:
    """Move a vertex of the separator to a side; gives by how much the separator grows."""
    indptr, indices = graph
    vertices, growth = indices.view(np.int32), -1  # as all who move them know them
    _note(label, v, base + side, moves)
    moves.locked[v] = stamp
    sides[side] += 1
    for p in range(indptr[v], indptr[v + 1]):
        u = vertices[p]
        where = label[u] - base
        if where == SEPARATOR:  # once it leaves for the other side, v comes back
            moves.gain[1 - side, u] -= 1
            _offer(u, 1 - side, moves)
        elif where == 1 - side:
            _note(label, u, base + SEPARATOR, moves)
            sides[1 - side] -= 1
            growth += 1
            _enter(graph, label, base, u, moves)
            for q in range(indptr[u], indptr[u + 1]):
                w = indices[q]
                if label[w] == base + SEPARATOR and w != u:
                    moves.gain[side, w] += 1
                    _offer(w, side, moves)
    return growth


@part()
def _enter(graph: Graph, label: Int32Array, base: int, v: int, moves: Moves) -> None:
    """Offer both moves of a vertex in the separator."""
    indptr, indices = graph
    near = far = 0
    for p in range(indptr[v], indptr[v + 1]):
        where = label[indices[p]] - base
        near += where == NEAR_SIDE
        far += where == FAR_SIDE
    moves.gain[NEAR_SIDE, v], moves.gain[FAR_SIDE, v] = 1 - far, 1 - near
    for side in range(2):
        _offer(v, side, moves)


@part()
def _offer(v: int, side: int, moves: Moves) -> None:
    """Put a move into its bucket; where there is no room left, it is not made."""
    entry = moves.used[0]
    if entry < len(moves.vertex):
        level = _level(moves.gain[side, v])
        moves.vertex[entry], moves.older[entry] = v, moves.head[side, level]
        moves.head[side, level] = entry
        moves.used[0] += 1


@part()
def _level(gain: int) -> int:
    """Bucket of a gain."""
    return max(0, min(GAINS - 1, 1 - gain))


@part()
def _note(label: Int32Array, v: int, new: int, moves: Moves) -> None:
    """Relabel a vertex so that it can be undone; at most three times a vertex and pass."""
    k = moves.used[1]
    moves.moved[k], moves.before[k] = v, label[v]
    moves.used[1] += 1
    label[v] = new
