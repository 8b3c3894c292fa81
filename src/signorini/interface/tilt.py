# SPDX-License-Identifier: BSD-3-Clause
"""The normals of a contact whose sides are tilted against each other: between those of both."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array

_KINK = np.pi / 12.0  # between a facet and the mean normal at its node: beyond it is a corner of the body


def normals_between(own: Array, opposite: Array, turn: Array, share: float) -> Array:
    """(m, d) Unit normals along which facets are pressed, from their own outward ones and those of what is opposite.

    Where the sides close, both turn: what becomes their common surface lies between them, nearer to the stiffer one.
    Pressed along their own normals instead, spheres that meet at an angle of theta on either side would close later by
    parts of theta^2 and be bent sideways. Sides that differ in their normals by no more than they turn from facet to
    facet are meant to match: there a facet keeps its own, and with it the exact passage of a uniform pressure.

    Parameters
    ----------
    own : (m, d) outward unit normals of the facets
    opposite : (m, d) sums of outward normals opposite each facet, of any length; 0 where there is nothing
    turn : (m,) largest angle from a facet to its neighbours, of it or of what is opposite, see :func:`turning_angles`
    share : of the nonmortar side in the stiffness of both, 0 to 1

    Examples
    --------
    >>> up, left = np.array([[0.0, 1.0]]), np.array([[-0.6, -0.8]])
    >>> normals_between(up, left, np.array([0.1]), 0.5).round(3).tolist()
    [[0.316, 0.949]]
    >>> normals_between(up, left, np.array([0.7]), 0.5).tolist()  # 37 degrees, of facets that turn by 40
    [[0.0, 1.0]]
    """
    size = np.linalg.norm(opposite, axis=1, keepdims=True)
    other = np.divide(opposite, size, out=-own, where=size > 0.0)
    between = share * own - (1.0 - share) * other
    between /= np.linalg.norm(between, axis=1, keepdims=True)
    tilted = _angle(own, -other) > turn
    return np.where(tilted[:, None], between, own)


def areas_between(areas: Array, own: Array, opposite: Array, share: float) -> Array:
    """(k, d) Normals times areas of node pairs, turned to between those of both sides as facets are.

    Parameters
    ----------
    areas : (k, d) of the nonmortar side
    own, opposite : (k, d) outward unit normals of both sides at the nodes; on sides that fit each other they cancel
    share : of the nonmortar side in the stiffness of both, 0 to 1

    Examples
    --------
    >>> right, down, up = np.array([[3.0, 0.0]]), np.array([[0.0, -1.0]]), np.array([[0.0, 1.0]])
    >>> areas_between(right, down, up, 0.5).tolist()
    [[3.0, 0.0]]
    >>> areas_between(3.0 * up, down, np.array([[-0.6, 0.8]]), 0.0).round(12).tolist()
    [[-1.8, 2.4]]
    """
    return rotate_between(areas, own, normals_between(own, opposite, np.zeros(len(own)), share))


def turning_angles(own: Array, at_nodes: Array) -> Array:
    """(m,) Angle by which a side turns from each of its facets to the next, corners of the body left out.

    Parameters
    ----------
    own : (m, d) unit normals of the facets
    at_nodes : (m, k, d) mean unit normals of the side at their nodes
    """
    angle = _angle(own[:, None], at_nodes)
    found: Array = 2.0 * np.where(angle < _KINK, angle, 0.0).max(axis=1)
    return found


def rotate_between(vectors: Array, before: Array, after: Array) -> Array:
    """Vectors turned by what turns one unit vector into another, the shortest way; arrays (..., d).

    Parameters
    ----------
    vectors : (..., d)
    before, after : (..., d) unit vectors

    Examples
    --------
    >>> rotate_between(np.array([[0.0, 2.0]]), np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])).tolist()
    [[-2.0, 0.0]]
    """
    both = before + after
    along = np.sum(both * vectors, axis=-1, keepdims=True) / (1.0 + np.sum(before * after, axis=-1, keepdims=True))
    result: Array = vectors - along * both + 2.0 * np.sum(before * vectors, axis=-1, keepdims=True) * after
    return result


def _angle(one: Array, two: Array) -> Array:
    """Between unit vectors, to rounding also where they are nearly parallel."""
    apart = np.linalg.norm(one - two, axis=-1)
    angle: Array = 2.0 * np.arctan2(apart, np.linalg.norm(one + two, axis=-1))
    return angle
