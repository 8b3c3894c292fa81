# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a model before it is solved: bodies, named boundaries, supports, loads, contacts and obstacles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.model.conditions import Load
from signorini.model.mesh import CORNERS
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle
from signorini.plot.camera import Camera, best_view
from signorini.plot.field import BODIES, draw_edges
from signorini.plot.paint import body_paint, paint_skin
from signorini.plot.picture_data import CELL_OUTLINES
from signorini.plot.skin import make_skin
from signorini.plot.style import INK, TRACTION, entitle, frame, label, literal
from signorini.plot.units import units_of
from signorini.plot.walls import draw_walls, walls_at_rest

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BOUNDARIES = ("#1b4f8a", "#8a5a1b", "#2f8f5b", "#7a3b8f", "#b03a5b", "#4a7a8a")
_SUPPORT, _LOAD = "#2f8f5b", TRACTION
_ARROW = 0.09  # of the size of the model: length of an arrow
_MOST_MARKS = 9  # of one support or load
_ROOM = 0.16  # of the size of the model: around it, for arrows and names


@dataclass(frozen=True, kw_only=True, eq=False)
class _Stage:
    """Where a model is drawn.

    Attributes
    ----------
    axes : of the figure
    points : (n, 2) nodes in the picture
    camera : of a model in space; None in the plane
    size : of the model in the picture, length
    """

    axes: Axes
    points: Array
    camera: Camera | None
    size: float

    def across(self, vectors: Array) -> Array:
        """Vectors (k, d) in the picture, (k, 2)."""
        return vectors if self.camera is None else self.camera.across(vectors)


