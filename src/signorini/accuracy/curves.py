# SPDX-License-Identifier: BSD-3-Clause
"""The shapes that boundaries of a mesh stand for: circles in the plane, spheres and cylinders in space."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, one_of
from signorini.meshing.facets import facet_corners
from signorini.meshing.simplices import Curve
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Obstacle

_ON_IT = 1e-6
"""Of the radius, or of a boundary: how far nodes may be from a shape that they lie on; files have few digits."""

_TURN = 0.78
"""Radians between neighbouring facets above which they are meant to be corners: those of an octagon are."""

_SPLINE_NODES = 4
"""That a cubic line goes through, at least."""

_SAMPLES, _STEPS = 8, 4
"""Places of every piece of a spline that are looked at, and steps of Newton's method from the nearest: all digits."""

_NODES_MORE = 1
"""Nodes that have to lie on a circle or sphere beyond those that any one goes through."""


@dataclass(frozen=True)
class Round:
    """A circle, a sphere, or a cylinder along an axis.

    Attributes
    ----------
    centre : (d,) length
    radius : length
    axis : (3,) of a cylinder; None
    """

    centre: Array
    radius: float
    axis: Array | None = None

    def __call__(self, points: Array) -> Array:
        """The nearest points of it to points (k, d)."""
        arm = points - self.centre
        along = np.zeros_like(arm) if self.axis is None else np.outer(arm @ self.axis, self.axis)
        across = arm - along
        size = np.linalg.norm(across, axis=1, keepdims=True)
        return np.asarray(self.centre + along + self.radius * across / np.where(size > 0.0, size, 1.0))

    def __str__(self) -> str:
        name = "a cylinder" if self.axis is not None else "a circle" if len(self.centre) == 2 else "a sphere"
        return f"{name} of radius {self.radius:.6g}"


@dataclass(frozen=True)
class ObstacleCurve:
    """A shape that an obstacle may have."""

    shape: Obstacle

    def __call__(self, points: Array) -> Array:
        """The nearest points of it to points (k, d)."""
        distance, normals = self.shape.nearest(points)
        return np.asarray(points - distance[:, None] * normals)

    def __str__(self) -> str:
        return str(self.shape)


class Spline:
    """A smooth line through points of the plane, in order; closed where the last is the first."""

    def __init__(self, points: Array, *, closed: bool) -> None:
        from scipy.interpolate import CubicSpline  # not before a spline is asked for: a tenth of a second
        from scipy.spatial import KDTree

        way = np.vstack([points, points[:1]]) if closed else points
        at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
        self._line = CubicSpline(at, way, bc_type="periodic" if closed else "not-a-knot")
        self._grid = np.interp(np.arange(_SAMPLES * (len(at) - 1) + 1) / _SAMPLES, np.arange(len(at)), at)
        self._tree = KDTree(self._line(self._grid))

    def __call__(self, points: Array) -> Array:
        """The nearest points of it to points (k, 2): the nearest of many, and Newton's method from there."""
        at = self._grid[self._tree.query(points)[1]]
        for _ in range(_STEPS):
            arm, slope, bend = self._line(at) - points, self._line(at, 1), self._line(at, 2)
            at = at - (arm * slope).sum(axis=1) / ((slope * slope).sum(axis=1) + (arm * bend).sum(axis=1))
        return np.asarray(self._line(np.clip(at, self._grid[0], self._grid[-1])))

    def __str__(self) -> str:
        return "a spline through its nodes"


def curves_of(mesh: Mesh, shapes: Mapping[str, Obstacle | str] | None = None) -> dict[str, Curve]:
    """Shapes of boundaries: those that are given, and those that nodes lie on; flat ones and corners have none.

    Parameters
    ----------
    mesh : of the boundaries
    shapes : of some, see :class:`signorini.model.accuracy.Accuracy`

    Raises
    ------
    InputError
        For an unknown boundary, nodes that are not on the shape, or a spline that there is none of.

    Examples
    --------
    >>> from signorini.meshing.plane import quarter_disk
    >>> curves = curves_of(quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=1.0))
    >>> {name: str(curve) for name, curve in curves.items()}
    {'arc': 'a circle of radius 8'}
    """
    given = shapes or {}
    found: dict[str, Curve] = {}
    for name in given:
        if name not in mesh.boundaries:
            raise InputError(one_of(name, mesh.boundaries, "boundary"), where=("accuracy", "shapes"))
    for name in mesh.boundaries:
        if name in given:
            if given[name] != "straight":
                found[name] = _given(mesh, name, given[name])
        elif not mesh.bounds_nothing(name):
            curve = _curve(mesh, name)
            if curve is not None:
                found[name] = curve
    return found


