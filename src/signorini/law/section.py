# SPDX-License-Identifier: BSD-3-Clause
"""Sections of friction cones: the tangential forces that friction allows, and which of them is nearest, or farthest.

A section of size s is in the plane the interval ``|r_t| <= s``, in space the ellipse ``|(r_1 / a_1, r_2 / a_2)| <= s``
along the tangents of the pair, or the polygon inscribed in it. Around a point y its projection r is, to first order and
because the section grows in proportion to s,

    r(y') = s' e + q tau,    tau . (y' - r(y')) = kappa q

with e the point on the section of s = 1, tau the tangent of its boundary there and q its unknown share: every direction
is left where y lies inside (it sticks), one on a smooth boundary or an edge, none at a corner or at the end of an
interval. kappa = 0 on an edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.compilation import kernel, part

_ROOT_TOL = 1e-15  # of the root and of the axes: a step of Newton's method below it is rounding
_ROOT_STEPS = 100  # of Newton's method for the nearest point of an ellipse, which takes some five
_POINT = 1e-150  # half-axis whose square underflows: a section smaller than that is a point
_FLAT_AXIS = 1e-8  # of the largest half-axis: one that counts as none


@part()
def _on_ellipse(y_1: float, y_2: float, a_1: float, a_2: float) -> tuple[float, float, float, float, float]:
    """Nearest point of an ellipse with half-axes a from outside it, its tangent, and kappa.

    The point is ``r_i = a_i^2 y_i / (a_i^2 + t)`` with t the root of ``|a_i y_i / (a_i^2 + t)| = 1``, left of which
    Newton's method for the reciprocal of that norm rises without overshooting.
    """
    if a_1 == a_2:
        length = math.hypot(y_1, y_2)
        return a_1 * y_1 / length, a_1 * y_2 / length, -y_2 / length, y_1 / length, length / a_1 - 1.0
    t = max(a_1 * abs(y_1) - a_1**2, a_2 * abs(y_2) - a_2**2, 0.0)
    for _ in range(_ROOT_STEPS):
        f_1, f_2 = a_1 * y_1 / (a_1**2 + t), a_2 * y_2 / (a_2**2 + t)
        norm = math.hypot(f_1, f_2)
        slope = (f_1**2 / (a_1**2 + t) + f_2**2 / (a_2**2 + t)) / norm
        step = norm * (norm - 1.0) / slope
        t += step
        if step <= _ROOT_TOL * (t + a_1 * a_2):
            break
    f_1, f_2 = a_1 * y_1 / (a_1**2 + t), a_2 * y_2 / (a_2**2 + t)
    norm = math.hypot(f_1, f_2)
    r_1, r_2 = a_1 * f_1 / norm, a_2 * f_2 / norm
    n_1, n_2 = r_1 / a_1**2, r_2 / a_2**2
    length = math.hypot(n_1, n_2)
    tau_1, tau_2 = -n_2 / length, n_1 / length
    return r_1, r_2, tau_1, tau_2, t * ((tau_1 / a_1) ** 2 + (tau_2 / a_2) ** 2)


@part()
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


@kernel()
def nearest_point(
    y_1: float, y_2: float, m_1: float, m_2: float, s: float, facets: int
) -> tuple[float, float, int, float, float, float]:
    """The projection r of y on the section, directions left to it (0, 1, 2), tau and kappa.

    Parameters
    ----------
    y_1, y_2 : the point
    m_1, m_2 : half-axes of the section for s = 1, 0 or more
    s : size of the section, 0 or more
    facets : corners of the polygon inscribed in the ellipse, a multiple of 4, the first on the first axis; 0 for the
        ellipse itself

    Examples
    --------
    >>> nearest_point(3.0, 4.0, 0.5, 0.5, 2.0, 0)
    (0.6, 0.8, 1, -0.8, 0.6, 4.0)
    """
    a_1, a_2 = m_1 * s, m_2 * s
    if a_1 <= _POINT and a_2 <= _POINT:
        return 0.0, 0.0, 0, 0.0, 0.0, 0.0
    if a_1 <= _POINT:
        return 0.0, min(max(y_2, -a_2), a_2), 1 if abs(y_2) <= a_2 else 0, 0.0, 1.0, 0.0
    if a_2 <= _POINT:
        return min(max(y_1, -a_1), a_1), 0.0, 1 if abs(y_1) <= a_1 else 0, 1.0, 0.0, 0.0
    if facets:
        r_1, r_2, count, tau_1, tau_2 = _on_polygon(y_1, y_2, a_1, a_2, facets)
        return r_1, r_2, count, tau_1, tau_2, 0.0
    if math.hypot(y_1 / a_1, y_2 / a_2) <= 1.0:
        return y_1, y_2, 2, 0.0, 0.0, 0.0
    r_1, r_2, tau_1, tau_2, kappa = _on_ellipse(y_1, y_2, a_1, a_2)
    return r_1, r_2, 1, tau_1, tau_2, kappa


@kernel()
def _project_all(y: Array, axes: Array, size: Array, sides: IntArray) -> tuple[Array, IntArray, Array, Array]:
    """`nearest_point` for every pair: y (2, n), axes (2, n), size and sides (n,)."""
    n = len(size)
    r, left = np.zeros((2, n)), np.zeros(n, np.int64)
    tau, kappa = np.zeros((2, n)), np.zeros(n)
    for i in range(n):
        r[0, i], r[1, i], left[i], tau[0, i], tau[1, i], kappa[i] = nearest_point(
            y[0, i], y[1, i], axes[0, i], axes[1, i], size[i], sides[i]
        )
    return r, left, tau, kappa


@dataclass(frozen=True, kw_only=True, eq=False)
class Projection:
    """Points of sections nearest to given ones, and what happens around them to first order (see above).

    Attributes
    ----------
    r : (d - 1, n) the points
    left : (n,) number of directions that are left
    tau : (d - 1, n) the direction where one is left of two, otherwise 0
    kappa : (n,) how much farther a point moves than its projection along it
    """

    r: Array
    left: IntArray
    tau: Array
    kappa: Array

    @property
    def inside(self) -> BoolArray:
        """(n,) Pairs whose point lies in its section."""
        return np.asarray(self.left == len(self.r), dtype=np.bool_)

    @property
    def slope(self) -> Array:
        """(d - 1, d - 1, n) Derivative of the projection while sections keep their size: symmetric, from 0 to 1."""
        share = np.where(self.left * (len(self.r) - self.left) == 1, 1.0 / (1.0 + self.kappa), 0.0)
        stick = np.eye(len(self.r))[:, :, None] * self.inside
        return np.asarray(stick + share * self.tau[:, None] * self.tau[None, :], dtype=np.float64)


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionSection:
    """Sections of n pairs, of size 1.

    Attributes
    ----------
    axes : (d - 1, n) half-axes along the tangents, the largest 1; 0 along a tangent without friction. In the plane 1
    sides : (n,) corners of the polygon inscribed in the ellipse, a multiple of 4, the first on the first axis; 0 for
        the ellipse itself
    """

    axes: Array
    sides: IntArray

    @classmethod
    def round(cls, directions: int, pairs: int) -> FrictionSection:
        """Intervals (1 direction) or circles (2 directions) of some pairs."""
        return cls(axes=np.ones((directions, pairs)), sides=np.zeros(pairs, dtype=np.int64))

    def among(self, kept: BoolArray | IntArray) -> FrictionSection:
        """The sections of some of the pairs."""
        return FrictionSection(axes=self.axes[:, kept], sides=self.sides[kept])

    def project(self, y: Array, size: Array) -> Projection:
        """The points of sections of some size, (n,), nearest to points y, (d - 1, n).

        Examples
        --------
        >>> found = FrictionSection.round(2, 2).project(np.array([[3.0, 0.1], [4.0, 0.0]]), np.ones(2))
        >>> found.r.round(12).tolist(), found.left.tolist(), found.kappa.tolist()
        ([[0.6, 0.1], [0.8, 0.0]], [1, 2], [4.0, 0.0])
        """
        if len(self.axes) == 1:
            left = ((np.abs(y[0]) <= size) & (size > _POINT)).astype(np.int64)
            return Projection(r=self.nearest(y, size), left=left, tau=np.zeros_like(y), kappa=np.zeros(len(size)))
        r, left, tau, kappa = _project_all(y, self.axes, size, self.sides)
        return Projection(r=r, left=left, tau=tau, kappa=kappa)

    def nearest(self, y: Array, size: Array) -> Array:
        """(d - 1, n) The points alone of `project`, of points y, (d - 1, n), and sections of some size, (n,)."""
        if len(self.axes) == 1:
            return np.asarray(np.minimum(np.maximum(y, -size), size), dtype=np.float64)
        return _project_all(y, self.axes, size, self.sides)[0]

    def effort(self, force: Array) -> Array:
        """(n,) Size of the section on whose boundary a force, (d - 1, n), lies: what friction has to be as large as.

        ``|(r_1 / a_1, r_2 / a_2)|``, and for a polygon what the circle that it is inscribed in has to be as large as.

        Examples
        --------
        >>> section = FrictionSection(axes=np.array([[1.0, 1.0], [0.5, 1.0]]), sides=np.array([0, 4]))
        >>> section.effort(np.array([[0.3, 1.0], [0.2, 1.0]])).round(12).tolist()
        [0.5, 2.0]
        """
        scaled = force / np.maximum(self.axes, _FLAT_AXIS)
        size = np.linalg.norm(scaled, axis=0)
        on = self.sides > 0
        if not on.any():
            return np.asarray(size, dtype=np.float64)
        half = np.pi / np.maximum(self.sides, 1)
        beside = np.mod(np.arctan2(scaled[-1], scaled[0]), 2.0 * half) - half
        return np.where(on, size * np.cos(beside) / np.cos(half), size)

    def farthest(self, direction: Array) -> Array:
        """(d - 1, n) Point of every section that lies farthest along a direction, (d - 1, n), of any length; 0 gives 0.

        Examples
        --------
        >>> section = FrictionSection(axes=np.ones((2, 2)), sides=np.array([0, 4]))
        >>> section.farthest(np.array([[3.0, 3.0], [4.0, 4.0]])).round(12).tolist()
        [[0.6, 0.0], [0.8, 1.0]]
        """
        scaled = self.axes * direction
        size = np.linalg.norm(scaled, axis=0)
        unit = np.divide(scaled, size, out=np.zeros_like(scaled), where=size > 0)
        on = (self.sides > 0) & (size > 0)
        if on.any():
            between = 2.0 * np.pi / self.sides[on]
            angle = between * np.round(np.arctan2(unit[1, on], unit[0, on]) / between)
            unit[:, on] = np.cos(angle), np.sin(angle)
        return np.asarray(self.axes * unit, dtype=np.float64)

    def facets(self, force: Array) -> tuple[Array, Array]:
        """Outward normals (k, d - 1, n) of the facets, and their distances (k, n) from the origin.

        Infinitely far where a section has fewer. A smooth section has one, its tangent where the ray of the force,
        (d - 1, n), leaves it; one that is a line has its two ends.

        Examples
        --------
        >>> normals, reach = FrictionSection(axes=np.ones((2, 1)), sides=np.array([4])).facets(np.zeros((2, 1)))
        >>> (normals[0, :, 0] * 2**0.5).round(12).tolist(), reach[:, 0].round(12).tolist()
        ([1.0, 1.0], [0.707106781187, 0.707106781187, 0.707106781187, 0.707106781187])
        """
        m, sides = self.axes, self.sides
        n, line = len(sides), (m <= _POINT).any(axis=0) | (len(m) == 1)
        k = max(int(sides.max(initial=0)), 2 if line.any() else 1)
        normals, reach = np.zeros((k, *m.shape)), np.full((k, n), np.inf)
        over = np.divide(1.0, m, out=np.zeros_like(m), where=m > _POINT)
        for j in range(k):
            angle = (2 * j + 1) * np.pi / np.maximum(sides, 1)
            polygon = over * np.stack([np.cos(angle), np.sin(angle)])[: len(m)]
            end = np.where(m > _POINT, (-1.0) ** j, 0.0)
            which = np.select([line, sides > j, sides == 0], [0, 1, 2], 3)
            normal = np.stack([end, polygon, over**2 * force, np.zeros_like(m)])[which, :, np.arange(n)].T
            size = np.linalg.norm(normal, axis=0)
            has = (size > 0) & ((which == 1) | (j == 0) | ((which == 0) & (j < 2)))
            at = np.where(sides > 0, np.cos(np.pi / np.maximum(sides, 1)), np.linalg.norm(over * force, axis=0))
            at = np.where(line, m.max(axis=0), at / np.where(has, size, 1.0))
            normals[j] = normal / np.where(has, size, 1.0)
            reach[j, has] = at[has]
        return normals, reach
