# SPDX-License-Identifier: BSD-3-Clause
"""Which pieces of two sides can lie opposite each other: by bounding spheres and by where they look."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.near import near

FACING = -0.05
"""Cosine between outward normals from which on two faces look at each other."""


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
    i, j = near(centre_1, centre_2, radius_1 + radius_2.max(), search)
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


def _bounds(pieces: Array) -> tuple[Array, Array, Array]:
    """Centres, radii and outward unit normals of pieces."""
    centre = pieces.mean(axis=1)
    radius = np.linalg.norm(pieces - centre[:, None], axis=2).max(axis=1)
    normal = np.cross(pieces[:, 2] - pieces[:, 0], pieces[:, -1] - pieces[:, 1])
    return centre, radius, normal / np.linalg.norm(normal, axis=1, keepdims=True)
