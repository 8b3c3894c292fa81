# SPDX-License-Identifier: BSD-3-Clause
"""What a point of the plane stands for: the thickness, or the circle through it."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.fem.boundary import Boundary
from signorini.model.model import Model


def measure(model: Model, points: Array) -> Array:
    """Length perpendicular to the plane that belongs to points (..., 2): the thickness, or ``2 pi r``, (...).

    Integrals over a body or a boundary are those over the plane times this.
    """
    if model.axisymmetric:
        return 2.0 * np.pi * np.asarray(points)[..., 0]
    return np.full(np.shape(points)[:-1], float(model.thickness))


def facet_areas(model: Model, side: Boundary) -> Array:
    """Area that belongs to each quadrature point of the facets, (m, q)."""
    areas: Array = side.weights * measure(model, side.at)
    return areas


def nodal_areas(model: Model, side: Boundary) -> Array:
    """``int N_k dS`` of every node of a boundary, (k,) in the order of its nodes, length^2.

    Linear facets: the trapezoidal rule, except that a node on the axis of an axisymmetric body has its share of the
    circle around it, ``pi h^2 / 3``. Quadratic facets: 1/6, 1/6 and 4/6 of a straight one.
    """
    return side.nodal(facet_areas(model, side))


def nodal_normal_areas(model: Model, side: Boundary) -> Array:
    """``int N_k n dS`` of every node of a boundary with the outward normals, (k, d) in the order of its nodes."""
    return side.nodal(side.outward * measure(model, side.at)[..., None])
