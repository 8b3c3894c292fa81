# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield: first yield under Hertz, tubes, press fits, punches, beams, rolling."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from signorini.arrays import Array
from signorini.reference.hertz import HertzLine
from signorini.reference.hertz_point import HertzPoint
from signorini.reference.lame import press_fit_pressure, shaft_contraction, thick_cylinder

_DEEPEST = 2.0  # contact radii: the largest equivalent stress lies at 0.5 to 0.8


def first_yield_line(nu: float) -> tuple[float, float]:
    """Where a long cylinder first yields: ``p_0 / Y`` and the depth ``z / a``, von Mises, plane strain.

    The largest equivalent stress on the axis of symmetry, with ``sigma_y = nu (sigma_x + sigma_z)``.

    References
    ----------
    Johnson (1985), Contact Mechanics, equations 4.46 and 6.2.

    Examples
    --------
    >>> [round(value, 4) for value in first_yield_line(0.3)]
    [1.7937, 0.7043]
    """
    unit = HertzLine(force=0.5 * np.pi, radius=1.0, modulus=2.0)  # p_0 = a = 1

    def equivalent(z: float) -> float:
        along, down = unit.axis_stress(z)
        across = nu * (along + down)
        return float(np.sqrt(0.5 * ((along - across) ** 2 + (across - down) ** 2 + (down - along) ** 2)))

    return _first_yield(equivalent)


def first_yield_point(nu: float) -> tuple[float, float]:
    """Where a ball first yields: ``p_0 / Y`` and the depth ``z / a``, von Mises or Tresca.

    The largest ``|sigma_r - sigma_z|`` on the axis of symmetry; the mean pressure is two thirds of p_0.

    References
    ----------
    Johnson (1985), Contact Mechanics, equations 3.45 and 6.8.

    Examples
    --------
    >>> [round(value, 4) for value in first_yield_point(0.3)]
    [1.6128, 0.4809]
    """
    unit = HertzPoint(force=2.0 * np.pi / 3.0, radius=1.0, modulus=0.5 * np.pi)  # p_0 = a = 1

    def equivalent(z: float) -> float:
        radial, axial = unit.axis_stress(z, nu)
        return float(abs(radial - axial))

    return _first_yield(equivalent)


def _first_yield(equivalent: Callable[[float], float]) -> tuple[float, float]:
    """Of the equivalent stress under unit pressure by depth: on the surface, or where it is largest below."""
    below = minimize_scalar(lambda z: -equivalent(z), bounds=(0.0, _DEEPEST), method="bounded", options={"xatol": 1e-9})
    depth = max(0.0, float(below.x), key=equivalent)
    return 1.0 / equivalent(depth), depth


