# SPDX-License-Identifier: BSD-3-Clause
"""The nearest admissible tangential force: projection on the cross-section of a friction cone, compiled, pair by pair.

The section at normal force s holds the tangential forces that friction allows: the ellipse
``|(r_1 / m_1, r_2 / m_2)| <= s``, or the polygon inscribed in it. Around a point y its projection r is, to first order
and because the section grows in proportion to s,

    r(y') = s' e + q tau,    tau . (y' - r(y')) = kappa q

with e the point on the section of s = 1, tau the tangent of its boundary there and q its unknown share: two directions
where y lies inside (it sticks), one on a smooth boundary or an edge, none at a corner. kappa = 0 on an edge.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from signorini.arrays import Array, IntArray

_TOLERANCE = 1e-15
_NOTHING = 1e-150  # its square underflows: a section smaller than that is a point
_MOST = 100


@njit(cache=True)
def _on_ellipse(y_1: float, y_2: float, a_1: float, a_2: float) -> tuple[float, float, float, float, float]:
    """Nearest point of an ellipse with half-axes a from outside it, its tangent, and kappa.

    The point is ``r_i = a_i^2 y_i / (a_i^2 + t)`` with t the root of ``|a_i y_i / (a_i^2 + t)| = 1``, left of which
    Newton's method for the reciprocal of that norm rises without overshooting.
    """
    if a_1 == a_2:
        length = math.hypot(y_1, y_2)
        return a_1 * y_1 / length, a_1 * y_2 / length, -y_2 / length, y_1 / length, length / a_1 - 1.0
    t = max(a_1 * abs(y_1) - a_1**2, a_2 * abs(y_2) - a_2**2, 0.0)
    for _ in range(_MOST):
        f_1, f_2 = a_1 * y_1 / (a_1**2 + t), a_2 * y_2 / (a_2**2 + t)
        norm = math.hypot(f_1, f_2)
        slope = (f_1**2 / (a_1**2 + t) + f_2**2 / (a_2**2 + t)) / norm
        step = norm * (norm - 1.0) / slope
        t += step
        if step <= _TOLERANCE * (t + a_1 * a_2):
            break
    f_1, f_2 = a_1 * y_1 / (a_1**2 + t), a_2 * y_2 / (a_2**2 + t)
    norm = math.hypot(f_1, f_2)
    r_1, r_2 = a_1 * f_1 / norm, a_2 * f_2 / norm
    n_1, n_2 = r_1 / a_1**2, r_2 / a_2**2
    length = math.hypot(n_1, n_2)
    tau_1, tau_2 = -n_2 / length, n_1 / length
    return r_1, r_2, tau_1, tau_2, t * ((tau_1 / a_1) ** 2 + (tau_2 / a_2) ** 2)


@njit(cache=True)
def _on_polygon(y_1: float, y_2: float, a_1: float, a_2: float, facets: int) -> tuple[float, float, int, float, float]:
    """Nearest point of a polygon (counter-clockwise), how many directions are left to it, and the direction."""
    best, count = np.inf, 2
    r_1, r_2, tau_1, tau_2 = y_1, y_2, 0.0, 0.0
    inside = True
    n_1, n_2 = a_1, 0.0
    for j in range(facets):
        p_1, p_2 = n_1, n_2
        angle = 2.0 * math.pi * ((j + 1) % facets) / facets
        n_1, n_2 = a_1 * math.cos(angle), a_2 * math.sin(angle)
        d_1, d_2 = n_1 - p_1, n_2 - p_2
        inside = inside and d_1 * (y_2 - p_2) - d_2 * (y_1 - p_1) >= 0.0
        length = math.hypot(d_1, d_2)
        t = min(max(((y_1 - p_1) * d_1 + (y_2 - p_2) * d_2) / length**2, 0.0), 1.0)
        x_1, x_2 = p_1 + t * d_1, p_2 + t * d_2
        distance = math.hypot(y_1 - x_1, y_2 - x_2)
        if distance < best:
            best, count = distance, 1 if 0.0 < t < 1.0 else 0
            r_1, r_2, tau_1, tau_2 = x_1, x_2, d_1 / length, d_2 / length
    return (y_1, y_2, 2, 0.0, 0.0) if inside else (r_1, r_2, count, tau_1, tau_2)


@njit(cache=True)
def nearest(
    y_1: float, y_2: float, m_1: float, m_2: float, s: float, facets: int
) -> tuple[float, float, int, float, float, float]:
    """The projection r of y on the section, directions left to it (0, 1, 2), tau and kappa.

    Parameters
    ----------
    m_1, m_2 : half-axes of the section for s = 1, 0 or more
    s : normal force, 0 or more
    facets : corners of the polygon inscribed in the ellipse, a multiple of 4, the first on the first axis; 0 for the
        ellipse itself

    Examples
    --------
    >>> nearest(3.0, 4.0, 0.5, 0.5, 2.0, 0)
    (0.6, 0.8, 1, -0.8, 0.6, 4.0)
    """
    a_1, a_2 = m_1 * s, m_2 * s
    if a_1 <= _NOTHING and a_2 <= _NOTHING:
        return 0.0, 0.0, 0, 0.0, 0.0, 0.0
    if a_1 <= _NOTHING:
        return 0.0, min(max(y_2, -a_2), a_2), 1 if abs(y_2) <= a_2 else 0, 0.0, 1.0, 0.0
    if a_2 <= _NOTHING:
        return min(max(y_1, -a_1), a_1), 0.0, 1 if abs(y_1) <= a_1 else 0, 1.0, 0.0, 0.0
    if facets:
        r_1, r_2, count, tau_1, tau_2 = _on_polygon(y_1, y_2, a_1, a_2, facets)
        return r_1, r_2, count, tau_1, tau_2, 0.0
    if math.hypot(y_1 / a_1, y_2 / a_2) <= 1.0:
        return y_1, y_2, 2, 0.0, 0.0, 0.0
    r_1, r_2, tau_1, tau_2, kappa = _on_ellipse(y_1, y_2, a_1, a_2)
    return r_1, r_2, 1, tau_1, tau_2, kappa


@njit(cache=True)
def project(y: Array, m: Array, size: Array, facets: IntArray) -> tuple[Array, IntArray, Array, Array]:
    """Admissible force nearest to y for every pair: r (3n,), directions left (n,), tau (n, 2), kappa (n,).

    Parameters
    ----------
    y : (3n,) n normals, n first and n second tangents
    m : (n, 2) half-axes of the section of size 1
    size : (n,) of the section at the normal force of y
    facets : (n,), see `nearest`
    """
    n = len(m)
    r, count = np.zeros(3 * n), np.zeros(n, np.int64)
    tau, kappa = np.zeros((n, 2)), np.zeros(n)
    for i in range(n):
        pressing = max(y[i], 0.0)
        r_1, r_2, left, t_1, t_2, stiff = nearest(y[n + i], y[2 * n + i], m[i, 0], m[i, 1], size[i], facets[i])
        r[i], r[n + i], r[2 * n + i], count[i] = pressing, r_1, r_2, left
        tau[i, 0], tau[i, 1], kappa[i] = t_1, t_2, stiff
    return r, count, tau, kappa


def outermost(directions: Array, m: Array, facets: IntArray) -> Array:
    """(n, 2) Point of each section of s = 1 that lies farthest along a direction (n, 2): a corner, or on the ellipse.

    Examples
    --------
    >>> outermost(np.array([[3.0, 4.0], [3.0, 4.0]]), np.ones((2, 2)), np.array([0, 4])).round(12).tolist()
    [[0.6, 0.8], [0.0, 1.0]]
    """
    stretched = m * directions
    angle = np.arctan2(stretched[:, 1], stretched[:, 0])
    between = 2.0 * np.pi / np.maximum(facets, 1)
    angle = np.where(facets > 0, between * np.round(angle / between), angle)
    still = (stretched == 0.0).all(axis=1)[:, None]
    return np.where(still, 0.0, m * np.column_stack([np.cos(angle), np.sin(angle)]))


def facets_of(m: Array, facets: IntArray, force: Array) -> tuple[Array, Array]:
    """Outward normals (k, n, 2) of the facets of sections of size 1, and their distances (k, n) from the origin.

    Infinitely far where a section has fewer. A smooth section has one, its tangent where the ray of the force (n, 2)
    leaves it; one that is a line has its two ends.

    Examples
    --------
    >>> normals, reach = facets_of(np.ones((1, 2)), np.array([4]), np.zeros((1, 2)))
    >>> (normals[0, 0] * 2**0.5).round(12).tolist(), reach[:, 0].round(12).tolist()
    ([1.0, 1.0], [0.707106781187, 0.707106781187, 0.707106781187, 0.707106781187])
    """
    n, flat = len(m), (m <= _NOTHING).any(axis=1)
    k = max(int(facets.max(initial=0)), 2 if flat.any() else 1)
    normals, reach = np.zeros((k, n, 2)), np.full((k, n), np.inf)
    over = np.divide(1.0, m, out=np.zeros_like(m), where=m > _NOTHING)
    for j in range(k):
        angle = (2 * j + 1) * np.pi / np.maximum(facets, 1)
        polygon = over * np.column_stack([np.cos(angle), np.sin(angle)])
        tangent = over**2 * force
        line = np.where(m > _NOTHING, (-1.0) ** j, 0.0)
        which = np.select([flat, facets > j, facets == 0], [0, 1, 2], 3)
        normal = np.stack([line, polygon, tangent, np.zeros_like(m)])[which, np.arange(n)]
        size = np.linalg.norm(normal, axis=1)
        has = (size > 0) & ((which == 1) | (j == 0) | ((which == 0) & (j < 2)))
        at = np.where(facets > 0, np.cos(np.pi / np.maximum(facets, 1)), np.linalg.norm(over * force, axis=1))
        at = np.where(flat, m.max(axis=1), at / np.where(has, size, 1.0))
        normals[j] = normal / np.where(has, size, 1.0)[:, None]
        reach[j, has] = at[has]
    return normals, reach
