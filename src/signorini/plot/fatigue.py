# SPDX-License-Identifier: BSD-3-Clause
"""The picture of fatigue: parameters of every criterion along surfaces or over bodies, and the worst place closer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.plot.curve import surface_coordinate
from signorini.plot.field import BODIES, draw_edges, triangles
from signorini.plot.picture_data import PictureData
from signorini.plot.style import INK, PRESSURE, TRACTION, colour_bar, dress, entitle, frame, label
from signorini.solution.fatigue_result import FatigueResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINES = (PRESSURE, TRACTION, "#4f8f3a", "#8a5aa8", INK)
_NEIGHBOURHOOD = 0.35  # of what is shown on the left: half the width of the picture of the worst place
_MARGIN = 0.5  # of what touches: so much more of a surface is shown on either side
_INSIDE = 0.1  # of that: a place is inside a body whose nodes around it have their middle as near
_IN_PLANE = 0.3  # of a unit normal: what it needs of it in the plane of a picture to be drawn


@dataclass(frozen=True, kw_only=True, eq=False)
class _Shown:
    """A criterion as a row shows it.

    Attributes
    ----------
    data, result : the history, and what the criterion says
    values : at the points of the bodies, NaN where it was not asked for
    axes : (2,) that are drawn: along which the places extend most
    low, high : (2,) corners of what is shown: around what touches and the worst place; all places where none does
    """

    data: PictureData
    result: FatigueResult
    values: Array
    axes: Array
    low: Array
    high: Array

    @classmethod
    def of(cls, data: PictureData, result: FatigueResult, values: Array) -> _Shown:
        """A criterion; ``values`` as of the attributes."""
        axes = np.array([0, 1])
        if data.solid:
            axes = np.sort(np.argsort(np.ptp(result.points, axis=0))[1:])
        points = result.points[:, axes]
        if data.closed.any() and not data.solid:
            points = np.concatenate([data.bodies.points[data.closed], points[[result.worst]]])
        low, high = points.min(axis=0), points.max(axis=0)
        room = (0.04 if data.solid else _MARGIN) * float((high - low).max())
        return cls(data=data, result=result, values=values, axes=axes, low=low - room, high=high + room)

    @property
    def worst(self) -> Array:
        """(2,) Where the parameter is largest."""
        return np.asarray(self.result.points[self.result.worst, self.axes])

    @property
    def covers_bodies(self) -> bool:
        """Whether the places are those of a whole body."""
        return any(body.name in self.result.request.where for body in self.data.model.bodies)

    @property
    def names(self) -> dict[str, str]:
        """Of the axes."""
        x, y = (self.data.model.axes[k] for k in self.axes)
        return {"x": f"{x}, length", "y": f"{y}, length"}


def draw_fatigue(data: PictureData) -> Figure:
    """One row a criterion: its parameter along the surfaces or over the bodies that it was asked for, and the worst
    place closer, with its critical plane.

    Raises
    ------
    InputError
        If no criterion was asked for.
    """
    from matplotlib.figure import Figure

    results, fields = data.history.fatigue_results, data.fatigue
    figure = Figure(figsize=(11.5, 0.5 + 3.9 * len(results)), layout="constrained")
    panels = figure.subplots(len(results), 2, squeeze=False, width_ratios=[1.25, 1.0])
    for (left, right), result, values in zip(panels, results, fields, strict=True):
        shown = _Shown.of(data, result, values)
        if data.solid or shown.covers_bodies:
            _map(figure, left, shown)
        else:
            _curves(left, shown)
        _worst(figure, right, shown)
    entitle(figure, data.model.title, f"fatigue over {', '.join(results[0].steps)}")
    return figure


def _curves(axes: Axes, shown: _Shown) -> None:
    """The parameter along surfaces of the plane, a line a body."""
    result = shown.result
    axis, s = surface_coordinate(result.points)
    for name, colour in zip(dict.fromkeys(result.body.tolist()), _LINES * len(result.body), strict=False):
        own = np.flatnonzero(result.body == name)
        own = own[np.argsort(s[own], kind="stable")]
        axes.plot(s[own], result.parameter[own], "o-", ms=2.5, lw=1.4, color=colour, label=name)
    axes.plot(s[result.worst], result.parameter[result.worst], "*", ms=12, color=TRACTION, zorder=4)
    if axis in ("x", "y"):
        k = "xy".index(axis)
        axes.set_xlim(shown.low[k], shown.high[k])
        axis = shown.data.model.axes[k]
    below = f", {result.request.average} at distance {result.request.distance:g}" if result.request.distance else ""
    unit = "" if axis == "angle in degrees" else ", length"
    dress(axes, x=f"{axis}{unit}", y="parameter", title=f"{result.name}{below}")
    axes.legend(fontsize=8.5, frameon=False, loc="best")


def _map(figure: Figure, axes: Axes, shown: _Shown) -> None:
    """The parameter over bodies of the plane, or at places in space as they are seen along the third axis."""
    frame(axes, shown.low, shown.high)
    _field(figure, axes, shown, marks=3.0)
    axes.plot(*shown.worst, "*", ms=12, color=TRACTION, zorder=4)
    label(axes, **shown.names, title=shown.result.name)


def _field(figure: Figure, axes: Axes, shown: _Shown, *, marks: float) -> None:
    """Colours of the parameter: on cells whose nodes are all known, otherwise at the places."""
    from matplotlib.tri import Triangulation

    data, result, values = shown.data, shown.result, shown.values
    most = max(float(result.parameter.max()), 1e-300)
    if not data.solid:
        _bodies(axes, data)
        corners = triangles(data.outlines)
        known = np.asarray(np.isfinite(values[corners]).all(axis=1))
        if known.any():
            x, y = data.bodies.points.T
            numbers = np.where(np.isfinite(values), values, 0.0)
            grid = Triangulation(x, y, corners[known])
            field = axes.tripcolor(grid, numbers, shading="gouraud", cmap="viridis", vmin=0.0, vmax=most)
            draw_edges(axes, data.outlines, data.bodies.points, colour="#ffffff", alpha=0.3)
            colour_bar(figure, field, axes, "parameter")
            return
    x, y = result.points[:, shown.axes].T
    dots = axes.scatter(x, y, c=result.parameter, s=marks**2, cmap="viridis", vmin=0.0, vmax=most, zorder=3)
    colour_bar(figure, dots, axes, "parameter")


def _bodies(axes: Axes, data: PictureData) -> None:
    """The bodies, undeformed, with their cells."""
    from matplotlib.collections import PolyCollection

    for cells, body in zip(data.outlines, data.bodies.body, strict=True):
        faces = [BODIES[i % len(BODIES)] for i in body]
        axes.add_collection(PolyCollection(list(data.bodies.points[cells]), facecolors=faces), autolim=False)
    draw_edges(axes, data.outlines, data.bodies.points, colour="#7d7d7d", alpha=0.6)


def _worst(figure: Figure, axes: Axes, shown: _Shown) -> None:
    """The neighbourhood of the worst place, its critical plane as a line, and numbers."""
    result, centre = shown.result, shown.worst
    i, half = result.worst, _NEIGHBOURHOOD * float((shown.high - shown.low).max())
    frame(axes, centre - half, centre + half)
    _field(figure, axes, shown, marks=6.0)
    normal = result.plane[i, shown.axes]
    size = float(np.linalg.norm(normal))
    if result.planes and size > _IN_PLANE:
        along = 0.7 * half * np.array([-normal[1], normal[0]]) / size
        inward = _inward(shown, half) @ along
        ends = [centre - along * (inward <= 0.0), centre + along * (inward >= 0.0)]
        axes.plot(*np.column_stack(ends), "-", color=TRACTION, lw=2.0, zorder=5)
    axes.plot(*centre, "*", ms=12, color=TRACTION, zorder=6)
    words = f"worst in '{result.body[i]}': {result.parameter[i]:.4g}"
    words += f", life {result.life[i]:.3g} cycles" if result.lives else ""
    parts = ", ".join(f"{round(part, 3) + 0.0:.3f}" for part in result.plane[i].tolist())
    plane = f"\nnormal of its plane ({parts})" if result.planes else ""
    label(axes, **shown.names, title=words + plane)


def _inward(shown: _Shown, half: float) -> Array:
    """(2,) From the worst place to the middle of the nodes of its body around it; 0 where it is inside the body."""
    data, result = shown.data, shown.result
    index = [body.name for body in data.model.bodies].index(str(result.body[result.worst]))
    blocks = zip(data.bodies.cells, data.bodies.body, strict=True)
    own = np.unique(np.concatenate([cells[body == index].ravel() for cells, body in blocks]))
    away = data.bodies.points[own][:, shown.axes] - shown.worst
    middle = away[np.abs(away).max(axis=1) <= half].mean(axis=0)
    return np.asarray(middle if np.linalg.norm(middle) > _INSIDE * half else np.zeros(2))