def draw_model(model: Model) -> Figure:
    """The undeformed mesh, a colour a body; boundaries by name, what supports hold, where loads act and which way.

    Arrows of supports point to where they hold, those of loads to where they push; all are equally long.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    figure = Figure(figsize=(9.0, 7.0), layout="constrained")
    axes = figure.add_subplot()
    stage = (_plane if model.dimension == 2 else _solid)(axes, model)
    handles: list[Line2D | Patch] = [
        Patch(facecolor=colour, edgecolor="#7d7d7d", label=body.name)
        for body, colour in zip(model.bodies, cycle(BODIES), strict=False)
    ]
    for (name, nodes), colour in zip(_boundaries(model), cycle(_BOUNDARIES), strict=False):
        _draw_boundary(stage, name, nodes, colour)
    for support in model.supports:
        held = np.array([part is not None for part in support.u[: model.dimension]])
        _draw_support(stage, _nodes_at(model, support.on), held)
    if model.supports:
        handles.append(Line2D([], [], marker=">", ls="", color=_SUPPORT, label="holds"))
    loads = [_draw_load(stage, model, load) for load in model.loads]
    if any(loads):
        handles.append(Line2D([], [], marker=">", ls="-", color=_LOAD, label="loads"))
    figure.legend(handles=handles, fontsize=9, frameon=False, loc="outside lower center", ncols=max(len(handles), 1))
    words = [f"{len(model.mesh.points)} nodes, {model.mesh.number_of_cells} elements, {model.kind}"]
    words += [f"{contact.label}: {contact.nonmortar} on {_side(contact.mortar)}" for contact in model.contacts[:3]]
    words += [f"not drawn: {names}"] if (names := ", ".join(_hidden(model, loads))) else []
    entitle(figure, model.title or "model", "\n".join(words))
    return literal(figure, units_of(model.units))


def _side(mortar: str | Obstacle) -> str:
    return mortar if isinstance(mortar, str) else str(mortar)


def _hidden(model: Model, loads: Sequence[bool]) -> Iterator[str]:
    """Loads that no arrow stands for: temperatures, and what acts on whole bodies without one direction."""
    for load, drawn in zip(model.loads, loads, strict=True):
        if not drawn:
            yield f"{load.label} ({load.kind.replace('_', ' ')})"


def _plane(axes: Axes, model: Model) -> _Stage:
    """Bodies and obstacles of the plane."""
    from matplotlib.collections import PolyCollection

    points = np.asarray(model.mesh.points)
    size = float(np.ptp(points, axis=0).max())
    frame(axes, points.min(axis=0) - _ROOM * size, points.max(axis=0) + _ROOM * size)
    owner = model.mesh.by_family(model.body_of_cells())
    outlines = [cells[:, CELL_OUTLINES[family]] for family, cells in model.mesh.cells.items()]
    for cells, body in zip(outlines, owner, strict=True):
        faces = [BODIES[i % len(BODIES)] for i in body]
        axes.add_collection(PolyCollection(list(points[cells]), facecolors=faces, edgecolors="none"))
    draw_edges(axes, outlines, points, colour="#9d9d9d", alpha=1.0)
    draw_walls(axes, walls_at_rest(model), moved=False)
    names = ("radius", "height") if model.axisymmetric else ("x", "y")
    label(axes, x=f"{names[0]}, length", y=f"{names[1]}, length")
    axes.tick_params(colors=INK, labelsize=9)
    return _Stage(axes=axes, points=points, camera=None, size=size)


def _solid(axes: Axes, model: Model) -> _Stage:
    """The skin of bodies in space."""
    mesh = model.mesh
    owner = mesh.by_family(model.body_of_cells())
    skin = make_skin(np.asarray(mesh.points), list(zip(mesh.cells, mesh.cells.values(), owner, strict=True)))
    camera = best_view(skin.spans(skin.points), np.ones(len(skin.body)))
    seen = camera.across(skin.points)
    size = float(np.ptp(seen, axis=0).max())
    frame(axes, seen.min(axis=0) - _ROOM * size, seen.max(axis=0) + _ROOM * size)
    axes.set_axis_off()
    paint_skin(axes, skin, skin.points, camera, body_paint(BODIES))
    return _Stage(axes=axes, points=camera.across(np.asarray(mesh.points)), camera=camera, size=size)


def _boundaries(model: Model) -> Iterator[tuple[str, list[IntArray]]]:
    """Names of boundaries with the corners of their facets."""
    for name in model.mesh.boundaries:
        per_facet = 2 if model.dimension == 2 else 4
        yield name, [facets[:, : min(per_facet, facets.shape[1])] for facets in model.mesh.facets(name)]


def _draw_boundary(stage: _Stage, name: str, blocks: list[IntArray], colour: str) -> None:
    from matplotlib.collections import LineCollection, PolyCollection

    for facets in blocks:
        corners = list(stage.points[facets])
        if stage.camera is None:
            stage.axes.add_collection(LineCollection(corners, colors=colour, lw=1.8, zorder=3), autolim=False)
        else:
            shade = PolyCollection(corners, facecolors=colour, alpha=0.16, edgecolors="none", zorder=3)
            stage.axes.add_collection(shade, autolim=False)
    centres = np.concatenate([stage.points[facets].mean(axis=1) for facets in blocks])
    sizes = np.concatenate([np.linalg.norm(np.ptp(stage.points[facets], axis=1), axis=1) for facets in blocks])
    middle = np.average(centres, axis=0, weights=sizes ** (1 if stage.camera is None else 2))
    at = centres[np.argmin(np.linalg.norm(centres - middle, axis=1))]
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1.0}
    stage.axes.text(
        float(at[0]), float(at[1]), name, fontsize=8.5, color=colour, ha="center", va="center", bbox=box, zorder=6
    )


def _nodes_at(model: Model, on: str | tuple[float, ...]) -> IntArray:
    """Nodes of a place, the nearest one of a point, those of the mesh around a rigid body, as far as it is known."""
    if not isinstance(on, str):
        return np.array([np.argmin(np.linalg.norm(model.mesh.points - np.array(on), axis=1))])
    for rigid in model.rigid_bodies:
        if rigid.name == on and isinstance(rigid.on, str):
            return model.mesh.nodes_of(rigid.on)
    if on in model.mesh.bodies:
        own = np.zeros(len(model.mesh.points), bool)
        number = [body.name for body in model.bodies].index(on)
        owner = model.mesh.by_family(model.body_of_cells())
        for (family, cells), body in zip(model.mesh.cells.items(), owner, strict=True):
            own[cells[body == number][:, : CORNERS[family]]] = True
        return np.flatnonzero(own)
    known = on in model.mesh.boundaries or on in model.mesh.nodes
    return model.mesh.nodes_of(on) if known else np.zeros(0, np.int64)


def _some(nodes: IntArray) -> IntArray:
    """At most `_MOST_MARKS` of the nodes."""
    chosen = np.linspace(0, len(nodes) - 1, min(_MOST_MARKS, len(nodes))).round().astype(int)
    return nodes[chosen]


def _draw_support(stage: _Stage, nodes: IntArray, held: Array) -> None:
    """An arrow to some of the nodes along every direction that is held."""
    if not len(nodes):
        return
    for way in np.eye(len(held))[np.flatnonzero(held)]:
        along = 0.6 * _ARROW * stage.size * stage.across(way[None])[0]
        _arrows(stage, stage.points[_some(nodes)] - along, along, _SUPPORT)


def _draw_load(stage: _Stage, model: Model, load: Load) -> bool:
    """Arrows of a load that has one direction, or pushes; whether there were any."""
    kind, nodes = load.kind, _nodes_at(model, load.on)
    value = getattr(load, kind)
    if not len(nodes) or kind in ("temperature", "centrifugal"):
        return False
    if kind == "pressure":
        ways = -_outward(model, nodes)
    elif kind == "nodal_forces":
        ways = np.asarray(value)
    elif isinstance(value, tuple):
        ways = np.array([part if isinstance(part, float | int) else float(part is not None) for part in value])
        ways = np.broadcast_to(ways[: model.dimension], (len(nodes), model.dimension))
    else:
        return False
    middle = isinstance(load.on, str) and load.on in model.mesh.bodies
    chosen = np.full(1, len(nodes) // 2) if middle else _some(np.arange(len(nodes)))
    flat = stage.across(np.asarray(ways, float)[chosen])
    length = np.linalg.norm(flat, axis=1, keepdims=True)
    if not length.any():
        return False
    along = _ARROW * stage.size * flat / np.where(length > 0.0, length, 1.0)
    tips = stage.points[nodes[chosen]]
    _arrows(stage, tips - along, along, _LOAD)
    return True


def _outward(model: Model, nodes: IntArray) -> Array:
    """Mean outward directions at nodes of the outside, (k, d): away from the middles of the cells beside them."""
    points = np.asarray(model.mesh.points)
    away, count = np.zeros_like(points), np.zeros(len(points))
    for family, cells in model.mesh.cells.items():
        corners = cells[:, : CORNERS[family]]
        middle = points[corners].mean(axis=1)
        for k in range(cells.shape[1]):
            np.add.at(away, cells[:, k], points[cells[:, k]] - middle)
            np.add.at(count, cells[:, k], 1.0)
    return np.asarray(away[nodes])


def _arrows(stage: _Stage, tails: Array, along: Array, colour: str) -> None:
    along = np.broadcast_to(along, tails.shape)
    stage.axes.quiver(
        *tails.T, *along.T, angles="xy", scale_units="xy", scale=1.0, color=colour, width=0.0035, zorder=5
    )
