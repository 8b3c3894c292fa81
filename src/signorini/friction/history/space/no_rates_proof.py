# SPDX-License-Identifier: BSD-3-Clause
"""Proof that a problem with cones has no solution: branch and bound over states and directions of slip.

A number is zero or its complement is; a pair is open, sticks, or slips in a direction between two angles. In the
coordinates that make its section a circle its motion then lies in the wedge between both directions and its force in a
triangle, between the chord of the arc and its tangents. All of that is linear: where the linear programme has no
solution none of these states and directions has one. Sectors are halved, numbers decided, tangents added where the
answer of a programme breaks the law, and Newton's method tried from there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.friction.history.rates import MARGIN, RUNAWAY_RATE, least_lacking
from signorini.friction.history.space.smooth_cones import ConeProblem

_MAX_PROGRAMMES = 400  # linear programmes
_WORK, _FACTORISATIONS = 2e9, 20.0  # operations, and factorisations of a system as large: the more of both is the most
_SLACK = 1e-8  # of the data: what an answer may lack to be looked at further
_PIVOTS = 10  # of a linear programme, per row and column; a half is usual
_TANGENTS = 8

Region = str | tuple[float, float] | None
"""Of a pair: "open", "stick", the angles between which its force lies while it slips, or undecided."""


@dataclass(frozen=True, kw_only=True)
class _Node:
    """What is decided: for every number whether it is positive, for every pair its region; None where undecided."""

    numbers: tuple[bool | None, ...]
    pairs: tuple[Region, ...]


@dataclass(frozen=True, kw_only=True)
class Exhausted:
    """No solution was found.

    Attributes
    ----------
    programmes : linear programmes solved
    undecided : whether some states and directions are left that none of them tells of
    margin : what all others lack at least, of the data
    """

    programmes: int
    undecided: bool
    margin: float

    @property
    def proved(self) -> bool:
        """Whether there is no solution, by more than rounding."""
        return not self.undecided and self.margin > MARGIN


def search_regions(problem: ConeProblem) -> Array | Exhausted:
    """A solution x, or that there is none up to 1e6 times the data, or that too many linear programmes would tell.

    Examples
    --------
    The node that jumps at a pull of 3, pushed on: its force cannot grow, sliding or sticking, nor can it leave.

    >>> M = np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 2.0]])
    >>> def pair(*q):
    ...     return ConeProblem(M=M, q=np.array(q), friction=np.full((1, 2), 3.0), closed=np.array([True]))
    >>> search_regions(pair(-1.0, 0.5, 0.0)).proved, search_regions(pair(1.0, 0.5, 0.0)).round(12).tolist()
    (True, [0.0, 0.0, 0.0])
    """
    N, m = problem.numbers, len(problem.closed)
    unit = problem.unit
    posed = replace(problem, q=problem.q / unit)
    nodes = [_Node(numbers=(None,) * N, pairs=(None,) * m)]
    tangents = [[2.0 * np.pi * j / _TANGENTS for j in range(_TANGENTS)] for _ in range(m)]
    count, margin, untold = 0, np.inf, False
    work = max(_WORK, _FACTORISATIONS * 2.0 / 3.0 * len(posed.q) ** 3)
    while nodes and count < _MAX_PROGRAMMES and work > 0.0:
        node = nodes.pop()
        count += 1
        lacks, x, took = _relaxed(posed, node, tangents, work)
        work -= took
        if not lacks <= _SLACK:
            untold |= bool(np.isnan(lacks))
            margin = min(margin, lacks)
            continue
        near = posed.newton(posed.w(x) - x)
        if near is not None:
            return near * unit
        nodes.extend(_branches(posed, node, x, tangents))
    return Exhausted(programmes=count, undecided=untold or bool(nodes), margin=margin)


def _branches(problem: ConeProblem, node: _Node, x: Array, tangents: list[list[float]]) -> Iterator[_Node]:
    """The node in parts that cover it, split where an answer breaks the law most; itself with one more tangent."""
    N = problem.numbers
    lacking = problem.lacking(x)
    lacking[:N][[value is not None for value in node.numbers]] = 0.0
    worst = int(np.argmax(lacking))
    if worst < N:
        for value in (True, False):
            yield replace(node, numbers=(*node.numbers[:worst], value, *node.numbers[worst + 1 :]))
        return
    k = worst - N
    region = node.pairs[k]
    parts: tuple[Region, ...]
    if region is None:
        quarters = tuple((0.5 * np.pi * j, 0.5 * np.pi * (j + 1)) for j in range(4))
        parts = (*quarters, "stick") if problem.closed[k] else (*quarters, "open", "stick")
    elif isinstance(region, tuple):
        middle = 0.5 * (region[0] + region[1])
        parts = (region[0], middle), (middle, region[1])
    else:
        _, along = _rows(problem, k, problem.M)
        start = problem.q[N + k + len(problem.closed) * np.arange(1, 3)] / problem.friction[:, k]
        one, two = along @ x + start
        tangents[k].append(float(np.arctan2(two, one)))
        parts = (region,)
    for part in parts:
        yield replace(node, pairs=(*node.pairs[:k], part, *node.pairs[k + 1 :]))


def _rows(problem: ConeProblem, k: int, matrix: Array) -> tuple[Array, Array]:
    """The normal row of a pair and its two tangential ones, these where its section is a circle of forces."""
    at = problem.numbers + k + len(problem.closed) * np.arange(3)
    return matrix[at[0]], matrix[at[1:]] / problem.friction[:, k, None]


class _Programme:
    """Rows of a linear programme ``A x <= b + t``, ``|C x - d| <= t``, ``low <= x <= high``, in the least t."""

    def __init__(self, size: int) -> None:
        self.above: list[tuple[Array, float]] = []
        self.equal: list[tuple[Array, float]] = []
        self.low, self.high = np.full(size, -RUNAWAY_RATE), np.full(size, RUNAWAY_RATE)

    def solve(self, work: float) -> tuple[float, Array, float]:
        """The least t, its x, and the operations that it took; NaN where these were not enough to solve it."""
        size = len(self.low)
        A, b = _stacked(self.above, size)
        C, d = _stacked(self.equal, size)
        rows, right = np.concatenate([A, C, -C]), np.concatenate([b, d, -d])
        pivot = 2.0 * len(rows) * size
        length = np.maximum(np.abs(rows).max(axis=1, initial=0.0), 1.0)
        most = max(1, min(_PIVOTS * (len(rows) + size), int(work / pivot)))
        lacks, x, pivots = least_lacking(rows / length[:, None], right / length, self.low, self.high, pivots=most)
        return lacks, x, pivot * max(pivots, 1)


def _stacked(rows: list[tuple[Array, float]], size: int) -> tuple[Array, Array]:
    return np.array([row for row, _ in rows]).reshape(-1, size), np.array([value for _, value in rows])


def _relaxed(problem: ConeProblem, node: _Node, tangents: list[list[float]], work: float) -> tuple[float, Array, float]:
    """How far the relaxed law of a node is from being obeyed, of the data, by which x, and the operations it took.

    NaN where ``work`` operations do not tell.
    """
    M, q = problem.M, problem.q
    programme = _Programme(len(q))
    for i, positive in enumerate(node.numbers):
        programme.low[i] = 0.0
        if positive is False:
            programme.high[i] = 0.0
        (programme.equal if positive else programme.above).append((-M[i], q[i]))
    for k, region in enumerate(node.pairs):
        _pair(problem, k, region, tangents[k], programme)
    return programme.solve(work)


def _pair(problem: ConeProblem, k: int, region: Region, tangents: list[float], programme: _Programme) -> None:
    """What a pair in a region allows."""
    N, m = problem.numbers, len(problem.closed)
    at = N + k + m * np.arange(3)
    closed = problem.closed[k] or region not in (None, "open")
    programme.low[at[0]], programme.high[at[0]] = 0.0, 0.0 if closed else RUNAWAY_RATE
    normal, along = _rows(problem, k, problem.M)
    start = problem.q[at[1:]] / problem.friction[:, k]
    if region == "open":
        programme.equal += [(row, -problem.q[i]) for row, i in zip(problem.M[at], at, strict=True)]
        return
    programme.above.append((-normal, problem.q[at[0]]))
    if region == "stick":
        programme.low[at[1:]] = programme.high[at[1:]] = 0.0

    def touch(angle: float, *, reach: float = 1.0, sign: float = 1.0) -> None:
        direction = np.array([np.cos(angle), np.sin(angle)])
        row, value = direction @ along - reach * normal, direction @ start - reach * problem.q[at[0]]
        programme.above.append((sign * row, -sign * value))

    if not isinstance(region, tuple):
        for angle in tangents:
            touch(angle)
        return
    low, high = region
    touch(low)
    touch(high)
    touch(0.5 * (low + high), reach=float(np.cos(0.5 * (high - low))), sign=-1.0)
    for angle, sign in ((low, 1.0), (high, -1.0)):  # slip is against the force, between both directions
        row = np.zeros(len(problem.q))
        row[at[1:]] = sign * np.array([-np.sin(angle), np.cos(angle)]) * problem.friction[:, k]
        programme.above.append((row, 0.0))
