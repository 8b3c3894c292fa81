# SPDX-License-Identifier: BSD-3-Clause
"""Flat punches on bodies that yield, Prandtl's problem, in the plane and on a layer of solids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

import numpy as np

from signorini.gallery.large_bodies import graded_lines, with_seat
from signorini.gallery.yielding import PERFECT, SHEAR_STRENGTH
from signorini.meshing.plane import Cells, rectangle
from signorini.meshing.solid import extruded
from signorini.meshing.tetrahedra import tetrahedra
from signorini.model.body import Body, Formulation
from signorini.model.conditions import Load, Support
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.step import Step

_GROWTH = 1.15
"""From cell to cell away from the edge of the punch: the fan of shear about it is as fine at every radius."""
_WIDTH, _DEPTH = 4.0, 2.0
"""Of the block: flow under a rough punch reaches 3 aside and sqrt(2) down, under a smooth one 2 and 1 / sqrt(2)."""

_RAISED: Mapping[str, str] = {
    "hexahedron": "quad",
    "hexahedron and wedge": "quad",
    "hexahedron20": "quad8",
    "hexahedron27": "quad9",
    "tetra10": "quad9",
    "wedge15": "triangle6",
}
"""Cells of a layer, and of the plane mesh that it is made of."""
_WEDGES = 0.1
"""Of the cells among hexahedra: as many as bodies that yield may have."""


def footing(
    pressure: float = 0.0,
    *,
    edge: float,
    cells: str = "quad",
    formulation: Formulation | None = None,
    depth: float = 0.0,
    rough: bool = False,
) -> Model:
    """Half of a perfectly plastic block under a flat punch of half-width 1, pressed by a mean pressure or driven.

    Parameters
    ----------
    pressure : mean, force per area; at factor 1 of "punch"
    edge : size of the cells at the edge of the punch, length
    cells : "quad", "quad8", ... in plane strain; "hexahedron", "tetra10", "hexahedron and wedge", ... of a layer, one
        cell thick, that cannot move across
    formulation : of the cells
    depth : to which the punch is driven instead, length
    rough : whether it holds the surface sideways
    """
    mesh = with_seat(_block(edge, _RAISED.get(cells, cells)), "top", 1.0)
    supports: dict[str, tuple[float | None, ...]] = {
        "left": (0.0, None),
        "right": (0.0, None),
        "bottom": (0.0, 0.0),
        "seat": (0.0 if rough else None, -depth if depth else None),
    }
    force: tuple[float | None, ...] = (None, -pressure)
    if cells in _RAISED:
        if cells == "hexahedron and wedge":
            mesh = _some_triangles(mesh)
        mesh = extruded(mesh, z=[0.0, edge], ends=("back", "front"))
        mesh = tetrahedra(mesh) if cells == "tetra10" else mesh
        supports = {side: (*u, None) for side, u in supports.items()}
        supports |= dict.fromkeys(("back", "front"), (None, None, 0.0))
        force = (None, -pressure * edge, None)
    held = {side: u for side, u in supports.items() if any(part is not None for part in u)}
    (name,) = mesh.bodies
    return Model(
        mesh,
        title="Flat punch on a body that yields",
        bodies=[Body(name, Elastic(E=1000.0 * SHEAR_STRENGTH, nu=0.3, plastic=PERFECT), formulation)],
        supports=[Support(side, u=u, name="punch" if side == "seat" and depth else side) for side, u in held.items()],
        loads=[] if depth else [Load("seat", force=force, spread="displacement", name="punch")],
        steps=[Step(name="press", increments=1)],
    )


def _block(edge: float, cells: str) -> Mesh:
    """The plane block right of the middle of the punch and below it."""
    under, beside, down = (graded_lines(edge, edge, far, _GROWTH) for far in (1.0, _WIDTH - 1.0, _DEPTH))
    return rectangle(x=np.concatenate([1.0 - under[::-1], 1.0 + beside[1:]]), y=-down[::-1], cells=cast(Cells, cells))


def _some_triangles(mesh: Mesh) -> Mesh:
    """A plane mesh whose squares about the edge of the punch are cut, into as many triangles as wedges may be."""
    quads, (name,) = mesh.cells["quad"], mesh.bodies
    away = np.argsort(np.hypot(*(mesh.points[quads].mean(axis=1) - (1.0, 0.0)).T), kind="stable")
    count = int(_WEDGES * len(quads) / (2.0 - _WEDGES))
    cut, whole = quads[away[:count]], quads[away[count:]]
    cells = {"quad": whole, "triangle": np.concatenate([cut[:, :3], cut[:, [0, 2, 3]]])}
    return replace(mesh, cells=cells, bodies={name: np.arange(len(whole) + 2 * count)})
