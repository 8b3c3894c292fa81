# SPDX-License-Identifier: BSD-3-Clause
"""Meshed rigid surfaces as obstacles: beside exact shapes, from files and meshes, at rest, moving, in archives."""

import meshio
import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.deck.write import write_deck
from signorini.errors import InputError
from signorini.meshing.write import write_mesh
from tests.helpers.rigid_surfaces import sphere

FINE = [0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.5]
FLOOR = ([[-3, -3, 0], [9, -3, 0], [9, 9, 0], [-3, 9, 0], [1.1, 0.7, 0]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


def block(x=FINE, z=(-2.5, -1.25, -0.6, -0.3, 0.0), cells="hexahedron", **given):
    return sg.Model(
        sg.box(x=x, y=x, z=z, cells=cells),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        **{
            "supports": [
                sg.Support("bottom", u=(0, 0, 0)),
                sg.Support("left", u=(0, None, None)),
                sg.Support("front", u=(None, 0, None)),
            ],
            **given,
        },
    )


@pytest.mark.parametrize("cells", ["hexahedron", "tetra10"])
def test_a_plane_of_triangles_is_the_plane(cells):
    """Moving, with friction: pressed down, then dragged; every number is the plane's."""
    points, triangles = np.array(FLOOR[0], float), FLOOR[1]
    lid = sg.Surface(points * [1, 1, -1], np.array(triangles)[:, ::-1])
    answers = []
    for shape in (lid, sg.Plane(point=(0, 0, 0), normal=(0, 0, -1))):
        model = block(
            x=[0, 1, 2.0],
            z=[-1, -0.5, 0.0],
            cells=cells,
            supports=[sg.Support("bottom", u=(0, 0, 0))],
            contacts=[sg.Contact("top", "lid", friction=0.2)],
            obstacles=[sg.Rigid("lid", shape, u=(0.004, 0.002, -0.01))],
            steps=[sg.Step(increments=2)],
        )
        answers.append(sg.solve(model))
    surface, plane = (answer.contact("top") for answer in answers)
    for key in ("pressure", "traction", "slip", "gap", "normals"):
        scale = np.abs(getattr(plane, key)).max() or 1.0
        np.testing.assert_allclose(getattr(surface, key), getattr(plane, key), atol=1e-12 * scale)
    assert (surface.status == plane.status).all()
    force = [answer.last.obstacles["lid"].force for answer in answers]
    np.testing.assert_allclose(force[0], force[1], rtol=1e-11)


def test_a_cube_pressed_on_a_surface_bears_its_pressure_everywhere():
    cube = block(
        x=[0, 0.5, 1.0],
        z=[0, 0.5, 1.0],
        supports=[sg.Support("left", u=(0, None, None)), sg.Support("front", u=(None, 0, None))],
        loads=[sg.Load("top", pressure=3.0)],
        contacts=[sg.Contact("bottom", sg.Surface(*FLOOR))],
    )
    solution = sg.solve(cube)
    np.testing.assert_allclose(solution.contact("bottom").pressure, 3.0, rtol=1e-10)
    top = cube.mesh.nodes_of("top")
    np.testing.assert_allclose(solution.last.displacement[top, 2], -3.0 / 1000.0, rtol=1e-10)


def test_a_ball_of_triangles_becomes_the_ball():
    """The force that drives it, against that of the sphere: the error goes with the square of the edges."""

    def force(shape):
        ball = sg.Rigid("ball", shape, u=(0, 0, -0.08))
        result = sg.solve(block(contacts=[sg.Contact("top", "ball")], obstacles=[ball])).contact("top")
        return result.normal_force[2]

    centre = (0.03, 0.02, 4.0)
    exact = force(sg.Sphere(centre=centre, radius=4.0))
    error = [abs(force(sphere(times, 4.0, centre)) / exact - 1.0) for times in (3, 5)]
    assert error[1] < error[0] / 12.0
    chord = (4.0 * np.pi / 2 / 2**5) ** 2 / (8.0 * 4.0)
    assert error[1] < 2.0 * 1.5 * chord / 0.08  # force goes with the 3/2 power of the depth


def stl(path, surface, binary):
    mesh = meshio.Mesh(surface.points, [("triangle", surface.triangles)])
    meshio.write(path, mesh, file_format="stl", binary=binary)
    return path


@pytest.mark.parametrize("binary", [False, True])
def test_stl(tmp_path, binary):
    ball = sphere(2, 2.0, (0, 0, 2))
    again = sg.read_surface(stl(tmp_path / "ball.stl", ball, binary))
    assert not again.open
    assert len(again.triangles) == len(ball.triangles)
    x = np.random.default_rng(1).uniform(-4, 4, (50, 3))
    np.testing.assert_allclose(again.nearest(x)[0], ball.nearest(x)[0], atol=1e-5)  # STL holds single precision
    assert np.sign(sg.read_surface(tmp_path / "ball.stl", flip=True).nearest([[0, 0, 2.0]])[0]) == 1


def test_triangles_that_stl_has_rounded_to_lines_are_left_out(tmp_path):
    text = "solid x\n"
    for corners in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)), ((0, 0), (0, 1), (0, 1))):
        text += "facet normal 0 0 1\nouter loop\n"
        text += "".join(f"vertex {x} {y} 0\n" for x, y in corners) + "endloop\nendfacet\n"
    (tmp_path / "x.stl").write_text(text + "endsolid x\n")
    assert len(sg.read_surface(tmp_path / "x.stl").triangles) == 2


