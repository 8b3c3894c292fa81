# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of revolution that turn about their axis: closed forms, and what they share with bodies that do not."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.stress import body_stresses
from signorini.gallery.twisted import STEEL, fit_under_torque, ring_under_torque, shaft_in_torsion
from signorini.model.kind import TWIST
from signorini.reference.torsion import plastic_torque, shaft_twist


@pytest.mark.parametrize(
    ("cells", "formulation"),
    [
        *((cells, "standard") for cells in ("quad", "quad8", "quad9", "triangle", "triangle6")),
        ("quad", "incompatible"),
        *((cells, "mean dilatation") for cells in ("quad", "quad8", "triangle6")),
    ],
)
def test_torsion_of_a_shaft(cells, formulation):
    model = shaft_in_torsion(cells=cells, n=12 if cells == "triangle" else 2)
    model = replace(model, bodies=[replace(model.bodies[0], formulation=formulation)])
    found = sg.solve(model).last
    exact = shaft_twist(torque=1000.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
    r, z = model.mesh.points.T
    tolerance = 5e-3 if cells == "triangle" else 1e-12  # their functions do not hold r z
    np.testing.assert_allclose(found.displacement[:, 2], exact * r * z / 8.0, atol=tolerance * 10.0 * exact)
    np.testing.assert_allclose(found.displacement[:, :2], 0.0, atol=1e-15)
    np.testing.assert_allclose(found.reactions["bottom"], [0.0, 0.0, -1000.0], atol=1e-8)
    (stress,) = body_stresses(make_space(model.mesh, kind=TWIST), model, found.displacement)
    shear = STEEL.shear_modulus * exact / 8.0 * r
    if cells != "triangle":
        np.testing.assert_allclose(stress.stress[:, 4], shear, rtol=1e-9)
        np.testing.assert_allclose(stress.stress[:, [0, 1, 2, 3, 5]], 0.0, atol=1e-9 * shear.max())
    assert found.strain_energy == pytest.approx(0.5 * 1000.0 * exact, rel=4e-3)


def test_what_turns_as_one_is_not_strained():
    model = shaft_in_torsion(cells="quad8")
    space = make_space(model.mesh, kind=TWIST)
    u = np.zeros((len(model.mesh.points), 3))
    u[:, 1], u[:, 2] = 0.5, 0.1 * model.mesh.points[:, 0]
    K = stiffness(space, model)
    assert np.abs(K @ u.ravel()).max() < 1e-10 * abs(K).max()


def test_without_twist_it_is_the_axisymmetric_model():
    """Temperature, gravity, interference, friction and steps: what has no part around the axis is as it was."""
    twisted = fit_under_torque(pull=0.01, turn=0.0, cells="quad8", n=(3, 2))
    heavy = replace(STEEL, density=8e-9, expansion=1.2e-5)
    twisted = replace(
        twisted,
        bodies=[replace(body, material=heavy) for body in twisted.bodies],
        loads=[
            sg.Load("hub", temperature=40.0, name="heat"),
            sg.Load("shaft", gravity=(0.0, -9810.0, 0.0), name="weight"),
        ],
    )
    plane = replace(
        twisted,
        kind="axisymmetric",
        supports=[sg.Support("hub.right", u=(None, 0.0), name="held"), sg.Support("core", u=(None, 0.01, 0.0))],
        loads=[twisted.loads[0], replace(twisted.loads[1], gravity=(0.0, -9810.0))],
        steps=[replace(step, increments=3, scale={"heat": 1.0, "weight": 1.0, **step.scale}) for step in twisted.steps],
    )
    twisted = replace(twisted, steps=plane.steps)
    one, other = sg.solve(plane), sg.solve(twisted)
    for a, b in zip(one.steps, other.steps, strict=True):
        np.testing.assert_allclose(b.displacement[:, :2], a.displacement, atol=1e-9 * np.abs(a.displacement).max())
        np.testing.assert_allclose(b.displacement[:, 2], 0.0, atol=1e-15)
        np.testing.assert_allclose(b.contacts[0].pressure, a.contacts[0].pressure, rtol=1e-8)
        np.testing.assert_allclose(b.contacts[0].traction[:, 0], a.contacts[0].traction, atol=1e-7)
        assert b.work == pytest.approx(a.work, rel=1e-8)
        assert b.dissipation == pytest.approx(a.dissipation, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("contact", [{}, {"coupling": "mortar"}, {"facets": 16}, {"coupling": "node-to-segment"}])
def test_torque_and_force_at_once(contact):
    """Sides that match and not: the fit holds what Coulomb's circle, or the polygon in it, allows; moments balance."""
    model = fit_under_torque(turn=0.03, pull=0.2, n=(4, 3), **contact)
    model = replace(model, steps=[model.steps[0], replace(model.steps[1], increments=4)])
    found = sg.solve(model).last
    fit, (_, pull, torque) = found.contacts[0], found.reactions["held"]
    held = np.hypot(torque / 10.0, pull) / (0.2 * float(fit.pressure @ fit.area))
    low = np.cos(np.pi / 16) if "facets" in contact else 1.0 - 1e-6
    assert low <= held <= 1.0 + 1e-9
    assert fit.torque == pytest.approx(torque, rel=1e-9)
    assert found.rigid_bodies["core"].moment == pytest.approx(-torque, rel=1e-9)
    assert set(fit.status) == {"slip"}
    assert found.certificate.passed


def test_tied_and_sticking_fits_turn_as_one():
    """The fit sticks: the same twist as of one body, up to what a mesh leaves."""
    stuck, tied = (
        sg.solve(fit_under_torque(turn=1e-4, friction=kind, interference=overlap, steps=(sg.Step(),)))
        for kind, overlap in (("stick", 0.01), ("tied", 0.0))
    )
    assert stuck.last.reactions["held"][2] == pytest.approx(tied.last.reactions["held"][2], rel=1e-9)


def test_twist_that_supports_prescribe():
    """Node by node by a formula of the radius, and as a number: the closed form, and what holds it."""
    model = shaft_in_torsion()
    turned = replace(
        model, loads=[], supports=[*model.supports, sg.Support("top", u=(None, None, "1e-5*x"), name="top")]
    )
    torque = 1e-5 / shaft_twist(torque=1.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
    found = sg.solve(turned).last
    assert found.reactions["top"][2] == pytest.approx(torque, rel=1e-12)
    assert found.work == pytest.approx(0.5 * torque * 1e-5, rel=1e-12)
    corner = replace(turned, supports=[*model.supports, sg.Support((10.0, 8.0), u=(None, None, 1e-4), name="top")])
    assert sg.solve(corner).last.displacement[-1, 2] == pytest.approx(1e-4, rel=1e-12)


@pytest.mark.parametrize("kind", ["axisymmetric", TWIST])
def test_a_bolt_bears_torque_through_its_section(kind):
    """A shank that is cut and drawn together is as long and as stiff as one that is not, and twists as one."""
    mesh = sg.cut(
        sg.rectangle(width=5.0, height=8.0, nx=2, ny=4, origin=(5.0, 0.0)),
        "cut",
        body="block",
        point=(5.0, 4.0),
        normal=(0.0, 1.0),
    )
    more = (0.0,) if kind == TWIST else ()
    model = sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(None, 0.0, *more)), sg.Support("top", u=(None, 0.0, *(None for _ in more)))],
        loads=[sg.Load("top", torque=1000.0, name="torque")] if more else [],
        bolts=[sg.Bolt("cut", force=5000.0, name="bolt")],
        steps=[sg.Step(scale={"bolt": 1.0, **({"torque": 1.0} if more else {})})],
    )
    found = sg.solve(model).last
    assert found.bolts["bolt"].force == pytest.approx(5000.0)
    assert found.bolts["bolt"].shortening == pytest.approx(5000.0 * 8.0 / (STEEL.E * 75.0 * np.pi), rel=1e-9)
    if more:
        exact = shaft_twist(torque=1000.0, shear_modulus=STEEL.shear_modulus, inner=5.0, outer=10.0, length=8.0)
        assert found.displacement[:, 2].max() == pytest.approx(10.0 * exact, rel=1e-9)
        assert found.reactions["bottom"][2] == pytest.approx(-1000.0, rel=1e-9)


