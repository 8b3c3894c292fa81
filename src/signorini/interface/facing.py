# SPDX-License-Identifier: BSD-3-Clause
"""What of two sides may be opposite each other, its number linear in that of both: by spheres, and where they look."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, BoolArray, IntArray, extent
from signorini.fem.boundary import Boundary

FACING = -0.05  # cosine between outward normals: from here on two facets look at each other
_SAME_PLACE_TOL = 1e-6  # of the longest facet: how far apart sides are that lie in each other


def search_distance(nonmortar: Boundary, mortar: Boundary, search: float | None) -> float:
    """How far apart facets can be and still be opposite each other, length.

    Parameters
    ----------
    nonmortar, mortar : both sides
    search : as given; None: half the size of the smaller side
    """
    if search is not None:
        return search
    return 0.5 * min(float(np.linalg.norm(extent(side.points[side.nodes]))) for side in (nonmortar, mortar))


def in_one_place(nonmortar: Boundary, mortar: Boundary) -> bool:
    """Whether sides lie in each other and look the same way, as bodies do that are drawn over each other."""
    distance, nearest = KDTree(mortar.points[mortar.nodes]).query(nonmortar.points[nonmortar.nodes])
    normals = mortar.nodal_normals[nearest]
    if (np.sum(nonmortar.nodal_normals * normals, axis=1) < -FACING).any():
        return False
    across = nonmortar.points[nonmortar.nodes] - mortar.points[mortar.nodes[nearest]]
    apart, size = np.abs(np.sum(across * normals, axis=1)), float(mortar.lengths.max())
    return bool((apart <= _SAME_PLACE_TOL * size).all() and (distance <= size).all())


def near(
    points: Array, centres: Array, radius: Array | float, sizes: Array | float, search: float
) -> tuple[IntArray, IntArray]:
    """Pairs of points and centres of what is around them that may be opposite each other along some normal.

    Along the normal the other side can be twice as far as the closest centre, which is 60 degrees aside. Facets of the
    other side are looked for with others of their size, so that a few large ones do not make small ones all near.

    Parameters
    ----------
    points : (p, d) nodes, or centres of facets
    centres : (m, d) of the facets of the other side
    radius, sizes : (p,) and (m,), or numbers: how far from its centre a facet may reach, length
    search : how far apart they can be along the normal, length

    Returns
    -------
    i, j : (k,) sorted by i, then by j

    Examples
    --------
    >>> i, j = near(np.array([[0.0, 0.0], [5.0, 0.0]]), np.array([[0.0, 1.0], [5.0, 3.0]]), 0.25, 0.25, 2.0)
    >>> i.tolist(), j.tolist()
    ([0], [0])
    """
    closest, _ = KDTree(centres).query(points)
    reach = radius + np.minimum(2.0 * closest, search)
    width = np.broadcast_to(sizes, len(centres))
    octave = np.frexp(width)[1]
    first, second = [np.empty(0, int)], [np.empty(0, int)]
    for each in np.unique(octave):
        own = np.flatnonzero(octave == each)
        farthest = (reach + width[own].max()) * (1.0 + 1e-9)
        lists = KDTree(centres[own]).query_ball_point(points, farthest, return_sorted=True)
        first.append(np.repeat(np.arange(len(points)), [len(found) for found in lists]))
        second.append(own[np.concatenate([np.asarray(found, int) for found in lists])])
    i, j = np.concatenate(first), np.concatenate(second)
    order = np.lexsort([j, i])
    return i[order], j[order]


def near_pairs(first: Array, second: Array, search: float) -> tuple[IntArray, IntArray]:
    """Pairs of pieces that may overlap along the normal of the first, their number linear in that of the pieces.

    Parameters
    ----------
    first, second : (p, c, 3) corners of the pieces
    search : how far apart they can be along the normal, length

    Returns
    -------
    i, j : (k,) sorted by i
    """
    centre_1, radius_1, normal_1 = _bounds(first)
    centre_2, radius_2, normal_2 = _bounds(second)
    i, j = near(centre_1, centre_2, radius_1, radius_2, search)
    across = centre_2[j] - centre_1[i]
    height = np.sum(across * normal_1[i], axis=1)
    beside = np.sqrt(np.maximum(np.sum(across**2, axis=1) - height**2, 0.0))
    facing = np.sum(normal_1[i] * normal_2[j], axis=1) < FACING
    touching = beside <= (radius_1[i] + radius_2[j]) * (1.0 + 1e-9)
    within = np.abs(height) <= search + radius_1[i] + radius_2[j]
    chosen = facing & touching & within
    return i[chosen], j[chosen]


def nearest_layers(area: Array, distance: Array, i: IntArray, whole: Array, search: float) -> BoolArray:
    """(k,) Pairs that are opposite each other within ``search``; where some lie behind others only the nearest.

    Parameters
    ----------
    area, distance : (k,) common area and distance along the normal
    i : (k,) first piece of each pair, sorted
    whole : (p,) area of the first pieces
    """
    there = (area > 0) & (np.abs(distance) <= search)
    order = np.lexsort([np.abs(distance), i])
    covered = np.cumsum(np.where(there, area, 0.0)[order])
    start = np.searchsorted(i, i, side="left")
    before = np.concatenate([[0.0], covered])[start]
    share = np.empty_like(area)
    share[order] = covered - before
    return there & (share <= whole[i] * (1.0 + 1e-6))


def piece_spans(pieces: Array) -> Array:
    """(p, d) Outward normals of edges (p, 2, 2), as long as they, or of pieces (p, 3 or 4, 3), as long as twice their
    areas: from their diagonals.
    """
    if pieces.shape[2] == 2:
        along = pieces[:, 1] - pieces[:, 0]
        return np.stack([along[:, 1], -along[:, 0]], axis=1)
    return np.cross(pieces[:, 2] - pieces[:, 0], pieces[:, -1] - pieces[:, 1])


def piece_normals(pieces: Array) -> Array:
    """(p, d) Outward unit normals of edges (p, 2, 2) or pieces (p, 3 or 4, 3)."""
    spans = piece_spans(pieces)
    return np.asarray(spans / np.linalg.norm(spans, axis=1, keepdims=True))


def _bounds(pieces: Array) -> tuple[Array, Array, Array]:
    """Centres, radii and outward unit normals of pieces."""
    centre = pieces.mean(axis=1)
    radius = np.linalg.norm(pieces - centre[:, None], axis=2).max(axis=1)
    return centre, radius, piece_normals(pieces)
