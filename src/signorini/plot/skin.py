# SPDX-License-Identifier: BSD-3-Clause
"""The skin of bodies in space: the faces that no other cell of the same body covers, cut into pieces to be drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.model.mesh import FACETS

_CREASE_COSINE = np.cos(np.radians(35.0))  # of the angle between faces: beyond it their edge is one of the body
# by the number of the nodes of a face: its pieces, a triangle with its last corner twice; 8 is the middle
_PIECES = {
    3: [[0, 1, 2, 2]],
    4: [[0, 1, 2, 3]],
    6: [[0, 3, 5, 5], [3, 1, 4, 4], [5, 4, 2, 2], [3, 4, 5, 5]],
    9: [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
}
_FACE_OUTLINES = {3: [0, 1, 2], 4: [0, 1, 2, 3], 6: [0, 3, 1, 4, 2, 5], 9: [0, 4, 1, 5, 2, 6, 3, 7]}
_MIDDLE_WEIGHTS = np.array([-0.25] * 4 + [0.5] * 4)  # shape functions of an 8-node face in its middle


@dataclass(frozen=True, kw_only=True, eq=False)
class Skin:
    """Faces on the surface of bodies.

    Attributes
    ----------
    points : (n, 3) undeformed, length
    middles : (q, 8) nodes of the faces in whose middle the last q points lie; none of the mesh is there
    pieces : (m, 4) points of the parts of the faces, anticlockwise seen from outside; a triangle has its last twice
    edges : (e, 2) points at the ends of the edges of faces, cut at nodes in their middle
    face, edge_face : (m,) and (e,) which face a piece and an edge is of
    body : (f,) which body a face is of
    """

    points: Array
    middles: IntArray
    pieces: IntArray
    edges: IntArray
    face: IntArray
    edge_face: IntArray
    body: IntArray

    def values(self, given: Array) -> Array:
        """Values at the points from those at the nodes, (n, ...)."""
        return np.concatenate([given, np.einsum("qa...,a->q...", given[self.middles], _MIDDLE_WEIGHTS)])

    def part(self, faces: BoolArray) -> Skin:
        """A skin of some of the faces, (f,)."""
        number = np.cumsum(faces) - 1
        own, edges = faces[self.face], faces[self.edge_face]
        return Skin(
            points=self.points,
            middles=self.middles,
            pieces=self.pieces[own],
            edges=self.edges[edges],
            face=number[self.face[own]],
            edge_face=number[self.edge_face[edges]],
            body=self.body[faces],
        )

    def spans(self, points: Array) -> Array:
        """Outward normals of the faces with moved points, as long as their areas, (f, 3)."""
        return _summed(self.face, piece_spans(points[self.pieces]), len(self.body))

    @cached_property
    def sharp(self) -> BoolArray:
        """(e,) whether an edge is one of the body: the faces beside it, undeformed, look different ways."""
        ends = np.sort(self.edges, axis=1)
        number = np.unique(ends[:, 0] * len(self.points) + ends[:, 1], return_inverse=True)[1].ravel()
        spans = self.spans(self.points)
        unit = spans / np.maximum(np.linalg.norm(spans, axis=1, keepdims=True), 1e-300)
        # the sum of two unit vectors at an angle t is 2 cos(t / 2) long
        length = np.linalg.norm(_summed(number, unit[self.edge_face], int(number.max(initial=-1)) + 1), axis=1)
        smooth = (np.bincount(number) == 2) & (length >= 2.0 * np.sqrt(0.5 * (1.0 + _CREASE_COSINE)))
        return np.asarray(~smooth[number])


def make_skin(points: Array, blocks: Sequence[tuple[str, IntArray, IntArray]]) -> Skin:
    """The skin of cells.

    Parameters
    ----------
    points : (n, 3); bodies share none
    blocks : family of cells, their nodes (m, k) in the order of meshio and either orientation, the body of each (m,)
    """
    faces: dict[int, list[IntArray]] = {}
    owner: dict[int, list[IntArray]] = {}
    inner: dict[int, list[Array]] = {}
    for family, cells, body in blocks:
        middle = points[cells].mean(axis=1)
        for face in FACETS[family]:
            faces.setdefault(len(face), []).append(cells[:, list(face)])
            owner.setdefault(len(face), []).append(body)
            inner.setdefault(len(face), []).append(middle)
    middles: list[IntArray] = []
    pieces: list[IntArray] = []
    edges: list[IntArray] = []
    cuts: list[IntArray] = []  # of every face: how many pieces, how many edges, which body
    behind = len(points)
    for width, parts in faces.items():
        every = np.concatenate(parts)
        alone = _alone(every, len(points))
        own, body = every[alone], np.concatenate(owner[width])[alone]
        if width == 8:
            middles.append(own)
            own = np.column_stack([own, behind + np.arange(len(own))])
            behind += len(own)
        cut, around = _pieces(own, points, np.concatenate(inner[width])[alone]), own[:, _FACE_OUTLINES[own.shape[1]]]
        pieces.append(cut.reshape(-1, 4))
        edges.append(np.stack([around, np.roll(around, -1, axis=1)], axis=2).reshape(-1, 2))
        cuts.append(np.column_stack([np.full(len(own), cut.shape[1]), np.full(len(own), around.shape[1]), body]))
    middle = np.concatenate(middles) if middles else np.zeros((0, 8), np.int64)
    per_face = np.concatenate(cuts)
    number = np.arange(len(per_face))
    return Skin(
        points=np.concatenate([points, np.einsum("qai,a->qi", points[middle], _MIDDLE_WEIGHTS)]),
        middles=middle,
        pieces=np.concatenate(pieces),
        edges=np.concatenate(edges),
        face=np.repeat(number, per_face[:, 0]),
        edge_face=np.repeat(number, per_face[:, 1]),
        body=per_face[:, 2],
    )


def _alone(faces: IntArray, points: int) -> IntArray:
    """Indices of faces that are there once: their three smallest corners are those of no other one."""
    corners = np.sort(faces[:, : 3 if faces.shape[1] in (3, 6) else 4], axis=1).astype(np.int64)
    key = (corners[:, 0] * points + corners[:, 1]) * points + corners[:, 2]
    _, first, times = np.unique(key, return_index=True, return_counts=True)
    return np.sort(first[times == 1])


def _pieces(faces: IntArray, points: Array, inner: Array) -> IntArray:
    """Pieces of faces (f, k), (f, p, 4), which look away from the middles of the cells (f, 3)."""
    pieces = faces[:, np.array(_PIECES[faces.shape[1]])]
    a, b, c = points[faces[:, :3]].transpose(1, 0, 2)
    inwards = np.einsum("fi,fi->f", np.cross(b - a, c - a), a - inner) < 0.0
    pieces[inwards] = pieces[inwards][..., [0, 2, 1, 1] if faces.shape[1] in (3, 6) else [0, 3, 2, 1]]
    return pieces


def piece_spans(corners: Array) -> Array:
    """Normals of pieces (m, 4, 3), as long as their areas."""
    a, b, c, d = corners.transpose(1, 0, 2)
    return 0.5 * np.cross(c - a, d - b)


def _summed(index: IntArray, vectors: Array, count: int) -> Array:
    return np.stack([np.bincount(index, weights=part, minlength=count).astype(float) for part in vectors.T], axis=1)