@dataclass(frozen=True, kw_only=True)
class HillTube:
    """A long tube of a perfectly plastic material under internal pressure, ends held: it yields from the inside.

    ``sigma_t - sigma_r = 2 k`` from the inner radius a to c, elastic beyond; ``p = k (1 - c^2 / b^2 + 2 ln(c / a))``.
    Exact for Tresca's criterion as long as the axial stress is the middle one, for von Mises' with ``k = Y / sqrt(3)``
    and nu = 0.5, nearly so below.

    Parameters
    ----------
    inner, outer : a, b, length
    shear_strength : k, force per area

    References
    ----------
    Hill (1950), The Mathematical Theory of Plasticity, chapter V.2.

    Examples
    --------
    >>> tube = HillTube(inner=1.0, outer=2.0, shear_strength=1.0)
    >>> tube.first_yield, round(tube.limit, 5), round(tube.plastic_radius(1.2), 4)
    (0.75, 1.38629, 1.424)
    >>> radial, hoop = tube.stress(np.array([1.0, 2.0]), 1.2)
    >>> radial.round(4).tolist(), hoop.round(4).tolist()
    ([-1.2, 0.0], [0.8, 1.0139])
    """

    inner: float
    outer: float
    shear_strength: float

    @property
    def first_yield(self) -> float:
        """Pressure at which the inside yields, ``k (1 - a^2 / b^2)``."""
        return self.shear_strength * (1.0 - self.inner**2 / self.outer**2)

    @property
    def limit(self) -> float:
        """Pressure at which all of it flows, ``2 k ln(b / a)``."""
        return self.pressure(self.outer)

    def pressure(self, plastic_radius: float) -> float:
        """Pressure at which the plastic radius is c, from a to b."""
        ends = plastic_radius / self.inner, plastic_radius / self.outer
        return self.shear_strength * (1.0 - ends[1] ** 2 + 2.0 * float(np.log(ends[0])))

    def plastic_radius(self, pressure: float) -> float:
        """c, length: a up to the first yield; beyond the limit there is none (ValueError)."""
        if pressure <= self.first_yield:
            return self.inner
        return float(brentq(lambda c: self.pressure(c) - pressure, self.inner, self.outer, xtol=1e-14 * self.outer))

    def stress(self, r: ArrayLike, pressure: float) -> tuple[Array, Array]:
        """Radial and hoop stress at radii under a pressure that has grown from 0, force per area; tension positive."""
        r, k = np.asarray(r, float), self.shear_strength
        c = self.plastic_radius(pressure)
        at_c = pressure - 2.0 * k * np.log(c / self.inner)
        _, radial, hoop = thick_cylinder(r, inner=c, outer=self.outer, pressure=at_c, E=1.0, nu=0.0)
        flowing = -pressure + 2.0 * k * np.log(np.minimum(r, c) / self.inner)
        return np.where(r < c, flowing, radial), np.where(r < c, flowing + 2.0 * k, hoop)

    def residual_stress(self, r: ArrayLike, pressure: float) -> tuple[Array, Array]:
        """Radial and hoop stress that are left where the pressure is taken away again, force per area.

        Nothing yields backwards below twice the pressure of first yield.
        """
        r = np.asarray(r, float)
        _, *less = thick_cylinder(r, inner=self.inner, outer=self.outer, pressure=pressure, E=1.0, nu=0.0)
        radial, hoop = (loaded - elastic for loaded, elastic in zip(self.stress(r, pressure), less, strict=True))
        return radial, hoop

    def expansion(self, pressure: float, body: tuple[float, float]) -> float:
        """Radial displacement of the inside, length; the body is (E, nu).

        ``u = 2 (1 - nu^2) k c^2 / (E a) - (1 + nu) (1 - 2 nu) p a / E`` once it yields: only elastic strain changes
        the volume.
        """
        E, nu = body
        if pressure <= self.first_yield:
            whole = {"inner": self.inner, "outer": self.outer, "pressure": pressure, "E": E, "nu": nu}
            return float(thick_cylinder(np.array(self.inner), **whole)[0])
        c = self.plastic_radius(pressure)
        flow = 2.0 * (1.0 - nu**2) * self.shear_strength * c**2 / self.inner
        return (flow - (1.0 + nu) * (1.0 - 2.0 * nu) * pressure * self.inner) / E


def yielding_press_fit_pressure(
    hub: HillTube, *, bore: float, interference: float, inner_body: tuple[float, float], outer_body: tuple[float, float]
) -> float:
    """Pressure between a hollow shaft that stays elastic and a hub that may yield, plane strain.

    The expansion of the hub and the contraction of the shaft are the interference; once all of the hub flows the
    pressure is its limit.

    Parameters
    ----------
    hub : its inner radius is that of the interface
    bore : inner radius of the shaft, length
    interference : radial, length
    inner_body, outer_body : (E, nu) of shaft and hub

    References
    ----------
    Lame's shaft within Hill's tube (1950).

    Examples
    --------
    >>> hub = HillTube(inner=2.0, outer=3.0, shear_strength=1.0)
    >>> bodies = {"inner_body": (2000.0, 0.4999), "outer_body": (1000.0, 0.4999)}
    >>> [round(yielding_press_fit_pressure(hub, bore=1.0, interference=d, **bodies), 4) for d in (0.004, 0.0065, 0.012)]
    [0.658, 0.8059, 0.8109]
    """
    rings = {"inner": bore, "interface": hub.inner, "outer": hub.outer, "interference": interference}
    elastic = press_fit_pressure(**rings, inner_body=inner_body, outer_body=outer_body, plane_strain=True)
    if elastic <= hub.first_yield:
        return elastic
    shaft = shaft_contraction(inner=bore, outer=hub.inner, body=inner_body, plane_strain=True)

    def overlap_left(plastic_radius: float) -> float:
        pressure = hub.pressure(plastic_radius)
        return interference - shaft * pressure - hub.expansion(pressure, outer_body)

    if overlap_left(hub.outer) >= 0.0:
        return hub.limit
    return hub.pressure(float(brentq(overlap_left, hub.inner, hub.outer, xtol=1e-14 * hub.outer)))


