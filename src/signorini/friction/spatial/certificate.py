# SPDX-License-Identifier: BSD-3-Clause
"""Whether a candidate is a solution: tests outside every method, on the problem as posed."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.friction.certificate import imbalance
from signorini.friction.spatial.law import split
from signorini.friction.spatial.problem import SpatialProblem
from signorini.friction.spatial.section import outermost, project


def certify(problem: SpatialProblem, y: Array) -> float:
    """Largest violation of equilibrium by y, relative to the data; y obeys Coulomb's law as such (see `law`).

    The larger of ``max |b + W (h + r) - h| / scale`` and, for each rigid motion rho, ``|rho.(r + b)| / (scale sum
    |rho_i|)``; infinite for motions above 1e9 times the data. See `friction.certificate.certify` for why.

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.0, 0.0]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> certify(problem, np.array([2.0, 0.0, 0.0])), certify(problem, np.zeros(3))
    (0.0, 1.0)
    """
    if not np.isfinite(y).all():
        return np.inf
    return imbalance(problem, *split(problem, y))


@dataclass(frozen=True, kw_only=True)
class Violations:
    """How far motions and forces of pairs break the law of contact, dimensionless; 0 is exact.

    Attributes
    ----------
    penetration : largest overlap, of the length given
    tension : largest normal force that pulls, of the force given
    cone : farthest tangential force from the section of the friction cone, of the force given
    dissipation : most power (per increment) that an admissible tangential force would dissipate beyond the one found,
        of force times length: 0 where friction opposes slip, and sticking pairs do not slip
    complementarity : largest normal force times gap, of force times length
    """

    penetration: float
    tension: float
    cone: float
    dissipation: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The largest of them."""
        return max(astuple(self))


def violations(
    gap: Array,
    slip: Array,
    normal_force: Array,
    tangential_force: Array,
    friction: ArrayLike,
    *,
    length: float,
    force: float,
    facets: int | IntArray = 0,
) -> Violations:
    """Test motions and forces of n pairs against Coulomb's law in the units of the problem; no equilibrium is asked.

    Parameters
    ----------
    gap : (n,) total gap, length
    slip : (n, 2) slip increment, length
    normal_force : (n,) pressing > 0
    tangential_force : (n, 2) on body 1
    friction : mu, (n,) or (n, 2) along the two tangents
    length, force : sizes from the data, > 0
    facets : see `SpatialProblem`

    Examples
    --------
    >>> one = violations(
    ...     np.zeros(1), np.array([[0.0, 1.0]]), np.ones(1), np.array([[0.0, -0.3]]), [0.3], length=1.0, force=1.0
    ... )
    >>> one.worst
    0.0
    """
    n = len(gap)
    mu = np.asarray(friction, dtype=np.float64).reshape(n, -1 if n else 1) * np.ones((1, 2))
    sides = np.broadcast_to(np.asarray(facets, dtype=np.int64), (n,))
    flat = np.concatenate([normal_force, tangential_force.T.ravel()])
    nearest = project(flat, mu, np.maximum(normal_force, 0.0), sides)[0][n:].reshape(2, n).T
    reach = (outermost(slip, mu, sides) * slip).sum(axis=1)
    pressing = np.maximum(normal_force, 0.0)
    power = pressing * reach + (tangential_force * slip).sum(axis=1)
    return Violations(
        penetration=float(np.maximum(-gap, 0.0).max(initial=0.0)) / length,
        tension=float(np.maximum(-normal_force, 0.0).max(initial=0.0)) / force,
        cone=float(np.linalg.norm(tangential_force - nearest, axis=1).max(initial=0.0)) / force,
        dissipation=float(np.abs(power).max(initial=0.0)) / (force * length),
        complementarity=float(np.abs(normal_force * gap).max(initial=0.0)) / (force * length),
    )


def natural_residual(motion: Array, force: Array, friction: ArrayLike, stiffness: ArrayLike) -> float:
    """Residual of motions and forces of n pairs as a cone complementarity problem, relative to the forces.

    With De Saxce's motion ``u~ = u + mu |u_t| n`` Coulomb's law with a circular cone K reads ``K contains r, K*
    contains u~, r . u~ = 0``; the residual is ``|r - P_K(r - rho u~)| / |r|``.

    Parameters
    ----------
    motion, force : (3n,) n normals, n first and n second tangents
    friction : mu, (n,) or a number
    stiffness : rho > 0, (n,) or a number, force per length

    References
    ----------
    De Saxce, Feng (1998), Mathematical and Computer Modelling 28:225-245. Acary, Bremond, Huber (2018), in: Advanced
    Topics in Nonsmooth Dynamics, section 6.

    Examples
    --------
    >>> natural_residual(np.array([0.0, -2.0, 0.0]), np.array([1.0, 0.5, 0.0]), 0.5, 1.0)
    0.0
    """
    u, r, rho = motion.reshape(3, -1), force.reshape(3, -1), np.asarray(stiffness, dtype=np.float64)
    mu = np.asarray(friction, dtype=np.float64) * np.ones(u.shape[1])
    x = r - rho * u
    x[0] -= rho * mu * np.hypot(u[1], u[2])
    length = np.hypot(x[1], x[2])
    outside = length > mu * x[0]
    pressing = np.where(outside, np.maximum(x[0] + mu * length, 0.0) / (1.0 + mu**2), x[0])
    share = np.where(outside, mu * pressing / np.where(length > 0, length, 1.0), 1.0)
    nearest = np.array([pressing, share * x[1], share * x[2]])
    size = float(np.linalg.norm(r))
    return float(np.linalg.norm(r - nearest)) / (size if size > 0 else 1.0)
