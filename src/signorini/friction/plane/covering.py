# SPDX-License-Identifier: BSD-3-Clause
"""The path method: from a far load whose solution is obvious to the load given, one state change at a time.

Follow ``F(y) = b + theta d``, F(y) = G h(y) - W r(y), from theta = infinity to 0. Two directions d have exactly one
solution at infinity, weights e > 0 on the normals::

    open    d = G (e, 0)     all pairs open by theta e: bring the bodies together from far; G must be regular
    press   d = -W (e, 0)    all pairs stick under theta e: press every pair together, then release

theta is a force, in the units of b, so that what is flat along a path is so in any units. Where the bound of friction
has further branches (adhesion, a shear limit), "press" lets them begin at ``1 + theta / scale`` times their forces, so
that at infinity every pair sticks whatever the bound; there the law itself depends on theta.

Where supports hold every body (G > 0) all motions of solutions are bounded by their loads, so that neither path can run
off at a finite theta nor return: in exact arithmetic and without ties, *either ends in a solution, for any friction*.
Floating bodies can follow "press" alone, and may end on a ray: bounded forces, a rigid motion without end. This is
Lemke's method in two unknowns a pair, not three multipliers, whose built-in ties it does not have.

A pivot crosses one wall ``l.(y, theta) = l_0``, and J changes by ``a l'``: the inverse X of ``[J, -d]`` with the row l
below is updated by rank-one products, and computed anew every 25 pivots. Initial gaps are perturbed by 1e-9 of the
scale against ties (not the loads, whose resultants must stay).

References
----------
Lemke (1965), Management Science 11; Eaves (1971), SIAM J. Appl. Math. 20 (piecewise linear paths); Klarbring (1986),
Ing.-Archiv 56 (Coulomb friction as an LCP).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.linalg import blas

from signorini.arrays import Array, IntArray
from signorini.friction.newton import admissible
from signorini.friction.plane.walls import beyond, columns, constant, jacobian, placed
from signorini.friction.problem import ContactProblem
from signorini.law.states import OPEN

Covering = Literal["open", "press"]

REFACTOR_PIVOTS = 25  # after which the inverse is computed anew: rank-one updates lose a digit or two in as many
RUNAWAY_SIZE = 1e8  # of the data: a point so far out is on a ray
FLAT_TOL = 1e-13  # of the largest slope along a path: below it a wall comes no nearer


@dataclass(frozen=True, kw_only=True)
class PathEnd:
    """Where a path ended.

    Attributes
    ----------
    end : ``"solution"`` (theta = 0), ``"ray"``, ``"budget spent"`` or ``"singular"``
    state : (n,) the last states
    y : (2, n) the last point
    pivots : walls crossed
    """

    end: Literal["solution", "ray", "budget spent", "singular"]
    state: IntArray
    y: Array
    pivots: int


@dataclass(frozen=True, kw_only=True)
class _Course:
    """What stays the same along a path."""

    G: Array
    W: Array
    b: Array
    d: Array
    problem: ContactProblem
    budget: int
    far: float
    loosened: float

    def walls(self, state: IntArray) -> tuple[Array, Array]:
        """(slots, 2, n) coefficients of the walls of every pair, and (slots, n) where they are: see `placed`."""
        return placed(state, self.problem.pieces, self.problem.law.closed)

    def y(self, point: Array) -> Array:
        """(2, n) The y of a point, (2 n + 1,), of the path: y row by row, then theta."""
        return point[:-1].reshape(2, -1)

    def room(self, walls: tuple[Array, Array], point: Array, here: float) -> Array:
        """(slots, n) Of a point (y, theta) to the walls (here = 1), or what a direction (here = 0) adds to it."""
        (wall, offset), (normal, tangential) = walls, self.y(point)
        room: Array = wall[:, 0] * normal + wall[:, 1] * tangential
        return room if self.problem.pieces.branches == 1 else room - (here + self.loosened * point[-1]) * offset

    def load(self, state: IntArray) -> tuple[Array, Array]:
        """``(b, d)`` of a state: without the friction that its slipping pairs carry at no pressure."""
        if self.problem.pieces.branches == 1:
            return self.b, self.d
        given = constant(self.G, self.W, self.problem.pieces, state)
        return self.b - given, self.d - self.loosened * given

    def jacobian(self, state: IntArray) -> Array:
        return jacobian(self.G, self.W, np.abs(self.problem.pieces.slope(state)), state)


def follow_covering(
    problem: ContactProblem, covering: Covering, *, budget: int, seed: int = 0, springs: float = 0.0
) -> PathEnd:
    """Follow one path to its end.

    Parameters
    ----------
    problem : the problem
    covering : ``"open"`` or ``"press"``, see above; "open" needs held bodies, or springs
    budget : most pivots
    seed : of the weights e (uniform in 1..2) and of the perturbation
    springs : stiffness of springs added to every pair, in units of the interface stiffness: G + springs W

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> ends = [follow_covering(problem, covering, budget=9) for covering in ("open", "press")]
    >>> [(end.end, end.state.tolist()) for end in ends]
    [('solution', [3]), ('solution', [3])]
    """
    n, W, unit = problem.pairs, np.asfortranarray(problem.W), problem.scale or 1.0
    G = np.eye(2 * n, order="F") - (1.0 - springs) * W
    rng = np.random.default_rng(seed)
    e = np.concatenate([rng.uniform(1.0, 2.0, n), np.zeros(n)])
    shift = rng.normal(size=2 * n) * 1e-9 * problem.scale
    shift[n:][problem.locked[0]] = 0.0
    open_start = covering == "open"
    course = _Course(
        G=G,
        W=W,
        b=problem.b + G @ shift,
        d=G @ e if open_start else -(W @ e),
        problem=problem,
        budget=budget,
        far=np.inf if springs else RUNAWAY_SIZE * problem.scale,
        loosened=0.0 if open_start else 1.0 / unit,
    )
    state = admissible(problem, np.full(n, OPEN) if open_start else None)
    return _walk(course, problem.pieces.coded(state, unit * e[:n]))


def _walk(course: _Course, state: IntArray) -> PathEnd:
    """Enter from infinity, then cross wall after wall."""
    problem, n = course.problem, course.problem.pairs
    try:
        ray = np.linalg.solve(course.jacobian(state), np.stack(course.load(state), axis=1))
    except np.linalg.LinAlgError:
        return PathEnd(end="singular", state=state, y=np.zeros((2, n)), pivots=0)
    walls = course.walls(state)
    pair, slot, theta = _entry(course, walls, np.concatenate([ray, [[0.0, 1.0]]]))
    point, pivots = np.append(ray[:, 0] + max(theta, 0.0) * ray[:, 1], max(theta, 0.0)), 0
    if theta <= 0:
        return PathEnd(end="solution", state=state, y=course.y(point), pivots=0)
    X = np.zeros((0, 0))
    while pivots < course.budget:
        before, at = state, walls[1][slot, pair]
        here = np.append(walls[0][slot, :, pair], -course.loosened * at)
        state = state.copy()
        state[pair], slot = beyond(int(before[pair]), slot, course.y(point)[1, pair], int(problem.law.closed[pair]))
        updated = None if pivots % REFACTOR_PIVOTS == 0 else _cross(course, X, before, state, pair, -here)
        fresh = _inverse(course, state, pair, -here) if updated is None else updated
        pivots += 1
        if fresh is None:
            return PathEnd(end="singular", state=state, y=course.y(point), pivots=pivots)
        X = fresh
        entry, way = X[:, :-1] @ course.load(state)[0] - at * X[:, -1], X[:, -1].copy()
        walls = course.walls(state)
        length, pair, slot = _next_wall(course, walls, entry, way, pair, slot)
        to_end = entry[-1] / -way[-1] if way[-1] < 0 else np.inf
        if not np.isfinite(min(length, to_end)):
            return PathEnd(end="ray", state=state, y=course.y(way), pivots=pivots)
        point = entry + min(length, to_end) * way
        if np.abs(point[:-1]).max() > course.far:
            return PathEnd(end="ray", state=state, y=course.y(point), pivots=pivots)
        if to_end <= length:
            return PathEnd(end="solution", state=state, y=course.y(point), pivots=pivots)
    return PathEnd(end="budget spent", state=state, y=course.y(point), pivots=pivots)


def _entry(course: _Course, walls: tuple[Array, Array], ray: Array) -> tuple[int, int, float]:
    """The first wall met coming from infinity along ``ray[:, 0] + theta ray[:, 1]``: its pair, slot and theta."""
    value, slope = course.room(walls, ray[:, 0], 1.0), course.room(walls, ray[:, 1], 0.0)
    met = np.divide(-value, slope, out=np.full_like(value, -np.inf), where=slope > FLAT_TOL * np.abs(ray[:, 1]).max())
    slot, pair = np.unravel_index(int(met.argmax()), met.shape)
    return int(pair), int(slot), float(met[slot, pair])


def _next_wall(
    course: _Course, walls: tuple[Array, Array], entry: Array, way: Array, pair: int, slot: int
) -> tuple[float, int, int]:
    """Length to the next wall from ``entry`` along ``way`` (never the one just crossed), its pair and slot."""
    value, slope = np.maximum(course.room(walls, entry, 1.0), 0.0), course.room(walls, way, 0.0)
    slope[slot, pair] = 0.0
    steep = slope < -FLAT_TOL * np.abs(way).max()
    lengths = np.divide(value, -slope, out=np.full_like(value, np.inf), where=steep)
    next_slot, next_pair = np.unravel_index(int(lengths.argmin()), lengths.shape)
    return float(lengths[next_slot, next_pair]), int(next_pair), int(next_slot)


def _inverse(course: _Course, state: IntArray, pair: int, wall: Array) -> Array | None:
    """Inverse of [J, -d] over l, or None where it is singular."""
    n = course.problem.pairs
    matrix = np.zeros((2 * n + 1, 2 * n + 1), order="F")
    matrix[:-1, :-1] = course.jacobian(state)
    matrix[:-1, -1] = -course.load(state)[1]
    matrix[-1, [pair, n + pair, 2 * n]] = wall
    try:
        return np.asfortranarray(np.linalg.inv(matrix))
    except np.linalg.LinAlgError:
        return None


def _cross(course: _Course, X: Array, before: IntArray, state: IntArray, pair: int, wall: Array) -> Array:
    """X after one pair crossed one wall, in place: the last row of its matrix becomes l, then J grows by a l'."""
    n, bound = course.problem.pairs, course.problem.pieces
    row = wall[0] * X[pair] + wall[1] * X[n + pair] + wall[2] * X[2 * n]
    pivot = row[-1]
    row[-1] -= 1.0
    X = blas.dger(-1.0 / pivot, X[:, -1].copy(), row, a=X, overwrite_a=1)
    new, old = (abs(float(bound.slope(states)[pair])) for states in (state, before))
    change = columns(course.G, course.W, new, int(state[pair]), pair)
    change -= columns(course.G, course.W, old, int(before[pair]), pair)
    X[:, -1] -= X[:, :-1] @ (change @ wall[:2])
    return np.asarray(X)
