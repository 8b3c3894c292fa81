# SPDX-License-Identifier: BSD-3-Clause
"""The system of a linearised law by GMRES: of many closed pairs the cheaper way, from where the last iterate ended.

The system of `equilibrium` for the problem as posed. Its preconditioner is the interface where every pair sticks,

    [ A   R ]^-1     [ G   R ]
    [ R'  0 ]     =  [ R'  0 ]   nearly,    G = (A + alpha I)^-1 - R R' / alpha,    alpha a little of A,

restricted to what is unknown: half a dozen products do what a factorisation would, at the cost of a few per cent of
one. What is lacking is measured in double precision; the products of an iteration that makes it a few digits less need
single precision alone, and read half as much.

References
----------
Saad, Schultz (1986), GMRES, SIAM J. Sci. Stat. Comput. 7:856-869.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from signorini.arrays import Array
from signorini.condense.image import softened, symmetric_product
from signorini.friction.spatial.equilibrium import Equilibrium, prescribed
from signorini.friction.spatial.law import Tangent

LARGE = 500
"""Unknowns from which a factorisation costs more."""

_MOST = 80  # products; a system that needs more is factorised
_FAR = 1.0  # slip per force, scaled, from which compliance counts little beside it
_FORWARD = 1e-2, 1e-4  # of what the last iterate lacks: no Newton step deserves more while states change, or then
_SHARP = 1e-14  # of the size of the data
_TRUSTED = 10.0  # times that: products in single precision are, where they leave no more,
_ROUNDED = 1e-12  # or where it is this small beside the data


def iterate(
    equilibrium: Equilibrium, law: Tangent, r: Array, a: Array, *, settled: bool
) -> tuple[Array, Array, Array] | None:
    """Forces r (3n,), rigid motion a (k,) and motions h (3n,) that nearly balance under a linearised law.

    Parameters
    ----------
    equilibrium : the problem as posed
    law : the law of every pair, linear
    r, a : (3n,) and (k,) where the last iterate ended
    settled : whether no state changed there

    Returns
    -------
    r, a, h; None where the iteration does not get there

    Examples
    --------
    >>> from signorini.friction.spatial.law import sticking
    >>> from signorini.friction.spatial.problem import SpatialProblem
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.1]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> r, a, h = iterate(Equilibrium.of(problem), sticking(problem), np.zeros(3), np.zeros(0), settled=True)
    >>> r.round(6).tolist(), h.tolist()
    ([2.0, -0.4, -0.2], [0.0, 0.0, 0.0])
    """
    problem = equilibrium.problem
    unknown, size = Unknowns.of(law), 3 * problem.pairs
    (A, factor, softness), R = problem.image.single, problem.image.R

    def balance(x: Array) -> tuple[Array, Array, Array]:
        force = unknown.forces(x[:size]) + unknown.fixed
        motion = equilibrium.moved(force, x[size:])
        seen = unknown.seen(motion) + unknown.resisting * x[:size]
        return force, motion, -np.concatenate([seen, equilibrium.lacking(force, x[size:])])

    def product(x: Array) -> Array:
        force = unknown.forces(x[:size])
        motion = symmetric_product(A, force) + R @ x[size:]
        return np.concatenate([unknown.seen(motion) + unknown.resisting * x[:size], R.T @ force])

    def precondition(y: Array) -> Array:
        motion = unknown.motions(y[:size])
        force = softened(factor, motion) + R @ (y[size:] - R.T @ motion / softness)
        return np.concatenate([unknown.along(force) + unknown.across * y[:size], R.T @ motion])

    start = np.concatenate([unknown.coordinates(r), a])
    error = balance(start)[2]
    least, aim = problem.scale * np.sqrt(len(error)), _FORWARD[settled] * float(np.linalg.norm(error))
    change = gmres(product, precondition, error, max(aim, _SHARP * least))
    if change is None:
        return None
    x = start + change
    force, motion, error = balance(x)
    if not np.linalg.norm(error) <= max(_TRUSTED * aim, _ROUNDED * least):
        return None
    return force, x[size:], prescribed(law, motion)


@dataclass(frozen=True, kw_only=True, eq=False)
class Unknowns:
    """Three unknowns a pair, those that the law does not leave are 0: `equilibrium.directions` without a matrix.

    The first is the normal force, the others are tangential forces: both where the pair sticks, the second alone, along
    tau, where one is left.

    Attributes
    ----------
    law : of every pair, linear
    force : (3, 3, n) force of every pair per unknown
    motion : (3, 3, n) what the law prescribes of its motion, per motion
    resisting : (3n,) what the law prescribes, per unknown: kappa, in the units of `motion`
    """

    law: Tangent
    force: Array
    motion: Array
    resisting: Array

    @classmethod
    def of(cls, law: Tangent) -> Unknowns:
        """What a law leaves unknown."""
        n, stick, one = len(law.left), law.left == 2, law.left == 1
        force, motion, resisting = np.zeros((3, 3, n)), np.zeros((3, 3, n)), np.zeros((3, n))
        soft = 1.0 + law.kappa  # across a slip rows are divided by it: kappa may be as large as it likes
        motion[0, 0] = law.closed
        motion[1, 1:] = np.where(one, law.tau.T / soft, 0.0)
        motion[1, 1, stick] = motion[2, 2, stick] = 1.0
        force[0, 0] = 1.0
        force[1:, 0] = law.share.T
        force[1:, 1] = np.where(one, law.tau.T, motion[1, 1:])
        force[2, 2] = stick
        resisting[1] = np.where(one, law.kappa / soft, 0.0)
        return cls(law=law, force=force, motion=motion, resisting=resisting.ravel())

    @cached_property
    def across(self) -> Array:
        """(3n,) 1 for unknowns across a slip that resist far more than compliance does."""
        far = (self.law.left == 1) & (self.law.kappa > _FAR)
        none = np.zeros_like(self.law.kappa)
        return np.concatenate([none, far.astype(np.float64), none])

    @cached_property
    def fixed(self) -> Array:
        """(3n,) Forces that are known."""
        return np.concatenate([np.zeros(len(self.law.left)), self.law.fixed.T.ravel()])

    @cached_property
    def _along(self) -> Array:
        return self.motion * (1.0 - self.across.reshape(3, 1, -1))

    def forces(self, x: Array) -> Array:
        """(3n,) Forces of the pairs, without those that are known."""
        return _by_pair("ijn,jn->in", self.force, x)

    def seen(self, h: Array) -> Array:
        """(3n,) Of motions those that the law prescribes."""
        return _by_pair("ijn,jn->in", self.motion, h)

    def along(self, h: Array) -> Array:
        """(3n,) The same without those across a slip."""
        return _by_pair("ijn,jn->in", self._along, h)

    def motions(self, y: Array) -> Array:
        """(3n,) The transpose of `along`."""
        return _by_pair("jin,jn->in", self._along, y)

    def coordinates(self, r: Array) -> Array:
        """(3n,) The unknowns of given forces; across a slip what the law does not foresee."""
        x = np.zeros((3, len(self.law.left)))
        x[0] = self.motion[0, 0] * r.reshape(3, -1)[0]
        rest = (r - self.fixed - self.forces(x.ravel())).reshape(3, -1)
        x[1] = (self.force[1:, 1] * rest[1:]).sum(axis=0)
        x[2] = self.force[2, 2] * rest[2]
        return x.ravel()


def _by_pair(indices: str, matrices: Array, values: Array) -> Array:
    """(3n,) The 3 x 3 matrix of every pair times its three values."""
    return np.asarray(np.einsum(indices, matrices, values.reshape(3, -1))).ravel()


def gmres(
    product: Callable[[Array], Array], precondition: Callable[[Array], Array], rhs: Array, tolerance: float
) -> Array | None:
    """Solve ``M x = rhs`` to a residual, with the preconditioner on the right; None where it takes too long.

    Examples
    --------
    >>> M = np.array([[2.0, 1.0], [0.0, 3.0]])
    >>> gmres(lambda x: M @ x, lambda y: y, np.array([3.0, 3.0]), 1e-12).round(12).tolist()
    [1.0, 1.0]
    """
    first = float(np.linalg.norm(rhs))
    if first <= tolerance:
        return np.zeros_like(rhs)
    basis, images = np.empty((_MOST + 1, len(rhs))), np.empty((_MOST, len(rhs)))
    basis[0] = rhs / first
    triangle, turned = np.zeros((_MOST, _MOST)), np.zeros(_MOST + 1)
    turned[0] = first
    rotations: list[tuple[float, float]] = []
    for j in range(_MOST):
        images[j] = precondition(basis[j])
        new, Q = product(images[j]), basis[: j + 1]
        column = np.zeros(j + 2)
        for _ in range(2):
            part = Q @ new
            new = new - part @ Q
            column[: j + 1] += part
        column[j + 1] = beyond = float(np.linalg.norm(new))
        _rotate(column, rotations)
        if not 0.0 < column[j] < np.inf:
            return None
        cosine, sine = rotations[j]
        triangle[: j + 1, j] = column[: j + 1]
        turned[j], turned[j + 1] = cosine * turned[j], -sine * turned[j]
        if abs(turned[j + 1]) <= tolerance:
            y = solve_triangular(triangle[: j + 1, : j + 1], turned[: j + 1], check_finite=False)
            return np.asarray(y @ images[: j + 1], dtype=np.float64)
        if beyond <= 1e-14 * first:
            return None
        basis[j + 1] = new / beyond
    return None


def _rotate(column: Array, rotations: list[tuple[float, float]]) -> None:
    """Turn a new column of the Hessenberg matrix by the rotations before it, and by one more that clears its end."""
    values: list[float] = column.tolist()
    for i, (cosine, sine) in enumerate(rotations):
        values[i], values[i + 1] = cosine * values[i] + sine * values[i + 1], cosine * values[i + 1] - sine * values[i]
    length = float(np.hypot(values[-2], values[-1]))
    rotations.append((values[-2] / length, values[-1] / length) if length > 0.0 else (1.0, 0.0))
    values[-2:] = [length, 0.0]
    column[:] = values
