# SPDX-License-Identifier: BSD-3-Clause
"""Make hertz_two_bodies.msh with Gmsh (``pip install gmsh``): right half of a cylinder on a block.

NAFEMS/FENET advanced contact benchmark 1: cylinder of diameter 100, block 200 x 200. The nodes of both contact curves
lie at the same x, so that the meshes match.

    python examples/hertz_two_bodies_mesh.py
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import gmsh
import numpy as np

RADIUS, BLOCK = 50.0, (100.0, 200.0)
CONTACT, STEPS = 10.0, 40  # length of the contact curves along x, and their edges
COARSE = 12.0


def chain(points: list[int]) -> list[int]:
    """Straight edges from point to point, one element each."""
    lines = [gmsh.model.geo.addLine(a, b) for a, b in pairwise(points)]
    for line in lines:
        gmsh.model.geo.mesh.setTransfiniteCurve(line, 2)
    return lines


def surface(lines: list[int], name: str) -> None:
    """One body inside a loop of lines."""
    tag = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(lines)])
    gmsh.model.geo.mesh.setRecombine(2, tag)
    gmsh.model.addPhysicalGroup(2, [tag], name=name)


def main() -> None:
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("hertz")
    fine = CONTACT / STEPS
    x = np.linspace(0.0, CONTACT, STEPS + 1)
    point = gmsh.model.geo.addPoint

    centre = point(0, RADIUS, 0, COARSE)
    arc = [point(xi, RADIUS - np.sqrt(RADIUS**2 - xi**2), 0, fine) for xi in x]
    side, pole = point(RADIUS, RADIUS, 0, COARSE), point(0, 2 * RADIUS, 0, COARSE / 3)
    contact = chain(arc)
    rest = [gmsh.model.geo.addCircleArc(arc[-1], centre, side), gmsh.model.geo.addCircleArc(side, centre, pole)]
    axis = gmsh.model.geo.addLine(pole, arc[0])
    surface([*contact, *rest, axis], "cylinder")
    gmsh.model.addPhysicalGroup(1, contact, name="cylinder_contact")
    gmsh.model.addPhysicalGroup(1, [axis], name="cylinder_axis")
    gmsh.model.addPhysicalGroup(0, [pole], name="pole")

    top = [point(xi, 0, 0, fine) for xi in x]
    right = [point(BLOCK[0], 0, 0, COARSE), point(BLOCK[0], -BLOCK[1], 0, COARSE)]
    foot = point(0, -BLOCK[1], 0, COARSE)
    seat = chain(top)
    outer = [gmsh.model.geo.addLine(a, b) for a, b in ((top[-1], right[0]), (right[0], right[1]), (right[1], foot))]
    axis = gmsh.model.geo.addLine(foot, top[0])
    surface([*seat, *outer, axis], "block")
    gmsh.model.addPhysicalGroup(1, seat, name="block_contact")
    gmsh.model.addPhysicalGroup(1, [axis], name="block_axis")
    gmsh.model.addPhysicalGroup(1, [outer[-1]], name="base")

    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(2)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.write(str(Path(__file__).with_name("hertz_two_bodies.msh")))
    gmsh.finalize()


if __name__ == "__main__":
    main()
