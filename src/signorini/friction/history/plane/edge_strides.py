# SPDX-License-Identifier: BSD-3-Clause
"""Edges of zones that creep: Newton moves the edge of a long zone by a pair a step, and here on to where it will end.

What is lacking at an edge falls as it moves on. Of the way to where it would vanish, by its last two values, a part is
gone at once. The pairs of a side are numbered along it, as meshes are; where they are not, no edge is seen to creep.
States are only proposed: what is not lawful Newton takes back.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray

_CREEPS = 2  # pairs: up to which an edge that moves is taken to creep
_EDGES = 16  # edges: more of them are no zones
_SHARE = 0.5  # of the way to where nothing is lacking that is gone at once; less where a part was taken back
_LESS = 0.8  # by which that share falls
_FARTHER = 8.0  # times as far as the last step: the farthest that is gone at once


class _Edge(NamedTuple):
    """The pair that an edge moves to next, its way, +1 or -1, and the state that it brings."""

    pair: int
    way: int
    state: int


class EdgeStrides:
    """What is known of edges from the last step.

    >>> strides, ahead = EdgeStrides(), np.zeros(12, dtype=np.int64)
    >>> for edge, lacking in ((3, 0.8), (4, 0.7)):
    ...     state, following = (np.where(np.arange(12) < end, 2, 1) for end in (edge, edge + 1))
    ...     ahead = strides.ahead(state, following, np.full(12, lacking))
    >>> ahead.tolist()
    [2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1]
    """

    def __init__(self) -> None:
        self._share = _SHARE
        self._known: dict[_Edge, tuple[int, float]] = {}
        self._gone: set[int] = set()

    def ahead(self, state: IntArray, following: IntArray, lacking: Array) -> IntArray:
        """The states that follow, (n,), with edges that creep moved on.

        Parameters
        ----------
        state, following : (n,) states tried, and those that Newton proposes after them
        lacking : (n,) by how much a pair breaks its condition, where it does
        """
        changed = np.flatnonzero(following != state)
        known, self._known = self._known, {}
        if self._gone.intersection(changed.tolist()):
            self._share *= _LESS
        self._gone = set()
        result, kinds = following.copy(), np.stack([state[changed], following[changed]])
        cuts = np.flatnonzero((np.diff(changed) > 1) | np.diff(kinds).any(axis=0)) + 1
        for run in np.split(changed, cuts) if len(changed) and len(cuts) < _EDGES else ():
            edge = _edge(state, following, run)
            if edge is None:
                continue
            far, value = 0, float(lacking[edge.pair])
            moved, before = known.get(edge, (0, 0.0))
            if value < before and len(run) <= _CREEPS:
                far = int(min(self._share * value * moved / (before - value), _FARTHER * moved)) - len(run)
            end = edge.pair + edge.way * len(run)
            free = (state == state[edge.pair]) & (following == state)
            gone = _in_a_row(free, end, edge.way, max(far, 0))
            result[gone] = edge.state
            self._gone.update(gone.tolist())
            self._known[edge._replace(pair=end + edge.way * len(gone))] = len(run) + len(gone), value
        return result


def _edge(state: IntArray, following: IntArray, run: IntArray) -> _Edge | None:
    """The edge that moved over a run of pairs: beside it they were in that state already, and stay in it."""
    new = following[run[0]]
    for pair, way in ((run[0], 1), (run[-1], -1)):
        behind = pair - way
        if 0 <= behind < len(state) and state[behind] == new == following[behind]:
            return _Edge(int(pair), way, int(new))
    return None


def _in_a_row(free: Array, begin: int, way: int, most: int) -> IntArray:
    """Pairs from one on, along a way, as long as they are free, at most so many.

    >>> _in_a_row(np.array([True, True, False, True]), 1, -1, 5).tolist()
    [1, 0]
    """
    last = begin + way * most
    row = np.arange(begin, max(last, -1) if way < 0 else min(last, len(free)), way)
    row = row[(row >= 0) & (row < len(free))]
    return row[np.logical_and.accumulate(free[row])]