def test_torsional_modes():
    """A shaft held at one end: f = (2 k - 1) / (4 L) sqrt(G / rho); other modes of so short a shaft are higher."""
    model = shaft_in_torsion(cells="quad8", n=3)
    model = replace(model, bodies=[sg.Body("block", replace(STEEL, density=8e-9))], loads=[])
    model = replace(model, supports=[sg.Support("bottom", u=(0.0, 0.0, 0.0))])
    (lowest,) = sg.natural_modes(sg.solve(model), 1, joint="stuck").frequencies
    assert lowest == pytest.approx(np.sqrt(STEEL.shear_modulus / 8e-9) / 32.0, rel=1e-4)


def test_a_ring_in_space_becomes_its_meridian():
    """Turned until it slips while it is pulled: polygons of 24 and 48 cells are off as the square of their sides."""
    exact = sg.solve(ring_under_torque()).last
    found = [sg.solve(ring_under_torque(sectors=n)).last for n in (24, 48)]
    core = exact.rigid_bodies["core"]
    for ring, own in (
        ([step.rigid_bodies["core"].moment[2] for step in found], core.moment),
        ([step.rigid_bodies["core"].force[2] for step in found], core.force[1]),
        ([step.strain_energy for step in found], exact.strain_energy),
        ([step.dissipation for step in found], exact.dissipation),
    ):
        assert (4.0 * ring[1] - ring[0]) / 3.0 == pytest.approx(own, rel=3e-4)
        assert abs(ring[1] - own) < 0.3 * abs(ring[0] - own)


