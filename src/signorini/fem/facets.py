# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions and quadratures of the facets of cells: edges in the plane, triangles and quadrilaterals in space."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import skfem

from signorini.arrays import Array
from signorini.fem.line import line_shapes

_EDGE_POINTS = {2: 2, 3: 4}  # of Gauss, by nodes of an edge: exact for pressure on both, with a radius too
_FACES: Mapping[int, tuple[type[skfem.Element], int]] = {
    # nodes: element, degree of polynomials that the quadrature integrates exactly
    3: (skfem.ElementTriP1, 2),
    4: (skfem.ElementQuad1, 3),
    6: (skfem.ElementTriP2, 4),
    8: (skfem.ElementQuadS2, 5),
    9: (skfem.ElementQuad2, 5),
}


def facet_shapes(dimension: int, count: int, at: Array) -> tuple[Array, Array]:
    """Values (q, count) and derivatives (q, count, dimension - 1) of the shape functions of a facet.

    Parameters
    ----------
    dimension : of space
    count : nodes of the facet
    at : (q, dimension - 1) reference coordinates: -1 to 1 on an edge, 0 to 1 on a face

    Examples
    --------
    >>> facet_shapes(3, 4, np.array([[0.5, 0.5]]))[0]
    array([[0.25, 0.25, 0.25, 0.25]])
    """
    if dimension == 2:
        values, slopes = line_shapes(count, at[:, 0])
        return values, slopes[..., None]
    element = _FACES[count][0]()
    where = np.ascontiguousarray(at.T)
    found = [element.lbasis(where, i) for i in range(count)]
    values = np.stack([np.broadcast_to(value, where.shape[1:]) for value, _ in found], axis=1)
    slopes = np.stack([np.broadcast_to(slope, where.shape).T for _, slope in found], axis=1)
    return values, slopes


@cache
def facet_rule(dimension: int, count: int) -> tuple[Array, Array]:
    """Quadrature points (q, dimension - 1) and weights (q,) of a facet with ``count`` nodes."""
    if dimension == 2:
        at, weights = np.polynomial.legendre.leggauss(_EDGE_POINTS[count])
        return at[:, None], weights
    element, degree = _FACES[count]
    at, weights = skfem.quadrature.get_quadrature(element.refdom, degree)
    return np.ascontiguousarray(at.T), weights


@cache
def facet_nodes(dimension: int, count: int) -> Array:
    """Reference coordinates of the nodes of a facet, (count, dimension - 1)."""
    if dimension == 2:
        return np.array([-1.0, 1.0, 0.0][:count])[:, None]
    return np.array(_FACES[count][0].doflocs, float)
