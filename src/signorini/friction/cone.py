# SPDX-License-Identifier: BSD-3-Clause
"""Equilibrium with every pair's state given: one regular linear system in the forces of the closed pairs.

In the force form (see `interface`) a state leaves these unknowns: the normal force p of every closed pair, the
tangential force of those that stick, and the rigid motion a. Slipping pairs carry ``r_t = s mu p``, s = +-1::

    [ A_nn + A_nt s mu   A_ns   R_n ] [ p   ]     [ c_n ]      gap = 0
    [ A_sn + A_st s mu   A_ss   R_s ] [ r_s ] = - [ c_s ]      slip = 0 where it sticks
    [ R_n' + R_t' s mu   R_s'   0   ] [ a   ]     [ R'b ]      resultants

On another branch of their bound (see `law.bound`) mu is its slope, and what does not depend on p, ``s
start``, is a load like any other. At most 2 n_closed + k unknowns, however many candidates are open.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack, lstsq

from signorini.arrays import Array, IntArray
from signorini.friction.krylov import Unknowns, iterate
from signorini.friction.law import OPEN, STICK, split
from signorini.friction.problem import CoulombProblem

_FORWARD = 1e-3  # of what the last states lack in the next ones

SINGULAR = 1e-13
"""Reciprocal condition below which a cone's system counts as singular."""

REFINE = 1e-13
"""Misfit, relative to scale, above which a solution is refined."""


@dataclass(frozen=True, kw_only=True)
class ConeSystem:
    """The factorised system of one state; build it with `cone_system`.

    Attributes
    ----------
    index : sign of the determinant relative to that of all pairs sticking; 0 where singular
    """

    problem: CoulombProblem
    state: IntArray
    lu: Array
    pivots: IntArray
    index: int

    def solve(self, near: Array) -> Array | None:
        """The y = r - h that is in equilibrium in this state; where singular, the one of least change from ``near``.

        Parameters
        ----------
        near : (2n,) a y, used only where the system is singular

        Returns
        -------
        y : (2n,), or None where nothing is in equilibrium in this state
        """
        least = None if self.index else _least_change(self.problem, self.state, near)
        if not self.index and least is None:
            return None
        b, given = self.problem.b, _given(self.problem, self.state)
        h, r = self._expand(self._unknowns(b, given), b, given) if least is None else least
        if least is None:
            for _ in range(2):
                error = self.problem.misfit(h, r)
                if np.abs(error).max(initial=0.0) <= REFINE * self.problem.scale:
                    break
                dh, dr = self._expand(self._unknowns(error, None), error, None)
                h, r = h + dh, r + dr
        return r - h

    def _unknowns(self, b: Array, given: Array | None) -> Array:
        rhs = _right_hand_side(self.problem, self.state, b, given)
        if not len(rhs):
            return rhs
        x, _ = lapack.dgetrs(self.lu, self.pivots, rhs)
        return np.asarray(x, dtype=np.float64)

    def _expand(self, x: Array, b: Array, given: Array | None) -> tuple[Array, Array]:
        return _expand(self.problem, self.state, x, b, given)


def cone_system(problem: CoulombProblem, state: IntArray) -> ConeSystem:
    """Set up and factorise the system of one state.

    Parameters
    ----------
    problem : the problem
    state : (n,) OPEN, STICK, SLIP_PLUS or SLIP_MINUS, or the code of slip on another branch

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> cone_system(problem, np.array([STICK])).solve(near=np.zeros(2)).round(12).tolist()
    [2.0, -0.4]
    """
    matrix = _matrix(problem, state)
    size = len(matrix)
    k = problem.motions.shape[1]
    if size == 0:
        return ConeSystem(problem=problem, state=state, lu=matrix, pivots=np.zeros(0, dtype=np.int64), index=1)
    norm = float(np.abs(matrix).sum(axis=0).max())
    lu, pivots, failed = lapack.dgetrf(matrix, overwrite_a=1)
    rcond = 0.0 if failed else float(lapack.dgecon(lu, norm)[0])
    odd = np.count_nonzero(pivots != np.arange(size)) + np.count_nonzero(np.diag(lu) < 0) + k
    index = 0 if rcond < SINGULAR else -1 if odd % 2 else 1
    return ConeSystem(problem=problem, state=state, lu=lu, pivots=pivots, index=index)


