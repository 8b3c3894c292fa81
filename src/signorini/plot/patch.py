# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a contact in space: a map of the pressure, and one of stick, slip and friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray
from signorini.model.model import Model
from signorini.plot.chart import Chart, chart_of
from signorini.plot.look import Look
from signorini.plot.style import INK, STATUS_INK, colour_bar, entitle, frame, label, legend_under, status_words
from signorini.solution.results import OPEN, ContactResult
from signorini.solution.surface import contact_faces

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MAX_ARROWS = 400  # of friction: more hide each other
_LONGEST_ARROW = 0.1  # of the size of what is shown: the largest friction, less where there are many arrows
_PANEL_WIDTH, _PANEL_HEIGHTS = 4.0, (1.2, 3.6)  # inches of a map: its width, the least and the most height
_ROW_ROOM = 1.1  # inches of a row: for the names of axes and the legend
_EDGE = 0.06  # of the size of what is shown: around it, where no arrow needs more
_PATCH_MARGIN = 0.35  # of the size of the closed patch: around it


@dataclass(frozen=True, kw_only=True, eq=False)
class Patch:
    """One contact in space at one moment, its nodes those of its faces.

    Attributes
    ----------
    contact : its name
    points : (n, 3) undeformed, length
    faces : (m, 4) indices of them, around the faces; a triangle has its last one twice
    pressure : (n,) force per area
    shear : (n, 3) friction on the nonmortar body, force per area
    slip : (n,) size of what has accumulated, length
    status : (n,) see `status_words`
    """

    contact: str
    points: Array
    faces: IntArray
    pressure: Array
    shear: Array
    slip: Array
    status: NDArray[np.str_]

    @cached_property
    def chart(self) -> Chart:
        """Places of the nodes on paper, those that touch in the middle."""
        return chart_of(self.points, self.faces, self.status != OPEN)

    @property
    def arrows(self) -> IntArray:
        """Nodes at which friction is drawn: some of those that rub."""
        rubbed = np.flatnonzero(np.linalg.norm(self.shear, axis=1) > 0.0)
        return rubbed[:: max(1, len(rubbed) // _MAX_ARROWS)]


def patch_of(model: Model, contact: ContactResult) -> Patch:
    """The faces of a contact in space whose corners all have pairs.

    Parameters
    ----------
    model, contact : the model, and the contact at the moment
    """
    faces = np.concatenate([corners[:, [0, 1, 2, -1]] for corners in contact_faces(model, contact)])
    own, index = np.unique(faces, return_inverse=True)
    return Patch(
        contact=contact.name,
        points=contact.points[own],
        faces=index.reshape(-1, 4),
        pressure=contact.pressure[own],
        shear=contact.shear[own],
        slip=contact.slipped[own],
        status=status_words(contact)[own],
    )


def draw_patches(patches: Sequence[Patch], title: str, when: str, look: Look) -> Figure:
    """One row a contact: pressure on the left; stick, slip and the friction as arrows on the right.

    Parameters
    ----------
    patches : the contacts
    title : of the model
    when : the moment in words
    look : what the reader asks for
    """
    from matplotlib.figure import Figure

    corners = [_corners(patch, look) for patch in patches]
    rows = [float(np.clip(_PANEL_WIDTH * (high - low)[1] / (high - low)[0], *_PANEL_HEIGHTS)) for low, high in corners]
    rows = [height + _ROW_ROOM for height in rows] or [4.6]
    figure = Figure(figsize=(11.0, 0.7 + sum(rows)), layout="constrained")
    panels = figure.subplots(len(rows), 2, squeeze=False, height_ratios=rows)
    for (left, right), patch in zip(panels, patches, strict=False):
        label(left, title=f"{patch.contact}, {when}")
        _pressure(figure, left, patch, look)
        _status(right, patch, look)
        for axes in (left, right):
            _frame(axes, patch, look)
    entitle(figure, title)
    return figure


def _pressure(figure: Figure, axes: Axes, patch: Patch, look: Look) -> None:
    from matplotlib.tri import Triangulation

    places, triangles, pressure = _quartered(patch)
    surface = Triangulation(places[:, 0], places[:, 1], triangles)
    low, high = look.range or (0.0, None)
    shown = axes.tripcolor(surface, pressure, shading="gouraud", cmap="viridis", vmin=low, vmax=high)
    colour_bar(figure, shown, axes, "pressure, force per area")


def _quartered(patch: Patch) -> tuple[Array, IntArray, Array]:
    """Places, triangles and pressures with every quadrangle cut from its middle, so that no diagonal is preferred."""
    at, faces, pressure = patch.chart.at, patch.chart.faces, patch.pressure[patch.chart.node]
    flat = faces[:, 2] == faces[:, 3]
    quads = faces[~flat]
    middle = len(at) + np.arange(len(quads))
    cut = [np.column_stack([quads[:, k], quads[:, (k + 1) % 4], middle]) for k in range(4)]
    places = np.concatenate([at, at[quads].mean(axis=1)])
    return places, np.concatenate([faces[flat, :3], *cut]), np.concatenate([pressure, pressure[quads].mean(axis=1)])


def _status(axes: Axes, patch: Patch, look: Look) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Patch as Swatch

    chart = patch.chart
    (x, y), shear = chart.at.T, patch.shear[chart.node]
    outlines = chart.at[chart.faces]
    axes.add_collection(PolyCollection(list(outlines), facecolors="none", edgecolors="#d0d0cc", lw=0.5, zorder=0))
    size = _marker(patch)
    handles = []
    for words, colour in STATUS_INK.items():
        own = patch.status[chart.node] == words
        if own.any():
            axes.scatter(x[own], y[own], s=size, color=colour, alpha=0.6, edgecolors="none", zorder=1)
            handles.append(Swatch(color=colour, alpha=0.6, label=words))
    some = np.flatnonzero(np.isin(chart.node, patch.arrows))
    if len(some):
        right, up = (np.sum(shear[some] * part[some], axis=1) for part in (chart.first, chart.second))
        low, high = _corners(patch, look)
        scale = np.hypot(right, up).max() / (_longest_arrow(patch) * (high - low).max())
        arrows = (x[some], y[some], right, up)  # as long as points of the map are apart
        axes.quiver(*arrows, color=INK, width=0.003, zorder=2, scale=scale, angles="xy", scale_units="xy")
    label(axes, title="status and friction on the nonmortar body" if len(some) else "status")
    legend_under(axes, handles, len(handles))


def _marker(patch: Patch) -> float:
    """Size of a dot, points squared: about the distance between nodes."""
    low, high = window_of(patch)
    inside = (patch.chart.at >= low) & (patch.chart.at <= high)
    count = max(int(inside.all(axis=1).sum()), 1)
    narrow = (high - low).min() / max((high - low).max(), 1e-300)
    return float(np.clip(2.5e4 * max(narrow, 0.1) / count, 4.0, 300.0))


def window_of(patch: Patch) -> tuple[Array, Array]:
    """Corners of the part to show: the closed nodes and something around them, at most everything."""
    points = patch.chart.at
    closed = points[patch.status[patch.chart.node] != OPEN]
    low, high = points.min(axis=0), points.max(axis=0)
    if not len(closed):
        return low, high
    margin = _PATCH_MARGIN * np.ptp(closed, axis=0).max()
    return np.maximum(low, closed.min(axis=0) - margin), np.minimum(high, closed.max(axis=0) + margin)


def _longest_arrow(patch: Patch) -> float:
    """Of the size of what is shown: about as far as arrows are apart; 0 where there are none."""
    count = len(patch.arrows)
    return min(_LONGEST_ARROW, 1.0 / np.sqrt(count)) if count else 0.0


def _corners(patch: Patch, look: Look) -> tuple[Array, Array]:
    """Lower left and upper right corner of what is shown."""
    if corners := look.corners("right up"):
        low, high = np.array(corners).T
        return low, high
    low, high = window_of(patch)
    edge = max(_EDGE, _longest_arrow(patch)) * (high - low).max()
    return low - edge, high + edge


def _frame(axes: Axes, patch: Patch, look: Look) -> None:
    frame(axes, *_corners(patch, look))
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(colors=INK, labelsize=9)
    label(axes, x=f"{patch.chart.labels[0]}, length", y=f"{patch.chart.labels[1]}, length")
