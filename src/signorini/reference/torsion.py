# SPDX-License-Identifier: BSD-3-Clause
"""Closed forms of torsion: shafts, a disc that sticks to a half-space, a ball that is turned on one."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array

_POINTS = 64  # of Gauss' rule: analytic integrands, to rounding


def shaft_twist(*, torque: float, shear_modulus: float, inner: float, outer: float, length: float) -> float:
    """Angle between the ends of a round shaft, ``T L / (G J)``, ``J = pi (b^4 - a^4) / 2``, radians.

    Parameters
    ----------
    torque, shear_modulus : T and G, force times length and force per area
    inner, outer, length : a, b and L

    Examples
    --------
    >>> round(shaft_twist(torque=np.pi, shear_modulus=2.0, inner=0.0, outer=1.0, length=1.0), 12)
    1.0
    """
    return 2.0 * torque * length / (np.pi * shear_modulus * (outer**4 - inner**4))


def plastic_torque(*, rate: float, shear_modulus: float, shear_stress: float, inner: float, outer: float) -> float:
    """Torque of a round shaft that yields at a shear stress beyond the radius ``c = k / (G rate)``, force times length.

    ``2 pi (G rate (c^4 - a^4) / 4 + k (b^3 - c^3) / 3)``, c between a and b.

    Parameters
    ----------
    rate : angle per length
    shear_modulus, shear_stress : G and k
    inner, outer : a and b

    Examples
    --------
    >>> round(plastic_torque(rate=1e9, shear_modulus=1.0, shear_stress=3.0, inner=0.0, outer=1.0) / np.pi, 12)
    2.0
    """
    c = min(max(shear_stress / (shear_modulus * rate), inner), outer)
    elastic = 0.25 * shear_modulus * rate * (c**4 - inner**4)
    return 2.0 * np.pi * (elastic + shear_stress * (outer**3 - c**3) / 3.0)


def disc_torque(*, angle: float, shear_modulus: float, radius: float) -> float:
    """Torque that turns a disc stuck to a half-space, ``16/3 G a^3 angle`` (Reissner, Sagoci 1944).

    Parameters
    ----------
    angle : radians
    shear_modulus, radius : G of the half-space and a

    Examples
    --------
    >>> round(disc_torque(angle=0.03, shear_modulus=100.0, radius=1.0), 12)
    16.0
    """
    return 16.0 / 3.0 * shear_modulus * radius**3 * angle


def gross_torque(*, friction: float, force: float, radius: float) -> float:
    """Torque under which a ball slips everywhere on its circle of contact, ``3 pi / 16 mu P a``.

    Parameters
    ----------
    friction, force, radius : mu, P and a

    Examples
    --------
    >>> round(gross_torque(friction=0.5, force=32.0, radius=1.0 / np.pi), 12)
    3.0
    """
    return 3.0 * np.pi / 16.0 * friction * force * radius


def ball_torsion(*, stick: float, friction: float, force: float, radius: float, shear_modulus: float) -> Array:
    """Angle and torque, (2,), of a rigid ball on a half-space with friction that sticks within a radius.

    Parameters
    ----------
    stick : c, length, 0 < c < a
    friction, force, radius : mu, P and a of Hertz's pressure ``p_0 sqrt(1 - r^2 / a^2)``
    shear_modulus : G of the half-space

    Notes
    -----
    Displacement and traction along the hoop are ``u = int_0^r t g / sqrt(r^2 - t^2) dt / r`` and
    ``q = -G/r int_r^a t g' / sqrt(t^2 - r^2) dt``. Where the disc sticks ``g = 4 angle t / pi``; where it slips
    ``q = mu p``, so that ``g' = 2 / (pi G) M' / t`` with ``M(x) = int_x^a r^2 q / sqrt(r^2 - x^2) dr`` by Abel's
    inversion. g is continuous and 0 at a, and the torque ``4 pi G int_0^a t g dt``. Two equal balls turn twice as far.

    References
    ----------
    Lubkin (1951), The torsion of elastic spheres in contact, J. Appl. Mech. 18:183-187.

    Examples
    --------
    Slip everywhere but near the middle, and hardly any slip:

    >>> data = {"friction": 0.5, "force": 32.0, "radius": 1.0 / np.pi, "shear_modulus": 10.0}
    >>> round(float(ball_torsion(stick=1e-6 / np.pi, **data)[1]), 6)
    3.0
    >>> angle, torque = ball_torsion(stick=0.999999 / np.pi, **data).tolist()
    >>> round(torque / disc_torque(angle=angle, shear_modulus=10.0, radius=1.0 / np.pi), 5)
    1.0
    """
    a, c, most = radius, stick, 1.5 * friction * force / (np.pi * radius**2)
    places, weights = np.polynomial.legendre.leggauss(_POINTS)
    # t = a sin takes the root of M' at a
    s, ds = 0.5 * (places + 1.0), 0.5 * weights
    t = a * np.sin(np.arcsin(c / a) + (0.5 * np.pi - np.arcsin(c / a)) * s)
    dt = a * np.cos(np.arcsin(t / a)) * (0.5 * np.pi - np.arcsin(c / a)) * ds
    slope = _slope(t, a) * most / a
    edge = -2.0 / (np.pi * shear_modulus) * float((slope / t) @ dt)  # g at c
    angle = 0.25 * np.pi * edge / c
    outside = -0.5 * c**2 * edge - float((t * slope) @ dt) / (np.pi * shear_modulus)
    return np.array([angle, 4.0 * np.pi * shear_modulus * (edge * c**2 / 3.0 + outside)])


def _slope(x: Array, a: float) -> Array:
    """(k,) Derivative of ``(a^2 - x^2) int_0^(pi/2) sqrt(x^2 + (a^2 - x^2) sin^2) cos^2`` at x (k,)."""
    places, weights = np.polynomial.legendre.leggauss(_POINTS)
    angle = 0.25 * np.pi * (places + 1.0)
    weight = 0.25 * np.pi * weights * np.cos(angle) ** 2
    square, sine = (a**2 - x**2)[:, None], np.sin(angle) ** 2
    root = np.sqrt(x[:, None] ** 2 + square * sine)
    found: Array = (-2.0 * x[:, None] * root + square * x[:, None] * (1.0 - sine) / root) @ weight
    return found
