# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb's law of a pair in one unknown, ``y = r - h``, three numbers a pair: see `friction.law` for the plane.

    p = max(y_n, 0)      gap  = max(-y_n, 0)
    r_t = projection of y_t on the section of the friction cone at p      slip = r_t - y_t

Every y obeys the law; what is left to solve is equilibrium.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.friction.spatial.problem import SpatialProblem
from signorini.friction.spatial.section import project
from signorini.law.states import OPEN as OPEN
from signorini.law.states import SLIP_PLUS
from signorini.law.states import STICK as STICK

SLIP = SLIP_PLUS
"""Closed and slipping; in space the direction is that of the tangential force."""

_FAR = 1e12


@dataclass(frozen=True, kw_only=True)
class SpatialTangent:
    """The law near a y, to first order: what every pair leaves unknown (see `section` for the notation).

    Attributes
    ----------
    closed : (n,) pairs that press
    left : (n,) tangential directions whose force is unknown: 2 where it sticks, 1 or 0 where it slips
    share : (n, 2) tangential force per normal force, e; zero where it sticks
    fixed : (n, 2) tangential force that does not depend on the normal force, where friction is bounded so
    tau : (n, 2) the unknown direction where one is left
    kappa : (n,) slip per force along it
    """

    closed: BoolArray
    left: IntArray
    share: Array
    fixed: Array
    tau: Array
    kappa: Array

    def same_states(self, other: SpatialTangent) -> BoolArray:
        """(n,) Pairs that are open, stick or slip in both."""
        alike = (self.closed == other.closed) & (self.left == other.left)
        return np.asarray(alike, dtype=np.bool_)


def split(problem: SpatialProblem, y: Array) -> tuple[Array, Array]:
    """Motion h = (gap, slip increment) and force r of y, each (3n,), with ``y = r - h``.

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> h, r = split(problem, np.array([2.0, 3.0, 4.0]))
    >>> h.round(12).tolist(), r.round(12).tolist()
    ([0.0, -2.4, -3.2], [2.0, 0.6, 0.8])
    """
    r = _projected(problem, y)[0]
    return r - y, r


def tangent(problem: SpatialProblem, y: Array) -> SpatialTangent:
    """The law near y, to first order."""
    n = problem.pairs
    r, left, tau, kappa = _projected(problem, y)
    closed = y[:n] > 0
    force = r[n:].reshape(2, n).T
    slips = (left < 2)[:, None]
    state = problem.bound.coded(np.full(n, SLIP), y[:n])
    size = np.where(left < 2, problem.bound.at(np.maximum(y[:n], 0.0)), 1.0)[:, None]
    unit = np.divide(force, size, out=np.zeros_like(force), where=size > 0)
    return SpatialTangent(
        closed=closed,
        left=left,
        share=np.where(slips & closed[:, None], unit * problem.bound.slope(state)[:, None], 0.0),
        fixed=np.where(slips, unit * problem.bound.start(state)[:, None], 0.0),
        tau=tau,
        kappa=kappa,
    )


def sticking(problem: SpatialProblem) -> SpatialTangent:
    """Every pair closed and sticking, where its friction and its supports let it."""
    n = problem.pairs
    y = np.concatenate([np.ones(n), np.zeros(2 * n)])
    return tangent(problem, y)


def states(problem: SpatialProblem, y: Array) -> IntArray:
    """(n,) OPEN, STICK or SLIP; a pair without friction slips wherever it is closed."""
    n = problem.pairs
    h, _ = split(problem, y)
    still = ~h[n:].reshape(2, n).any(axis=0) & (problem.mu > 0).any(axis=1)
    return np.where(y[:n] <= 0, OPEN, np.where(still, STICK, SLIP)).astype(np.int64)


def _projected(problem: SpatialProblem, y: Array) -> tuple[Array, IntArray, Array, Array]:
    """`project`, except that pairs whose supports drag them slip in the direction known beforehand."""
    n, dragged = problem.pairs, np.flatnonzero(problem.dragged)
    size = problem.bound.at(np.maximum(y[:n], 0.0))
    if not len(dragged):
        return project(y, problem.axes, size, problem.sides)
    along = np.array(y)
    b = problem.b[n:].reshape(2, n)[:, dragged]
    reach = _FAR * np.maximum(size[dragged], problem.mu[dragged].max(axis=1)) / np.hypot(*b)
    along[n + dragged], along[2 * n + dragged] = -reach * b
    r, left, tau, kappa = project(along, problem.axes, size, problem.sides)
    left[dragged] = 0
    return r, left, tau, kappa
