# SPDX-License-Identifier: BSD-3-Clause
"""Small drawings as SVG: the outlines of bodies, and the pressure along a contact."""

from __future__ import annotations

from itertools import cycle

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.model.mesh import CORNERS
from signorini.model.model import Model
from signorini.plot.camera import best_view
from signorini.plot.curve import surface_coordinate
from signorini.plot.skin import make_skin
from signorini.plot.style import HOOP, PRESSURE, TRACTION
from signorini.plot.walls import FILL_COLOUR, filled, walls_at_rest
from signorini.report.markup import said
from signorini.solution.results import ContactResult

_FILLS = ("#7aa6d6", "#e0b071", "#86bd86", "#c791b6", "#a9a9a4")
_MOST_HEIGHT = 0.9  # of a drawing, over its width
_WALL_MARGIN = 0.06  # of the size of the bodies: how much of obstacles is shown around them
_MOST_POINTS = 300  # of a loop: more cannot be told apart in a small drawing
_MOST_EDGES = 1500  # of bodies in space: the longest ones


def sketch_model(model: Model, width: int = 260) -> str:
    """The bodies, each in a colour, seen from above one corner where they are solid; obstacles of the plane in grey."""
    shapes = _areas(model) if model.dimension == 2 else _creases(model)
    points = np.concatenate([loop for _, loops in shapes for loop in loops])
    low, high = points.min(axis=0), points.max(axis=0)
    walls = walls_at_rest(model)
    if walls:
        low, high = low - _WALL_MARGIN * (high - low).max(), high + _WALL_MARGIN * (high - low).max()
    size = np.maximum(high - low, 1e-3 * np.ptp(points, axis=0).max())
    scale = width / max(size[0], size[1] / _MOST_HEIGHT)
    drawn = []
    for wall in walls:
        ways = "".join(
            _way((loop - low) * scale, size[1] * scale, closed=True) for loop in filled(wall, low, high, width)
        )
        drawn.append(f'<path d="{ways}" fill="{FILL_COLOUR}" fill-rule="evenodd"><title>rigid obstacle</title></path>')
    for (name, loops), colour in zip(shapes, cycle(_FILLS), strict=False):
        ways = "".join(_way((loop - low) * scale, size[1] * scale, closed=model.dimension == 2) for loop in loops)
        look = f'fill="{colour}" fill-opacity=".55"' if model.dimension == 2 else 'fill="none"'
        drawn.append(
            f'<path d="{ways}" {look} fill-rule="evenodd" stroke="{colour}"><title>{said(name)}</title></path>'
        )
    box = f"-2 -2 {size[0] * scale + 4:.0f} {size[1] * scale + 4:.0f}"
    return _svg(box, "".join(drawn), f"the bodies of the model {model.title}", width + 4)


def sketch_contact(contact: ContactResult, width: int = 260) -> str:
    """Pressure, and friction where there is any, along a contact of the plane; nothing in space."""
    own = contact.area > 0
    if contact.points.shape[1] != 2 or own.sum() < 2:
        return ""
    axis, s = surface_coordinate(contact.points[own])
    order = np.argsort(s, kind="stable")
    lines = [(contact.pressure[own][order], PRESSURE, "pressure")]
    for i, friction in enumerate(contact.traction[own][order].reshape(len(order), -1).T):
        lines.append((friction, (TRACTION, HOOP)[i], ("friction", "friction around the axis")[i]))
    lines = [line for line in lines if line[0].any()]
    values = np.concatenate([[0.0], *(line[0] for line in lines)])
    low, high, height = values.min(), values.max(), 0.45 * width
    across = width * (s[order] - s.min()) / (np.ptp(s) or 1.0)
    drawn = []
    for given, colour, name in lines:
        up = height * (given - low) / ((high - low) or 1.0)
        way = _way(np.column_stack([across, up]), height, closed=False)
        drawn.append(f'<path d="{way}" fill="none" stroke="{colour}" stroke-width="2"><title>{name}</title></path>')
    zero = height - height * -low / ((high - low) or 1.0)
    drawn.append(f'<path d="M0 {zero:.1f}H{width}" stroke="currentColor" stroke-opacity=".5"/>')
    words = f"pressure and friction over {axis}, at most {high:.5g}"
    return _svg(f"-2 -2 {width + 4} {height + 4:.0f}", "".join(drawn), words, width)


def _svg(box: str, inside: str, words: str, width: int) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="{width}" role="img" '
        f'style="max-width:100%;height:auto" aria-label="{said(words)}">{inside}</svg>'
    )


def _way(points: Array, height: float, *, closed: bool) -> str:
    """A path of SVG through points (n, 2), whose second coordinate goes up."""
    text = "L".join(f"{x:.1f} {height - y:.1f}" for x, y in points.tolist())
    return f"M{text}Z" if closed else f"M{text}"


def _areas(model: Model) -> list[tuple[str, list[Array]]]:
    """Of every body of the plane its name and the loops around it."""
    owner = model.mesh.by_family(model.body_of_cells())
    blocks = [
        (cells[:, : CORNERS[family]], body)
        for (family, cells), body in zip(model.mesh.cells.items(), owner, strict=True)
    ]
    found = []
    for number, body in enumerate(model.bodies):
        edges = np.concatenate(
            [np.stack([own, np.roll(own, -1, axis=1)], axis=2).reshape(-1, 2) for own in _cells_of(blocks, number)]
        )
        found.append((body.name, [model.mesh.points[_thinned(loop)] for loop in _loops(edges)]))
    return found


def _cells_of(blocks: list[tuple[IntArray, IntArray]], body: int) -> list[IntArray]:
    """Corners of the cells of one body, of every family."""
    return [corners[owner == body] for corners, owner in blocks if (owner == body).any()]


def _loops(edges: IntArray) -> list[IntArray]:
    """The loops of the edges (m, 2) that only one cell has, each in order."""
    _, first, times = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    beside: dict[int, list[int]] = {}
    for a, b in edges[first[times == 1]].tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    loops = []
    while beside:
        here = next(iter(beside))
        loop = [here]
        while beside.get(here):
            there = beside[here].pop()
            beside[there].remove(here)
            for node in (here, there):
                if not beside[node]:
                    del beside[node]
            here = there
            loop.append(here)
        beside.pop(here, None)
        loops.append(np.array(loop))
    return loops


def _thinned(loop: IntArray) -> IntArray:
    return loop[:: -(-len(loop) // _MOST_POINTS)]


def _creases(model: Model) -> list[tuple[str, list[Array]]]:
    """Of every body in space its name and its sharp edges, the longest ones, as they are seen."""
    mesh, owner = model.mesh, model.mesh.by_family(model.body_of_cells())
    skin = make_skin(mesh.points, list(zip(mesh.cells, mesh.cells.values(), owner, strict=True)))
    camera = best_view(skin.spans(skin.points), np.ones(len(skin.body)))
    ends = camera.across(skin.points[skin.edges])
    body, length = skin.body[skin.edge_face], np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    found = []
    for number, part in enumerate(model.bodies):
        sharp = np.flatnonzero((body == number) & skin.sharp)
        chosen = sharp if len(sharp) else np.flatnonzero(body == number)  # a ball has none
        chosen = chosen[np.argsort(-length[chosen], kind="stable")[:_MOST_EDGES]]
        found.append((part.name, list(ends[chosen])))
    return found