def test_what_bodies_that_twist_do_not_do():
    model = fit_under_torque()
    for changes, words in (
        ({"contacts": [replace(model.contacts[0], wear=sg.Wear(1e-8))]}, "wear: is given, but bodies twist"),
        (
            {"contacts": [replace(model.contacts[0], sliding="finite")]},
            'is "finite", but bodies twist; expected "small"',
        ),
        (
            {"contacts": [replace(model.contacts[0], friction=(0.2, 0.1), friction_axis=(0, 1, 1))]},
            r"or \(0, 0, 1\) aro",
        ),
        ({"supports": [sg.Support("core", u=(1.0, 0.0, 0.0))]}, "moves a rigid body off the axis of revolution"),
        ({"loads": [sg.Load("hub.top", force=(None, 1.0, 1.0), spread="displacement")]}, "all radii alike around"),
        ({"thickness": 2.0}, "forces and areas are for the circumference"),
        (
            {"kind": "axisymmetric", "supports": [], "loads": [sg.Load("hub.top", torque=1.0)]},
            "expected kind 'axisymmet",
        ),
        (
            {"kind": "plane strain", "supports": [], "loads": [sg.Load("hub.top", torque=1.0)]},
            "axisymmetric models with",
        ),
    ):
        with pytest.raises(sg.InputError, match=words):
            replace(model, **changes)


def test_turning_around_the_axis_is_no_large_motion():
    """A shaft that spins in its hub by a radian is as it was; one that is twisted so, or pulled so far, is not."""
    spun, drawn = (sg.solve(fit_under_torque(turn=turn, pull=pull)).last for turn, pull in ((1.0, 0.0), (0.0, 2.0)))
    assert not any("holds for small" in note for note in spun.notes)
    assert any("contact 'fit' slips by up to 1.9" in note for note in drawn.notes)
    held = [sg.Support("bottom", u=(0, 0, 0)), sg.Support("top", u=(0, 0, "x"))]
    wrung = sg.solve(replace(shaft_in_torsion(), supports=held, loads=[])).last
    assert any("body 'block' strains or turns by" in note for note in wrung.notes)


FLOWS = replace(STEEL, plastic=sg.Plastic(yield_stress=200.0))
LIMIT = {"shear_modulus": STEEL.shear_modulus, "shear_stress": 200.0 / np.sqrt(3.0), "inner": 5.0, "outer": 10.0}


