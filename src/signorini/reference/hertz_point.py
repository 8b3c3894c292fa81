# SPDX-License-Identifier: BSD-3-Clause
"""Hertz and Mindlin: two spheres pressed together, then pulled sideways; Boussinesq: a flat round punch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array


@dataclass(frozen=True, kw_only=True)
class HertzPoint:
    """Point contact: ``a^3 = 3 F R / (4 E*)``, ``p_0 = 3 F / (2 pi a^2)``, ``p = p_0 sqrt(1 - r^2 / a^2)``.

    Valid without friction for half-spaces, a << R.

    Parameters
    ----------
    force : F
    radius : R, ``1/R = 1/R_1 + 1/R_2``
    modulus : E*, see :func:`signorini.reference.hertz.contact_modulus`

    References
    ----------
    Johnson (1985), Contact Mechanics, section 4.2(a).

    Examples
    --------
    >>> ball = HertzPoint(force=4.0, radius=3.0, modulus=9.0)
    >>> round(ball.contact_radius, 6), round(ball.peak_pressure, 6), round(ball.approach, 6)
    (1.0, 1.909859, 0.333333)
    """

    force: float
    radius: float
    modulus: float

    @property
    def contact_radius(self) -> float:
        """``a``, length."""
        return float(np.cbrt(3.0 * self.force * self.radius / (4.0 * self.modulus)))

    @property
    def peak_pressure(self) -> float:
        """``p_0``, force per area."""
        return float(1.5 * self.force / (np.pi * self.contact_radius**2))

    @property
    def approach(self) -> float:
        """``a^2 / R`` of distant points, length."""
        return self.contact_radius**2 / self.radius

    def pressure(self, r: ArrayLike) -> Array:
        """p at the distance r from the centre, force per area."""
        inside = 1.0 - (np.asarray(r, float) / self.contact_radius) ** 2
        pressure: Array = self.peak_pressure * np.sqrt(np.maximum(inside, 0.0))
        return pressure

    def axis_stress(self, z: ArrayLike, nu: float) -> tuple[Array, Array]:
        """Radial (and hoop) and axial stress at the depth z >= 0 below the centre in a body with nu; tension positive.

        ``sigma_r = -p_0 [(1 + nu) (1 - s atan(1/s)) - 1 / (2 (1 + s^2))]``, ``sigma_z = -p_0 / (1 + s^2)``,
        ``s = z / a``.
        """
        s = np.asarray(z, float) / self.contact_radius
        fading = 1.0 / (1.0 + s**2)
        radial: Array = (1.0 + nu) * (1.0 - s * np.arctan2(1.0, s)) - 0.5 * fading
        return -self.peak_pressure * radial, -self.peak_pressure * fading


@dataclass(frozen=True, kw_only=True)
class MindlinPoint:
    """Point contact at constant normal force P under a tangential force Q, ``|Q| < mu P``.

    Equal materials (or Dundurs' beta = 0), half-spaces; the friction is taken along Q everywhere, which slip obeys up
    to a small part across it. Then it is the full slip of P less that of P - Q/mu::

        q = mu p_0 [sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)],    c/a = (1 - Q / mu P)^(1/3)

    Parameters
    ----------
    normal : the contact under P
    friction : mu
    shear_compliance : ``sum (2 - nu) / G`` over the bodies, area per force

    References
    ----------
    Cattaneo (1938); Mindlin (1949), J. Appl. Mech. 16; Johnson (1985), sections 7.2(d) and 7.4.

    Examples
    --------
    >>> ball = HertzPoint(force=4.0, radius=3.0, modulus=9.0)
    >>> pulled = MindlinPoint(normal=ball, friction=0.5, shear_compliance=1.0)
    >>> round(pulled.stick_radius(1.75), 6), round(pulled.shift(1.75), 6)
    (0.5, 0.28125)
    """

    normal: HertzPoint
    friction: float
    shear_compliance: float

    @property
    def most(self) -> float:
        """``mu P``, the onset of full sliding."""
        return self.friction * self.normal.force

    def stick_radius(self, Q: float) -> float:
        """``c``, length, for a force that has grown from 0."""
        return self.normal.contact_radius * float(np.cbrt(max(1.0 - abs(Q) / self.most, 0.0)))

    def traction(self, r: ArrayLike, Q: float) -> Array:
        """q at r for a force that has grown from 0, force per area."""
        force = max(1.0 - abs(Q) / self.most, 1e-300) * self.normal.force
        less = HertzPoint(force=force, radius=self.normal.radius, modulus=self.normal.modulus).pressure(r)
        traction: Array = np.sign(Q) * self.friction * (self.normal.pressure(r) - less)
        return traction

    def shift(self, Q: float) -> float:
        """How far Q, grown from 0, moves distant points of one body against the other, length."""
        part = 1.0 - abs(Q) / self.most
        return float(np.sign(Q)) * self._unit * (1.0 - float(np.cbrt(part) ** 2))

    def loss(self, highest: float) -> float:
        """Dissipation of a cycle between ``highest`` and ``-highest``, work."""
        part = highest / self.most
        rest = 1.0 - part
        bracket = 1.0 - rest ** (5.0 / 3.0) - 5.0 * part / 6.0 * (1.0 + rest ** (2.0 / 3.0))
        return 4.8 * self._unit * self.most * bracket

    @property
    def _unit(self) -> float:
        return 3.0 * self.most * self.shear_compliance / (16.0 * self.normal.contact_radius)


def round_punch(r: ArrayLike, *, force: float, radius: float) -> Array:
    """Pressure ``F / (2 pi a sqrt(a^2 - r^2))`` under a flat rigid punch without friction, for r < a.

    The approach is ``F / (2 a E*)``; the part ``1 - sqrt(1 - r^2 / a^2)`` of F acts within r.

    Parameters
    ----------
    r : distances from the centre, length
    force, radius : F, a

    References
    ----------
    Boussinesq (1885); Johnson (1985), section 3.4.

    Examples
    --------
    >>> round_punch([0.0, 0.6], force=6.2831853, radius=1.0).round(6).tolist()
    [1.0, 1.25]
    """
    pressure: Array = force / (2.0 * np.pi * radius * np.sqrt(radius**2 - np.asarray(r, float) ** 2))
    return pressure