@pytest.mark.parametrize("cells", ["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10"])
def test_a_meshed_tool_lends_its_surface(cells):
    tool = sg.box(x=[0, 1, 2], y=[0, 1], z=[0, 1], cells=cells)
    top = sg.mesh_surface(tool, "top")
    assert top.open
    distance, normals = top.nearest([[0.7, 0.4, 1.5], [0.7, 0.4, 0.25]])
    np.testing.assert_allclose(distance, [0.5, -0.75], atol=1e-14)
    np.testing.assert_allclose(normals, [[0, 0, 1]] * 2, atol=1e-14)
    np.testing.assert_allclose(sg.mesh_surface(tool, "top", flip=True).nearest([[0.7, 0.4, 1.5]])[0], -0.5)


def test_curved_quadratic_faces_are_cut_through_their_middles():
    mesh = sg.box(x=[0, 1], y=[0, 1], z=[0, 1], cells="hexahedron20")
    bent = mesh.points + np.outer(0.1 * mesh.points[:, 0] * (1 - mesh.points[:, 0]), [0, 0, 4.0])
    top = sg.mesh_surface(sg.Mesh(**{**vars(mesh), "points": bent}), "top")
    np.testing.assert_allclose(top.nearest([[0.5, 0.0, 2.0]])[0], 0.9, atol=1e-12)


