# SPDX-License-Identifier: BSD-3-Clause
"""Make bolted_bracket.msh with Gmsh (``pip install gmsh``): half of an angle bracket that is bolted to a base.

Millimetres; y = 0 is the plane of symmetry, z = 0 the joint, the bolt (M10) goes along z. Tetrahedra of 10 nodes; the
sides of the joint do not match. Edges are shorter by a factor, if one is given.

    python examples/bolted_bracket_mesh.py [factor [file]]
"""

from __future__ import annotations

import sys
from pathlib import Path

import gmsh

WIDTH = 20.0  # half of it; the foot ends round about the bolt, the web about its eye
THICKNESS, BEND = 10.0, 6.0  # radius inside the bend
WEB, EYE = 30.0, 40.0  # inner face of the web, height of the eye
HEEL = 31.0  # where the side of the joint ends, some way up the bend
BORE, WASHER, THREAD, EYE_RADIUS = 5.5, 10.0, 4.25, 6.0
BORDER, DEPTH, MOUTH = 6.0, 20.0, 5.0  # the base around and below the foot, the wide part of its hole
FINE, FINER, COARSE = 3.0, 2.0, 10.0  # edges about the bolt, along the bend, and far from the joint

Solids = list[tuple[int, int]]
Point = tuple[float, float, float]


def bracket() -> int:
    """Foot, bend and web with bore and eye; its skin is cut where washer and joint end."""
    occ = gmsh.model.occ
    end = WEB + THICKNESS
    foot = [(3, occ.addBox(0, 0, 0, end, WIDTH, THICKNESS)), (3, occ.addCylinder(0, 0, 0, 0, 0, THICKNESS, WIDTH))]
    web = [
        (3, occ.addBox(WEB, 0, 0, THICKNESS, WIDTH, EYE)),
        (3, occ.addCylinder(WEB, 0, EYE, THICKNESS, 0, 0, WIDTH)),
    ]
    whole, _ = occ.fuse(foot, web)
    for corner, radius in (((WEB, THICKNESS), BEND), ((end, 0.0), BEND + THICKNESS)):
        occ.synchronize()
        edge = [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*around(*corner), dim=1)]
        whole = occ.fillet([whole[0][1]], edge, [radius])
    holes = [
        (3, occ.addCylinder(0, 0, 0, 0, 0, THICKNESS, BORE)),
        (3, occ.addCylinder(WEB, 0, EYE, THICKNESS, 0, 0, EYE_RADIUS)),
    ]
    solid = half(occ.cut(whole, holes)[0])
    outer = BEND + THICKNESS
    rise = outer - (outer**2 - (HEEL - end + outer) ** 2) ** 0.5  # of the bend, up to the heel
    washer = (2, occ.addDisk(0, 0, THICKNESS, WASHER, WASHER))
    heel = (1, occ.addLine(occ.addPoint(HEEL, 0, rise), occ.addPoint(HEEL, WIDTH, rise)))
    pieces, _ = occ.fragment(solid, [washer, heel])
    occ.remove([piece for piece in pieces if piece[0] < 3], recursive=True)
    return int(next(tag for dimension, tag in pieces if dimension == 3))


def base() -> int:
    """A block with a threaded hole, wider at its mouth."""
    occ = gmsh.model.occ
    block = [(3, occ.addBox(-BORDER - WIDTH, 0, -DEPTH, 2 * BORDER + WIDTH + WEB + THICKNESS, BORDER + WIDTH, DEPTH))]
    hole = [
        (3, occ.addCylinder(0, 0, -DEPTH, 0, 0, DEPTH, THREAD)),
        (3, occ.addCylinder(0, 0, -MOUTH, 0, 0, MOUTH, BORE)),
    ]
    return int(half(occ.cut(block, hole)[0])[0][1])


def half(solid: Solids) -> Solids:
    """What lies at y >= 0."""
    found: Solids = gmsh.model.occ.intersect(solid, [(3, gmsh.model.occ.addBox(-100, 0, -100, 200, 100, 200))])[0]
    return found


def around(x: float, z: float) -> tuple[float, float, float, float, float, float]:
    """A box about a straight line along y."""
    return x - 0.1, -50.0, z - 0.1, x + 0.1, 50.0, z + 0.1


def inside(solid: int, low: Point, high: Point) -> set[int]:
    """The faces of a solid that lie in a box."""
    gap = 0.01
    box = [x - gap for x in low] + [x + gap for x in high]
    own = {tag for _, tag in gmsh.model.getBoundary([(3, solid)], oriented=False)}
    return own & {tag for _, tag in gmsh.model.getEntitiesInBoundingBox(*box, dim=2)}


def name_parts(upper: int, lower: int) -> None:
    """Bodies and boundaries, as the deck calls them."""
    far, end = 100.0, WEB + THICKNESS
    for name, tags in {
        "foot": inside(upper, (-WIDTH, 0, 0), (HEEL, WIDTH, 0.5 * THICKNESS)),
        "washer": inside(upper, (-WASHER, 0, THICKNESS), (WASHER, WASHER, THICKNESS)),
        "eye": inside(upper, (WEB, 0, EYE - EYE_RADIUS), (end, EYE_RADIUS, EYE + EYE_RADIUS)),
        "bracket_middle": inside(upper, (-far, 0, -far), (far, 0, far)),
        "seat": inside(lower, (-far, 0, 0), (far, far, 0)),
        "thread": inside(lower, (-THREAD, 0, -DEPTH), (THREAD, THREAD, -MOUTH)),
        "bottom": inside(lower, (-far, 0, -DEPTH), (far, far, -DEPTH)),
        "base_middle": inside(lower, (-far, 0, -far), (far, 0, far)),
    }.items():
        gmsh.model.addPhysicalGroup(2, sorted(tags), name=name)
    gmsh.model.addPhysicalGroup(3, [upper], name="bracket")
    gmsh.model.addPhysicalGroup(3, [lower], name="base")


def grade(upper: int, lower: int, factor: float) -> None:
    """Short edges where the joint is pressed: about the bolt and along the beginning of the bend."""
    size, fields = gmsh.model.mesh.field, []
    bolt = f"{FINE} + 0.4 * Max(Sqrt(x*x + y*y) - 15, 0)"
    bend = f"{FINER} + 0.8 * Max(Abs(x - {WEB - BEND}) - 1, 0)"
    below = "0.6 * Max(Abs(z) - 2, 0)"
    for solid, share in ((upper, 1.0), (lower, 0.9)):
        grown = size.add("MathEval")
        size.setString(grown, "F", f"{share / factor} * Min(Min({bolt}, {bend}) + {below}, {COARSE})")
        own = size.add("Restrict")
        size.setNumber(own, "InField", grown)
        size.setNumbers(own, "VolumesList", [solid])
        fields.append(own)
    both = size.add("Min")
    size.setNumbers(both, "FieldsList", fields)
    size.setAsBackgroundMesh(both)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)


def main(factor: float, file: Path) -> None:
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("bracket")
    upper, lower = bracket(), base()
    gmsh.model.occ.synchronize()
    name_parts(upper, lower)
    grade(upper, lower, factor)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 1)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(file))
    gmsh.finalize()


if __name__ == "__main__":
    given = dict(enumerate(sys.argv))
    main(float(given.get(1, "1")), Path(given.get(2, Path(__file__).with_name("bolted_bracket.msh"))))