@pytest.mark.parametrize(("cells", "formulation"), [("quad", None), ("quad", "incompatible"), ("triangle6", None)])
def test_the_limit_torque_is_proved(cells, formulation):
    """A hub that turns the shaft: up to 2 pi k (b^3 - a^3) / 3 there is an equilibrium, and beyond it a proof."""
    limit = plastic_torque(rate=1e9, **LIMIT)
    shaft = shaft_in_torsion(cells=cells, n=4)
    shaft = replace(
        shaft,
        bodies=[sg.Body("block", FLOWS, formulation=formulation)],
        rigid_bodies=[sg.RigidBody("hub", on="top", point=(0.0, 8.0))],
        supports=[*shaft.supports, sg.Support("hub", u=(0.0, 0.0, None))],
    )
    within, beyond = (replace(shaft, loads=[sg.Load("hub", force=(None, None, part * limit))]) for part in (0.99, 1.25))
    assert sg.solve(within).last.yielding.share > 0.5
    with pytest.raises(sg.SolveFailed, match=r"flow plastically at 80\.00[0-9]*% of the step at most"):
        sg.solve(beyond)


def test_a_fit_whose_hub_yields_still_holds_by_its_circle():
    model = fit_under_torque(turn=0.003, pull=0.02, interference=0.04, n=(2, 2))
    model = replace(model, bodies=[model.bodies[0], sg.Body("hub", FLOWS)])
    model = replace(model, steps=[model.steps[0], replace(model.steps[1], increments=6)])
    found = sg.solve(model).last
    fit, (_, pull, torque) = found.contacts[0], found.reactions["held"]
    assert found.yielding.share > 0.3
    assert np.hypot(torque / 10.0, pull) == pytest.approx(0.2 * float(fit.pressure @ fit.area), rel=1e-3)
    assert found.certificate.passed


def test_contacts_that_share_a_corner_share_its_force_in_one_way():
    """What a floor and a wall bear is the same in few increments as in many, as without twist."""
    found = []
    for count in (2, 8):
        model = sg.Model(
            sg.rectangle(width=5.0, height=5.0, nx=2, ny=2, origin=(5.0, 0.0)),
            kind=TWIST,
            bodies=[sg.Body("block", STEEL)],
            supports=[sg.Support("top", u=(None, -0.01, "0.001*x"), name="top")],
            contacts=[
                sg.Contact("bottom", sg.Plane((0.0, 0.0), (0.0, 1.0)), friction=0.3, name="floor"),
                sg.Contact("right", sg.Plane((10.0, 0.0), (-1.0, 0.0)), friction=0.3, name="wall"),
            ],
            steps=[sg.Step(increments=count)],
        )
        found.append(sg.solve(model).last.contacts)
    for one, other in zip(*found, strict=True):
        np.testing.assert_allclose(other.pressure, one.pressure, atol=1e-3 * one.pressure.max())


def test_exact_paths_on_facets_and_bodies_that_are_iterated():
    """To and fro: work is stored or rubbed to rounding from event to event, many increments come to the same, and so do
    bodies that nothing is factorised of.
    """
    drive = sg.Step(name="drive", scale={"core": [0.4, -0.2, 0.3]})
    model = fit_under_torque(turn=0.003, pull=0.01, n=(2, 2), facets=8, steps=(sg.Step(scale={"core": 0.0}), drive))
    press, drive = model.steps
    exact = sg.solve(replace(model, steps=[replace(press, path="exact"), replace(drive, path="exact")])).last
    many = sg.solve(replace(model, steps=[press, replace(drive, increments=32)])).last
    assert len(exact.events) > 4
    assert abs(exact.energy_defect) < 1e-12 * exact.dissipation
    one, other = exact.contacts[0], many.contacts[0]
    np.testing.assert_allclose(other.traction, one.traction, atol=2e-3 * one.pressure.max())
    assert many.dissipation == pytest.approx(exact.dissipation, rel=2e-2)
    smooth = replace(
        model, contacts=[replace(model.contacts[0], facets=0)], steps=[press, replace(drive, increments=2)]
    )
    torques = [sg.solve(smooth, backend=backend).last.contacts[0].torque for backend in ("auto", "iterative")]
    assert torques[1] == pytest.approx(torques[0], rel=1e-6)
