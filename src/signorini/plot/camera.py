# SPDX-License-Identifier: BSD-3-Clause
"""From where bodies in space are looked at, in parallel projection."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from signorini.arrays import Array

_ASIDE, _UP = np.radians(33.0), np.radians(28.0)  # of a view, from the x axis and from the plane x, y
_WEIGHT_FROM_BELOW = 0.5  # of a view from above: readers expect to look down on things


@dataclass(frozen=True, kw_only=True, eq=False)
class Camera:
    """Axes of a view: to the right, up, and towards the eye.

    Attributes
    ----------
    axes : (3, 3) unit vectors in rows, right-handed
    """

    axes: Array

    def across(self, points: Array) -> Array:
        """Places in the picture, (..., 2)."""
        return np.asarray(points @ self.axes[:2].T)

    def depth(self, points: Array) -> Array:
        """Distances of points (..., 3) towards the eye, (...), length."""
        return np.asarray(points @ self.axes[2])

    @property
    def towards(self) -> Array:
        """Unit vector towards the eye."""
        return np.asarray(self.axes[2])


def look_from(direction: Array) -> Camera:
    """A view from a direction, the z axis up."""
    towards = direction / np.linalg.norm(direction)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    return Camera(axes=np.stack([right, np.cross(towards, right), towards]))


def best_view(spans: Array, weight: Array) -> Camera:
    """The view from that of eight corners which shows most of what matters.

    Parameters
    ----------
    spans : (f, 3) outward normals of faces, as long as their areas
    weight : (f,) how much each matters
    """
    signs = np.array(list(product((-1.0, 1.0), (-1.0, 1.0), (1.0, -1.0))))
    views = signs * [np.cos(_UP) * np.sin(_ASIDE), np.cos(_UP) * np.cos(_ASIDE), np.sin(_UP)]
    seen = weight @ np.maximum(spans @ views.T, 0.0) * np.where(views[:, 2] > 0.0, 1.0, _WEIGHT_FROM_BELOW)
    # views that show the same within rounding: the first of them
    return look_from(views[np.argmax(seen >= seen.max() * (1.0 - 1e-9))])
