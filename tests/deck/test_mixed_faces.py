# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of triangles and quadrilaterals from Gmsh and from keywords, through runs to files and pictures."""

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.deck import load_deck
from signorini.meshing.read import read_mesh
from signorini.model.mesh import FACETS

TYPES = {"hexahedron": "C3D8", "wedge": "C3D6", "hexahedron20": "C3D20", "wedge15": "C3D15"}
SURFACES = ("foot", "low.top", "up.bottom", "load")
LAW = """*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*SOLID SECTION, ELSET=low, MATERIAL=M
*SOLID SECTION, ELSET=up, MATERIAL=M
*SURFACE INTERACTION, NAME=I
*FRICTION
0.3
*CONTACT PAIR, INTERACTION=I
up.bottom, low.top
*BOUNDARY
foot, 1, 3
*STEP
*STATIC
*DSLOAD
load, P, 10.
*END STEP
"""
TOML = """
[mesh]
file = "mesh.msh"

[material.M]
E = 1000.0
nu = 0.3

[[body]]
name = "low"
material = "M"

[[body]]
name = "up"
material = "M"

[[support]]
on = "foot"
u = [0, 0, 0]

[[load]]
on = "load"
pressure = 10.0

[[contact]]
nonmortar = "up.bottom"
mortar = "low.top"
friction = 0.3
"""


@pytest.fixture(scope="module", params=[1, 2])
def folder(request, tmp_path_factory):
    """Two blocks that Gmsh extrudes, one half of each recombined to hexahedra, the other left as wedges."""
    gmsh = pytest.importorskip("gmsh")
    path = tmp_path_factory.mktemp("mixed")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        found = {}
        for name, z, ends in (("low", 0.0, ("foot", "low.top")), ("up", 1.0, ("up.bottom", "load"))):
            floors = [gmsh.model.occ.addRectangle(x, 0, z, 1, 2) for x in (0, 1)]
            gmsh.model.occ.fragment([(2, floors[0])], [(2, floors[1])])
            gmsh.model.occ.synchronize()
            raised = gmsh.model.occ.extrude([(2, floor) for floor in floors], 0, 0, 1, numElements=[2], recombine=True)
            gmsh.model.occ.synchronize()
            for _, curve in gmsh.model.getBoundary([(2, floor) for floor in floors], combined=False, oriented=False):
                gmsh.model.mesh.setTransfiniteCurve(curve, 4)
            for floor in floors:
                gmsh.model.mesh.setTransfiniteSurface(floor)
            gmsh.model.mesh.setRecombine(2, floors[name == "up"])  # opposite triangles
            found[name] = [tag for dimension, tag in raised if dimension == 3]
            for end, height in zip(ends, (z, z + 1.0), strict=True):
                flat = gmsh.model.getEntitiesInBoundingBox(-0.1, -0.1, height - 0.1, 2.1, 2.1, height + 0.1, 2)
                own = np.concatenate([gmsh.model.getAdjacencies(3, volume)[1] for volume in found[name]])
                found[end] = [tag for _, tag in flat if tag in own]
        for name, tags in found.items():
            gmsh.model.addPhysicalGroup(3 if name in ("low", "up") else 2, tags, name=name)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(request.param)
        gmsh.write(str(path / "mesh.msh"))
    finally:
        gmsh.finalize()
    (path / "deck.toml").write_text(TOML)
    return path


def keywords(mesh, *, nodal=False):
    """The mesh as a deck, its surfaces by elements and faces or by their nodes."""
    lines, faces, number = ["*NODE"], {}, 0
    lines += [f"{i + 1}, " + ", ".join(repr(float(x)) for x in point) for i, point in enumerate(mesh.points)]
    for family, cells in mesh.cells.items():
        lines.append(f"*ELEMENT, TYPE={TYPES[family]}")
        for cell in cells:
            number += 1
            words = [str(number), *map(str, cell + 1)]
            lines += [", ".join(words[:10]) + "," * (len(words) > 10), *([", ".join(words[10:])] if words[10:] else [])]
            for k, face in enumerate(FACETS[family]):
                faces[frozenset(cell[list(face)].tolist())] = f"{number}, S{k + 1}"
    for name, cells in mesh.bodies.items():
        lines += [f"*ELSET, ELSET={name}", *map(str, cells + 1)]
    for name in SURFACES:
        lines += [f"*NSET, NSET={name}", *map(str, mesh.nodes_of(name) + 1)]
        lines += [f"*SURFACE, NAME={name}" + ", TYPE=NODE" * nodal]
        lines += [name] if nodal else [faces[frozenset(own)] for part in mesh.facets(name) for own in part.tolist()]
    return "\n".join(lines) + "\n" + LAW


def test_gmsh_and_keywords_say_the_same(folder, tmp_path):
    mesh = read_mesh(folder / "mesh.msh")
    order = 2 if "wedge15" in mesh.cells else 1
    assert [part.shape[1] for part in mesh.boundaries["low.top"]] == ([3, 4] if order == 1 else [6, 8])
    expected = sg.solve(load_deck(folder / "deck.toml").model).last
    for nodal in (False, True):
        (tmp_path / "deck.inp").write_text(keywords(mesh, nodal=nodal))
        deck = load_deck(tmp_path / "deck.inp")
        assert all(len(deck.model.mesh.facets(name)) == 2 for name in SURFACES)
        found = sg.solve(deck.model).last
        np.testing.assert_allclose(found.displacement, expected.displacement, atol=1e-12)
        np.testing.assert_array_equal(found.contacts[0].node, expected.contacts[0].node)
        np.testing.assert_allclose(found.contacts[0].pressure, expected.contacts[0].pressure, rtol=1e-9)
    np.testing.assert_allclose(expected.contacts[0].normal_force, [0, 0, 40.0], atol=1e-9)


def test_a_converted_deck_and_an_archive_are_the_same_model(folder, tmp_path):
    mesh = read_mesh(folder / "mesh.msh")
    (tmp_path / "deck.inp").write_text(keywords(mesh))
    assert main(["convert", str(tmp_path / "deck.inp"), "-o", str(tmp_path / "deck.toml")]) == 0
    one, other = load_deck(tmp_path / "deck.inp").model, load_deck(tmp_path / "deck.toml").model
    solution = sg.solve(one)
    np.testing.assert_allclose(sg.solve(other).last.displacement, solution.last.displacement, atol=1e-12)
    solution.write(tmp_path / "all.h5")
    again = sg.load(tmp_path / "all.h5")
    for model in (other, again.model):
        assert set(model.mesh.boundaries) == set(one.mesh.boundaries)
        for name in SURFACES:
            for mine, theirs in zip(model.mesh.facets(name), one.mesh.facets(name), strict=True):
                np.testing.assert_array_equal(mine, theirs)


@pytest.mark.slow
def test_a_run_draws_and_writes_both_kinds(folder, tmp_path, capsys):
    assert main(["check", str(folder / "deck.toml")]) == 0
    assert main(["run", str(folder / "deck.toml"), "-o", str(tmp_path / "out")]) == 0
    mesh = read_mesh(folder / "mesh.msh")
    surface = meshio.read(tmp_path / "out" / "contact.vtu")
    cells = {block.type: len(block.data) for block in surface.cells}
    assert cells == {kind: len(part) for kind, part in zip(("triangle", "quad"), mesh.facets("up.bottom"), strict=True)}
    for what in ("contact", "stress"):
        assert main(["plot", str(tmp_path / "out"), "--what", what, "-o", str(tmp_path / f"{what}.png")]) == 0
        assert (tmp_path / f"{what}.png").stat().st_size > 10_000
    capsys.readouterr()
