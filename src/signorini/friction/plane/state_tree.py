# SPDX-License-Identifier: BSD-3-Clause
"""Proof that no state of the pairs is in equilibrium, or a state that is: a tree of linear programs.

Relax every pair to ``gap >= 0, p >= 0, |r_t| <= F(p)``, F the bound of friction, and minimise what equilibrium lacks.
Where that is positive, no state allowed there exists, and the multipliers z of the program prove it (Farkas):
``z.(G h - W r)`` stays below ``z.b`` for everything allowed. Where it is zero, branch the pair that breaks the law
worst: open or closed, then stick, slip + or slip -, on any branch of F.

Forces are combinations of the corners and edges of ``|r_t| <= F(p)``: in Coulomb's law of the edges (1, mu) and
(1, -mu) alone; every kink of F adds two corners, and the shares of all corners are at most 1 together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from signorini.arrays import Array, IntArray
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import PROGRAM_TOL
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

CLOSED = -2
"""Closed, and not yet decided whether it sticks or slips."""

MARGIN = 1e-7
"""Equilibrium lacking, relative to scale, above which a branch is refused; a certified solution is at 1e-10."""

_PRODUCT_ROUNDING = 1e-13
"""Of the products that it is summed from: what is rounding, of a column of the program that multipliers should not see
and of what they prove."""

_RUNAWAY_SIZE = 1e9
"""Of the data: how far one unknown may move the pairs. What multipliers see of an unbounded one counts with it."""

_PROGRAM_ROUNDING = 1e-7  # of those products, before multipliers are polished: ten times what the program is solved to


@dataclass(frozen=True, kw_only=True)
class TreeEnd:
    """What the tree found.

    Attributes
    ----------
    end : ``"solution"``, ``"impossible"`` (every leaf refused) or ``"budget spent"``
    state : (n,) states of the solution, None otherwise
    programs : linear programs solved
    margin : of "impossible": what equilibrium lacks at least in the leaf that comes nearest to it, of the size of the
        data, as the multipliers prove
    """

    end: Literal["solution", "impossible", "budget spent"]
    state: IntArray | None
    programs: int
    margin: float = 0.0


def search_states(problem: ContactProblem, *, budget: int = 2000) -> TreeEnd:
    """Search all states for equilibrium.

    Parameters
    ----------
    problem : the problem; a few dozen pairs at most
    budget : most linear programs

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> end = search_states(problem)
    >>> end.end, end.state.tolist()
    ('solution', [3])
    """
    n = problem.pairs
    program = _program(problem)
    waiting = [np.full(n, UNDECIDED)]
    margin = np.inf
    for programs in range(1, budget + 1):
        node = waiting.pop()
        answer = _relaxed(program, node)
        if answer is None:
            return TreeEnd(end="budget spent", state=None, programs=programs)
        lacking, proved, h, r = answer
        margin = min(margin, proved) if lacking > MARGIN else margin
        if lacking <= MARGIN:
            pair, complete = _worst(problem, node, h, r)
            if pair is None:
                return TreeEnd(end="solution", state=complete, programs=programs)
            for branch in _branches(problem, pair, int(node[pair]), int(complete[pair])):
                child = node.copy()
                child[pair] = branch
                waiting.append(child)
        if not waiting:
            return TreeEnd(end="impossible", state=None, programs=programs, margin=margin)
    return TreeEnd(end="budget spent", state=None, programs=budget)


@dataclass(frozen=True, kw_only=True)
class _Program:
    """The linear program of every node, but for its bounds.

    Unknown are h (2n), then two shares a pair for every branch of F, plus and minus in turn: of the kinks at which the
    branches begin (from the second on) and at last of the edges of the last branch; then, with kinks, what their shares
    leave of 1 (n).

    Attributes
    ----------
    matrix, rhs : equations, of equilibrium and of the shares
    summed : magnitude of what the entries of the matrix are summed from: I - W leaves but rounding of a rigid motion
    forces : (2n, size) the forces r of the unknowns
    lasts : (n,) number of the last branch of every pair
    """

    problem: ContactProblem
    matrix: Array
    summed: Array
    rhs: Array
    forces: Array
    lasts: IntArray

    @property
    def load(self) -> float:
        """The largest load over scale, at least 1."""
        return max(1.0, float(np.abs(self.rhs).max(initial=0.0)))


def _program(problem: ContactProblem) -> _Program:
    n, bound, unit = problem.pairs, problem.pieces, problem.scale or 1.0
    lasts = bound.branch_counts - 1
    edge = bound.slopes[lasts, np.arange(n)]
    length = np.hypot(1.0, edge)
    corners = [np.where(np.isfinite(p), p, 0.0) for p in bound.kinks[1:-1]]
    shares = [(p / unit, bound.at(p) / unit) for p in corners] + [(1.0 / length, edge / length)]
    blocks = [np.vstack([np.diag(p), sign * np.diag(F)]) for p, F in shares for sign in (1.0, -1.0)]
    forces = np.concatenate([np.zeros((2 * n, 2 * n)), *blocks], axis=1)
    matrix = -problem.W @ forces
    matrix[:, : 2 * n] = np.eye(2 * n) - problem.W
    summed = np.abs(problem.W) @ np.abs(forces)
    summed[:, : 2 * n] = np.eye(2 * n) + np.abs(problem.W)
    rhs = problem.b / unit
    if corners:
        whole = np.concatenate(
            [np.zeros((n, 2 * n)), *[np.eye(n)] * (2 * len(corners)), np.zeros((n, 2 * n)), np.eye(n)], axis=1
        )
        matrix, summed = (np.vstack([np.pad(part, ((0, 0), (0, n))), whole]) for part in (matrix, summed))
        rhs, forces = np.concatenate([rhs, np.ones(n)]), np.pad(forces, ((0, 0), (0, n)))
    return _Program(problem=problem, matrix=matrix, summed=summed, rhs=rhs, forces=forces, lasts=lasts)


def _relaxed(program: _Program, node: IntArray) -> tuple[float, float, Array, Array] | None:
    """Least misfit (sum of its entries over scale) of a node, what its multipliers prove of it, and h, r (2, n) there.

    None where they prove too little.
    """
    n, matrix = program.problem.pairs, program.matrix
    low, high = _bounds(program, node)
    rows, size = matrix.shape
    slack = np.eye(rows, 2 * n)
    answer = scipy.optimize.linprog(
        np.concatenate([np.zeros(size), np.ones(4 * n)]),
        A_eq=np.concatenate([matrix, slack, -slack], axis=1),
        b_eq=program.rhs,
        bounds=[*zip(low, high, strict=True), *[(0.0, np.inf)] * (4 * n)],
        method="highs",
        options=PROGRAM_TOL,
    )
    x, lacking = answer.x, answer.fun
    if answer.status != 0 or x is None or lacking is None:
        return None
    proved = _proved(program, np.asarray(answer.eqlin.marginals), low, high)
    if lacking > MARGIN and proved <= 0.5 * MARGIN * program.load:
        return None
    return float(lacking), proved, x[: 2 * n].reshape(2, n), (program.forces @ x[:size]).reshape(2, n)


def _proved(program: _Program, z: Array, low: Array, high: Array) -> float:
    """The misfit that multipliers z prove whatever is between the bounds; nothing where it is not positive.

    Polished first, so that columns that they should not see, but for the accuracy of the program, vanish to rounding.
    """
    matrix = program.matrix
    size = np.linalg.norm(program.summed, axis=0)
    seen = matrix.T @ z
    unseen = ~np.isfinite(np.where(seen > 0, high, low)) & (np.abs(seen) <= _PROGRAM_ROUNDING * size)
    z = z - np.linalg.lstsq(matrix[:, unseen].T, seen[unseen], rcond=_PROGRAM_ROUNDING)[0]
    reduced = matrix.T @ z
    reduced[np.abs(reduced) <= _PRODUCT_ROUNDING * (program.summed.T @ np.abs(z))] = 0.0
    most = np.where(reduced > 0, high, low)
    endless = np.isinf(most) & (reduced != 0.0)
    most = np.where(endless | (reduced == 0.0), 0.0, most)
    far = _RUNAWAY_SIZE * program.load * float((np.abs(reduced) / size)[endless].max(initial=0.0))
    cancelled = float(np.abs(z) @ np.abs(program.rhs) + np.abs(reduced) @ np.abs(most))
    proved = float(z @ program.rhs) - float(reduced @ most) - far - _PRODUCT_ROUNDING * cancelled
    return proved / max(1.0, float(np.abs(z).max(initial=0.0)))


def _bounds(program: _Program, node: IntArray) -> tuple[Array, Array]:
    """Bounds of the unknowns in a node."""
    problem = program.problem
    n, branches = problem.pairs, problem.pieces.branches
    low, high = np.zeros((2 + 2 * branches, n)), np.full((2 + 2 * branches, n), np.inf)
    rest = np.ones(n if branches > 1 else 0)
    slips, minus = node >= SLIP_PLUS, node % 2
    low[1] = -np.inf
    high[0, (node == STICK) | (node == CLOSED) | slips] = 0.0
    low[1, (node == STICK) | (slips & (minus == 1))] = 0.0
    high[1, (node == STICK) | (slips & (minus == 0))] = 0.0
    high[2:, node == OPEN] = 0.0
    for i in np.flatnonzero(slips & (problem.mu > 0)):
        branch = (int(node[i]) - SLIP_PLUS) // 2
        behind = branch if branch < program.lasts[i] else branches - 1
        others = np.ones(2 * branches, dtype=np.bool_)
        others[2 * behind + minus[i]] = False
        if branch:  # between two corners, or behind the last: nothing of the one at zero
            others[2 * (branch - 1) + minus[i]] = False
            rest[i] = 0.0
        high[2:, i][others] = 0.0
    return np.concatenate([low.ravel(), np.zeros_like(rest)]), np.concatenate([high.ravel(), rest])


def _worst(problem: ContactProblem, node: IntArray, h: Array, r: Array) -> tuple[int | None, IntArray]:
    """The pair that breaks the law worst (None where none does), and the state that each pair comes nearest to."""
    unit, bound, (gap, slip), (p, friction) = problem.scale or 1.0, problem.pieces, h, r
    pressed = np.hypot(p, friction)
    spare = (bound.at(unit * p) / unit + np.sign(slip) * friction) / np.hypot(1.0, problem.mu)
    against = np.where((problem.mu == 0) | (slip == 0), 0.0, np.maximum(spare, 0.0))
    slipping = np.where(node == OPEN, 0.0, np.minimum(np.abs(slip), against))
    wrong = np.maximum(np.minimum(gap, pressed), slipping)
    nearest = np.where(np.abs(slip) <= 1e-9, STICK, np.where(slip < 0, SLIP_PLUS, SLIP_MINUS))
    nearest = np.where(problem.law.closed == UNDECIDED, nearest, problem.law.closed)
    nearest = bound.coded(np.where(pressed <= 1e-9, OPEN, nearest), unit * p)
    decided = (node != UNDECIDED) & (node != CLOSED)
    nearest = np.where(decided, node, nearest).astype(np.int64)
    pair = int(np.where(decided, 0.0, wrong).argmax())
    return (None if decided[pair] or wrong[pair] <= 1e-9 else pair), nearest


def _branches(problem: ContactProblem, pair: int, node: int, nearest: int) -> list[int]:
    """The branches of a pair, the likeliest last (it is taken first)."""
    if node == UNDECIDED:
        return [CLOSED, OPEN] if nearest == OPEN else [OPEN, CLOSED]
    return sorted(problem.closed_states(pair), key=lambda state: state == nearest)
