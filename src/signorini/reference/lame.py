# SPDX-License-Identifier: BSD-3-Clause
"""Lame: thick cylinders and spheres under pressure, rings pressed onto each other."""

from __future__ import annotations

from signorini.arrays import Array


def press_fit_pressure(
    *,
    inner: float,
    interface: float,
    outer: float,
    interference: float,
    inner_body: tuple[float, float],
    outer_body: tuple[float, float],
    plane_strain: bool = False,
) -> float:
    """Pressure between two rings a..b and b..c with the radial interference d.

    ``p = d / {b [((b^2+a^2)/(b^2-a^2) - nu_i)/E_i + ((c^2+b^2)/(c^2-b^2) + nu_o)/E_o]}`` in plane stress; plane strain
    with ``E / (1 - nu^2)`` and ``nu / (1 - nu)``.

    Parameters
    ----------
    inner, interface, outer : a, b, c, length
    interference : d, length, radial
    inner_body, outer_body : (E, nu) of each
    plane_strain : rather than plane stress

    References
    ----------
    Timoshenko, Goodier (1970), Theory of Elasticity, section 28.

    Examples
    --------
    >>> body = (2000.0, 0.3)
    >>> p = press_fit_pressure(inner=1, interface=2, outer=3, interference=0.01, inner_body=body, outer_body=body)
    >>> round(p, 6)
    2.34375
    """
    a, b, c = inner, interface, outer
    E_o, nu_o = _plane_strain(outer_body) if plane_strain else outer_body
    shaft = shaft_contraction(inner=a, outer=b, body=inner_body, plane_strain=plane_strain)
    hub = b * ((c**2 + b**2) / (c**2 - b**2) + nu_o) / E_o
    return interference / (shaft + hub)


def shaft_contraction(*, inner: float, outer: float, body: tuple[float, float], plane_strain: bool = False) -> float:
    """How far the outside of a ring a..b comes inwards under unit pressure on it, length per force per area.

    ``b [(b^2 + a^2) / (b^2 - a^2) - nu] / E`` in plane stress; plane strain as :func:`press_fit_pressure`.

    Parameters
    ----------
    inner, outer : a, b, length
    body : (E, nu)
    plane_strain : rather than plane stress

    Examples
    --------
    >>> round(shaft_contraction(inner=0.0, outer=2.0, body=(100.0, 0.3)), 6)
    0.014
    """
    E, nu = _plane_strain(body) if plane_strain else body
    return outer * ((outer**2 + inner**2) / (outer**2 - inner**2) - nu) / E


def _plane_strain(body: tuple[float, float]) -> tuple[float, float]:
    E, nu = body
    return E / (1.0 - nu**2), nu / (1.0 - nu)


def thick_cylinder(r: Array, *, inner: float, outer: float, pressure: float, E: float, nu: float) -> tuple[Array, ...]:
    """A long thick cylinder under internal pressure, plane strain: radial displacement, radial and hoop stress.

    ``sigma = A -+ B / r^2`` with ``A = p a^2 / (b^2 - a^2)``, ``B = A b^2``;
    ``u = (1 + nu) / E ((1 - 2 nu) A r + B / r)``.

    Parameters
    ----------
    r : radii, length
    inner, outer : a, b, length
    pressure : p inside, positive when it pushes on the wall

    Returns
    -------
    u, radial, hoop : in the shape of r; tension positive

    References
    ----------
    Timoshenko, Goodier (1970), Theory of Elasticity, section 28.

    Examples
    --------
    >>> import numpy as np
    >>> _, radial, hoop = thick_cylinder(np.array([1.0, 2.0]), inner=1, outer=2, pressure=3, E=1, nu=0.3)
    >>> print(radial, hoop)
    [-3.  0.] [5. 2.]
    """
    A = pressure * inner**2 / (outer**2 - inner**2)
    B = A * outer**2
    return (1.0 + nu) / E * ((1.0 - 2.0 * nu) * A * r + B / r), A - B / r**2, A + B / r**2


def hollow_sphere(r: Array, *, inner: float, outer: float, pressure: float, E: float, nu: float) -> tuple[Array, ...]:
    """A hollow sphere under internal pressure: radial displacement, radial and hoop stress.

    ``sigma_r = A (1 - b^3 / r^3)``, ``sigma_t = A (1 + b^3 / (2 r^3))`` with ``A = p a^3 / (b^3 - a^3)``;
    ``u = r ((1 - nu) sigma_t - nu sigma_r) / E``.

    Parameters and results as :func:`thick_cylinder`.

    References
    ----------
    Timoshenko, Goodier (1970), Theory of Elasticity, section 136.

    Examples
    --------
    >>> import numpy as np
    >>> _, radial, hoop = hollow_sphere(np.array([1.0, 2.0]), inner=1, outer=2, pressure=7, E=1, nu=0.3)
    >>> print(radial, hoop)
    [-7.  0.] [5.  1.5]
    """
    A, cube = pressure * inner**3 / (outer**3 - inner**3), outer**3 / r**3
    radial, hoop = A * (1.0 - cube), A * (1.0 + 0.5 * cube)
    return r * ((1.0 - nu) * hoop - nu * radial) / E, radial, hoop
