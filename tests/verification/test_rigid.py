# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles that move: driven and free ones, balance, symmetry, equivalence, work."""

from dataclasses import replace

import meshio
import numpy as np
import pytest

from signorini.deck import read
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.meshing.plane import annulus, rectangle
from signorini.meshing.profile import mesh_profile
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane, Profile
from signorini.model.rigid import Rigid
from signorini.model.step import Step

ELASTIC = Elastic(E=1000.0, nu=0.3)
PUNCH = Profile(((1, 3), (1, 0), (-1, 0), (-1, 3)), fillet=0.2)
ONCE = (Step(increments=1),)


def pressed(friction=0.0, steps=ONCE, cells="quad", shape=PUNCH, **given):
    """A block on a fixed base under a rigid punch; by default free to sink and to tilt."""
    motion = {"u": (0.0, None), "rotation": None, "force": (None, -10.0), "point": (0.0, 0.0)} | given
    return Model(
        rectangle(width=8.0, height=4.0, nx=40, ny=8, origin=(-4.0, -4.0), cells=cells),
        bodies=[Body("block", ELASTIC)],
        supports=[Support("bottom", u=(0, 0))],
        contacts=[Contact("top", "punch", friction=friction)],
        obstacles=[Rigid("punch", shape, **motion)],
        steps=steps,
    )


