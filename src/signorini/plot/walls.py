# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles in pictures of plane bodies: what they fill, where they are at the moment that is shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.arrays import Array
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle
from signorini.output.fields import State
from signorini.plot.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS_ACROSS = 400  # a panel: where obstacles are asked for their distance
FILL_COLOUR = "#e2e2df"
"""Of what obstacles fill."""


@dataclass(frozen=True, eq=False)
class Wall:
    """A rigid obstacle of a plane model.

    Attributes
    ----------
    shape : before it moves
    about : (2,) point about which it turns, length
    displacement : (2,) of that point at the moment, length
    rotation : radians
    """

    shape: Obstacle
    about: Array
    displacement: Array
    rotation: float

    def depth(self, points: Array, *, moved: bool) -> Array:
        """Depths of points (n, 2) inside, (n,) length; ``moved``: of the obstacle at the moment."""
        if moved:
            cosine, sine = np.cos(self.rotation), np.sin(self.rotation)
            turn = np.array([[cosine, -sine], [sine, cosine]])
            points = (points - self.about - self.displacement) @ turn + self.about
        return -self.shape.nearest(points)[0]


def walls_of(model: Model, state: State) -> list[Wall]:
    """Obstacles of a plane model in a state; none in space. Older archives do not say how they move within steps."""
    if model.dimension == 3:
        return []
    known = state.motions or {}
    moving = [(rigid.shape, rigid.about, known[rigid.name]) for rigid in model.obstacles if rigid.name in known]
    walls = [Wall(shape, np.array(about), found.displacement, float(found.rotation)) for shape, about, found in moving]
    return walls + _at_rest(_resting(model))


def walls_at_rest(model: Model) -> list[Wall]:
    """Obstacles of a plane model before any of them moves; none in space."""
    if model.dimension == 3:
        return []
    return _at_rest([*_resting(model), *(rigid.shape for rigid in model.obstacles)])


def _resting(model: Model) -> list[Obstacle]:
    """Obstacles that never move."""
    return [contact.mortar for contact in model.contacts if isinstance(contact.mortar, Obstacle)]


def _at_rest(shapes: list[Obstacle]) -> list[Wall]:
    return [Wall(shape, np.zeros(2), np.zeros(2), 0.0) for shape in shapes]


def filled(wall: Wall, low: Array, high: Array, across: int) -> list[Array]:
    """Loops (n, 2) around what a wall fills of a rectangle, where it rests.

    Parameters
    ----------
    wall : the obstacle
    low, high : (2,) corners of the rectangle, length
    across : points an edge at which the obstacle is asked for its distance
    """
    from contourpy import contour_generator

    x, y = np.meshgrid(*np.linspace(low, high, across).T)
    depth = wall.depth(np.column_stack([x.ravel(), y.ravel()]), moved=False).reshape(x.shape)
    found: Any = contour_generator(x, y, depth, fill_type="OuterOffset").filled(0.0, np.inf)
    return [_bent(loop[:-1]) for own, at in zip(*found, strict=True) for loop in np.split(own, at[1:-1])]


def _bent(loop: Array) -> Array:
    """The points (n, 2) of a closed loop at which it does not go straight on."""
    before, after = loop - np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0) - loop
    turn = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    bent: Array = loop[np.abs(turn) > 1e-9 * np.ptp(loop, axis=0).max() ** 2]
    return bent


def draw_walls(axes: Axes, walls: list[Wall], *, moved: bool) -> None:
    """Fill what walls fill of axes, behind everything else; ``moved``: where they are at the moment."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    x, y = np.meshgrid(np.linspace(left, right, _POINTS_ACROSS), np.linspace(low, high, _POINTS_ACROSS))
    points = np.column_stack([x.ravel(), y.ravel()])
    for wall in walls:
        depth = wall.depth(points, moved=moved).reshape(x.shape)
        if depth.max() > 0.0 > depth.min():
            axes.contourf(x, y, depth, levels=[0.0, depth.max()], colors=[FILL_COLOUR], zorder=0)
            axes.contour(x, y, depth, levels=[0.0], colors=[INK], linewidths=0.8, zorder=0)
