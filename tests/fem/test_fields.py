# SPDX-License-Identifier: BSD-3-Clause
"""Data that vary: the same field said in every way gives the same answer, and the one that mechanics asks for."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import signorini as sg
from signorini.cli.main import main
from signorini.reference.hertz import HertzLine

STEEL = sg.Elastic(E=200.0, nu=0.3, expansion=1e-5)
WALL = sg.rectangle(x=np.linspace(0.0, 2.0, 5), y=np.linspace(0.0, 1.0, 4))


def on_wall(**load):
    return sg.Model(
        mesh=WALL,
        kind="plane strain",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(0.0, 0.0))],
        loads=[sg.Load(on="right", **load)],
    )


WATER = {
    "formula": "3*(1 - y)",
    "along": sg.Along("y", (0, 1), (3, 0)),
    "function": lambda at: 3.0 * (1.0 - at[:, 1]),
    "nodes of the mesh": 3.0 * (1.0 - WALL.points[:, 1]),
    "numbers of nodes": sg.NodeValues(3.0 * (1.0 - WALL.points[:, 1]), nodes=np.arange(1, 21)),
    "arc length upwards": sg.ArcLength((0, 1), (3, 0), start=(2, 0)),
    "arc length downwards": sg.ArcLength((0, 1), (0, 3), start=(2, 1)),
    "places": sg.Scattered([[2.0, 0.0], [2.0, 1.0], [3.0, 0.0], [3.0, 1.0]], [3.0, 0.0, 3.0, 0.0]),
}


@pytest.mark.parametrize("water", WATER.values(), ids=WATER.keys())
def test_water_presses_with_half_its_depth_and_turns_about_a_third(water):
    step = sg.solve(on_wall(pressure=water)).steps[-1]
    plain = sg.solve(on_wall(traction=("-3*(1 - y)", 0.0))).steps[-1]
    assert_allclose(step.reactions["bottom"], [1.5, 0.0], atol=1e-12)
    assert_allclose(step.displacement, plain.displacement, atol=1e-14)


def test_a_function_of_vectors_is_a_traction():
    pull = sg.solve(on_wall(traction=lambda at: np.column_stack([at[:, 1], -2.0 * at[:, 1]]))).steps[-1]
    assert_allclose(pull.reactions["bottom"], [-0.5, 1.0], atol=1e-12)


def test_displacements_that_are_affine_strain_evenly():
    edge = np.vstack(list(WALL.boundaries.values()))
    mesh = replace(WALL, boundaries={"edge": edge})
    model = sg.Model(
        mesh=mesh,
        kind="plane stress",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("edge", u=("1e-3*x + 2e-3*y", lambda at: -3e-4 * at[:, 1]), name="pull")],
        steps=[sg.Step(scale={"pull": 0.5}), sg.Step(scale={"pull": 1.0})],
    )
    solution = sg.solve(model)
    shear = 2e-3 * 200.0 / 2.6
    along = 200.0 / (1.0 - 0.09) * (1e-3 - 0.3 * 3e-4)
    stress = solution.stress("block").stress
    assert_allclose(stress[:, 0], along, rtol=1e-10)
    assert_allclose(stress[:, 3], shear, rtol=1e-10)


def test_a_crown_is_a_gap_whichever_way_it_is_said():
    radius, press = 50.0, 0.01
    mesh = sg.rectangle(x=np.linspace(-2.0, 2.0, 41), y=np.linspace(0.0, 4.0, 21))
    crown = mesh.points[:, 0] ** 2 / (2.0 * radius)
    along = np.linspace(-2.0, 2.0, 41)

    def pressure(plane=None, **gap):
        model = sg.Model(
            mesh=mesh,
            kind="plane strain",
            bodies=[sg.Body("block", STEEL)],
            supports=[sg.Support("top", u=(0.0, -press))],
            contacts=[sg.Contact("bottom", plane or sg.Plane((0, 0), (0, 1)), friction=0.2, **gap)],
        )
        return sg.solve(model).steps[-1].contacts[0].pressure

    one = pressure(interference=f"-x^2/(2*{radius})")
    assert_allclose(one, pressure(gap=f"x^2/(2*{radius})"), atol=1e-12)
    assert_allclose(one, pressure(gap=crown), atol=1e-12)
    assert_allclose(one, pressure(gap=sg.ArcLength(along + 2.0, along**2 / (2 * radius), (-2, 0))), atol=1e-12)
    assert_allclose(one, pressure(sg.Circle((0.0, -radius), radius)), atol=0.01 * one.max())


@pytest.mark.parametrize("coupling", ["mortar", "node-to-segment"])
def test_a_crown_between_meshes_presses_as_hertz_says(coupling):
    radius, force = 40.0, 1.0
    fine = np.sign(along := np.linspace(-1, 1, 49)) * np.abs(along) ** 1.5 * 6.0
    upper = sg.rectangle(x=fine, y=np.linspace(0.0, 1.0, 17) ** 1.7 * 12.0)
    lower = sg.rectangle(x=1.02 * fine, y=-(np.linspace(1.0, 0.0, 17) ** 1.7) * 12.0)
    model = sg.Model(
        mesh=sg.join({"a": upper, "b": lower}),
        kind="plane strain",
        bodies=[sg.Body("a", STEEL), sg.Body("b", STEEL)],
        supports=[sg.Support("b.bottom", u=(0.0, 0.0)), sg.Support("a.top", u=(0.0, None))],
        loads=[sg.Load("a.top", force=(None, -force), spread="displacement")],
        contacts=[sg.Contact("a.bottom", "b.top", interference=f"-x^2/{2 * radius}", coupling=coupling)],
    )
    hertz = HertzLine(force=force, radius=radius, modulus=200.0 / (2.0 * (1.0 - 0.3**2)))
    found = sg.solve(model).steps[-1].contacts[0]
    assert_allclose(found.pressure.max(), hertz.peak_pressure, rtol=0.03)


def test_a_pin_presses_with_the_cosine_and_its_whole_force():
    ring = sg.annulus(inner=1.0, outer=2.0, n_radial=3, n_angular=64, angle=360.0, centre=(0.0, 0.0))
    model = sg.Model(
        mesh=ring,
        kind="plane strain",
        thickness=2.0,
        bodies=[sg.Body("ring", STEEL)],
        supports=[sg.Support("outer", u=(0.0, 0.0))],
        loads=[sg.Load("inner", bearing=(0.3, -0.4))],
    )
    from signorini.engine.examine import examine
    from signorini.fem.loads import nodal_loads

    assert_allclose(sg.solve(model).steps[-1].reactions["outer"], [-0.3, 0.4], atol=1e-4)
    forces = nodal_loads(examine(model).space, model)["inner"].reshape(-1, 2)
    inner = np.abs(np.linalg.norm(ring.points, axis=1) - 1.0) < 1e-9
    cosine = ring.points[inner] @ [0.6, -0.8]
    expected = np.maximum(cosine, 0.0)
    size = np.linalg.norm(forces[inner], axis=1)
    assert_allclose(size / size.max(), expected, atol=0.01)


def test_temperatures_by_formula_are_those_of_the_function():
    def heated(temperature):
        model = sg.Model(
            mesh=WALL,
            kind="plane strain",
            bodies=[sg.Body("block", STEEL)],
            supports=[sg.Support("bottom", u=(0.0, 0.0))],
            loads=[sg.Load("block", temperature=temperature)],
        )
        return sg.solve(model).steps[-1].displacement

    assert_array_equal(heated("100 - 20*x*y"), heated(lambda at: 100.0 - 20.0 * at[:, 0] * at[:, 1]))


WRONG = {
    "coordinate": ("3*(1 - z)", "load[0].pressure: has 'z'; expected one of x, y, pi"),
    "program": ("__import__('os')", "pressure: unknown function '__import__'"),
    "not whole": ("y**", "pressure: 'y**' is no formula"),
    "infinite": ("1/(y - y)", "load[0].pressure: is inf at (2, 0); expected a finite number"),
    "function": (lambda at: at[0, 0], "load[0].pressure: is a function that gives shape ()"),
    "few": (np.ones(3), "load[0].pressure: has 3 values; expected one per node of the mesh, 20"),
    "absent": (sg.NodeValues([1.0], [1]), "load[0].pressure: has no value at node 5; expected one at each of the 4"),
    "on and on": ("+".join(["x"] * 600), "pressure: has 1199 characters"),
    "deep": ("(" * 400 + "x" + ")" * 400, "pressure: '((("),
}


@pytest.mark.parametrize(("given", "said"), WRONG.values(), ids=WRONG.keys())
def test_what_is_no_field_is_told(given, said):
    with pytest.raises(sg.InputError) as told:
        sg.solve(on_wall(pressure=given))
    assert str(told.value).startswith(said)


def on_two_feet(steps, **contact):
    """A block on a rigid floor by a side with a crown that steps change."""
    return sg.Model(
        mesh=sg.rectangle(width=2.0, height=1.0, nx=8, ny=4),
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("top", u=(0.0, -0.01))],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=0.2, name="foot", **contact)],
        steps=steps,
    )


CROWN = {
    "formula": "-0.02*(x - 1)^2",
    "function": lambda at: -0.02 * (at[:, 0] - 1.0) ** 2,
    "nodes": sg.NodeValues([-0.02 * (k / 4 - 1.0) ** 2 for k in range(9)], list(range(1, 10))),
}


@pytest.mark.parametrize("crown", CROWN.values(), ids=CROWN.keys())
def test_a_step_changes_what_varies(crown):
    """What a step has brought about is what was there: linear in between, and gone with a number."""
    there = sg.solve(on_two_feet([sg.Step(name="press")], interference=crown)).last
    steps = [sg.Step(name="set", scale={"top": 0.0}, interference={"foot": crown})]
    brought = sg.solve(on_two_feet([*steps, sg.Step(name="press")]))
    assert brought.last.contacts[0].gap == pytest.approx(there.contacts[0].gap, abs=1e-12)
    assert brought.last.contacts[0].pressure == pytest.approx(there.contacts[0].pressure, rel=1e-6, abs=1e-6)
    assert max(abs(step.energy_defect) for step in brought.steps) <= 1e-9 * brought.last.work
    level = [sg.Step(name="level", scale={"top": 0.0}, interference={"foot": 0.0}), sg.Step(name="press")]
    flat = sg.solve(on_two_feet(level, interference=crown)).last
    plain = sg.solve(on_two_feet([sg.Step()])).last
    assert flat.contacts[0].pressure == pytest.approx(plain.contacts[0].pressure, rel=1e-9)


def test_a_history_that_is_cut_keeps_what_varies(tmp_path):
    steps = [
        sg.Step(name="set", interference={"foot": CROWN["formula"]}, scale={"top": 0.5}),
        sg.Step(name="press"),
        sg.Step(name="back", interference={"foot": "-0.01*(x - 1)^2"}),
    ]
    whole = sg.solve(on_two_feet(steps))
    first = sg.solve(on_two_feet(steps[:1]))
    first.save_state(tmp_path / "state.npz")
    second = sg.solve(on_two_feet(steps[1:]), start=tmp_path / "state.npz")
    assert (second.last.displacement == whole.last.displacement).all()
    whole.write(tmp_path / "whole.h5")
    again = sg.load(tmp_path / "whole.h5")
    assert (again.model.steps[0].interference["foot"].values == whole.model.steps[0].interference["foot"].values).all()


def test_what_no_step_can_vary_is_told():
    with pytest.raises(sg.InputError, match=r"step\[0\].interference.foot: varies over a side that slides far"):
        on_two_feet([sg.Step(interference={"foot": "x"})], sliding="finite")
    with pytest.raises(sg.InputError, match=r"step\[0\].interference.foot: varies over a side whose mesh moves"):
        on_two_feet([sg.Step(interference={"foot": "x"})], wear=sg.Wear(1e-3, move_mesh=0.1))
    with pytest.raises(sg.InputError, match=r"interference.foot: '2 \+' is no formula"):
        sg.Step(interference={"foot": "2 +"})
    with pytest.raises(sg.InputError, match=r"step\[0\].interference.foot: has no value at node"):
        sg.solve(on_two_feet([sg.Step(interference={"foot": sg.NodeValues([1.0], [1])})]))


def test_an_archive_holds_what_varies(tmp_path):
    model = replace(on_wall(pressure=WATER["arc length upwards"]), title="water")
    sg.solve(model).write(tmp_path / "water.h5")
    again = sg.load(tmp_path / "water.h5").model.loads[0].pressure
    assert again == WATER["arc length upwards"]


def test_a_deck_has_steps_that_vary_interferences(tmp_path):
    (tmp_path / "crown.csv").write_text("node,depth\n" + "".join(f"{k},{-0.01 * (k - 5) ** 2}\n" for k in range(1, 10)))
    deck, again = tmp_path / "deck.toml", tmp_path / "again.toml"
    text = DECK_STEPS.replace("GIVEN", '"-0.16*(x - 1)^2"')
    found = []
    for given in ('"-0.16*(x - 1)^2"', '{ file = "crown.csv" }'):
        deck.write_text(DECK_STEPS.replace("GIVEN", given))
        found.append(sg.solve(sg.read(deck)).last.contacts[0].pressure)
        assert main(["convert", str(deck), "-o", str(again)]) == 0
        found.append(sg.solve(sg.read(again)).last.contacts[0].pressure)
    assert all(other == pytest.approx(found[0], rel=1e-9) for other in found)
    assert (found[0] == 0.0).any()
    deck.write_text(text.replace("(x - 1)", "(w - 1)"))
    assert main(["check", str(deck)]) == 2


DECK_STEPS = """
kind = "plane stress"
[mesh]
generator = "rectangle"
width = 2.0
height = 1.0
nx = 8
ny = 4
[material.steel]
E = 100.0
nu = 0.3
[[body]]
name = "block"
material = "steel"
[[support]]
on = "top"
u = [0.0, -0.01]
[[contact]]
name = "foot"
nonmortar = "bottom"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }
friction = 0.2
[[step]]
interference = { foot = GIVEN }
"""
