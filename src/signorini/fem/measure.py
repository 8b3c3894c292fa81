# SPDX-License-Identifier: BSD-3-Clause
"""What a point of the plane stands for: the thickness, or the circle through it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.facet_block import FacetBlock
from signorini.model.model import Model


def measure(model: Model, points: Array, cells: IntArray) -> Array:
    """Length perpendicular to the plane that belongs to points of cells: the thickness, or ``2 pi r``, (m, q).

    Integrals over a body or a boundary are those over the plane times this.

    Parameters
    ----------
    model : tells the thickness, or that it is axisymmetric
    points : (m, q, d)
    cells : (m,) numbers of the cells that they are in
    """
    if model.axisymmetric:
        return 2.0 * np.pi * np.asarray(points)[..., 0]
    return np.broadcast_to(model.cell_thickness[cells][:, None], np.shape(points)[:-1])


def measure_of_cells(model: Model, places: Callable[[], Array], cells: IntArray) -> Array:
    """Thickness, or ``2 pi r``, at all points of cells, (m, q); (m, 1) where it is one, and places are not asked for.

    Parameters
    ----------
    model : tells the thickness, or that it is axisymmetric
    places : gives the points, (m, q, d)
    cells : (m,) their numbers
    """
    return measure(model, places(), cells) if model.axisymmetric else model.cell_thickness[cells][:, None]


def contact_measure(model: Model, points: Array, one: IntArray, other: IntArray) -> Array:
    """Thickness or circumference where two bodies touch, (m, q): they lie on one middle plane, so the thinner one's.

    Parameters
    ----------
    model : tells the thickness, or that it is axisymmetric
    points : (m, q, d) where they touch, length
    one, other : (m,) numbers of the cells opposite each other
    """
    smaller: Array = np.minimum(measure(model, points, one), measure(model, points, other))
    return smaller


def facet_areas(model: Model, block: FacetBlock) -> Array:
    """Area that belongs to each quadrature point of the facets, (m, q)."""
    areas: Array = block.weights * measure(model, block.at, block.cells)
    return areas
