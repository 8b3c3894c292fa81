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
from signorini.friction.posed import PosedContact
from signorini.linalg.krylov import gmres

LARGE = 500
"""Unknowns from which a factorisation costs more."""

_SHARP = 1e-14  # of the size of the data: less is rounding
_TRUSTED = 10.0  # times what was asked for: products in single precision are trusted where they leave no more,
_ROUNDED = 1e-12  # or where it is this small beside the data


@dataclass(frozen=True, kw_only=True, eq=False)
class Unknowns:
    """What a linear law leaves unknown of n pairs with d rows each.

    Attributes
    ----------
    force : (d, d, n) Z, force of every pair per unknown; the first unknown is its normal force, the others are forces
        along directions at right angles to each other
    motion : (d, d, n) Y', what the law prescribes of its motion, per motion
    fixed : (d n,) r_f, forces that are known
    resisting : (d n,) K
    apart : (d n,) 1 where K is so large that compliance counts little beside it, otherwise 0
    """

    force: Array
    motion: Array
    fixed: Array
    resisting: Array
    apart: Array

    def forces(self, x: Array) -> Array:
        """(d n,) Z x."""
        return _by_pair("ijn,jn->in", self.force, x)

    def seen(self, h: Array) -> Array:
        """(d n,) Y'h."""
        return _by_pair("ijn,jn->in", self.motion, h)

    @cached_property
    def _along(self) -> Array:
        d, _, n = self.motion.shape
        return self.motion * (1.0 - self.apart.reshape(d, 1, n))

    def along(self, h: Array) -> Array:
        """(d n,) The same without those apart."""
        return _by_pair("ijn,jn->in", self._along, h)

    def motions(self, y: Array) -> Array:
        """(d n,) The transpose of `along`."""
        return _by_pair("jin,jn->in", self._along, y)

    def coordinates(self, r: Array) -> Array:
        """(d n,) x of given forces, as far as the law foresees them."""
        d, _, n = self.force.shape
        x = np.zeros((d, n))
        x[0] = self.motion[0, 0] * r[:n]
        rest = (r - self.fixed - self.forces(x.ravel())).reshape(d, n)
        x[1:] = np.einsum("ijn,in->jn", self.force[1:, 1:], rest[1:])
        return x.ravel()


def iterate(
    problem: PosedContact, unknown: Unknowns, c: Array, r: Array, a: Array, *, forward: float
) -> tuple[Array, Array, Array] | None:
    """Forces r (d n,), rigid motion a (k,) and motions h (d n,) that nearly balance under a linear law.

    Parameters
    ----------
    problem : the problem as posed
    unknown : what the law leaves
    c : (d n,) motion of the pairs under the load alone, without its rigid part
    r, a : (d n,) and (k,) where the last iterate ended
    forward : of what is lacking there, what may be left

    Returns
    -------
    r, a, h; None where the iteration does not get there

    Examples
    --------
    A pair that sticks under a pressure and a drag:

    >>> from signorini.friction.problem import CoulombProblem
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> every, none = np.eye(2)[:, :, None], np.zeros(2)
    >>> unknown = Unknowns(force=every, motion=every, fixed=none, resisting=none, apart=none)
    >>> r, _, h = iterate(problem, unknown, problem.free_motion(problem.b), none, np.zeros(0), forward=1e-6)
    >>> r.round(5).tolist()
    [2.0, -0.4]
    """
    size = len(unknown.fixed)
    (A, factor, softness), R = problem.image.single, problem.image.R

    def balance(x: Array) -> tuple[Array, Array, Array]:
        force = unknown.forces(x[:size]) + unknown.fixed
        motion = symmetric_product(problem.image.A, force) + c + R @ x[size:]
        seen = unknown.seen(motion) + unknown.resisting * x[:size]
        return force, motion, -np.concatenate([seen, R.T @ (force + problem.b)])

    def product(x: Array) -> Array:
        force = unknown.forces(x[:size])
        motion = symmetric_product(A, force) + R @ x[size:]
        return np.concatenate([unknown.seen(motion) + unknown.resisting * x[:size], R.T @ force])

    def precondition(y: Array) -> Array:
        motion = unknown.motions(y[:size])
        force = softened(factor, motion) + R @ (y[size:] - R.T @ motion / softness)
        return np.concatenate([unknown.along(force) + unknown.apart * y[:size], R.T @ motion])

    start = np.concatenate([unknown.coordinates(r), a])
    error = balance(start)[2]
    least, aim = problem.scale * np.sqrt(len(error)), forward * float(np.linalg.norm(error))
    x = start + gmres(product, precondition, error, max(aim, _SHARP * least))
    force, motion, error = balance(x)
    if not np.linalg.norm(error) <= max(_TRUSTED * aim, _ROUNDED * least):
        return None
    return force, x[size:], motion


def _by_pair(indices: str, matrices: Array, values: Array) -> Array:
    """(d n,) The d x d matrix of every pair times its d values."""
    return np.asarray(np.einsum(indices, matrices, values.reshape(len(matrices), -1))).ravel()