@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_a_centred_force_sinks_a_punch_without_tilting_it(cells):
    history = solve(pressed(cells=cells))
    punch, contact = history.last.obstacles["punch"], history.contact("top")
    assert abs(punch.rotation) < 1e-12
    assert punch.displacement[1] < 0.0
    np.testing.assert_allclose(contact.normal_force, [0.0, -10.0], atol=1e-9)
    order = np.argsort(contact.points[:, 0])
    np.testing.assert_allclose(contact.pressure[order], contact.pressure[order][::-1], atol=1e-8)
    np.testing.assert_allclose(history.last.reactions["bottom"], [0.0, 10.0], atol=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("path", ["increments", "exact"])
def test_force_and_moment_are_what_the_contact_bears(friction, path):
    side = 1.0 if friction else 0.0
    free = {"u": (None, None), "force": (side, -10.0)} if friction else {}
    history = solve(pressed(friction, moment=2.0, steps=[Step(path=path)], **free))
    punch, contact = history.last.obstacles["punch"], history.contact("top")
    np.testing.assert_allclose(contact.normal_force + contact.tangential_force, [side, -10.0], atol=1e-8)
    assert contact.moment((0.0, 0.0)) == pytest.approx(2.0)
    assert punch.rotation > 0.0
    np.testing.assert_allclose([*punch.force, punch.moment], [side, -10.0, 2.0], atol=1e-8)


def test_driving_it_where_it_went_takes_the_same_force():
    free = solve(pressed(moment=2.0))
    found = free.last.obstacles["punch"]
    driven = solve(pressed(u=tuple(found.displacement), rotation=found.rotation, force=None))
    again = driven.last.obstacles["punch"]
    np.testing.assert_allclose([*again.force, again.moment], [*found.force, found.moment], rtol=1e-7, atol=1e-8)
    np.testing.assert_allclose(driven.contact("top").pressure, free.contact("top").pressure, atol=1e-7)
    # driving does work: all that is stored without friction
    assert driven.last.work == pytest.approx(driven.last.strain_energy)
    assert free.last.work == pytest.approx(free.last.strain_energy)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_a_moving_plane_is_a_moving_support_seen_from_the_other_side(friction):
    """Pressing a plane into a held block equals pressing the block onto a plane at rest."""
    mesh = rectangle(width=2.0, height=1.0, nx=8, ny=4)
    steps = [Step(name="press", scale={"move": 1.0}, increments=1)]
    plane = Plane((0.0, 1.0), (0.0, -1.0))
    moved = Model(
        mesh,
        bodies=[Body("block", ELASTIC)],
        supports=[Support("bottom", u=(0, 0))],
        contacts=[Contact("top", "move", friction=friction)],
        obstacles=[Rigid("move", plane, u=(0.02, -0.05))],
        steps=steps,
    )
    supported = replace(
        moved,
        supports=[Support("bottom", u=(-0.02, 0.05), name="move")],
        contacts=[Contact("top", plane, friction=friction)],
        obstacles=[],
    )
    one, two = solve(moved).last, solve(supported).last
    for key in ("pressure", "traction", "gap"):
        np.testing.assert_allclose(getattr(one.contacts[0], key), getattr(two.contacts[0], key), atol=1e-9)
    np.testing.assert_allclose(one.obstacles["move"].force, -two.reactions["move"], atol=1e-9)
    np.testing.assert_allclose(one.displacement - (0.02, -0.05), two.displacement, atol=1e-12)
    assert one.work == pytest.approx(two.work)


def test_steps_scale_obstacles_like_loads():
    steps = [Step(scale={"punch": f}, increments=1) for f in (1.0, 0.5, 0.0)]
    history = solve(pressed(u=(0.0, -0.01), rotation=0.0, force=None, steps=steps))
    forces = [step.obstacles["punch"].force[1] for step in history.steps]
    assert forces[0] < forces[1] < 0.0
    assert forces[2] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose([step.obstacles["punch"].displacement[1] for step in history.steps], [-0.01, -0.005, 0])


def test_one_roller_on_two_bodies():
    """A free roller in a gap between two blocks presses both alike."""
    angle = np.deg2rad(30.0)
    mesh = join({k: rectangle(width=2.0, height=2.0, nx=10, ny=10, origin=(-1.0, -2.0)) for k in ("left", "right")})
    points = mesh.points.copy()
    for name, turn in (("left", -angle), ("right", angle)):
        own = np.unique(mesh.cells["quad"][mesh.bodies[name]])
        c, s = np.cos(turn), np.sin(turn)
        points[own] = points[own] @ np.array([[c, s], [-s, c]]) + 1.0 * np.array([s, -c])
    model = Model(
        replace(mesh, points=points),
        bodies=[Body("left", ELASTIC), Body("right", ELASTIC)],
        supports=[Support("left.bottom", u=(0, 0)), Support("right.bottom", u=(0, 0))],
        contacts=[Contact("left.top", "roller", name="left"), Contact("right.top", "roller", name="right")],
        obstacles=[Rigid("roller", Circle((0.0, 0.0), 1.0), u=(None, None), force=(0.0, -5.0))],
        steps=ONCE,
    )
    history = solve(model)
    left, right = (contact.normal_force for contact in history.last.contacts)
    np.testing.assert_allclose(left * (-1, 1), right, atol=1e-6)
    np.testing.assert_allclose(left + right, [0.0, -5.0], atol=1e-8)
    assert history.last.obstacles["roller"].displacement[0] == pytest.approx(0.0, abs=1e-9)


def test_a_round_punch_on_a_disc():
    """Axisymmetric: a sphere pressed by a force; Hertz within what the finite block allows."""
    x = np.concatenate([np.linspace(0, 1, 25), 1 + 9 * (np.arange(1, 11) / 10) ** 2])
    model = Model(
        rectangle(x=x, y=-x[::-1]),
        kind="axisymmetric",
        bodies=[Body("block", ELASTIC)],
        supports=[Support("bottom", u=(0, 0))],
        contacts=[Contact("top", "ball")],
        obstacles=[Rigid("ball", Circle((0.0, 10.0), 10.0), u=(0.0, None), force=(None, -40.0))],
        steps=ONCE,
    )
    history = solve(model)
    stiffness = ELASTIC.E / (1 - ELASTIC.nu**2)
    a = (3 * 40.0 * 10.0 / (4 * stiffness)) ** (1 / 3)
    assert history.contact("top").pressure.max() == pytest.approx(1.5 * 40.0 / (np.pi * a**2), rel=0.02)
    assert history.last.obstacles["ball"].displacement[1] == pytest.approx(-(a**2) / 10.0, rel=0.1)


DECK = """
[mesh]
generator = "rectangle"
width = 4.0
height = 2.0
nx = 8
ny = 4
[material.soft]
E = 100.0
nu = 0.3
[[body]]
name = "block"
material = "soft"
[[support]]
on = "bottom"
u = [0.0, 0.0]
[[contact]]
nonmortar = "top"
mortar = "punch"
[[obstacle]]
name = "punch"
profile = { points = [[3.0, 4.0], [3.0, 2.0], [1.0, 2.0], [1.0, 4.0]], fillet = 0.25 }
u = [0.0, "free"]
rotation = "free"
force = ["free", -3.0]
moment = 0.5
"""


def test_a_deck_can_say_it(tmp_path):
    (tmp_path / "deck.toml").write_text(DECK)
    punch = solve(read(tmp_path / "deck.toml")).last.obstacles["punch"]
    np.testing.assert_allclose([*punch.force, punch.moment], [0.0, -3.0, 0.5], atol=1e-9)


def test_a_deck_can_take_a_profile_from_a_mesh(tmp_path):
    tool = rectangle(width=2.0, height=1.0, nx=2, ny=1, origin=(1.0, 2.0))
    bottom = tool.boundaries["bottom"]
    meshio.write(
        tmp_path / "tool.msh",
        meshio.Mesh(
            np.column_stack([tool.points, np.zeros(len(tool.points))]),
            [("quad", tool.cells["quad"]), ("line", bottom)],
            cell_data={"gmsh:physical": [np.full(2, 1), np.full(2, 2)], "gmsh:geometrical": [np.full(2, 1)] * 2},
            field_data={"tool": np.array([1, 2]), "edge": np.array([2, 1])},
        ),
        file_format="gmsh22",
    )
    shape = "profile = { points = [[3.0, 4.0], [3.0, 2.0], [1.0, 2.0], [1.0, 4.0]], fillet = 0.25 }"
    assert DECK.count(shape) == 1
    path = tmp_path / "deck.toml"
    path.write_text(DECK.replace(shape, 'profile = { file = "tool.msh", boundary = "edge" }'))
    assert read(path).obstacles[0].shape.points == ((3.0, 2.0), (2.0, 2.0), (1.0, 2.0))
    path.write_text(DECK.replace(shape, 'profile = { file = "tool.msh", boundary = "egde" }'))
    with pytest.raises(InputError, match=r"profile\.boundary: unknown boundary 'egde'; did you mean 'edge'"):
        read(path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"force": (1.0, -10.0)}, "a force acts in a prescribed direction"),
        ({"rotation": 0.0, "moment": 1.0}, "acts on a prescribed rotation"),
        ({"shape": "ball"}, "shape: is 'ball'; expected a Plane, Circle, Profile or another shape"),
        ({"shape": Circle((0.0, -2.0), 0.5)}, "faces away from a circle"),
        ({"shape": Circle((0.0, 3.0), 2.0)}, "obstacle 'punch' can rotate about (0, 3): nothing but frictionless"),
        ({"shape": Circle((0.0, 0.5), 2.0), "rotation": 0.0}, "the two sides overlap by 1.5 at node"),
    ],
)
def test_wrong_obstacles_are_refused(change, said):
    with pytest.raises(InputError) as caught:
        solve(pressed(**({"point": None} if "shape" in change else {}), **change))
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"contacts": [Contact("top", "punhc")]},
            "contact[0].mortar: unknown boundary or obstacle 'punhc'; did you mean",
        ),
        ({"contacts": [Contact("top", "left")]}, "obstacle[0].name: 'punch' is the mortar side of no contact"),
        (
            {"obstacles": [Rigid("left", PUNCH)], "contacts": [Contact("top", "left")]},
            "obstacle[0].name: 'left' is a boundary of the mesh too",
        ),
        ({"kind": "axisymmetric"}, "obstacle[0]: moves off the axis of revolution"),
        ({"loads": [Load("left", pressure=1.0, name="punch")]}, "obstacle[0].name: 'punch' is a load or a support too"),
        ({"contacts": [Contact("top", "punch", coupling="mortar")]}, "coupling: is 'mortar'; that is for two meshed"),
    ],
)
def test_wrong_names_are_refused(change, said):
    with pytest.raises(InputError) as caught:
        replace(pressed(), **change)
    assert said in str(caught.value)