def balanced(problem: CoulombProblem, state: IntArray, near: Array) -> Array | None:
    """The y = r - h that is nearly in equilibrium in a state, by iteration; None where that does not get there.

    Parameters
    ----------
    state : (n,) see `cone_system`
    near : (2n,) a y to begin with

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> balanced(problem, np.array([STICK]), np.zeros(2)).round(3).tolist()
    [2.0, -0.4]
    """
    n, stick, slips = problem.pairs, state == STICK, state > STICK
    force, motion = np.zeros((2, 2, n)), np.zeros((2, 2, n))
    force[0, 0], motion[0, 0] = 1.0, state != OPEN
    force[1, 0, slips] = problem.bound.slope(state)[slips]
    force[1, 1] = motion[1, 1] = stick
    given, none = _given(problem, state), np.zeros(2 * n)
    unknown = Unknowns(force=force, motion=motion, fixed=none if given is None else given, resisting=none, apart=none)
    h, r = split(near, problem.bound)
    found = iterate(problem, unknown, problem.free_motion(problem.b), r, problem.image.R.T @ h, forward=_FORWARD)
    if found is None:
        return None
    r, _, h = found
    h[:n][state != OPEN] = 0.0
    h[n:][stick] = 0.0
    return r - h


def _unknown_rows(state: IntArray) -> tuple[IntArray, IntArray]:
    return np.flatnonzero(state != OPEN), np.flatnonzero(state == STICK)


def _given(problem: CoulombProblem, state: IntArray) -> Array | None:
    """(2n,) Forces that the state knows; None where there are none, as in Coulomb's law."""
    if problem.bound.branches == 1:
        return None
    return np.concatenate([np.zeros(problem.pairs), problem.bound.start(state)])


def _matrix(problem: CoulombProblem, state: IntArray) -> Array:
    A, R, n = problem.image.A, problem.image.R, problem.pairs
    closed, stick = _unknown_rows(state)
    rows = np.concatenate([closed, n + stick])
    slips = np.flatnonzero(state[closed] > STICK)
    slope = problem.bound.slope(state)[closed[slips]]
    size, k = len(rows), R.shape[1]
    matrix = np.zeros((size + k, size + k), order="F")
    matrix[:size, :size] = A[np.ix_(rows, rows)]
    matrix[:size, slips] += A[np.ix_(rows, n + closed[slips])] * slope
    matrix[:size, size:] = R[rows]
    matrix[size:, :size] = R[rows].T
    matrix[size:, slips] += R[n + closed[slips]].T * slope
    return matrix


def _right_hand_side(problem: CoulombProblem, state: IntArray, b: Array, given: Array | None) -> Array:
    closed, stick = _unknown_rows(state)
    c, resultants = problem.free_motion(b), problem.image.R.T @ b
    if given is not None:
        c, resultants = c + problem.image.A @ given, resultants + problem.image.R.T @ given
    return -np.concatenate([c[closed], c[problem.pairs + stick], resultants])


def _expand(problem: CoulombProblem, state: IntArray, x: Array, b: Array, given: Array | None) -> tuple[Array, Array]:
    """Motion and force of every pair from the unknowns of the system."""
    n, m = problem.pairs, problem.image
    closed, stick = _unknown_rows(state)
    size = len(closed) + len(stick)
    r = np.zeros(2 * n)
    r[closed] = x[: len(closed)]
    slope = problem.bound.slope(state)
    r[n:] = np.where(slope == 0, 0.0, slope * r[:n])
    r[n + stick] = x[len(closed) : size]
    if given is not None:
        r += given
    acting = np.flatnonzero(r)
    h = r[acting] @ m.A[acting] + problem.free_motion(b) + m.R @ x[size:]
    h[closed] = 0.0
    h[n + stick] = 0.0
    return h, r


def _least_change(problem: CoulombProblem, state: IntArray, near: Array) -> tuple[Array, Array] | None:
    """The equilibrium nearest to ``near`` of a state that leaves a motion or a force undetermined."""
    closed, stick = _unknown_rows(state)
    h, r = split(near, problem.bound)
    x = np.concatenate([r[closed], r[problem.pairs + stick], problem.image.R.T @ h])
    matrix, b, given = _matrix(problem, state), problem.b, _given(problem, state)
    rhs = _right_hand_side(problem, state, b, given)
    if not len(rhs):
        return None
    for _ in range(2):
        x = x + lstsq(matrix, rhs - matrix @ x, cond=1e-12, lapack_driver="gelsy")[0]
    missing = np.abs(rhs - matrix @ x).max(initial=0.0)
    if missing > 1e-11 * problem.scale:
        return None
    return _expand(problem, state, x, b, given)
