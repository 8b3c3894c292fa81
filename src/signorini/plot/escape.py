# SPDX-License-Identifier: BSD-3-Clause
"""The picture of why there is no equilibrium: the rigid motion along which bodies run away."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.errors import InputError
from signorini.plot.camera import best_view
from signorini.plot.oblique import HOOP_WORDS, oblique
from signorini.plot.paint import body_paint, paint_skin
from signorini.plot.skin import make_skin
from signorini.plot.style import INK, PRESSURE, TRACTION, entitle, frame, legend_below
from signorini.solution.history import History

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOTION_SIZE = 0.12  # of the size of the model: large enough to be seen, and the bodies stay in the picture
_MAX_ARROWS = 12
_RUNS, _STAYS = "#eab39a", "#e4ecf4"


def plot_escape(history: History) -> Figure:
    """The bodies where they are, and where the motion takes them.

    Raises
    ------
    InputError
        If the history has no such motion.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    if history.escape is None:
        raise InputError("no body runs away in this history; there is nothing to draw")
    points = np.asarray(history.model.mesh.points)
    size = float(np.ptp(points, axis=0).max())
    motion = _MOTION_SIZE * size * np.asarray(history.escape)
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_axis_off()
    draw = _plane if history.model.dimension == 2 else _solid
    flat, along = draw(axes, history, points, motion)
    moving = np.flatnonzero(np.linalg.norm(motion, axis=1) > 1e-6 * size)
    chosen = moving[np.linspace(0, len(moving) - 1, min(_MAX_ARROWS, len(moving))).astype(int)]
    axes.quiver(
        *flat[chosen].T, *along[chosen].T, angles="xy", scale_units="xy", scale=1.0, color=INK, width=0.004, zorder=4
    )
    around = f"\n{HOOP_WORDS}" if history.model.twists else ""
    names = ", ".join(f"'{name}'" for name in _running(history, np.linalg.norm(motion, axis=1) > 1e-6 * size))
    title = f"no equilibrium: the loads carry {names} away{around}"
    entitle(figure, history.model.title, title)
    plane = history.model.dimension == 2
    looks = (("where they are", PRESSURE if plane else _STAYS), ("where they go", TRACTION if plane else _RUNS))
    arrow = Line2D([], [], color=INK, marker=">", ls="-", label="the motion, whatever its size")
    legend_below(figure, [*(Patch(color=colour, label=words) for words, colour in looks), arrow])
    return figure


def _running(history: History, moves: BoolArray) -> Iterator[str]:
    """Names of bodies some of whose nodes are among those that move, (n,)."""
    model = history.model
    owner = model.mesh.by_family(model.body_of_cells())
    for number, body in enumerate(model.bodies):
        if any(moves[cells[own == number]].any() for cells, own in zip(model.mesh.cells.values(), owner, strict=True)):
            yield body.name


def _plane(axes: Axes, history: History, points: Array, motion: Array) -> tuple[Array, Array]:
    """Meshes of the plane at both places; the points and their motion in the picture."""
    from matplotlib.collections import PolyCollection

    motion = oblique(motion)
    for where, colour, alpha in ((points, PRESSURE, 0.35), (points + motion, TRACTION, 0.8)):
        for family, cells in history.model.mesh.cells.items():
            corners = cells[:, : 3 if family.startswith("triangle") else 4]
            faces = list(where[corners])
            axes.add_collection(PolyCollection(faces, facecolors="none", edgecolors=colour, lw=0.6, alpha=alpha))
    axes.autoscale_view()
    return points, motion


def _solid(axes: Axes, history: History, points: Array, motion: Array) -> tuple[Array, Array]:
    """The skin of the bodies where they go, and the edges of those that go where they are."""
    from matplotlib.collections import LineCollection

    mesh, owner = history.model.mesh, history.model.body_of_cells()
    skin = make_skin(points, list(zip(mesh.cells, mesh.cells.values(), mesh.by_family(owner), strict=True)))
    camera = best_view(skin.spans(skin.points), np.ones(len(skin.body)))
    moved = skin.points + skin.values(motion)
    seen = camera.across(np.concatenate([skin.points, moved]))
    room = 0.05 * np.ptp(seen, axis=0).max()
    frame(axes, seen.min(axis=0) - room, seen.max(axis=0) + room)
    runs = np.bincount(skin.body[skin.face], np.abs(skin.values(motion)[skin.pieces]).sum(axis=(1, 2))) > 0.0
    paint_skin(axes, skin, moved, camera, body_paint([_RUNS if run else _STAYS for run in runs]))
    left = skin.sharp & runs[skin.body[skin.edge_face]]
    lines = camera.across(skin.points[skin.edges[left]])
    axes.add_collection(LineCollection(list(lines), colors=PRESSURE, lw=0.9, alpha=0.8, zorder=3))
    return camera.across(points), camera.across(motion)
