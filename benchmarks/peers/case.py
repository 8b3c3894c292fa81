# SPDX-License-Identifier: BSD-3-Clause
"""The paper's cylinder for other codes: the same mesh, loads and supports, as a CalculiX deck or as arrays.

The quarter cylinder of ``signorini.gallery.cylinder``, bilinear quadrilaterals, plane strain, small displacements,
uniform traction on the cut, one increment.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.gallery.cylinder import FORCE, NU, RADIUS, E
from signorini.meshing.plane import quarter_disk

CALCULIX_PENALTY = 1e4
"""Pressure per overlap. Its stick slope is a tenth, the manual's advice for the ratio is 1 to 100."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """Nodes (n, 2), cells (m, 4), end nodes of the facets of each boundary, and the traction on the cut."""

    points: Array
    cells: IntArray
    arc: IntArray
    axis: IntArray
    cut: IntArray
    traction: float

    @property
    def arc_nodes(self) -> IntArray:
        """Nodes of the arc, from the pole upwards."""
        nodes: IntArray = np.unique(self.arc)
        up: IntArray = nodes[np.argsort(self.points[nodes, 0] + self.points[nodes, 1])]
        return up

    @property
    def arc_lengths(self) -> Array:
        """Tributary length of each of ``arc_nodes``."""
        half = np.linalg.norm(np.diff(self.points[self.arc_nodes], axis=0), axis=1) / 2
        lengths: Array = np.append(half, 0.0) + np.append(0.0, half)
        return lengths


def cylinder_case(refine: int) -> Case:
    """The gallery's mesh with every edge of the paper's divided by ``refine``."""
    mesh = quarter_disk(radius=RADIUS, contact_length=4.0, contact_spacing=0.5, refine=refine)
    return Case(
        points=mesh.points,
        cells=mesh.cells["quad"],
        arc=mesh.boundaries["arc"],
        axis=mesh.boundaries["axis"],
        cut=mesh.boundaries["cut"],
        traction=FORCE / 2 / RADIUS,
    )


def write_arrays(case: Case, file: Path) -> None:
    """For ``getfem_cylinder.py``, which runs without signorini."""
    np.savez(
        file,
        points=case.points,
        cells=case.cells,
        arc=case.arc_nodes,
        arc_lengths=case.arc_lengths,
        axis=np.unique(case.axis),
        cut=np.unique(case.cut),
        traction=case.traction,
        approach=FORCE / 2 / E,
        E=E,
        nu=NU,
    )


def write_calculix(case: Case, file: Path, *, friction: float) -> None:
    """Surface to surface contact on one fixed element below y = 0."""
    n, m = len(case.points), len(case.cells)
    ground = np.array([(-1.0, -2.0), (9.0, -2.0), (9.0, 0.0), (-1.0, 0.0)])
    points = np.vstack([case.points, ground])
    cells = np.vstack([case.cells, n + np.arange(4)])
    nodes = "\n".join(f"{i},{x:.15g},{y:.15g},0." for i, (x, y) in enumerate(points, start=1))
    elements = [",".join(map(str, (i, *(cell + 1)))) for i, cell in enumerate(cells, start=1)]
    friction_lines = [f"*FRICTION\n{friction},{CALCULIX_PENALTY / 10:g}"] if friction > 0 else []
    blocks = [
        f"*NODE\n{nodes}",
        "*ELEMENT,TYPE=CPE4,ELSET=DISK\n" + "\n".join(elements[:m]),
        "*ELEMENT,TYPE=CPE4,ELSET=GROUND\n" + elements[m],
        node_set("AXIS", np.unique(case.axis)),
        node_set("ARC", case.arc_nodes),
        node_set("FIXED", n + np.arange(4)),
        "*SURFACE,NAME=SLAVE\n" + "\n".join(f"{cell},S{side}" for cell, side in faces(case.cells, case.arc)),
        f"*SURFACE,NAME=MASTER\n{m + 1},S3",
        f"*MATERIAL,NAME=ELASTIC\n*ELASTIC\n{E:g},{NU:g}",
        *(f"*SOLID SECTION,ELSET={part},MATERIAL=ELASTIC\n1." for part in ("DISK", "GROUND")),
        f"*SURFACE INTERACTION,NAME=LAW\n*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR\n{CALCULIX_PENALTY:g}",
        *friction_lines,
        "*CONTACT PAIR,INTERACTION=LAW,TYPE=SURFACE TO SURFACE\nSLAVE,MASTER",
        "*BOUNDARY\nAXIS,1,1\nFIXED,1,3",
        "*STEP\n*STATIC\n1.,1.",
        "*DLOAD\n" + "\n".join(f"{cell},P{side},{case.traction:.15g}" for cell, side in faces(case.cells, case.cut)),
        "*NODE FILE,OUTPUT=2D,NSET=ARC\nU\n*CONTACT FILE\nCDIS,CSTR\n*END STEP",
    ]
    file.write_text("\n".join(blocks) + "\n")


def node_set(name: str, nodes: IntArray) -> str:
    """Lines of a deck that name nodes, numbered from 0."""
    return f"*NSET,NSET={name}\n" + "\n".join(f"{node + 1}," for node in nodes)


def faces(cells: IntArray, facets: IntArray) -> list[tuple[int, int]]:
    """Cell and side, both from 1, of each facet."""
    near = np.nonzero(np.isin(cells, facets).sum(axis=1) >= 2)[0]
    sides = {
        frozenset(pair): (cell + 1, side + 1)
        for side in range(4)
        for cell, pair in zip(near.tolist(), cells[near][:, [side, (side + 1) % 4]].tolist(), strict=True)
    }
    return [sides[frozenset(facet)] for facet in facets.tolist()]
