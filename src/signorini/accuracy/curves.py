# SPDX-License-Identifier: BSD-3-Clause
"""The shapes that boundaries of a mesh stand for: circles in the plane, spheres and cylinders in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.meshing.facets import facet_corners
from signorini.meshing.simplices import Curve
from signorini.model.mesh import Mesh

_ON_IT = 1e-6
"""Of the radius: how far nodes may be from a circle that they lie on; files have few digits."""

_TURN = 0.78
"""Radians between neighbouring facets above which they are meant to be corners: those of an octagon are."""

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


def curves_of(mesh: Mesh) -> dict[str, Curve]:
    """Shapes of the boundaries whose nodes lie on one; flat ones and those with corners are left out.

    Examples
    --------
    >>> from signorini.meshing.plane import quarter_disk
    >>> curves = curves_of(quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=1.0))
    >>> {name: str(curve) for name, curve in curves.items()}
    {'arc': 'a circle of radius 8'}
    """
    found: dict[str, Curve] = {}
    for name in mesh.boundaries:
        if not mesh.bounds_nothing(name):
            curve = _curve(mesh, name)
            if curve is not None:
                found[name] = curve
    return found


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
