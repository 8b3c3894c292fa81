# SPDX-License-Identifier: BSD-3-Clause
"""The system of a linear law by GMRES: of many closed pairs the cheaper way, from where the last iterate ended.

The system is that of `friction.linear` as posed, in the same unknowns, but it is not formed. The preconditioner is the
interface where every pair sticks,

    [ A   R ]^-1     [ G   R ]
    [ R'  0 ]     =  [ R'  0 ]   nearly,    G = (A + alpha I)^-1 - R R' / alpha,    alpha a little of A,

restricted to what is unknown: half a dozen products do what a factorisation would, at the cost of a few per cent of
one. What is lacking is measured in double precision; the products of an iteration that makes it a few digits less need
single precision alone, and read half as much.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.condense.operator import symmetric_product
from signorini.friction.linear import Balance, Unknowns
from signorini.friction.problem import ContactProblem
from signorini.law.pair import Tangent
from signorini.linalg.krylov import gmres

ITERATED_UNKNOWNS = 500
"""Unknowns from which a factorisation costs more."""

_DATA_ROUNDING = 1e-14  # of the size of the data: less is rounding
_OVERSHOOT = 10.0  # times what was asked for: products in single precision are trusted where they leave no more,
_SINGLE_ROUNDING = 1e-12  # or where it is this small beside the data
_STIFF_SLIP = 1.0  # slip per force, scaled, from which compliance counts little beside it


def iterate(problem: ContactProblem, law: Tangent, r: Array, a: Array, *, forward: float) -> Balance | None:
    """Forces, rigid motion and motions that nearly balance under a linear law; None where the iteration gets to none.

    Parameters
    ----------
    problem : the problem as posed
    law : of every pair, linear
    r, a : (d, n) and (k,) where the last iterate ended
    forward : of what is lacking there, what may be left

    Examples
    --------
    A pair that sticks under a pressure and a drag:

    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> r, _, h = iterate(problem, problem.law.sticking, np.zeros((2, 1)), np.zeros(0), forward=1e-6)
    >>> r.round(5).tolist()
    [[2.0], [-0.4]]
    """
    unknowns, c, soft, R = Unknowns(law), problem.free_motion(), problem.image.single, problem.image.R
    size, along = unknowns.size, len(unknowns.rows)
    fixed, kappa = np.concatenate([np.zeros((1, problem.pairs)), law.fixed]), law.kappa[unknowns.one]
    resisting = np.concatenate([np.zeros(along), kappa * unknowns.soft])
    apart = along + np.flatnonzero(kappa > _STIFF_SLIP)

    def left(x: Array, force: Array, motion: Array) -> Array:
        return np.concatenate([unknowns.seen(problem.by_pair(motion)) + resisting * x[:size], R.T @ force])

    def balance(x: Array) -> tuple[Array, Array, Array]:
        force = unknowns.forces(x[:size]) + fixed
        motion = symmetric_product(problem.image.A, force.ravel()) + c + R @ x[size:]
        return force, problem.by_pair(motion), -left(x, force.ravel() + problem.b, motion)

    def product(x: Array) -> Array:
        force = unknowns.forces(x[:size]).ravel()
        return left(x, force, soft.product(force) + R @ x[size:])

    def precondition(y: Array) -> Array:
        acting = y[:size].copy()
        acting[apart] = 0.0
        motion = unknowns.seen_by(acting).ravel()
        force = soft.solve(motion) + R @ (y[size:] - R.T @ motion / soft.softness)
        found = unknowns.seen(problem.by_pair(force))
        found[apart] = y[apart]
        return np.concatenate([found, R.T @ motion])

    start = np.concatenate([unknowns.coordinates(r - fixed), a])
    error = balance(start)[2]
    least, aim = problem.scale * np.sqrt(r.size + len(a)), forward * float(np.linalg.norm(error))
    x = start + gmres(product, precondition, error, max(aim, _DATA_ROUNDING * least))
    force, motion, error = balance(x)
    if not np.linalg.norm(error) <= max(_OVERSHOOT * aim, _SINGLE_ROUNDING * least):
        return None
    return force, x[size:], unknowns.prescribed(motion)
