# SPDX-License-Identifier: BSD-3-Clause
"""From which load on contact cannot hold floating bodies, whatever its pairs do: a linear programme of a few rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from signorini.arrays import Array, BoolArray
from signorini.attempt import Spent
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import (
    GAIN,
    ITERATION_LIMIT,
    PROGRAM_TOL,
    STRONGEST_FORCES,
    strongest_edges,
    unit_edges,
    work_of,
)
from signorini.law.section import FrictionSection

MAX_ROUNDS = 60
"""Linear programmes, each with the edges of the cones that work most against the answer of the last."""

MAX_PIVOTS = 20_000
"""Of one linear programme, which takes some hundreds."""

_DIRECTIONS = 8  # of friction on every pair that the first linear programme knows
_TILT_TOL = 1e-3  # of unit motions: what sliding may lift or press, by normals that are not quite alike
_RESISTED_WORK = 1e-2  # of the work of the loads that grow: what the largest forces may do by a motion's rounding


@dataclass(frozen=True, kw_only=True)
class Overload:
    """The load from which on contact cannot hold floating bodies, whatever the state of its pairs.

    Attributes
    ----------
    factor : part of the way between two loads, to the last digit
    motion : (d n,) rigid motion that proves it, largest entry 1
    proved : part of the way beyond which none is in equilibrium even under forces of 1e6 times the loads, which work
        against the motion by its rounding; not less than the factor
    share : of the load at the end of the way on rigid motions what no force takes, at least; not positive where nothing
        is proved of it
    """

    factor: float
    motion: Array
    proved: float
    share: float


def overload(
    problem: ContactProblem, held: Array, b_end: Array, *, near: BoolArray | None = None
) -> Overload | Spent | None:
    """Where on the straight way from the problem's b to ``b_end`` rigid equilibrium ends; None where it does not.

    The largest s with forces r in the friction cones and ``R'(r + b + s (b_end - b)) = 0`` is a linear programme in s
    and the edges of the cones, of as many rows as there are rigid motions. Each round adds the edges that work most
    against the motion a that is dual to it. Once none does, ``r . R a >= 0`` for all admissible forces while the work
    of the loads along a vanishes at s and grows beyond: a proof for every load beyond, whatever the pairs do.

    Parameters
    ----------
    problem : at a load that is in equilibrium
    held : (d, n) its forces, from which the first programme has a solution
    b_end : (d n,) load at the end of the way
    near : (n,) pairs that may close; all where not given

    Returns
    -------
    Overload, or None: also where nothing is proved, as for pairs in Tresca's law, whose friction knows no cone; that
        the budget is spent, where it is

    Examples
    --------
    A body of one point, pressed by 1 and pulled by 1.2, slides at a pull of 0.3:

    >>> problem = ContactProblem.of(
    ...     W=np.eye(3), b=np.array([-1.0, 0.0, 0.0]), friction=[0.3], motions=np.eye(3), scale=1.0
    ... )
    >>> found = overload(problem, np.array([[1.0], [0.0], [0.0]]), np.array([-1.0, 1.2, 0.0]))
    >>> round(found.factor, 9), found.motion.round(9).tolist()
    (0.25, [0.3, 1.0, 0.0])

    Of the pull of 1.2 at the end, with the pressure 1, this leaves 0.9 along (0.3, 1):

    >>> round(float(found.share * np.hypot(1.0, 1.2) * np.hypot(0.3, 1.0)), 9), found.proved - found.factor < 1e-9
    (0.9, True)
    """
    R = problem.image.R
    if not R.shape[1] or problem.bounded.any():
        return None
    load, growth = R.T @ problem.b, R.T @ (b_end - problem.b)
    if np.abs(growth).max() <= GAIN * (problem.scale or 1.0):
        return None
    cones = FrictionSection(axes=problem.half_axes, sides=problem.section.sides)
    return unheld(R, cones, held, load, growth, near=near)


def unheld(
    R: Array, cones: FrictionSection, held: Array, load: Array, growth: Array, *, near: BoolArray | None = None
) -> Overload | Spent | None:
    """Where on a way rigid equilibrium ends, of what pairs see of rigid motions alone, see `overload`; None where not.

    Parameters
    ----------
    R : (d n, k) orthonormal motions of the pairs
    cones : sections of the friction cones at a normal force of 1, finite
    held : (d, n) forces in equilibrium at the beginning of the way
    load, growth : (k,) work of the loads along each motion there, and what the way adds to it
    near : (n,) pairs that may close; all where not given

    Examples
    --------
    A point of the plane, pressed by 1 and pulled by 1.2:

    >>> floor = FrictionSection(axes=np.array([[0.3]]), sides=np.array([0]))
    >>> found = unheld(np.eye(2), floor, np.array([[1.0], [0.0]]), np.array([-1.0, 0.0]), np.array([0.0, 1.2]))
    >>> round(found.factor, 9), found.motion.round(9).tolist()
    (0.25, [0.3, 1.0])
    """
    m, n = cones.axes.shape
    may = np.ones(n, dtype=np.bool_) if near is None else near
    unit = max(float(np.abs(load).max()), float(np.abs(growth).max()))
    rows, sizes = R.reshape(m + 1, n, -1), np.linalg.norm(held, axis=0)
    presses = sizes > 0.0
    edges = [work_of(held[:, presses] / sizes[presses], rows[:, presses])]
    turns = 2.0 * np.pi / _DIRECTIONS * np.arange(_DIRECTIONS) if m == 2 else np.array([0.0, np.pi])
    ways = np.array([np.cos(turns), np.sin(turns)])[:m]
    for share in (np.zeros((m, n)), *(cones.farthest(np.tile(way[:, None], n)) for way in ways.T)):
        edges.append(work_of(unit_edges(share)[:, may], rows[:, may]))
    for _ in range(MAX_ROUNDS):
        columns = np.concatenate(edges).T
        answer = scipy.optimize.linprog(
            np.append(-1.0, np.zeros(columns.shape[1])),
            A_eq=np.column_stack([growth / unit, columns]),
            b_eq=-load / unit,
            bounds=[(0.0, 1.0)] + [(0.0, None)] * columns.shape[1],
            method="highs",
            options=PROGRAM_TOL | {"maxiter": MAX_PIVOTS},
        )
        if answer.status == ITERATION_LIMIT:
            return Spent(most=MAX_PIVOTS, of="pivots of a linear programme about the load that contact can hold")
        if answer.status != 0 or answer.x[0] >= 1.0 - GAIN:
            return None
        a = -np.asarray(answer.eqlin.marginals)
        rho = R @ a
        strongest = work_of(strongest_edges(cones, rho), rows)
        works = np.where(may, strongest @ a, 0.0)
        resisted = STRONGEST_FORCES * works < -0.5 * _RESISTED_WORK  # the work of the loads that grow is 1
        if not resisted.any():
            return _proved(float(answer.x[0]), a, rho, load / unit, growth / unit, float(works.min(initial=0.0)))
        edges.append(strongest[resisted])
    return Spent(most=MAX_ROUNDS, of="linear programmes about the load that contact can hold")


def _proved(factor: float, a: Array, rho: Array, load: Array, growth: Array, works: float) -> Overload | None:
    """What a dual motion a, of rows rho, proves: ``a.(load + s growth)`` beyond what the largest forces do against it.

    Parameters
    ----------
    factor : where the first programme ends
    works : the least work of forces of size 1 along the motion, below 0 by rounding
    """
    left, grows = float(a @ (load + factor * growth)) + STRONGEST_FORCES * works, float(a @ growth)
    if grows <= 0.5 or left <= -_RESISTED_WORK:
        return None
    end = load + growth
    share = (left + (1.0 - factor) * grows) / (float(np.linalg.norm(a) * np.linalg.norm(end)) or 1.0)
    return Overload(factor=factor, motion=rho / np.abs(rho).max(), proved=factor + max(0.0, -left / grows), share=share)


def along_contact(R: Array, motion: Array, pressed: BoolArray) -> Array | None:
    """What of a rigid motion neither presses nor lifts pressed pairs, largest entry 1; None where that is nothing.

    A motion that proves an overload lifts as it slides; friction of Coulomb's law does not.

    Parameters
    ----------
    R : (d n, k) orthonormal motions of the pairs
    motion : (d n,) one of their combinations
    pressed : (n,) pairs that carry load
    """
    n = len(pressed)
    _, sizes, ways = np.linalg.svd(R[:n][pressed], full_matrices=True)
    null = ways[np.count_nonzero(sizes > _TILT_TOL) :]
    rho = R @ (null.T @ (null @ (R.T @ motion)))
    size = float(np.abs(rho).max(initial=0.0))
    return rho / size if size > _TILT_TOL * float(np.abs(motion).max(initial=0.0)) else None
