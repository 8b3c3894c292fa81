# SPDX-License-Identifier: BSD-3-Clause
"""The system of a linear law by GMRES: of many closed pairs the cheaper way, from where the last iterate ended.

Every pair has d unknowns x, those that the law does not leave are 0: forces are ``r = Z x + r_f``, and of the motions
``h = A r + c + R a`` the law prescribes ``Y'h = -K x``, K diagonal::

    [ Y'A Z + K   Y'R ] [ x ]     [ Y'(A r_f + c) ]
    [ R'Z          0  ] [ a ] = - [ R'(r_f + b)   ]

The preconditioner is the interface where every pair sticks,

    [ A   R ]^-1     [ G   R ]
    [ R'  0 ]     =  [ R'  0 ]   nearly,    G = (A + alpha I)^-1 - R R' / alpha,    alpha a little of A,

restricted to what is unknown: half a dozen products do what a factorisation would, at the cost of a few per cent of
one. What is lacking is measured in double precision; the products of an iteration that makes it a few digits less need
single precision alone, and read half as much.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array
from signorini.condense.operator import softened, symmetric_product
from signorini.friction.problem import ContactProblem
from signorini.law.pair import Tangent
from signorini.linalg.krylov import gmres

ITERATED_UNKNOWNS = 500
"""Unknowns from which a factorisation costs more."""

_DATA_ROUNDING = 1e-14  # of the size of the data: less is rounding
_OVERSHOOT = 10.0  # times what was asked for: products in single precision are trusted where they leave no more,
_SINGLE_ROUNDING = 1e-12  # or where it is this small beside the data
_STIFF_SLIP = 1.0  # slip per force, scaled, from which compliance counts little beside it


@dataclass(frozen=True, kw_only=True, eq=False)
class PairBlocks:
    """What a linear law leaves unknown of n pairs with d rows each, as a d x d matrix of every pair.

    Attributes
    ----------
    force : (d, d, n) Z, force of every pair per unknown; the first unknown is its normal force, the others are forces
        along directions at right angles to each other
    motion : (d, d, n) Y', what the law prescribes of its motion, per motion
    fixed : (d, n) r_f, forces that are known
    resisting : (d, n) K
    apart : (d, n) 1 where K is so large that compliance counts little beside it, otherwise 0
    """

    force: Array
    motion: Array
    fixed: Array
    resisting: Array
    apart: Array

    @classmethod
    def of(cls, law: Tangent) -> PairBlocks:
        """The blocks of a linear law."""
        d, n = 1 + len(law.share), len(law.left)
        stick, one = law.left == d - 1, (law.left == 1) & (d == 3)
        force, motion = np.zeros((d, d, n)), np.zeros((d, d, n))
        resisting, apart = np.zeros((d, n)), np.zeros((d, n))
        soft = 1.0 + law.kappa  # across a slip rows are divided by it: kappa may be as large as it likes
        motion[0, 0] = law.closed
        motion[1, 1:] = np.where(one, law.tau / soft, 0.0)
        force[0, 0] = 1.0
        force[1:, 0] = law.share
        for axis in range(1, d):
            motion[axis, axis, stick] = 1.0
            force[axis, axis] = stick
        force[1:, 1] += np.where(one, law.tau, 0.0)
        resisting[1] = np.where(one, law.kappa / soft, 0.0)
        apart[1] = one & (law.kappa > _STIFF_SLIP)
        fixed = np.concatenate([np.zeros((1, n)), law.fixed])
        return cls(force=force, motion=motion, fixed=fixed, resisting=resisting, apart=apart)

    def forces(self, x: Array) -> Array:
        """(d, n) Z x of unknowns, (d, n)."""
        return np.asarray(np.einsum("ijn,jn->in", self.force, x))

    def seen(self, h: Array) -> Array:
        """(d, n) Y'h of motions, (d, n)."""
        return np.asarray(np.einsum("ijn,jn->in", self.motion, h))

    @cached_property
    def _along(self) -> Array:
        return self.motion * (1.0 - self.apart[:, None])

    def along(self, h: Array) -> Array:
        """(d, n) What `seen` says of motions, (d, n), but for directions apart."""
        return np.asarray(np.einsum("ijn,jn->in", self._along, h))

    def motions(self, y: Array) -> Array:
        """(d, n) The transpose of `along`."""
        return np.asarray(np.einsum("jin,jn->in", self._along, y))

    def coordinates(self, r: Array) -> Array:
        """(d, n) x of given forces, (d, n), as far as the law foresees them."""
        x = np.zeros_like(r)
        x[0] = self.motion[0, 0] * r[0]
        rest = r - self.fixed - self.forces(x)
        x[1:] = np.einsum("ijn,in->jn", self.force[1:, 1:], rest[1:])
        return x


def iterate(
    problem: ContactProblem, law: Tangent, r: Array, a: Array, *, forward: float
) -> tuple[Array, Array, Array] | None:
    """Forces (d, n), rigid motion (k,) and motions (d, n) that nearly balance under a linear law.

    Parameters
    ----------
    problem : the problem as posed
    law : of every pair, linear
    r, a : (d, n) and (k,) where the last iterate ended
    forward : of what is lacking there, what may be left

    Returns
    -------
    r, a, h; None where the iteration does not get there

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
    blocks, shape, size, c = PairBlocks.of(law), r.shape, r.size, problem.free_motion()
    (A, factor, softness), R = problem.image.single, problem.image.R

    def left(x: Array, force: Array, motion: Array) -> Array:
        seen = blocks.seen(motion.reshape(shape)) + blocks.resisting * x[:size].reshape(shape)
        return np.concatenate([seen.ravel(), R.T @ force])

    def balance(x: Array) -> tuple[Array, Array, Array]:
        force = blocks.forces(x[:size].reshape(shape)) + blocks.fixed
        motion = symmetric_product(problem.image.A, force.ravel()) + c + R @ x[size:]
        return force, motion.reshape(shape), -left(x, force.ravel() + problem.b, motion)

    def product(x: Array) -> Array:
        force = blocks.forces(x[:size].reshape(shape)).ravel()
        return left(x, force, symmetric_product(A, force) + R @ x[size:])

    def precondition(y: Array) -> Array:
        motion = blocks.motions(y[:size].reshape(shape)).ravel()
        force = softened(factor, motion) + R @ (y[size:] - R.T @ motion / softness)
        along = blocks.along(force.reshape(shape)) + blocks.apart * y[:size].reshape(shape)
        return np.concatenate([along.ravel(), R.T @ motion])

    start = np.concatenate([blocks.coordinates(r).ravel(), a])
    error = balance(start)[2]
    least, aim = problem.scale * np.sqrt(len(error)), forward * float(np.linalg.norm(error))
    x = start + gmres(product, precondition, error, max(aim, _DATA_ROUNDING * least))
    force, motion, error = balance(x)
    if not np.linalg.norm(error) <= max(_OVERSHOOT * aim, _SINGLE_ROUNDING * least):
        return None
    return force, x[size:], motion
