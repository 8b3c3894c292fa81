# SPDX-License-Identifier: BSD-3-Clause
"""Charts of contact surfaces in space: seen along their normal, unrolled where they are round."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray

_MIN_FACING = 0.7  # of its area: a surface that shows more when it is looked at along its normal faces one way
_AXIS_COSINE = 0.99  # of a unit vector with a coordinate axis: beyond it the axis gives its name
_CONE_TOL = 0.05  # of the area: normals leave one plane by less on a cylinder, or on a slim cone
_ROUNDNESS_TOL = 0.1  # of the radius: a section that is farther from a circle is not unrolled


@dataclass(frozen=True, kw_only=True, eq=False)
class Chart:
    """Places on paper of the nodes of a surface.

    Attributes
    ----------
    at : (n, 2) length
    first, second : (n, 3) unit vectors that point right and up on paper
    labels : of the two axes
    node : (n,) which node this is: where a surface is cut open, those on the cut are there twice
    faces : (m, 4) indices of the places
    """

    at: Array
    first: Array
    second: Array
    labels: tuple[str, str]
    node: IntArray
    faces: IntArray


def chart_of(points: Array, faces: IntArray, middle: BoolArray) -> Chart:
    """Spread out a surface.

    Parameters
    ----------
    points : (n, 3) length
    faces : (m, 4) indices around the faces; a triangle has its last one twice
    middle : (n,) bool; nodes that are to be in the middle of what is unrolled

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]])
    >>> chart_of(square, np.array([[0, 1, 2, 3]]), np.zeros(4, bool)).labels
    ('y', 'z')
    """
    corners = points[faces]
    spans = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    area = np.linalg.norm(spans, axis=1)
    facing = spans.sum(axis=0)
    if np.linalg.norm(facing) < _MIN_FACING * area.sum():
        spread, axes = np.linalg.eigh(np.einsum("mi,mj,m->ij", spans, spans, 1.0 / np.maximum(area, 1e-300)))
        axis = axes[:, 0] * np.sign(axes[np.argmax(np.abs(axes[:, 0])), 0])
        across = points - (points @ axis)[:, None] * axis
        centre = _centre(across, axis)
        far = np.linalg.norm(across - centre, axis=1)
        if spread[0] < _CONE_TOL * area.sum() and far.std() < _ROUNDNESS_TOL * far.mean():
            return _unrolled(points, faces, middle, axis, centre)
        return _seen(points, faces, np.eye(3)[np.argmin(np.ptp(points, axis=0))])
    return _seen(points, faces, facing / np.linalg.norm(facing))


def _seen(points: Array, faces: IntArray, normal: Array) -> Chart:
    """A view along a normal; of coordinates where the normal is about along one of their axes."""
    if np.abs(normal).max() > _AXIS_COSINE * _AXIS_COSINE:
        normal = np.eye(3)[np.argmax(np.abs(normal))]
    first, second = np.delete(np.eye(3), np.argmax(np.abs(normal)), axis=0)
    if np.abs(normal).max() < 1.0:
        second = np.eye(3)[np.argmin(np.abs(normal))]
        second = second - (second @ normal) * normal
        second /= np.linalg.norm(second)
        first = np.cross(second, normal)
    return Chart(
        at=np.column_stack([points @ first, points @ second]),
        first=np.broadcast_to(first, points.shape),
        second=np.broadcast_to(second, points.shape),
        labels=(_called(first), _called(second)),
        node=np.arange(len(points)),
        faces=faces,
    )


def _unrolled(points: Array, faces: IntArray, middle: BoolArray, axis: Array, centre: Array) -> Chart:
    """Arc lengths about an axis, cut open opposite what is to be in the middle, and places along it."""
    one = np.eye(3)[np.argmin(np.abs(axis))]
    one = one - (one @ axis) * axis
    one /= np.linalg.norm(one)
    arm = points - (points @ axis)[:, None] * axis - centre
    turned = arm @ one + 1j * (arm @ np.cross(axis, one))
    towards = turned[middle].sum() if middle.any() else turned.sum()
    if np.abs(towards) > _ROUNDNESS_TOL * np.abs(turned).mean():
        turned = turned * np.conj(towards / np.abs(towards))
    angle = np.angle(turned)
    cut = np.ptp(angle[faces], axis=1) > np.pi
    again = np.unique(faces[cut][angle[faces[cut]] < 0.0])
    copy = np.arange(len(points))
    copy[again] = len(points) + np.arange(len(again))
    faces = np.where(cut[:, None], copy[faces], faces)
    node = np.concatenate([np.arange(len(points)), again])
    angle = np.concatenate([angle, angle[again] + 2.0 * np.pi])
    outward = arm / np.linalg.norm(arm, axis=1, keepdims=True)
    return Chart(
        at=np.column_stack([np.abs(turned).mean() * angle, points[node] @ axis]),
        first=np.cross(axis, outward)[node],
        second=np.broadcast_to(axis, (len(node), 3)),
        labels=("arc length around", _called(axis)),
        node=node,
        faces=faces,
    )


def _centre(across: Array, axis: Array) -> Array:
    """The centre (3,) of the circle that fits points (n, 3) in a plane across an axis best."""
    system = np.column_stack([2.0 * across, np.ones(len(across))])
    found = np.linalg.lstsq(system, (across**2).sum(axis=1), rcond=1e-10)[0][:3]
    return np.asarray(found - (found @ axis) * axis)


def _called(direction: Array) -> str:
    """A coordinate axis by its letter."""
    if np.abs(direction).max() > _AXIS_COSINE:
        return "xyz"[int(np.argmax(np.abs(direction)))]
    return "along (" + ", ".join(f"{part:.2g}" for part in direction + 0.0) + ")"
