# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of bodies in space: a field on their deformed skin, and the mesh; the contact on its own beside."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array
from signorini.plot.camera import Camera
from signorini.plot.components import Scalar, colours_of
from signorini.plot.field import BODIES, beyond, body_handles, factor_words
from signorini.plot.paint import Paint, body_paint, paint_skin
from signorini.plot.picture_data import PictureData
from signorini.plot.shots import Shot, deformed, make_shots
from signorini.plot.style import INK, SCALE, STATUS_INK, colour_bar, entitle, frame, label, legend_below, round_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MESH_COLOUR = (1.0, 1.0, 1.0, 0.30)  # on the dark colours of stresses


def draw_solid_field(data: PictureData, scalar: Scalar) -> Figure:
    """A field on the deformed skin of the bodies, whole and at the contact, or of the part that is asked for.

    The title says by what the displacements are multiplied. Colours end at the largest value of the skin that is shown
    last.
    """
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    values, shots = data.skin.values(scalar.values), make_shots(data)
    factor, points = deformed(data, shots[-1])
    colours = colours_of(values[shots[-1].inside(points)], data.look.range)
    scale, ramp = Normalize(colours.low, colours.high), matplotlib.colormaps[colours.map]
    figure, panels = _canvas(shots, points)
    paint = Paint(values=values, colours=lambda shades: ramp(scale(shades))[:, :3], mesh=_MESH_COLOUR)
    for axes, shot in zip(panels, shots, strict=True):
        paint_skin(axes, shot.skin, points, shot.camera, paint)
    words, extend = beyond(scalar, scalar.words.format(" on the skin"), colours)
    colour_bar(figure, ScalarMappable(scale, ramp), panels, words, shrink=0.7, extend=extend)
    entitle(figure, data.model.title, f"{factor_words(factor)}; {data.when}")
    return figure


def draw_solid_mesh(data: PictureData) -> Figure:
    """The undeformed mesh, a colour a body, and the contact nodes with their status."""
    from matplotlib.lines import Line2D

    skin, shots = data.skin, make_shots(data)
    figure, panels = _canvas(shots, skin.points)
    paint = body_paint(BODIES)
    for axes, shot in zip(panels, shots, strict=True):
        paint_skin(axes, shot.skin, skin.points, shot.camera, paint)
    handles = body_handles(data)
    seen = shots[-1].inside(skin.points)
    for words, points in data.dots.items():
        own, colour = np.intersect1d(points, seen), STATUS_INK[words]
        if len(own):
            panels[-1].plot(*shots[-1].camera.across(skin.points[own]).T, "o", ms=3.5, color=colour, zorder=3)
            handles.append(Line2D([], [], marker="o", ls="", ms=4, color=colour, label=f"contact node, {words}"))
    legend_below(figure, handles)
    entitle(figure, data.model.title, f"{data.size}; {data.when}")
    return figure


def _canvas(shots: list[Shot], points: Array) -> tuple[Figure, list[Axes]]:
    """A panel a shot, each of the shape of what it shows, with the directions of the axes and a scale."""
    from matplotlib.figure import Figure

    frames = [shot.frame(points) for shot in shots]
    shapes = [(high - low) / (high - low).max() for low, high in frames]
    widths = [6.0 * max(float(shape[0]), 0.35) for shape in shapes]
    height = 6.0 * max(float(shape[1]) for shape in shapes)
    figure = Figure(figsize=(sum(widths) + 1.6, height + 1.1), layout="compressed")
    panels = list(figure.subplots(1, len(shots), width_ratios=widths, squeeze=False)[0])
    for axes, shot, (low, high) in zip(panels, shots, frames, strict=True):
        frame(axes, low, high)
        axes.set_axis_off()
        label(axes, title=shot.title)
        _directions(axes, shot.camera)
        _scale(axes, float(high[0] - low[0]))
    return figure, panels


def _directions(axes: Axes, camera: Camera) -> None:
    """Arrows along x, y and z below the left corner."""
    corner = axes.inset_axes((0.0, -0.13, 0.13, 0.13))
    frame(corner, np.full(2, -1.5), np.full(2, 1.5))
    corner.set_axis_off()
    arrow = {"arrowstyle": "-|>", "color": INK, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
    for name, (across, up) in zip("xyz", camera.axes[:2].T, strict=True):
        corner.annotate("", (across, up), (0.0, 0.0), arrowprops=arrow)
        corner.text(1.35 * across, 1.35 * up, name, ha="center", va="center", fontsize=9, color=INK)


def _scale(axes: Axes, width: float) -> None:
    """A bar of a round length below the right corner."""
    length = round_number(width / 5.0)
    part = length / width
    axes.plot([1.0 - part, 1.0], [-0.05, -0.05], transform=axes.transAxes, color=INK, lw=2.0, clip_on=False)
    axes.text(
        1.0 - 0.5 * part, -0.04, f"{length:g}", transform=axes.transAxes, ha="center", fontsize=9, color=INK, gid=SCALE
    )
