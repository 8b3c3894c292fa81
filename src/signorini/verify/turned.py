# SPDX-License-Identifier: BSD-3-Clause
"""Models with a known uniform strain, turned in the plane: loads instead of supports along the axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.model.conditions import Load, Support
from signorini.model.model import Model


def rotation(angle: float) -> Array:
    """(2, 2) Rows are the turned axes; the angle in degrees. Points (n, 2) turn by multiplying from the left."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array([[c, s], [-s, c]])


def turned(
    model: Model,
    angle: float,
    strain: tuple[float, float],
    loads: Sequence[Load],
    corners: Sequence[tuple[float, float]],
) -> Model:
    """The model turned about the origin, pressed from all sides and kept in place by a few corners that bear nothing.

    Parameters
    ----------
    angle : in degrees
    strain : along x and y of the model as it is given; its displacements are ``strain * (x, y)``
    loads : instead of the model's; those that were reactions included
    corners : nodes that move as the exact solution does, two of one body and one of every other, before the turn
    """
    Q = rotation(angle)
    held = [
        Support(_pair(place @ Q), u=_pair((place * strain) @ Q)) for place in (np.array(corner) for corner in corners)
    ]
    mesh = replace(model.mesh, points=model.mesh.points @ Q)
    return replace(model, mesh=mesh, supports=held, loads=list(loads))


def _pair(vector: Array) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])