def _given(mesh: Mesh, name: str, shape: Obstacle | str) -> Curve:
    """A shape that is asked for."""
    where = ("accuracy", "shapes", name)
    d, points = mesh.points.shape[1], mesh.points[mesh.nodes_of(name)]
    if isinstance(shape, str):
        if d == 3 or len(points) < _SPLINE_NODES:
            words = "is a line of the plane through four nodes or more; expected a shape here"
            raise InputError(f"'spline' {words}", where=where)
        from signorini.meshing.profile import mesh_profile  # brings meshio with it

        line = mesh_profile(mesh, name)
        return Spline(np.array(line.points), closed=line.closed)
    if shape.dimension != d:
        raise InputError(f"is {shape}; expected a shape with {d} coordinates", where=where)
    corners = np.unique(np.concatenate([f[:, : facet_corners(d, f.shape[1])].ravel() for f in mesh.facets(name)]))
    distance, _ = shape.nearest(mesh.points[corners])
    worst = int(np.argmax(np.abs(distance)))
    if np.abs(distance[worst]) > _ON_IT * float(np.ptp(points, axis=0).max()):
        node = mesh.labels[corners[worst]]
        raise InputError(f"is {shape}; node {node} of the boundary is {abs(distance[worst]):.3g} off it", where=where)
    return ObstacleCurve(shape)


def _curve(mesh: Mesh, name: str) -> Round | None:
    d, parts = mesh.points.shape[1], mesh.facets(name)
    points = mesh.points[mesh.nodes_of(name)]
    if d == 2 and parts[0].shape[1] == 3:  # both halves of a quadratic edge
        parts = (np.concatenate([parts[0][:, [0, 2]], parts[0][:, [2, 1]]]),)
    normals = np.concatenate([_normals(mesh.points, facets, d) for facets in parts])
    if len(points) < d + 1 + _NODES_MORE or not _smooth(parts, normals, d):
        return None
    found = _round(points)
    if found is None and d == 3:
        found = _cylinder(points, normals)
    return found


def _round(points: Array) -> Round | None:
    """The circle or sphere through points: ``|x|^2 = 2 c.x + const``."""
    middle = points.mean(axis=0)
    x = points - middle
    scale = np.abs(x).max()
    if scale == 0.0:
        return None
    system = np.column_stack([2.0 * x / scale, np.ones(len(x))])
    solved, _, rank, _ = np.linalg.lstsq(system, (x**2).sum(axis=1) / scale**2, rcond=1e-9)
    if rank < system.shape[1]:
        return None
    centre = solved[:-1] * scale
    distance = np.linalg.norm(x - centre, axis=1)
    radius = float(distance.mean())
    return Round(middle + centre, radius) if np.abs(distance - radius).max() <= _ON_IT * radius else None


def _cylinder(points: Array, normals: Array) -> Round | None:
    """The cylinder through points of faces, whose normals are across its axis."""
    _, sizes, ways = np.linalg.svd(normals, full_matrices=True)
    if sizes[1] < 1e-3 * sizes[0] or sizes[2] > 1e-6 * sizes[0]:  # flat, or of no common direction
        return None
    axis, across = ways[2], ways[:2]
    section = _round(points @ across.T)
    return None if section is None else Round(section.centre @ across, section.radius, axis)


def _normals(points: Array, facets: IntArray, d: int) -> Array:
    """Unit normals of facets by their corners, (m, d)."""
    x = points[facets[:, : facet_corners(d, facets.shape[1])]]
    if d == 2:
        along = x[:, 1] - x[:, 0]
        normals = np.column_stack([along[:, 1], -along[:, 0]])
    else:
        normals = np.cross(x[:, 1] - x[:, 0], x[:, -1] - x[:, 0])
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def _smooth(parts: tuple[IntArray, ...], normals: Array, d: int) -> bool:
    """Whether no two facets with a common corner turn by more than a curve's facets do."""
    corners = [facets[:, : facet_corners(d, facets.shape[1])] for facets in parts]
    facet = np.concatenate(
        [np.repeat(np.arange(len(c)), c.shape[1]) + s for c, s in zip(corners, _starts(corners), strict=True)]
    )
    node = np.concatenate([c.ravel() for c in corners])
    order = np.argsort(node, kind="stable")
    same = np.diff(node[order]) == 0
    one, two = facet[order][:-1][same], facet[order][1:][same]
    cosine = np.abs(np.einsum("ki,ki->k", normals[one], normals[two]))  # facets may be numbered either way
    return bool((cosine >= np.cos(_TURN)).all())


def _starts(corners: list[IntArray]) -> list[int]:
    return [0, *np.cumsum([len(c) for c in corners])[:-1].tolist()]
