# SPDX-License-Identifier: BSD-3-Clause
"""Gaps that faces feign between curved surfaces that are meant to match."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.coupling import Coupling
from signorini.interface.spatial.faces import node_places
from signorini.interface.spatial.surface import Block, Surface

_KINK = np.pi / 6.0  # a turn between two faces beyond this is an edge of the body, not a curve
_STRAIGHT = 1e-9  # a turn below this is rounding
_ROOM = 1.25  # times the bound: curvatures are estimates
_TINY = 1e-12  # of the size of the side: a gap that is rounding
_QUADRATIC = {6: 4.0, 8: 10.0, 9: 4.0}  # times the sag of an edge: what a face may be off, by its nodes
_BESIDE = 1.6  # times bulge and how far its middle node is beside the middle: what an edge may be off by that


def without_chords(gap: Array, coupling: Coupling, nonmortar: Surface, mortar: Surface) -> Array:
    """Gaps (k,), 0 where they are no more than what faces leave between two surfaces that are meant to match.

    Two different nets of flat faces on one surface of curvature kappa are up to ``h^2 kappa / 8`` of both apart, h the
    diameter of a face, of quadratic ones a few ``h^4 kappa^3 / 512``, h the length of an edge: it would ruin the
    pressure. All gaps must be as small as that, and one side hollow where the other bulges: otherwise they are meant,
    and stay.

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
    """(2, k) How far faces at each node may be off a smooth surface, where it bulges and where it is hollow."""
    found = np.zeros((2, len(side.nodes)))
    parts = _chord_sags(side) if side.linear else [(block.faces, _curved_sags(block)) for block in side.blocks]
    for nodes, sags in parts:
        for kind, own in enumerate((np.maximum(sags, 0.0), np.maximum(-sags, 0.0))):
            np.maximum.at(found[kind], np.searchsorted(side.nodes, nodes), own.max(axis=0)[:, None])
    return _continued(side, found) if side.linear else found


def _continued(side: Surface, found: Array) -> Array:
    """Sags (2, k) of flat faces, at the rim of the side as beside it where no face there turns to a neighbour.

    The two triangles of a plane quadrilateral do not turn to each other: one at the rim may have no other neighbour.
    """
    edges, _, start = _edges(side)
    rim = np.zeros(len(side.nodes), np.bool_)
    rim[np.searchsorted(side.nodes, edges[start[:-1][np.diff(start) == 1]])] = True
    beside = np.zeros_like(found)
    for block in side.blocks:
        place = np.searchsorted(side.nodes, block.corners)
        for kind in (0, 1):
            np.maximum.at(beside[kind], place, found[kind][place].max(axis=1, keepdims=True))
    return np.where(rim & (found == 0.0).all(axis=0), beside, found)


def _curved_sags(block: Block) -> Array:
    """(2, m) How far quadratic faces may be off a smooth surface: largest and, negative, smallest of their edges.

    Of an edge ``h^4 kappa^3 / 512``, in terms of its bulge ``b = h^2 kappa / 8`` that is ``b^3 / h^2``; where its
    middle node is beside the middle the surface is a cubic of the reference coordinate there, a parabola too. Faces of
    8 nodes lack ``x^2 y^2``.
    """
    corners = block.corners.shape[1]
    first = block.points[:, :corners]
    chord = np.roll(first, -1, axis=1) - first
    length = np.linalg.norm(chord, axis=2)
    normal = block.outward(node_places(block.nodes_a_face)[corners : 2 * corners])
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    middle = (block.points[:, corners : 2 * corners] - first - 0.5 * chord) / length[..., None]
    bulge, beside = np.sum(middle * normal, axis=2), np.abs(np.sum(middle * chord, axis=2)) / length
    bulge[np.abs(bulge) < _STRAIGHT] = 0.0
    sags = length * bulge * (_QUADRATIC[block.nodes_a_face] * bulge**2 + _BESIDE * beside)
    return np.stack([sags.max(axis=1), sags.min(axis=1)])


def _chord_sags(side: Surface) -> list[tuple[IntArray, Array]]:
    """Corners of flat faces by block, and ``h^2 kappa / 8`` (2, m) of the largest turn either way to a neighbour."""
    faces, centres, normals, diameters = _faces(side)
    one, two = _neighbours(side)
    across = centres[two] - centres[one]
    sine = np.linalg.norm(np.cross(normals[one], normals[two]), axis=1)
    turn = np.arctan2(sine, np.sum(normals[one] * normals[two], axis=1))
    bends = np.sum((normals[two] - normals[one]) * across, axis=1)
    curvature = np.sign(bends) * turn / np.linalg.norm(across, axis=1)
    smooth = (turn > _STRAIGHT) & (turn < _KINK)
    sags = np.zeros((2, len(centres)))
    for face in (one[smooth], two[smooth]):
        sag = diameters[face] ** 2 * curvature[smooth] / 8.0
        np.maximum.at(sags[0], face, sag)
        np.minimum.at(sags[1], face, sag)
    return [(nodes, sags[:, face]) for face, nodes in faces]


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
    _, faces, start = _edges(side)
    pairs = start[:-1][np.diff(start) == 2]
    return faces[pairs], faces[pairs + 1]


def _edges(side: Surface) -> tuple[IntArray, IntArray, IntArray]:
    """Edges of all faces (e, 2), equal ones behind each other, the face of each, and where different ones start."""
    ends, owner, first = [], [], 0
    for block in side.blocks:
        corners = block.corners
        ends.append(np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2))
        owner.append(np.repeat(first + np.arange(len(corners)), corners.shape[1]))
        first += len(corners)
    edges, faces = np.sort(np.concatenate(ends), axis=1), np.concatenate(owner)
    order = np.lexsort(edges.T)
    edges, faces = edges[order], faces[order]
    new: BoolArray = np.ones(len(edges) + 1, np.bool_)
    new[1:-1] = (edges[1:] != edges[:-1]).any(axis=1)
    return edges, faces, np.flatnonzero(new)
