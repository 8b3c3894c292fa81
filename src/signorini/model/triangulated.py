# SPDX-License-Identifier: BSD-3-Clause
"""A rigid surface of triangles: how far points are from it, on which side, and which way is out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.checks import rows
from signorini.errors import InputError, spell_point
from signorini.model.boxes import BoxTree
from signorini.short import Short

_ON = 1e-12  # of the size of the surface: a point so near lies on it
_HEIGHT_TOL = 1e-12  # height of a triangle without area, of its longest edge
_BEHIND_COSINE = 0.5**0.5  # cosine: a point at the border is behind it if it lies within 45 degrees of its normal


@dataclass(frozen=True, eq=False, repr=False)
class Surface(Short):
    """A rigid surface of triangles in space, closed or open, the obstacle behind it.

    Beyond the border of an open surface there is no obstacle. Distances are exact for the triangles; those from a
    curved surface that they stand for differ by the order of ``h^2 / R``, normals by ``h / R`` (edges h, radius R).

    Parameters
    ----------
    points : (n, 3), length; points at one place are one
    triangles : (m, 3) corners, counter-clockwise seen from the bodies

    Raises
    ------
    InputError
        For wrong shapes, corners that are not there, triangles without area, edges of more than two triangles, and
        neighbours of which one is turned over.

    References
    ----------
    Baerentzen, Aanaes (2005), IEEE Transactions on Visualization and Computer Graphics 11:243-253 (normals at edges and
    corners, weighted by angles, tell the sides apart).

    Examples
    --------
    >>> floor = Surface([[0, 0, 0], [2, 0, 0], [0, 2, 0]], [[0, 1, 2]])
    >>> floor.nearest([[0.5, 0.5, 3.0], [0.5, 0.5, -0.25]])[0].tolist()
    [3.0, -0.25]
    """

    dimension: ClassVar[int] = 3
    """Of the space that it lies in."""

    points: Array
    triangles: IntArray

    def __post_init__(self) -> None:
        points, triangles = rows(self.points, ("points",), size=3), rows(self.triangles, ("triangles",), size=3)
        if not len(triangles) or (triangles != np.rint(triangles)).any():
            found = "holds what is no index" if len(triangles) else "is empty"
            raise InputError(f"{found}; expected (m, 3) indices of points, m > 0", where=("triangles",))
        triangles = triangles.astype(np.int64)
        if triangles.min() < 0 or triangles.max() >= len(points):
            wrong = triangles.min() if triangles.min() < 0 else triangles.max()
            raise InputError(f"names point {wrong}; expected 0 to {len(points) - 1}", where=("triangles",))
        merged, index = np.unique(points[triangles].reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
        object.__setattr__(self, "points", frozen(merged))
        object.__setattr__(self, "triangles", frozen(index.reshape(-1, 3), np.int64))
        self._check()

    def __str__(self) -> str:
        return f"{'an open' if self.open else 'a closed'} surface of {len(self.triangles)} triangles"

    @cached_property
    def open(self) -> bool:
        """Whether it has a border."""
        return bool(self._border.any())

    def reverse(self) -> Surface:
        """This surface with the obstacle on its other side."""
        return Surface(self.points, self.triangles[:, ::-1])

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, 3), positive outside the obstacle, and its outward normals there (n, 3).

        The normal of a point off the surface is the direction in which its distance grows; of one on it the mean of
        the triangles there.
        """
        x = np.asarray(points, dtype=np.float64)
        triangle, weights = self._tree.nearest(x)
        across = x - np.einsum("na,nae->ne", weights, self._corners[triangle])
        mean, border = self._feature(triangle, weights)
        size = np.linalg.norm(across, axis=1)
        ahead = np.sum(across * mean, axis=1)
        sign = np.where(ahead < np.where(border, -_BEHIND_COSINE * size, 0.0), -1.0, 1.0)
        on = size <= _ON * float(np.ptp(self.points, axis=0).max())
        normals = np.where(on[:, None], mean, across * (sign / np.where(on, 1.0, size))[:, None])
        return sign * size, normals + 0.0

    def _check(self) -> None:
        """Triangles with an area, at most two at an edge, all turned the same way."""
        longest = np.linalg.norm(self._corners - np.roll(self._corners, 1, axis=1), axis=2).max(axis=1)
        flat = np.linalg.norm(self._spans, axis=1) <= _HEIGHT_TOL * longest**2
        if flat.any():
            worst = int(np.argmax(flat))
            raise InputError(f"triangle {worst} at {self._place(worst)} has no area", where=("triangles",))
        count = np.bincount(self._edges[0])
        if (count > 2).any():
            edge = int(np.argmax(count > 2))
            at = self._place(np.flatnonzero(self._edges[0] == edge)[0] // 3)
            raise InputError(
                f"{count[edge]} meet at one edge at {at}; expected a surface, two at an edge", where=("triangles",)
            )
        balance = np.bincount(self._edges[0], weights=self._edges[1])
        turned = np.flatnonzero((count == 2) & (balance != 0))
        if len(turned):
            first, second = np.flatnonzero(self._edges[0] == turned[0]) // 3
            raise InputError(
                f"{first} and {second} are neighbours at {self._place(int(first))}, one of them turned over; expected "
                "all counter-clockwise seen from the bodies",
                where=("triangles",),
            )

    def _place(self, triangle: int) -> str:
        """The middle of a triangle in words."""
        return spell_point(self._corners[triangle].mean(axis=0))

    @cached_property
    def _corners(self) -> Array:
        corners: Array = self.points[self.triangles]
        return corners

    @cached_property
    def _spans(self) -> Array:
        """(m, 3) normals, as long as twice the areas."""
        a, b, c = self._corners.transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    @cached_property
    def _units(self) -> Array:
        units: Array = self._spans / np.linalg.norm(self._spans, axis=1, keepdims=True)
        return units

    @cached_property
    def _tree(self) -> BoxTree:
        return BoxTree(self._corners)

    @cached_property
    def _edges(self) -> tuple[IntArray, Array]:
        """Number of the edge opposite every corner, and whether it goes up (1) or down (-1) in the points, (3 m,)."""
        ends = self.triangles[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        key = ends.min(axis=1) * len(self.points) + ends.max(axis=1)
        number = np.unique(key, return_inverse=True)[1].ravel()
        return number, np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0)

    @cached_property
    def _border(self) -> BoolArray:
        """(m, 3) whether the edge opposite a corner belongs to this triangle alone."""
        alone: BoolArray = np.bincount(self._edges[0])[self._edges[0]].reshape(-1, 3) == 1
        return alone

    @cached_property
    def _edge_normals(self) -> Array:
        """(m, 3, 3) Sums of the unit normals on both sides of the edge opposite each corner."""
        total = _summed(self._edges[0], np.repeat(self._units, 3, axis=0))
        return total[self._edges[0]].reshape(-1, 3, 3)

    @cached_property
    def _corner_normals(self) -> Array:
        """(n, 3) Unit normals of the triangles at every point, weighted with their angles there."""
        before = np.roll(self._corners, -1, axis=1) - self._corners
        after = np.roll(self._corners, 1, axis=1) - self._corners
        area = np.linalg.norm(self._spans, axis=1)[:, None]
        angle = np.arctan2(area, np.sum(before * after, axis=2))
        parts = (angle[:, :, None] * self._units[:, None]).reshape(-1, 3)
        return _summed(self.triangles.ravel(), parts)

    @cached_property
    def _border_points(self) -> BoolArray:
        found = np.zeros(len(self.points), bool)
        found[self.triangles[:, [[1, 2], [2, 0], [0, 1]]][self._border]] = True
        return found

    def _feature(self, triangle: IntArray, weights: Array) -> tuple[Array, BoolArray]:
        """At the nearest points: unit normal of the triangle, of both beside an edge or of all at a corner; border?"""
        zero = weights <= 1e-12
        count = zero.sum(axis=1)
        normals, border = self._units[triangle].copy(), np.zeros(len(triangle), bool)
        edge, opposite = count == 1, np.argmax(zero, axis=1)
        normals[edge] = self._edge_normals[triangle[edge], opposite[edge]]
        border[edge] = self._border[triangle[edge], opposite[edge]]
        corner = count == 2
        nodes = self.triangles[triangle[corner], np.argmin(zero[corner], axis=1)]
        normals[corner] = self._corner_normals[nodes]
        border[corner] = self._border_points[nodes]
        return normals / np.linalg.norm(normals, axis=1, keepdims=True), border


def _summed(index: IntArray, vectors: Array) -> Array:
    """Sums of the vectors (k, 3) that bear one index."""
    return np.stack([np.bincount(index, weights=component).astype(float) for component in vectors.T], axis=1)
