# SPDX-License-Identifier: BSD-3-Clause
"""Loads inside bodies and elastic foundations against closed forms: weight, rotation, heat, springs; energies."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.solve import solve
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.reference.discs import rotating_disc

HOT = sg.Elastic(E=200.0, nu=0.3, density=2.0, expansion=1e-3)
FAMILIES = ("triangle", "quad", "triangle6", "quad8", "quad9")
KINDS = ("plane strain", "plane stress", "axisymmetric")


def stresses(history):
    model = history.model
    space = make_space(model.mesh, kind=model.kind)
    return body_stresses(space, model, history.last.displacement, history.last.factors)


def assert_balanced(history):
    for step in history.steps:
        assert step.certificate.passed
        assert abs(step.energy_defect) <= 1e-10 * max(abs(step.work), 1e-4)


def energy_of(history):
    """Elastic energy by quadrature of nodal stresses, for uniform states."""
    stress = stresses(history)[0].stress[0]
    E, nu = HOT.E, HOT.nu
    normal, shear = stress[:3], stress[3]
    mesh = history.model.mesh
    size = np.ptp(mesh.points, axis=0)
    volume = np.pi * size[0] ** 2 * size[1] if history.model.axisymmetric else size.prod() * history.model.thickness
    return volume * ((normal @ normal * (1 + nu) - nu * normal.sum() ** 2) / (2 * E) + shear**2 * (1 + nu) / E)


@pytest.mark.parametrize("cells", FAMILIES)
@pytest.mark.parametrize("kind", ["plane stress", "axisymmetric"])
def test_free_expansion_is_free_of_stress(cells, kind):
    model = sg.Model(
        sg.rectangle(nx=3, ny=2, cells=cells),
        kind=kind,
        bodies=[sg.Body("block", HOT)],
        supports=[sg.Support("bottom", u=(None, 0)), sg.Support((0.0, 0.0), u=(0, None))],
        loads=[sg.Load("block", temperature=10.0)],
    )
    history = solve(model)
    np.testing.assert_allclose(history.last.displacement, 0.01 * model.mesh.points, atol=1e-14)
    np.testing.assert_allclose(stresses(history)[0].stress, 0.0, atol=1e-11)
    assert history.last.strain_energy == pytest.approx(0.0, abs=1e-12)
    assert history.last.work == pytest.approx(0.0, abs=1e-12)
    assert_balanced(history)


@pytest.mark.parametrize("formulation", ["standard", "incompatible", "mean dilatation"])
@pytest.mark.parametrize("kind", KINDS)
def test_heat_between_walls(kind, formulation):
    """Free sideways, held along y, scaled by half: uniform stress, energy by the law, work that of heating."""
    model = sg.Model(
        sg.rectangle(width=2.0, nx=3, ny=2),
        kind=kind,
        bodies=[sg.Body("block", HOT, formulation)],
        supports=[sg.Support("bottom", u=(None, 0)), sg.Support("top", u=(None, 0)), sg.Support("left", u=(0, None))],
        loads=[sg.Load("block", temperature=lambda x: np.full(len(x), 20.0), name="heat")],
        steps=[sg.Step(scale={"heat": 0.5}), sg.Step(scale={"heat": 0.25})],
    )
    if formulation == "mean dilatation" and kind == "plane stress":
        with pytest.raises(sg.InputError, match="of which plane stress has no need"):
            solve(model)
        return
    history = solve(model)
    strain = -0.25 * 20.0 * 1e-3
    across = {"plane strain": strain * HOT.E / (1 - HOT.nu), "plane stress": 0.0, "axisymmetric": 0.0}[kind]
    along = strain * HOT.E + HOT.nu * across
    (found,) = stresses(history)
    np.testing.assert_allclose(found.stress[:, :3], np.tile([0.0, along, across], (len(found.nodes), 1)), atol=1e-10)
    assert history.last.strain_energy == pytest.approx(energy_of(history), rel=1e-10)
    assert history.steps[0].work == pytest.approx(4 * history.last.strain_energy, rel=1e-10)
    assert history.last.work == pytest.approx(-3 * history.last.strain_energy, rel=1e-10)
    np.testing.assert_allclose(history.last.reactions["top"] + history.last.reactions["bottom"], 0.0, atol=1e-12)
    assert_balanced(history)


def test_a_linear_temperature_bends_without_stress():
    """Plane stress, T = c y: ``u = (a x y, a (y^2 - x^2) / 2)``, exact for quadratic cells; as values and function."""
    mesh = sg.rectangle(width=2.0, nx=4, ny=2, cells="quad8")
    model = sg.Model(
        mesh,
        kind="plane stress",
        bodies=[sg.Body("block", HOT)],
        supports=[sg.Support((0.0, 0.0), u=(0, 0)), sg.Support((2.0, 0.0), u=(None, -0.02))],
        loads=[sg.Load("block", temperature=10.0 * mesh.points[:, 1])],
    )
    x, y = mesh.points.T
    for temperature in (10.0 * y, lambda at: 10.0 * at[:, 1]):
        history = solve(replace(model, loads=[sg.Load("block", temperature=temperature)]))
        expected = 0.01 * np.column_stack([x * y, 0.5 * (y**2 - x**2)])
        np.testing.assert_allclose(history.last.displacement, expected, atol=1e-12)
        np.testing.assert_allclose(stresses(history)[0].stress, 0.0, atol=1e-10)


def test_a_shrink_fit_by_heat_is_one_by_interference():
    """A hub that cools onto its shaft presses like one that was made too small."""
    from signorini.gallery.press_fit import press_fit

    tight = press_fit(interference=0.02 * 1e-3 * 2.0 * 10, n_radial=4, n_angular=8)
    loose = replace(
        tight,
        contacts=[replace(contact, interference=0.0) for contact in tight.contacts],
        bodies=[replace(b, material=replace(b.material, expansion=0.02e-3)) for b in tight.bodies],
        loads=[sg.Load("hub", temperature=-10.0)],
    )
    pressures = [solve(model).last.contacts[0].pressure for model in (tight, loose)]
    np.testing.assert_allclose(pressures[1], pressures[0], rtol=5e-3)


def test_prepared_temperatures_scale():
    model = sg.Model(
        sg.rectangle(nx=2, ny=2),
        bodies=[sg.Body("block", HOT)],
        supports=[sg.Support("bottom", u=(None, 0)), sg.Support("left", u=(0, None))],
        loads=[sg.Load("block", temperature=5.0, name="heat")],
        contacts=[sg.Contact("top", sg.Plane(point=(0, 1.001), normal=(0, -1)))],
    )
    prepared = sg.prepare(model)
    once, thrice = prepared.solve(), prepared.solve(loads={"heat": 3.0})
    direct = sg.solve(replace(model, loads=[sg.Load("block", temperature=15.0, name="heat")]))
    np.testing.assert_allclose(thrice.stress("block").stress, direct.stress("block").stress, atol=1e-10)
    assert np.abs(once.stress("block").stress).max() < np.abs(thrice.stress("block").stress).max()
    assert thrice.last.strain_energy == pytest.approx(direct.last.strain_energy)


@pytest.mark.parametrize("cells", ["quad", "triangle6", "quad9"])
@pytest.mark.parametrize("kind", KINDS)
def test_weight(cells, kind):
    """A column under its own weight: ``sigma_yy = -rho g (h - y)``; the base bears all of it."""
    model = sg.Model(
        sg.rectangle(width=1.0, height=3.0, nx=2, ny=6, cells=cells),
        kind=kind,
        bodies=[sg.Body("block", replace(HOT, nu=0.0))],
        supports=[sg.Support("bottom", u=(None, 0)), sg.Support("left", u=(0, None))],
        loads=[sg.Load("block", gravity=(0.0, -10.0))],
    )
    history = solve(model)
    y = model.mesh.points[:, 1]
    volume = 3.0 * (np.pi if kind == "axisymmetric" else 1.0)
    np.testing.assert_allclose(history.last.reactions["bottom"], [0.0, 20.0 * volume], atol=1e-9)
    tolerance = 1e-9 if cells != "quad" else 0.5 * 20.0 * 0.5 + 1e-9  # half a cell of it
    np.testing.assert_allclose(stresses(history)[0].stress[:, 1], -20.0 * (3.0 - y), atol=tolerance)
    assert_balanced(history)


@pytest.mark.parametrize("kind", ["axisymmetric", "plane stress"])
def test_a_rotating_disc(kind):
    material = replace(HOT, nu=0.0) if kind == "axisymmetric" else HOT  # a thin disc needs nu = 0 in the meridian
    if kind == "axisymmetric":
        mesh = sg.rectangle(width=1.0, height=0.1, nx=6, ny=1, origin=(1.0, 0.0), cells="quad8")
        name, supports = "block", [sg.Support("bottom", u=(None, 0))]
    else:
        mesh = sg.annulus(inner=1.0, outer=2.0, n_radial=6, n_angular=8, angle=90.0, cells="quad8")
        name, supports = "ring", [sg.Support("start", u=(None, 0)), sg.Support("end", u=(0, None))]
    model = sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body(name, material)],
        supports=supports,
        loads=[sg.Load(name, centrifugal=3.0)],
    )
    history = solve(model)
    r = mesh.points[:, 0] if kind == "axisymmetric" else np.linalg.norm(mesh.points, axis=1)
    u, _, hoop = rotating_disc(r, inner=1.0, outer=2.0, omega=3.0, density=2.0, E=HOT.E, nu=material.nu)
    moved = history.last.displacement
    moved = moved[:, 0] if kind == "axisymmetric" else np.linalg.norm(moved, axis=1)
    np.testing.assert_allclose(moved, u, rtol=1e-4)
    if kind == "axisymmetric":
        inside = (r > 1.1) & (r < 1.9)
        np.testing.assert_allclose(stresses(history)[0].stress[inside, 2], hoop[inside], rtol=5e-3)


def test_the_centre_of_rotation_moves_with_the_body():
    def spinning(shift):
        return sg.Model(
            sg.annulus(inner=1.0, outer=2.0, n_radial=3, n_angular=8, centre=shift),
            bodies=[sg.Body("ring", HOT)],
            supports=[sg.Support((shift[0] + 2.0, shift[1]), u=(None, 0)), sg.Support("inner", u=(0, 0))],
            loads=[sg.Load("ring", centrifugal=2.0, centre=shift)],
        )

    here, there = (solve(spinning(shift)).last.displacement for shift in ((0.0, 0.0), (5.0, -3.0)))
    np.testing.assert_allclose(there, here, atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_a_block_on_springs(kind, cells):
    """Uniform pressure on a foundation alone: it sinks by p / k; the foundation bears it and resists rigid motions."""
    model = sg.Model(
        sg.rectangle(width=2.0, nx=4, ny=2, cells=cells),
        kind=kind,
        bodies=[sg.Body("block", replace(HOT, nu=0.0))],
        foundations=[sg.Foundation("bottom", normal_stiffness=50.0, tangential_stiffness=10.0, name="soil")],
        loads=[sg.Load("top", pressure=1.0)],
    )
    history = solve(model)
    area = np.pi * 4.0 if kind == "axisymmetric" else 2.0
    base = model.mesh.nodes_of("bottom")
    np.testing.assert_allclose(history.last.displacement[base, 1], -1.0 / 50.0, rtol=1e-10)
    np.testing.assert_allclose(history.last.reactions["soil"], [0.0, area], atol=1e-10)
    assert history.last.interface_energy == pytest.approx(0.5 * area / 50.0)
    assert history.last.strain_energy == pytest.approx(0.5 * area / HOT.E)
    assert_balanced(history)


def test_springs_hold_what_they_see():
    def model(**stiffness):
        return sg.Model(
            sg.rectangle(),
            bodies=[sg.Body("block", HOT)],
            foundations=[sg.Foundation("bottom", **stiffness)],
            loads=[sg.Load("top", pressure=1.0)],
        )

    with pytest.raises(sg.InputError, match="body 'block' can move along x"):
        solve(model(normal_stiffness=1.0))
    with pytest.raises(sg.InputError, match="body 'block' can"):
        solve(model(tangential_stiffness=1.0))
    solve(model(normal_stiffness=0.01, tangential_stiffness=0.01))
    with pytest.raises(sg.InputError, match="has no stiffness"):
        sg.Foundation("bottom")


def test_springs_and_contact_share_a_load():
    """A block pressed on a plane with springs above it: force and energy balance with friction and two steps."""
    model = sg.Model(
        sg.rectangle(width=2.0, nx=4, ny=2),
        bodies=[sg.Body("block", HOT)],
        foundations=[sg.Foundation("top", normal_stiffness=30.0, tangential_stiffness=20.0)],
        loads=[
            sg.Load("block", body_force=(0.0, -3.0), name="down"),
            sg.Load("right", traction=(-2.0, 0), name="push"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.2)],
        steps=[sg.Step(scale={"down": 1.0}), sg.Step(scale={"push": 1.0})],
    )
    history = solve(model)
    contact = history.contact("bottom")
    total = contact.normal_force + contact.tangential_force + history.last.reactions["top"] + [-2.0, -6.0]
    np.testing.assert_allclose(total, 0.0, atol=1e-9)
    assert (contact.status == "slip").any()
    for step in history.steps:
        assert abs(step.energy_defect) < 1e-9


@pytest.mark.parametrize(
    ("load", "message"),
    [
        ({"gravity": (0, -1)}, r"load\[0\].gravity: 'block' has no density"),
        ({"centrifugal": 1.0}, r"load\[0\].centrifugal: 'block' has no density"),
        ({"temperature": 1.0}, r"load\[0\]: 'block' has no thermal expansion"),
    ],
)
def test_what_loads_need(load, message):
    with pytest.raises(sg.InputError, match=message):
        sg.Model(sg.rectangle(), bodies=[sg.Body("block", sg.Elastic(E=1, nu=0))], loads=[sg.Load("block", **load)])


@pytest.mark.parametrize(
    ("load", "message"),
    [
        ({"on": (0.0, 0.0), "force": (1.0, 0.0)}, r"load\[0\]: has a radial component at node 1, which is on the axis"),
        ({"gravity": (1.0, -1.0)}, r"load\[0\].gravity: .* not symmetric"),
        ({"centrifugal": 1.0, "centre": (0, 0)}, r"load\[0\].centre: an axisymmetric body rotates about its axis"),
        ({"temperature": [1.0, 2.0]}, r"load\[0\].temperature: has 2 values; expected one per node of the mesh, 4"),
    ],
)
def test_loads_that_do_not_fit(load, message):
    disc = {"kind": "axisymmetric", "bodies": [sg.Body("block", HOT)], "supports": [sg.Support("bottom", u=(None, 0))]}
    with pytest.raises(sg.InputError, match=message):
        solve(sg.Model(sg.rectangle(), loads=[sg.Load(**({"on": "block"} | load))], **disc))
