# SPDX-License-Identifier: BSD-3-Clause
"""Rotating discs."""

from __future__ import annotations

from signorini.arrays import Array


def rotating_disc(
    r: Array, *, inner: float, outer: float, omega: float, density: float, E: float, nu: float
) -> tuple[Array, Array, Array]:
    """A thin disc with a hole, free at both rims, at constant speed: radial displacement, radial and hoop stress.

    ``sigma_r = c (3 + nu) (a^2 + b^2 - a^2 b^2 / r^2 - r^2)``,
    ``sigma_t = c ((3 + nu) (a^2 + b^2 + a^2 b^2 / r^2) - (1 + 3 nu) r^2)``, ``c = density omega^2 / 8``;
    ``u = r (sigma_t - nu sigma_r) / E``.

    Parameters
    ----------
    r : radii, length
    inner, outer : a, b, length
    omega : angular velocity, angle per time
    density : mass per volume

    Returns
    -------
    u, radial, hoop : in the shape of r; tension positive

    References
    ----------
    Timoshenko, Goodier (1970), Theory of Elasticity, section 32.

    Examples
    --------
    >>> import numpy as np
    >>> _, radial, hoop = rotating_disc(np.array([1.0, 2.0]), inner=1, outer=2, omega=2, density=2, E=1, nu=0)
    >>> print(radial, hoop)
    [0. 0.] [26. 14.]
    """
    c, a, b = density * omega**2 / 8.0, inner**2, outer**2
    radial = c * (3.0 + nu) * (a + b - a * b / r**2 - r**2)
    hoop = c * ((3.0 + nu) * (a + b + a * b / r**2) - (1.0 + 3.0 * nu) * r**2)
    return r * (hoop - nu * radial) / E, radial, hoop
