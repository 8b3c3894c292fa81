# SPDX-License-Identifier: BSD-3-Clause
"""Gaps that flat faces feign between curved surfaces that are meant to match."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.coupling import Coupling
from signorini.interface.spatial.surface import Surface

_KINK = np.pi / 6.0  # a turn between two faces beyond this is an edge of the body, not a curve
_STRAIGHT = 1e-9  # a turn below this is rounding
_ROOM = 1.25  # times the bound: curvatures are estimates
_TINY = 1e-12  # of the size of the side: a gap that is rounding


def without_chords(gap: Array, coupling: Coupling, nonmortar: Surface, mortar: Surface) -> Array:
    """Gaps (k,), 0 where they are no more than what faces leave between two surfaces that are meant to match.

    Two different nets of flat faces on one surface of curvature kappa are up to ``h^2 kappa / 8`` of both apart, h the
    diameter of a face: it would ruin the pressure. All gaps must be as small as that, and one side hollow where the
    other bulges: otherwise they are meant, and stay. Quadratic faces are left alone.

    Parameters
    ----------
    gap : (k,) from the geometry, length
    coupling : of the two sides

    Examples
    --------
    >>> from signorini.interface.spatial import make_surface, mortar_coupling
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> points = np.concatenate([square + [0, 0, 0.01], square])
    >>> upper, lower = make_surface(points, [[3, 2, 1, 0]]), make_surface(points, [[4, 5, 6, 7]])
    >>> without_chords(np.full(4, 0.01), mortar_coupling(upper, lower), upper, lower).tolist()  # flat: meant
    [0.01, 0.01, 0.01, 0.01]
    """
    if not (nonmortar.linear and mortar.linear):
        return gap
    count = coupling.relative.shape[1]
    own, other = np.zeros((2, count)), np.zeros((2, count))
    own[:, nonmortar.nodes], other[:, mortar.nodes] = _sags(nonmortar), _sags(mortar)
    pattern = coupling.relative.tocoo()
    opposite = np.zeros((2, len(gap)))
    for kind in (0, 1):
        np.maximum.at(opposite[kind], pattern.row, other[kind][pattern.col])
    mine = own[:, coupling.nodes]
    # bulging against hollow, and hollow against bulging
    fits = sum(np.where((mine[k] > 0) & (opposite[1 - k] > 0), mine[k] + opposite[1 - k], 0.0) for k in (0, 1))
    size = float(np.ptp(nonmortar.points[nonmortar.nodes], axis=0).max())
    meant = np.abs(gap) > _ROOM * fits + _TINY * size
    return gap if meant.any() else np.zeros_like(gap)


def _sags(side: Surface) -> Array:
    """(2, k) Largest ``h^2 kappa / 8`` of the faces at each node, where the side bulges and where it is hollow."""
    faces, centres, normals, diameters = _faces(side)
    one, two = _neighbours(side)
    across = centres[two] - centres[one]
    sine = np.linalg.norm(np.cross(normals[one], normals[two]), axis=1)
    turn = np.arctan2(sine, np.sum(normals[one] * normals[two], axis=1))
    bends = np.sum((normals[two] - normals[one]) * across, axis=1)
    curvature = np.sign(bends) * turn / np.linalg.norm(across, axis=1)
    smooth = (turn > _STRAIGHT) & (turn < _KINK)
    of_faces = np.zeros((2, len(centres)))
    for kind, sign in ((0, 1.0), (1, -1.0)):
        bending = smooth & (sign * curvature > 0)
        for face in (one[bending], two[bending]):
            np.maximum.at(of_faces[kind], face, diameters[face] ** 2 * np.abs(curvature[bending]) / 8.0)
    result = np.zeros((2, len(side.nodes)))
    for face, nodes in faces:
        for kind in (0, 1):
            np.maximum.at(result[kind], np.searchsorted(side.nodes, nodes), of_faces[kind][face][:, None])
    return result


def _faces(side: Surface) -> tuple[list[tuple[IntArray, IntArray]], Array, Array, Array]:
    """Numbers and corners of the faces by block; centres, unit normals and diameters of all."""
    faces: list[tuple[IntArray, IntArray]] = []
    centres, normals, diameters, start = [], [], [], 0
    for block in side.blocks:
        x = block.points[:, : block.corners.shape[1]]
        normal = np.cross(x[:, 2] - x[:, 0], x[:, -1] - x[:, 1])
        faces.append((start + np.arange(len(x)), block.corners))
        centres.append(x.mean(axis=1))
        normals.append(normal / np.linalg.norm(normal, axis=1, keepdims=True))
        diameters.append(np.linalg.norm(x[:, :, None] - x[:, None], axis=3).max(axis=(1, 2)))
        start += len(x)
    return faces, np.concatenate(centres), np.concatenate(normals), np.concatenate(diameters)


def _neighbours(side: Surface) -> tuple[IntArray, IntArray]:
    """Faces on both sides of every edge that two share."""
    ends, owner, start = [], [], 0
    for block in side.blocks:
        corners = block.corners
        ends.append(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2))
        owner.append(np.repeat(start + np.arange(len(corners)), corners.shape[1]))
        start += len(corners)
    edges, faces = np.sort(np.concatenate(ends), axis=1), np.concatenate(owner)
    order = np.lexsort(edges.T)
    edges, faces = edges[order], faces[order]
    first: BoolArray = np.ones(len(edges) + 1, np.bool_)
    first[1:-1] = (edges[1:] != edges[:-1]).any(axis=1)
    start_of = np.flatnonzero(first)
    pairs = start_of[:-1][np.diff(start_of) == 2]
    return faces[pairs], faces[pairs + 1]
