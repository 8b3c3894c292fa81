# SPDX-License-Identifier: BSD-3-Clause
"""Local axes of pairs in space: a normal and two tangents."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.errors import InputError

ALONG = 0.1
"""Sine between an axis and a normal below which the axis gives no tangent."""


def frames(normals: Array, axis: ArrayLike | None = None) -> Array:
    """(k, 3, 3) Rows n, t1, t2 of every pair, right-handed: t1 is the part of an axis across the normal.

    Parameters
    ----------
    normals : (k, 3) unit normals, into the nonmortar body
    axis : (3,) direction of the first tangents, of the fibres of a surface for instance; the coordinate axis that the
        normals follow least where not given. Where a normal runs along it another coordinate axis takes its place

    Raises
    ------
    InputError
        For an axis without length.

    Examples
    --------
    >>> frames(np.array([[0.0, 0.0, 1.0]]), axis=(2.0, 0.0, 5.0))[0].tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    """
    followed = (normals**2).sum(axis=0)
    direction = np.eye(3)[np.argmin(followed)] if axis is None else np.asarray(axis, dtype=np.float64)
    length = float(np.linalg.norm(direction))
    if not length > 0:
        raise InputError("is zero; expected a direction", where=("axis",))
    along = np.tile(direction / length, (len(normals), 1))
    across = along - np.sum(along * normals, axis=1)[:, None] * normals
    size = np.linalg.norm(across, axis=1)
    lost = size < ALONG
    least = np.eye(3)[np.argmin(np.abs(normals[lost]), axis=1)]
    across[lost] = least - np.sum(least * normals[lost], axis=1)[:, None] * normals[lost]
    first = across / np.linalg.norm(across, axis=1, keepdims=True)
    return np.stack([normals, first, np.cross(normals, first)], axis=1) + 0.0
