# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles in pictures of plane bodies: what they fill, where they are after the last step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.arrays import Array
from signorini.model.obstacle import Circle, Plane, Profile
from signorini.plot.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHAPES = {kind.__name__.lower(): kind for kind in (Plane, Circle, Profile)}
_POINTS_ACROSS = 400  # a panel: where obstacles are asked for their distance
_FILL_COLOUR = "#e2e2df"


@dataclass(frozen=True, kw_only=True)
class Wall:
    """A rigid obstacle of a plane model.

    Attributes
    ----------
    shape : before it moves
    about : (2,) point about which it turns, length
    displacement : (2,) of that point after the last step, length
    rotation : radians, small
    """

    shape: Plane | Circle | Profile
    about: Array
    displacement: Array
    rotation: float

    def depth(self, points: Array, *, moved: bool) -> Array:
        """Depths of points (n, 2) inside, (n,) length; ``moved``: of the obstacle after the last step."""
        if moved:
            arm = points - self.about - self.displacement
            points = points - self.displacement - self.rotation * np.column_stack([-arm[:, 1], arm[:, 0]])
        return -self.shape.nearest(points)[0]


def read_walls(summary: Mapping[str, Any]) -> list[Wall]:
    """Obstacles of the plane that a summary describes."""
    moved = summary["steps"][-1]["obstacles"]
    walls = []
    for obstacle in summary.get("obstacles", []):
        known = dict(obstacle)
        name, kind, about = known.pop("name"), known.pop("shape"), known.pop("about")
        motion = moved.get(name, {"displacement": [0.0, 0.0], "rotation": 0.0})
        walls.append(
            Wall(
                shape=_SHAPES[kind](**known),
                about=np.array(about),
                displacement=np.array(motion["displacement"]),
                rotation=motion["rotation"],
            )
        )
    return walls


def draw_walls(axes: Axes, walls: list[Wall], *, moved: bool) -> None:
    """Fill what walls fill of axes, behind everything else; ``moved``: where they are after the last step."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    x, y = np.meshgrid(np.linspace(left, right, _POINTS_ACROSS), np.linspace(low, high, _POINTS_ACROSS))
    points = np.column_stack([x.ravel(), y.ravel()])
    for wall in walls:
        depth = wall.depth(points, moved=moved).reshape(x.shape)
        if depth.max() > 0.0 > depth.min():
            axes.contourf(x, y, depth, levels=[0.0, depth.max()], colors=[_FILL_COLOUR], zorder=0)
            axes.contour(x, y, depth, levels=[0.0], colors=[INK], linewidths=0.8, zorder=0)