def punch_limit(shear_strength: float) -> float:
    """Mean pressure under a flat punch on a perfectly plastic half-plane, ``(2 + pi) k``, rough or smooth.

    References
    ----------
    Prandtl (1920); Hill (1950), chapter IX.5.

    Examples
    --------
    >>> round(punch_limit(1.0), 4)
    5.1416
    """
    return (2.0 + np.pi) * shear_strength


def rolling_shakedown_limit(shear_strength: float) -> float:
    """Largest p_0 of a cylinder that rolls without friction again and again and in the end deforms only elastically.

    ``4 k``: residual stresses that do not change along the way have no shear across it, and that of Hertz's pressure
    is ``p_0 / 4`` at the most. First yield is at 3.1 k, see :func:`first_yield_line`.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 9.2; Melan (1938).

    Examples
    --------
    >>> rolling_shakedown_limit(1.0)
    4.0
    """
    return 4.0 * shear_strength


@dataclass(frozen=True, kw_only=True)
class YieldingBeam:
    """A perfectly plastic beam of rectangular section in bending: what is beyond ``core`` from its middle flows.

    ``M = M_p (1 - (kappa_y / kappa)^2 / 3)``. In plane strain the modulus is ``E / (1 - nu^2)`` and the strength
    ``2 Y / sqrt(3)``, exact for nu = 0.5; its limit holds for any nu.

    Parameters
    ----------
    height : h, length; moments are per thickness
    E, nu : of the elastic material
    yield_stress : Y, force per area
    plane_strain : rather than plane stress

    References
    ----------
    Timoshenko (1956), Strength of Materials II, section 64; Hill (1950), chapter IV.6.

    Examples
    --------
    >>> beam = YieldingBeam(height=2.0, E=200.0, nu=0.5, yield_stress=3.0)
    >>> beam.first_yield, beam.limit, round(beam.moment(2 * beam.yield_curvature), 4)
    (2.0, 3.0, 2.75)
    >>> wide = YieldingBeam(height=2.0, E=200.0, nu=0.5, yield_stress=3.0, plane_strain=True)
    >>> round(wide.limit / beam.limit, 4)
    1.1547
    """

    height: float
    E: float
    nu: float
    yield_stress: float
    plane_strain: bool = False

    @property
    def strength(self) -> float:
        """Stress along the beam where it flows, force per area."""
        return self.yield_stress * (2.0 / float(np.sqrt(3.0)) if self.plane_strain else 1.0)

    @property
    def modulus(self) -> float:
        """Stress over strain along the beam while it is elastic, force per area."""
        return self.E / (1.0 - self.nu**2) if self.plane_strain else self.E

    @property
    def first_yield(self) -> float:
        """Moment at which the outer fibres yield, ``Y h^2 / 6``, force times length per thickness."""
        return self.strength * self.height**2 / 6.0

    @property
    def limit(self) -> float:
        """Moment at which all of the section flows, 3/2 of the first."""
        return 1.5 * self.first_yield

    @property
    def yield_curvature(self) -> float:
        """Curvature at which the outer fibres yield, ``2 Y / (E h)``, per length."""
        return 2.0 * self.strength / (self.modulus * self.height)

    def moment(self, curvature: float) -> float:
        """Moment of a curvature that has grown from 0, force times length per thickness."""
        part = abs(curvature) / self.yield_curvature
        size = self.first_yield * part if part <= 1.0 else self.limit * (1.0 - part**-2 / 3.0)
        return float(np.copysign(size, curvature))

    def core(self, moment: float) -> float:
        """Half height of what is still elastic under a moment that has grown from 0, below the limit, length."""
        part = abs(moment) / self.limit
        return 0.5 * self.height * min(1.0, float(np.sqrt(3.0 * (1.0 - part))))
