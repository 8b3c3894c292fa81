# SPDX-License-Identifier: BSD-3-Clause
"""Sections of the friction cones of pairs: circles, ellipses along the tangents, polygons inscribed in them."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray

_NONE = 1e-8  # of the largest coefficient: what counts as none


def effort(tangential: Array, anisotropy: Array, facets: IntArray) -> Array:
    """(n,) Size of tangential forces as friction feels it: friction carries up to its coefficient times the pressing.

    ``|(t_1 / a_1, t_2 / a_2)|``, and for a polygon what the circle that it is inscribed in has to be as large as.

    Parameters
    ----------
    tangential : (n, d - 1) forces
    anisotropy : (n, d - 1) coefficient along every tangent over the largest one
    facets : (n,) corners of the polygon, the first on the first tangent; 0 for none

    Examples
    --------
    >>> effort(np.array([[0.3, 0.2], [1, 1]]), np.array([[1.0, 0.5], [1.0, 1.0]]), np.array([0, 4])).round(12).tolist()
    [0.5, 2.0]
    """
    scaled = tangential / np.maximum(anisotropy, _NONE)
    size = np.linalg.norm(scaled, axis=1)
    on = facets > 0
    if not on.any():
        return np.asarray(size, dtype=np.float64)
    half = np.pi / np.maximum(facets, 1)
    beside = np.mod(np.arctan2(scaled[:, -1], scaled[:, 0]), 2.0 * half) - half
    return np.where(on, size * np.cos(beside) / np.cos(half), size)


def farthest(direction: Array, anisotropy: Array, facets: IntArray) -> Array:
    """(n, d - 1) Point of every section that lies farthest along a direction, for a largest coefficient of 1.

    Parameters
    ----------
    direction : (n, d - 1), of any length; 0 gives 0
    anisotropy, facets : see `effort`

    Examples
    --------
    >>> farthest(np.array([[3.0, 4.0], [3.0, 4.0]]), np.ones((2, 2)), np.array([0, 4])).round(12).tolist()
    [[0.6, 0.8], [0.0, 1.0]]
    """
    scaled = anisotropy * direction
    size = np.linalg.norm(scaled, axis=1)[:, None]
    unit = np.divide(scaled, size, out=np.zeros_like(scaled), where=size > 0)
    on = facets > 0
    if on.any():
        between = 2.0 * np.pi / facets[on]
        angle = between * np.round(np.arctan2(unit[on, 1], unit[on, 0]) / between)
        unit[on] = np.where(size[on] > 0, np.column_stack([np.cos(angle), np.sin(angle)]), 0.0)
    return np.asarray(anisotropy * unit, dtype=np.float64)
