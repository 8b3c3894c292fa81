# SPDX-License-Identifier: BSD-3-Clause
"""Motions and forces of pairs in space against Coulomb's law, in the units of a problem, outside every method."""

from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.law.section import FrictionSection


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
    slip : (2, n) slip increment, length
    normal_force : (n,) pressing > 0
    tangential_force : (2, n) on body 1
    friction : mu, (n,) or (2, n) along the two tangents
    length, force : sizes from the data, > 0
    facets : see `ContactProblem`

    Examples
    --------
    >>> one = violations(
    ...     np.zeros(1), np.array([[0.0], [1.0]]), np.ones(1), np.array([[0.0], [-0.3]]), [0.3], length=1.0, force=1.0
    ... )
    >>> one.worst
    0.0
    """
    mu = np.asarray(friction, dtype=np.float64) * np.ones((2, 1))
    cones = FrictionSection(axes=mu, sides=np.broadcast_to(np.asarray(facets, dtype=np.int64), gap.shape).copy())
    nearest = cones.nearest(tangential_force, np.maximum(normal_force, 0.0))
    reach = (cones.farthest(slip) * slip).sum(axis=0)
    pressing = np.maximum(normal_force, 0.0)
    power = pressing * reach + (tangential_force * slip).sum(axis=0)
    return Violations(
        penetration=float(np.maximum(-gap, 0.0).max(initial=0.0)) / length,
        tension=float(np.maximum(-normal_force, 0.0).max(initial=0.0)) / force,
        cone=float(np.linalg.norm(tangential_force - nearest, axis=0).max(initial=0.0)) / force,
        dissipation=float(np.abs(power).max(initial=0.0)) / (force * length),
        complementarity=float(np.abs(normal_force * gap).max(initial=0.0)) / (force * length),
    )
