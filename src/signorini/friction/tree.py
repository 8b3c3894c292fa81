# SPDX-License-Identifier: BSD-3-Clause
"""Proof that no state of the pairs is in equilibrium, or a state that is: a tree of linear programs.

Relax every pair to ``gap >= 0, p >= 0, |r_t| <= mu p`` and minimise what equilibrium lacks. Where that is positive, no
state allowed there exists, and the multipliers z of the program prove it (Farkas): ``z.(G h - W r) <= 0`` for
everything allowed, yet ``z.b > 0``. Where it is zero, branch the pair that breaks Coulomb's law worst: open or closed,
then stick, slip + or slip -.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import linprog

from signorini.arrays import Array, IntArray
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.friction.problem import CoulombProblem

CLOSED = 4
"""Closed, and not yet decided whether it sticks or slips."""

MARGIN = 1e-7
"""Equilibrium lacking, relative to scale, above which a branch is refused; a certified solution is at 1e-10."""


@dataclass(frozen=True, kw_only=True)
class TreeEnd:
    """What the tree found.

    Attributes
    ----------
    end : ``"solution"``, ``"impossible"`` (every leaf refused) or ``"budget spent"``
    state : (n,) states of the solution, None otherwise
    programs : linear programs solved
    """

    end: Literal["solution", "impossible", "budget spent"]
    state: IntArray | None
    programs: int


def search(problem: CoulombProblem, *, budget: int = 2000) -> TreeEnd:
    """Search all states for equilibrium.

    Parameters
    ----------
    problem : the problem; a few dozen pairs at most
    budget : most linear programs

    Examples
    --------
    >>> problem = CoulombProblem(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> end = search(problem)
    >>> end.end, end.state.tolist()
    ('solution', [3])
    """
    n = problem.pairs
    matrix = _generators(problem)
    waiting = [np.full(n, UNDECIDED)]
    for programs in range(1, budget + 1):
        node = waiting.pop()
        answer = _relaxed(problem, matrix, node)
        if answer is None:
            return TreeEnd(end="budget spent", state=None, programs=programs)
        lacking, h, c = answer
        if lacking <= MARGIN:
            pair, complete = _worst(problem, node, h, c)
            if pair is None:
                return TreeEnd(end="solution", state=complete, programs=programs)
            for branch in _branches(int(node[pair]), int(complete[pair]), int(problem.closed[pair])):
                child = node.copy()
                child[pair] = branch
                waiting.append(child)
        if not waiting:
            return TreeEnd(end="impossible", state=None, programs=programs)
    return TreeEnd(end="budget spent", state=None, programs=budget)


def _generators(problem: CoulombProblem) -> Array:
    """(2n, 4n) columns of h_n, h_t and two forces a pair, the edges (1, mu) and (1, -mu) of its friction cone.

    Edges are scaled to length 1.
    """
    n, W = problem.pairs, problem.W
    length = np.hypot(1.0, problem.mu)
    plus = (W[:, :n] + W[:, n:] * problem.mu) / length
    minus = (W[:, :n] - W[:, n:] * problem.mu) / length
    return np.concatenate([np.eye(2 * n) - W, -plus, -minus], axis=1)


def _relaxed(problem: CoulombProblem, matrix: Array, node: IntArray) -> tuple[float, Array, Array] | None:
    """Least misfit (sum of its entries over scale) of a node, with motions h (2n) and edge forces c (2n)."""
    n, unit = problem.pairs, problem.scale or 1.0
    low, high = _bounds(problem, node)
    answer = linprog(
        np.concatenate([np.zeros(4 * n), np.ones(4 * n)]),
        A_eq=np.concatenate([matrix, np.eye(2 * n), -np.eye(2 * n)], axis=1),
        b_eq=problem.b / unit,
        bounds=[*zip(low, high, strict=True), *[(0.0, np.inf)] * (4 * n)],
        method="highs",
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    x, lacking = answer.x, answer.fun
    if answer.status != 0 or x is None or lacking is None:
        return None
    z = np.asarray(answer.eqlin.marginals)
    proved = float(z @ problem.b) / unit
    reduced = matrix.T @ z
    wrong = max(reduced[high > 0].max(initial=0.0), -reduced[low < 0].min(initial=0.0))
    if lacking > MARGIN and (proved <= 0.5 * MARGIN or wrong > 1e-9):
        return None
    return float(lacking), x[: 2 * n], x[2 * n : 4 * n]


def _bounds(problem: CoulombProblem, node: IntArray) -> tuple[Array, Array]:
    """Bounds of (h_n, h_t, c_1, c_2) in a node."""
    n, inf = problem.pairs, np.inf
    low, high = np.zeros((4, n)), np.full((4, n), inf)
    low[1] = -inf
    high[0, (node != UNDECIDED) & (node != OPEN)] = 0.0
    low[1, (node == STICK) | (node == SLIP_MINUS)] = 0.0
    high[1, (node == STICK) | (node == SLIP_PLUS)] = 0.0
    high[3, (node == SLIP_PLUS) & (problem.mu > 0)] = 0.0
    high[2, (node == SLIP_MINUS) & (problem.mu > 0)] = 0.0
    high[2:, node == OPEN] = 0.0
    return low.ravel(), high.ravel()


def _worst(problem: CoulombProblem, node: IntArray, h: Array, c: Array) -> tuple[int | None, IntArray]:
    """The pair that breaks the law worst (None where none does), and the state that each pair comes nearest to."""
    n = problem.pairs
    gap, slip, plus, minus = h[:n], h[n:], c[:n], c[n:]
    against = np.where(problem.mu == 0, 0.0, np.where(slip > 0, plus, minus))
    slipping = np.where(node == OPEN, 0.0, np.minimum(np.abs(slip), against))
    wrong = np.maximum(np.minimum(gap, plus + minus), slipping)
    nearest = np.where(np.abs(slip) <= 1e-9, STICK, np.where(slip < 0, SLIP_PLUS, SLIP_MINUS))
    nearest = np.where(plus + minus <= 1e-9, OPEN, np.where(problem.closed == UNDECIDED, nearest, problem.closed))
    decided = (node != UNDECIDED) & (node != CLOSED)
    nearest = np.where(decided, node, nearest).astype(np.int64)
    pair = int(np.where(decided, 0.0, wrong).argmax())
    return (None if decided[pair] or wrong[pair] <= 1e-9 else pair), nearest


def _branches(node: int, nearest: int, closed: int) -> list[int]:
    """The branches of a pair, the likeliest last (it is taken first)."""
    if node == UNDECIDED:
        return [CLOSED, OPEN] if nearest == OPEN else [OPEN, CLOSED]
    choices = (STICK, SLIP_PLUS, SLIP_MINUS) if closed == UNDECIDED else (closed,)
    return sorted(choices, key=lambda state: state == nearest)