def test_profiles_know_their_distances():
    """Against the union of the shapes that they bound: sharp and rounded corners, bulging and hollow, closed."""
    square = Profile(((1, 1), (1, -1), (-1, -1), (-1, 1)), closed=True)
    x = np.random.default_rng(3).uniform(-2, 2, (400, 2))
    beyond = np.abs(x) - 1.0
    exact = np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)
    distance, normals = square.nearest(x)
    np.testing.assert_allclose(distance, exact, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    # moving along the normal to the surface arrives there
    np.testing.assert_allclose(square.nearest(x - distance[:, None] * normals)[0], 0.0, atol=1e-12)
    rounded = Profile(square.points, fillet=0.3, closed=True)
    inner = np.abs(x) - 0.7
    exact = np.linalg.norm(np.maximum(inner, 0), axis=1) + np.minimum(inner.max(axis=1), 0) - 0.3
    np.testing.assert_allclose(rounded.nearest(x)[0], exact, atol=1e-12)
    hole = Profile(square.points[::-1], fillet=0.3, closed=True)
    np.testing.assert_allclose(hole.nearest(x)[0], -exact, atol=1e-12)
    np.testing.assert_allclose(hole.nearest(x)[1], -rounded.nearest(x)[1], atol=1e-12)


@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_a_meshed_tool_lends_its_profile(cells):
    tool = annulus(inner=1.0, outer=2.0, n_radial=1, n_angular=40, cells=cells)
    ring = mesh_profile(tool, "outer")
    assert ring.closed
    assert len(ring.points) == (40 if cells == "quad" else 80)
    distance, normals = ring.nearest(np.array([[2.5, 0.0], [0.0, -2.25], [0.0, 1.5]]))
    np.testing.assert_allclose(distance, [0.5, 0.25, -0.5], atol=0.01)
    np.testing.assert_allclose(normals, [[1, 0], [0, -1], [0, 1]], atol=0.1)
    hole = mesh_profile(tool, "inner")
    np.testing.assert_allclose(hole.nearest(np.array([[0.5, 0.0]]))[0], 0.5, atol=0.01)
    quarter = mesh_profile(annulus(inner=1.0, outer=2.0, n_radial=1, n_angular=8, angle=90.0, cells=cells), "outer")
    assert not quarter.closed
    np.testing.assert_allclose([quarter.points[0], quarter.points[-1]], [[0, 2], [2, 0]], atol=1e-12)


def test_a_profile_needs_one_piece():
    mesh = annulus(inner=1.0, outer=2.0, n_radial=1, n_angular=8)
    both = np.vstack([mesh.boundaries["inner"], mesh.boundaries["outer"]])
    with pytest.raises(InputError, match="'both' is in several pieces"):
        mesh_profile(replace(mesh, boundaries={"both": both}), "both")
    with pytest.raises(InputError, match="unknown boundary 'iner'; did you mean 'inner'"):
        mesh_profile(mesh, "iner")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"points": ((0, 0),)}, "expected two points or more"),
        ({"points": ((0, 0), (0, 0))}, "points[0]: is the same as the next"),
        ({"points": ((0, 0), (1, 0), (0, 0))}, "points[1]: is where the way turns back on itself"),
        ({"points": ((0, 0), (1, 0), (1, 1)), "fillet": 2.0}, "fillet: is 2; between points 1 and 2, 1 apart"),
    ],
)
def test_wrong_profiles_are_refused(given, said):
    with pytest.raises(InputError) as caught:
        Profile(**given)
    assert said in str(caught.value)
