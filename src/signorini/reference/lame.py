# SPDX-License-Identifier: BSD-3-Clause
"""Lame: thick rings under pressure and pressed onto each other."""

from __future__ import annotations


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
    (E_i, nu_i), (E_o, nu_o) = (_plane_strain(body) if plane_strain else body for body in (inner_body, outer_body))
    shaft = ((b**2 + a**2) / (b**2 - a**2) - nu_i) / E_i
    hub = ((c**2 + b**2) / (c**2 - b**2) + nu_o) / E_o
    return interference / (b * (shaft + hub))


def _plane_strain(body: tuple[float, float]) -> tuple[float, float]:
    E, nu = body
    return E / (1.0 - nu**2), nu / (1.0 - nu)
