# SPDX-License-Identifier: BSD-3-Clause
"""Data that vary: the same field said in every way gives the same answer, and the one that mechanics asks for."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import signorini as sg
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


def test_a_step_does_not_change_what_varies():
    with pytest.raises(sg.InputError, match="changes one that varies over the side"):
        sg.Model(
            mesh=WALL,
            bodies=[sg.Body("block", STEEL)],
            supports=[sg.Support("top", u=(0.0, -0.01))],
            contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), interference="-x^2", name="foot")],
            steps=[sg.Step(interference={"foot": 0.1})],
        )


def test_an_archive_holds_what_varies(tmp_path):
    model = replace(on_wall(pressure=WATER["arc length upwards"]), title="water")
    sg.solve(model).write(tmp_path / "water.h5")
    again = sg.load(tmp_path / "water.h5").model.loads[0].pressure
    assert again == WATER["arc length upwards"]
