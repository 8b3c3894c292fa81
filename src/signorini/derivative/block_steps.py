# SPDX-License-Identifier: BSD-3-Clause
"""Many points in the plane passed backwards at once, with one inverse and products of matrices, in compiled steps.

As in `state_blocks` a block is a run of points between which few pairs change: pairs that are touched, by a change, an
event or what is remembered of them, stick in the state whose inverse X it uses. What the output asks of the points
directly meets X in one product for all of them. What is handed from point to point, memories and the loads of events,
is on touched pairs alone, so that a step asks for their rows of X and for a small system, and for no product with X.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel, part
from signorini.derivative.adjoint_terms import Weights
from signorini.derivative.points import TapePoint
from signorini.friction.history.plane.state_inverse import SingularState, StateInverse
from signorini.friction.linear import SINGULAR
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN, STICK

_TOUCHED = 20  # pairs that may be touched in a block: more cost more in each of its steps than another block

LONGEST_BLOCK = 128
"""Points that are looked at ahead."""


class Steps(NamedTuple):
    """The points of a block in the order in which they are passed, and what the output asks of them.

    Attributes
    ----------
    codes : (k, n) states
    slope : (k, n) friction per pressure of pairs that slip
    h, r : (k, 2, n) how the output changes with motions and forces
    h_rate, r_rate : (k, 2, n) rates of both, 0 where the load is given
    pair : (k,) that comes to its event, -1 where the load is given
    event : (k, 4) how its condition changes with gap, pressure and friction, and its rate
    """

    codes: IntArray
    slope: Array
    h: Array
    r: Array
    h_rate: Array
    r_rate: Array
    pair: IntArray
    event: Array


class Base(NamedTuple):
    """The state that holds all of a block.

    Attributes
    ----------
    pairs : (c,) that are touched; they stick in it
    number : (n,) of a pair among these
    rows : (2, c, m) of X, of their normal and of their tangential forces
    place : (2n + k,) of an unknown among those of the state, -1 of others
    unknowns : (m,)
    """

    pairs: IntArray
    number: IntArray
    rows: Array
    place: IntArray
    unknowns: IntArray


class Passed(NamedTuple):
    """What a block leaves, for its points.

    Attributes
    ----------
    free : (k, 2n + motions) how the output changes with their loads
    pushed : (k, 1, n) how it changes with friction directly
    share : (k,) and with the condition of their events
    used : (k,) whether it changes with any of that
    """

    free: Array
    pushed: Array
    share: Array
    used: BoolArray


class BlockSteps:
    """Points of one system in the plane, passed backwards.

    Parameters
    ----------
    problem : the law; its b does not matter
    """

    def __init__(self, problem: ContactProblem) -> None:
        self._inverse, self._problem = StateInverse(problem), problem

    def back(self, points: Sequence[TapePoint], asked: Callable[[int], Weights | None], memory: Array) -> Passed | None:
        """Pass as many points, in order of passing, as one inverse serves; None where there is none.

        Parameters
        ----------
        points : that come next, more than a block has
        asked : how the output changes with motions and forces (d, n) of a point by its place, scaled; None: not at all
        memory : (n,) how it changes with what is remembered of the pairs; overwritten
        """
        codes = np.array([point.states.codes for point in points], dtype=np.int64)
        pair = np.array([point.event.pair if point.at_event else -1 for point in points])
        changed = codes != codes[0]
        changed[0] = (memory != 0.0) & (codes[0] != STICK)
        changed[np.flatnonzero(pair >= 0), pair[pair >= 0]] = True
        changed = np.logical_or.accumulate(changed, axis=0)
        count = max(1, int(np.searchsorted(changed.sum(axis=1), _TOUCHED, side="right")))
        touched = changed[count - 1]
        try:
            self._inverse.move_to(np.where(touched, STICK, codes[0]))
        except SingularState:
            return None
        steps = self._steps(points[:count], codes[:count], pair[:count], asked)
        return self._pass(steps, np.flatnonzero(touched), memory)

    def _steps(
        self, points: Sequence[TapePoint], codes: IntArray, pair: IntArray, asked: Callable[[int], Weights | None]
    ) -> Steps:
        """The points of a block."""
        shape = (len(points), 2, codes.shape[1])
        h, r, h_rate, r_rate = (np.zeros(shape) for _ in range(4))
        event = np.ones((len(points), 4))
        for k, point in enumerate(points):
            weight = asked(k)
            if weight is not None:
                h[k], r[k] = weight.h, weight.r
            if pair[k] >= 0:
                assert point.rates is not None
                h_rate[k], r_rate[k] = point.rates
                known = point.event
                event[k] = known.gap, known.pressure, float(known.friction), known.rate
        slope = self._problem.pieces.slope(codes)
        return Steps(codes, slope, h, r, h_rate, r_rate, pair, event)

    def _pass(self, steps: Steps, touched: IntArray, memory: Array) -> Passed:
        """What a block leaves; its memory is overwritten."""
        inverse, n = self._inverse, steps.codes.shape[1]
        X, place, unknowns = inverse.matrix, inverse.place, inverse.unknowns.copy()
        number = np.full(n, -1)
        number[touched] = np.arange(len(touched))
        rows = np.ascontiguousarray(X[np.stack([place[touched], place[n + touched]])])
        free = np.zeros((len(steps.pair), inverse.rows))
        free[:, : 2 * n] = steps.h.reshape(-1, 2 * n)
        free[:, unknowns] = 0.0
        left = self._pushed(steps, free)[:, unknowns]
        asked = np.flatnonzero(left.any(axis=1))
        left[asked] = left[asked] @ X
        used, share = np.zeros(len(free), dtype=np.bool_), np.zeros(len(free))
        pushed = steps.r[:, 1:].copy()
        base = Base(touched, number, rows, place, unknowns)
        if not _back(steps, base, left, memory, Passed(free, pushed, share, used)):
            raise SingularState
        return Passed(free, pushed, share, used)

    def _pushed(self, steps: Steps, seen: Array) -> Array:
        """(k, 2n + motions) What the output asks of forces, those apart that the state that holds all leaves no choice.

        Parameters
        ----------
        steps : of the block
        seen : (k, 2n + motions) what it asks of motions, 0 of those that the state prescribes
        """
        image, n = self._problem.image, steps.codes.shape[1]
        found = np.concatenate([steps.r.reshape(-1, 2 * n), np.zeros((len(seen), seen.shape[1] - 2 * n))], axis=1)
        there = np.flatnonzero(seen.any(axis=0))
        if len(there):  # what forces move of it: rows of the compliance, which is symmetric
            asked = np.flatnonzero(seen.any(axis=1))
            given = seen[np.ix_(asked, there)]
            found[asked, : 2 * n] += given @ image.A[there]
            found[asked, 2 * n :] = given @ image.R[there]
        found[:, :n] += self._inverse.slope * found[:, n : 2 * n]
        return found


@kernel()
def _back(steps: Steps, base: Base, left: Array, memory: Array, found: Passed) -> bool:
    """Pass the points of a block; False where one of their states has no unique response.

    Parameters
    ----------
    steps, base : the block
    left : (k, m) what is asked directly, times X; overwritten by minus how the output changes with the unknowns' loads
    memory : (n,) overwritten
    found : overwritten; free holds what is asked of motions that are not unknowns' equations
    """
    n, most = len(memory), 2 * len(base.pairs)
    h, matrix = np.empty((2, n)), np.empty((most, most))
    rhs, freed, of_pair = np.empty(most), np.empty(most, np.int64), np.empty(most, np.int64)
    for k in range(len(steps.pair)):
        codes, w, any_asked = steps.codes[k], left[k], steps.r[k].any()
        for p in range(n):
            h[0, p], h[1, p] = steps.h[k, 0, p], steps.h[k, 1, p] + memory[p]
            memory[p] = 0.0
            if codes[p] == STICK:
                memory[p], h[1, p] = h[1, p], 0.0
            any_asked |= h[0, p] != 0.0 or h[1, p] != 0.0
        if not any_asked:
            continue
        found.used[k] = True
        event = steps.pair[k]
        if event >= 0:
            share = -(np.sum(h * steps.h_rate[k]) + np.sum(steps.r[k] * steps.r_rate[k])) / steps.event[k, 3]
            found.share[k] = share
            h[0, event] += share * steps.event[k, 0]
            found.pushed[k, 0, event] += share * steps.event[k, 2]
            for i in range(2):
                w += share * steps.event[k, 1 + i] * base.rows[i, base.number[event]]
        count = 0
        for c in range(len(base.pairs)):
            p = base.pairs[c]
            for i in range(2):
                if codes[p] == OPEN or (i == 1 and codes[p] != STICK):
                    freed[count], of_pair[count] = i * n + p, c
                    rhs[count] = w[base.place[i * n + p]] + h[i, p]
                    count += 1
        if not _relate(steps.slope[k], base, freed[:count], of_pair[:count], matrix[:count, :count], rhs[:count]):
            return False
        _take_off(steps.slope[k], base, freed[:count], of_pair[:count], rhs[:count], w)
        for i in range(len(w)):
            found.free[k, base.unknowns[i]] = -w[i]
        for i in range(count):
            side = freed[i] // n
            found.free[k, freed[i]] = h[side, freed[i] - side * n]
        for p in range(n):
            if codes[p] == STICK:
                memory[p] += w[base.place[n + p]]
    return True


@part()
def _relate(slope: Array, base: Base, freed: IntArray, of_pair: IntArray, matrix: Array, rhs: Array) -> bool:
    """Solve the transposed small system of a state for rhs, (q,), in place; False where it is singular.

    Parameters
    ----------
    slope, base : (n,) of the state, and the block
    freed, of_pair : (q,) equations that the state gives up, and the number of the touched pair of each
    matrix : (q, q) overwritten
    rhs : (q,)
    """
    n, size = len(slope), 0.0
    for j in range(len(freed)):
        c = of_pair[j]
        for i in range(len(freed)):
            at = base.place[freed[i]]
            if freed[j] < n:
                matrix[i, j] = base.rows[0, c, at]
            else:
                matrix[i, j] = base.rows[1, c, at] - slope[freed[j] - n] * base.rows[0, c, at]
    least = np.inf
    for j in range(len(freed)):
        pivot = j
        for i in range(j + 1, len(freed)):
            if abs(matrix[i, j]) > abs(matrix[pivot, j]):
                pivot = i
        size, least = max(size, np.abs(matrix[pivot, j:]).max()), min(least, abs(matrix[pivot, j]))
        if least <= SINGULAR * size:
            return False
        if pivot != j:
            for i in range(j, len(freed)):
                matrix[j, i], matrix[pivot, i] = matrix[pivot, i], matrix[j, i]
            rhs[j], rhs[pivot] = rhs[pivot], rhs[j]
        for i in range(j + 1, len(freed)):
            factor = matrix[i, j] / matrix[j, j]
            if factor != 0.0:
                rhs[i] -= factor * rhs[j]
                matrix[i, j + 1 :] -= factor * matrix[j, j + 1 :]
    for j in range(len(freed) - 1, -1, -1):
        rhs[j] = (rhs[j] - np.sum(matrix[j, j + 1 :] * rhs[j + 1 :])) / matrix[j, j]
    return True


@part()
def _take_off(slope: Array, base: Base, freed: IntArray, of_pair: IntArray, share: Array, w: Array) -> None:
    """Take shares of the relations of a state, (q,), from w, (m,); the others as of `_relate`."""
    n = len(slope)
    for j in range(len(freed)):
        normal, tangential = base.rows[0, of_pair[j]], base.rows[1, of_pair[j]]
        if freed[j] < n:
            w -= share[j] * normal
        else:
            w -= share[j] * tangential
            if slope[freed[j] - n] != 0.0:
                w += share[j] * slope[freed[j] - n] * normal