@pytest.fixture(scope="module")
def gmsh_files(tmp_path_factory):
    """A block over a curved die of no body in one file, and a curve on its own in another."""
    gmsh = pytest.importorskip("gmsh")
    folder = tmp_path_factory.mktemp("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ, model = gmsh.model.occ, gmsh.model
        block = occ.addBox(-1, -1, 0, 2, 2, 1)
        ball = occ.addSphere(0, 0, -3, 3)
        occ.synchronize()
        (shell,) = (tag for _, tag in model.getBoundary([(3, ball)], oriented=False))
        sides = [tag for _, tag in model.getBoundary([(3, block)], oriented=False)]
        low, top = ([tag for tag in sides if abs(occ.getCenterOfMass(2, tag)[2] - z) < 1e-9] for z in (0, 1))
        occ.remove([(3, ball)])
        occ.synchronize()
        model.addPhysicalGroup(3, [block], name="block")
        for name, tags in (("low", low), ("top", top), ("die", [shell])):
            model.addPhysicalGroup(2, tags, name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        model.mesh.generate(3)
        gmsh.write(str(folder / "block.msh"))
        gmsh.clear()
        arc = [occ.addCircle(0, -5, 0, 5, angle1=a, angle2=b) for a, b in ((0.0, 1.5), (1.5, np.pi))]
        occ.removeAllDuplicates()
        occ.synchronize()
        model.addPhysicalGroup(1, [arc[0], -arc[1]], name="arc")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.05)
        model.mesh.generate(1)
        gmsh.write(str(folder / "arc.msh"))
    finally:
        gmsh.finalize()
    return folder


DECK = """
[mesh]
file = "block.msh"

[material.soft]
E = 100.0
nu = 0.3

[[body]]
name = "block"
material = "soft"

[[support]]
on = "top"
u = [0, 0, -0.3]

[[contact]]
nonmortar = "low"
surface = {surface}
friction = 0.1
"""


@pytest.mark.parametrize("surface", ['{ boundary = "die" }', '"die.stl"', '{ file = "die.stl" }'])
def test_a_deck_names_a_boundary_of_no_body_or_a_file(gmsh_files, capsys, surface):
    mesh = sg.read_mesh(gmsh_files / "block.msh")
    stl(gmsh_files / "die.stl", sg.mesh_surface(mesh, "die"), True)
    (gmsh_files / "deck.toml").write_text(DECK.format(surface=surface))
    assert main(["check", str(gmsh_files / "deck.toml")]) == 0
    assert "a closed surface of" in capsys.readouterr().out
    model = sg.read(gmsh_files / "deck.toml")
    solution, exact = (
        sg.solve(sg.Model(**{**vars(model), "contacts": [sg.Contact("low", shape)]}))
        for shape in (model.contacts[0].mortar, sg.Sphere(centre=(0, 0, -3), radius=3))
    )
    found, known = (answer.contact("low").normal_force[2] for answer in (solution, exact))
    assert found == pytest.approx(known, rel=0.15)


def test_a_meshed_line_serves_in_the_plane(gmsh_files):
    """A physical curve of two, one of them named against its way."""
    profile = sg.read_profile(gmsh_files / "arc.msh", boundary="arc")
    x = [[0.0, 1.0], [3.0, 0.0], [0.0, -1.0]]
    exact = sg.Circle(centre=(0, -5), radius=5).nearest(x)
    if profile.nearest(x)[0][0] < 0:  # where the bodies are, a curve does not know
        profile = sg.read_profile(gmsh_files / "arc.msh", flip=True)
    for found, known in zip(profile.nearest(x), exact, strict=True):
        np.testing.assert_allclose(found, known, atol=2e-2)
    assert len(profile.points) > 100


def test_a_line_of_no_body_is_an_obstacle_of_a_deck_in_the_plane(tmp_path, capsys):
    """Of the deck's own mesh, and in a file of its own: the profile of its points."""
    block = sg.rectangle(width=2.0, height=1.0, nx=4, ny=2)
    line = np.array([[2.5, -0.2], [1.0, 0.0], [-0.5, -0.2]])
    count = len(block.points)
    mesh = sg.Mesh(
        points=np.vstack([block.points, line]),
        cells=block.cells,
        bodies=block.bodies,
        boundaries={**block.boundaries, "die": [[count + 2, count + 1], [count + 1, count]]},
    )
    write_mesh(mesh, tmp_path / "both.vtu")
    meshio.write(tmp_path / "line.vtu", meshio.Mesh(np.pad(line, ((0, 0), (0, 1))), [("line", [[2, 1], [1, 0]])]))
    exact = sg.Profile(line[::-1].tolist())
    for key in ('{ boundary = "die" }', '{ file = "line.vtu" }', '{ file = "both.vtu", boundary = "die" }'):
        text = DECK.format(surface="{}").replace("surface = {}", f"profile = {key}").replace("block.msh", "both.vtu")
        text = text.replace("u = [0, 0, -0.02]", "").replace('"low"', '"bottom"').replace("[0, 0, -0.3]", "[0, -0.1]")
        (tmp_path / "deck.toml").write_text(text)
        model = sg.read(tmp_path / "deck.toml")
        assert model.contacts[0].mortar == exact
        assert main(["check", str(tmp_path / "deck.toml")]) == 0
        assert "belong to no element" not in capsys.readouterr().out
    forces = sg.solve(model).contact("bottom").normal_force
    apart = sg.solve(sg.Model(**{**vars(model), "mesh": block})).contact("bottom").normal_force
    np.testing.assert_allclose(forces, apart, rtol=1e-12)
    assert forces[1] > 0


def test_what_is_solved_with_a_surface_is_kept_and_gone_on_from(tmp_path):
    model = block(
        x=[0, 0.5, 1.0],
        z=[-1, -0.5, 0.0],
        contacts=[sg.Contact("top", "ball", friction=0.3)],
        obstacles=[sg.Rigid("ball", sphere(3, 4.0, (0, 0, 4.0)), u=(0.004, 0, -0.02))],
        steps=[sg.Step(scale={"ball": 0.5}, increments=1), sg.Step(scale={"ball": 1.0}, increments=1)],
    )
    whole = sg.solve(model)
    half = sg.solve(sg.Model(**{**vars(model), "steps": model.steps[:1]}))
    half.write(tmp_path / "half.h5")
    again = sg.load(tmp_path / "half.h5")
    shape, kept = model.obstacles[0].shape, again.model.obstacles[0].shape
    np.testing.assert_array_equal(kept.triangles, shape.triangles)
    np.testing.assert_array_equal(kept.nearest(FLOOR[0])[0], shape.nearest(FLOOR[0])[0])
    second = sg.solve(sg.Model(**{**vars(again.model), "steps": model.steps[1:]}), start=again)
    np.testing.assert_array_equal(second.last.displacement, whole.last.displacement)
    write_deck(model, tmp_path / "deck.toml")
    written = sg.read(tmp_path / "deck.toml").obstacles[0]
    np.testing.assert_array_equal(written.shape.points, shape.points)
    assert written.about == model.obstacles[0].about


@pytest.mark.parametrize("shape", ["cylinder", "cone", "torus"])
def test_round_shapes_survive_their_deck(tmp_path, shape):
    kinds = {
        "cylinder": sg.Cylinder(point=(0, 0, 3), axis=(1, 0, 0), radius=3.0),
        "cone": sg.Cone(point=(0, 0, 0), axis=(0, 0, 1), angle=0.5, inside=False),
        "torus": sg.Torus(point=(0, 0, 1), axis=(0, 0, 1), radius=3.0, tube=1.0),
    }
    write_deck(block(contacts=[sg.Contact("top", kinds[shape])]), tmp_path / "deck.toml")
    assert sg.read(tmp_path / "deck.toml").contacts[0].mortar == kinds[shape]


def test_a_surface_turned_over_is_told_so():
    model = block(contacts=[sg.Contact("top", sphere(1, 4.0, (0, 0, 4.0)).reverse())])
    with pytest.raises(InputError, match=r"contact\[0\]\.surface: 'top' faces away from a closed surface of 32 triang"):
        sg.solve(model)


def test_a_surface_in_the_plane_is_refused():
    plane = sg.rectangle(width=1, height=1, nx=1, ny=1)
    with pytest.raises(InputError, match=r"contact\[0\]\.surface: has 3 components; expected 2"):
        sg.Model(
            plane, bodies=[sg.Body("block", sg.Elastic(E=1, nu=0))], contacts=[sg.Contact("top", sg.Surface(*FLOOR))]
        )
    with pytest.raises(InputError, match="'top' lies in the plane; expected a mesh in space"):
        sg.mesh_surface(plane, "top")


@pytest.mark.parametrize(
    ("surface", "said"),
    [
        ('"dye.stl"', "deck.toml:19: contact[0].surface.file: there is no file"),
        ('{ file = "block.msh" }', "contact[0].surface: is not given, but"),
        (
            '{ boundary = "low" }',
            "contact[0].surface.boundary: 'low' bounds a body; expected a boundary of no body",
        ),
        ('{ boundary = "dye" }', "contact[0].surface.boundary: unknown boundary 'dye'; did you mean 'die'"),
        ('{ boundary = "die", flip = 1 }', "contact[0].surface.flip: is 1; expected true or false"),
        ('{ boundary = "die", fillet = 1 }', "contact[0].surface.fillet: unknown key"),
        ("{ points = [[0, 0, 0]], triangles = [[0, 1, 2]] }", "contact[0].surface.triangles: names point 2"),
        ("3", "contact[0].surface: is 3; expected a table"),
    ],
)
def test_mistakes_are_told_with_their_place(gmsh_files, surface, said):
    (gmsh_files / "deck.toml").write_text(DECK.format(surface=surface))
    with pytest.raises(InputError) as caught:
        sg.read(gmsh_files / "deck.toml")
    assert said in str(caught.value)


SHELL = """lc = 0.7;
Point(1) = {0, 0, 0, lc}; Point(2) = {2, 0, 0, lc}; Point(3) = {2, 1, 0.5, lc}; Point(4) = {0, 1, 0.5, lc};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Physical Surface("ramp") = {1};
"""


def test_surfaces_and_profiles_of_geometries_and_universal_files(tmp_path):
    """A ramp meshed by Gmsh from its geometry, and the same mesh as a universal file."""
    gmsh = pytest.importorskip("gmsh")
    (tmp_path / "ramp.geo").write_text(SHELL)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(tmp_path / "ramp.geo"))
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "ramp.unv"))
    finally:
        gmsh.finalize()
    normal = np.array([0.0, -0.5, 1.0]) / np.hypot(1.0, 0.5)
    for name in ("ramp.geo", "ramp.unv"):
        ramp = sg.read_surface(tmp_path / name, boundary="ramp")
        distance, normals = ramp.nearest(np.array([[1.0, 0.5, 0.25]]) + 0.3 * normal)
        assert distance == pytest.approx([0.3])
        np.testing.assert_allclose(normals, normal[None], atol=1e-12)
    points = "Point(1) = {0, 0, 0, 1}; Point(2) = {3, 0, 0, 1};"
    (tmp_path / "edge.geo").write_text(f'{points} Line(1) = {{1, 2}}; Physical Curve("edge") = {{1}};\n')
    points = np.array(sg.read_profile(tmp_path / "edge.geo", boundary="edge").points)
    assert points[[0, -1]].tolist() == [[0.0, 0.0], [3.0, 0.0]]
