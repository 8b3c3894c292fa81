# SPDX-License-Identifier: BSD-3-Clause
"""Laws of the interface beyond one friction coefficient: tied sides, friction that varies, compliance with mortar."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.deck import read
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.gallery.blocks import four_blocks, stacked_blocks
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.model.varying import Along
from signorini.prepared import prepare

ELASTIC = Elastic(E=1000.0, nu=0.3)


def cantilever(upper, lower, **contact):
    """Two halves of a beam, one above the other, tied along y = 0.5, clamped at the left, loaded at the right."""
    mesh = join({"upper": rectangle(width=4, height=0.5, nx=upper, ny=2, origin=(0, 0.5)),
                 "lower": rectangle(width=4, height=0.5, nx=lower, ny=2)})  # fmt: skip
    return Model(
        mesh,
        bodies=[Body("upper", ELASTIC), Body("lower", ELASTIC)],
        supports=[Support("upper.left", u=(0, 0)), Support("lower.left", u=(0, 0))],
        loads=[Load("upper.right", traction=(0.0, 1.0)), Load("lower.right", traction=(0.0, 1.0))],
        contacts=[Contact("upper.bottom", "lower.top", name="seam", **{"friction": "tied"} | contact)],
    )


def whole_beam(n):
    return Model(
        rectangle(width=4, height=1, nx=n, ny=4),
        bodies=[Body("block", ELASTIC)],
        supports=[Support("left", u=(0, 0))],
        loads=[Load("right", traction=(0.0, 1.0))],
    )


def tip(model):
    history = solve(model)
    return history.last.displacement[np.argmax(model.mesh.points @ (1.0, 1e-3))]


def test_tied_matching_meshes_are_one_mesh():
    np.testing.assert_allclose(tip(cantilever(16, 16)), tip(whole_beam(16)), rtol=1e-9)


@pytest.mark.parametrize("lower", [11, 16, 25])
def test_tied_meshes_that_do_not_match_are_nearly_one(lower):
    model = cantilever(16, lower)
    np.testing.assert_allclose(tip(model), tip(whole_beam(min(16, lower))), rtol=0.03)
    seam = solve(model).contact("seam")
    assert (seam.status == "stick").all()
    assert seam.pressure.min() < 0.0  # it carries tension
    np.testing.assert_allclose(seam.gap, 0.0, atol=1e-9)


@pytest.mark.parametrize("across", [(4, 4), (4, 7)])
def test_tension_passes_through_a_tied_seam_exactly(across):
    model = stacked_blocks(across=across)
    supports = [replace(s, u=(None, 0.1)) if s.on == "upper.top" else s for s in model.supports]
    history = solve(replace(model, supports=supports, contacts=[replace(model.contacts[0], friction="tied")]))
    np.testing.assert_allclose(history.contact("interface").pressure, -1e5, rtol=1e-9)
    y = history.model.mesh.points[:, 1]
    np.testing.assert_allclose(history.last.displacement[:, 1], 0.05 * y, atol=1e-11)


@pytest.mark.parametrize("across", [(3, 3, 3, 3), (2, 3, 4, 5)])
def test_ties_that_meet_at_a_corner(across):
    """Where four tied blocks meet one tie follows from the three others: the answer stays that of one block."""
    model = four_blocks(across=across)
    pull = [replace(load, pressure=-load.pressure) for load in model.loads]
    tied = replace(model, loads=pull, contacts=[replace(c, friction="tied") for c in model.contacts])
    history = solve(tied)
    x, y = history.model.mesh.points.T
    E, nu = 1000.0, 0.3
    xx, yy = ((1 - nu**2) * s - nu * (1 + nu) * t for s, t in ((10.0, 20.0), (20.0, 10.0)))
    np.testing.assert_allclose(history.last.displacement, np.column_stack([xx * x, yy * y]) / E, atol=1e-12)


def test_supports_that_drive_a_tied_side_drive_the_other():
    model = cantilever(8, 8)
    driven = replace(model, supports=[Support("lower.top", u=(0.1, 0.2))], loads=[])
    np.testing.assert_allclose(solve(driven).last.displacement, [[0.1, 0.2]] * len(model.mesh.points), atol=1e-11)


@pytest.mark.parametrize("path", ["increments", "exact"])
def test_a_tied_beam_slides_on_a_plane_like_one(path):
    """Contact with friction beside a tie: pressed and pushed, the two halves act as a whole block."""
    floor = Contact("bottom", Plane((0.0, 0.0), (0.0, 1.0)), friction=0.3, name="floor")
    press = {"traction": (0.0, -5.0), "name": "press"}
    steps = [
        Step(scale={"press": 1.0}, path=path, increments=1 if path == "increments" else None),
        Step(scale={"push": 1.0}, path=path, increments=4 if path == "increments" else None),
    ]
    whole = whole_beam(12)
    one = replace(
        whole,
        supports=[],
        loads=[Load("top", **press), Load("left", traction=(4.0, 0.0), name="push")],
        contacts=[floor],
        steps=steps,
    )
    halves = cantilever(12, 12)
    mesh = halves.mesh
    left = np.vstack([mesh.boundaries["upper.left"], mesh.boundaries["lower.left"]])
    two = replace(
        halves,
        mesh=replace(mesh, boundaries={**mesh.boundaries, "left": left}),
        supports=[],
        loads=[Load("upper.top", **press), Load("left", traction=(4.0, 0.0), name="push")],
        contacts=[*halves.contacts, replace(floor, nonmortar="lower.bottom")],
        steps=steps,
    )
    one, two = solve(one), solve(two)
    for key in ("pressure", "traction", "slip"):
        values = [getattr(history.contact("floor"), key) for history in (one, two)]
        orders = [np.argsort(history.contact("floor").points[:, 0]) for history in (one, two)]
        np.testing.assert_allclose(values[1][orders[1]], values[0][orders[0]], atol=1e-7)
    for a, b in zip(one.steps, two.steps, strict=True):
        assert b.work == pytest.approx(a.work)


def test_a_tied_punch_pulls():
    model = Model(
        rectangle(width=2.0, height=1.0, nx=8, ny=4),
        bodies=[Body("block", ELASTIC)],
        supports=[Support("bottom", u=(0, 0))],
        contacts=[Contact("top", "lid", friction="tied")],
        obstacles=[Rigid("lid", Plane((1.0, 1.0), (0.0, -1.0)), u=(None, None), rotation=None, force=(1.0, 3.0))],
    )
    history = solve(model)
    contact, lid = history.contact("top"), history.last.obstacles["lid"]
    np.testing.assert_allclose(contact.normal_force + contact.tangential_force, [1.0, 3.0], atol=1e-9)
    assert contact.moment((1.0, 1.0)) == pytest.approx(0.0, abs=1e-9)
    assert lid.displacement[1] > 0.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"interference": 0.1}, "interference: is given, but a tied contact is neither pressed nor compliant"),
        ({"normal_compliance": 0.1}, "normal_compliance: is given, but a tied"),
    ],
)
def test_tied_contacts_take_no_other_law(change, said):
    with pytest.raises(InputError, match=said):
        cantilever(4, 4, **change)


@pytest.mark.parametrize("path", [{"increments": 2}, {"increments": "auto"}, {"path": "exact"}])
def test_a_model_in_space_of_tied_contacts_alone_has_a_path(path):
    """No pair is left that a law is asked of."""
    line = np.linspace(0.0, 1.0, 3)
    mesh = join({"up": box(x=line, y=line, z=1.0 + line), "low": box(x=line, y=line, z=line)})
    model = Model(
        mesh,
        kind="3d",
        bodies=[Body("up", ELASTIC), Body("low", ELASTIC)],
        supports=[Support("low.bottom", u=(0, 0, 0))],
        loads=[Load("up.top", traction=(0.5, 0.0, -1.0))],
        contacts=[Contact("up.bottom", "low.top", friction="tied")],
        steps=[Step(**path)],
    )
    whole = box(x=line, y=line, z=np.linspace(0.0, 2.0, 5))
    one = replace(
        model,
        mesh=whole,
        bodies=[Body(name, ELASTIC) for name in whole.bodies],
        supports=[Support("bottom", u=(0, 0, 0))],
        loads=[Load("top", traction=(0.5, 0.0, -1.0))],
        contacts=[],
        steps=[Step()],
    )
    tied, solid = solve(model).last.displacement, solve(one).last.displacement
    ends = model.mesh.nodes_of("up.top"), whole.nodes_of("top")
    np.testing.assert_allclose(tied[ends[0]], solid[ends[1]], atol=1e-9 * np.abs(solid).max())


def test_tied_contacts_stay_tied():
    with pytest.raises(InputError, match="'seam' is tied for good"):
        replace(cantilever(4, 4), steps=[Step(inactive=["seam"])])
    with pytest.raises(InputError, match="tied for good"):
        prepare(cantilever(4, 4)).solve(friction={"seam": 0.3})


def rough_floor(friction):
    return Model(
        rectangle(width=4.0, height=1.0, nx=16, ny=4),
        bodies=[Body("block", ELASTIC)],
        supports=[Support("top", u=(0.03, -0.01))],
        contacts=[Contact("bottom", Plane((0.0, 0.0), (0.0, 1.0)), friction=friction, name="floor")],
        steps=[Step(increments=1)],
    )


@pytest.mark.parametrize("friction", [Along("x", (0, 4), (0.05, 0.65)), lambda x: 0.05 + 0.15 * x[:, 0]])
def test_friction_may_vary(friction):
    floor = solve(rough_floor(friction)).contact("floor")
    mu = 0.05 + 0.15 * floor.points[:, 0]
    ratio = np.abs(floor.traction) / floor.pressure
    assert (ratio <= mu + 1e-9).all()
    slips = floor.status == "slip"
    assert slips.any()
    np.testing.assert_allclose(ratio[slips], mu[slips], rtol=1e-9)


def test_friction_that_varies_little_is_constant():
    one, two = (solve(rough_floor(mu)).contact("floor") for mu in (0.2, Along("x", (1.0,), (0.2,))))
    np.testing.assert_array_equal(one.traction, two.traction)


@pytest.mark.parametrize("wrong", [lambda x: x, lambda x: -x[:, 0], lambda x: np.full(len(x), np.nan)])
def test_functions_must_give_friction(wrong):
    with pytest.raises(InputError, match=r"contact\[0\].friction: gives an array of shape"):
        solve(rough_floor(wrong))


def test_a_deck_can_say_both(tmp_path):
    text = """
[mesh]
generator = "rectangle"
nx = 4
ny = 2
[material.soft]
E = 100.0
nu = 0.3
[[body]]
name = "block"
material = "soft"
[[load]]
on = "top"
pressure = 1.0
[[contact]]
nonmortar = "bottom"
plane = { point = [0, 0], normal = [0, 1] }
friction = """
    (tmp_path / "deck.toml").write_text(text + "{ x = [0.0, 1.0], mu = [0.1, 0.3] }\n")
    law = read(tmp_path / "deck.toml").contacts[0].law
    np.testing.assert_allclose(law.parameters(np.array([[0.5, 0.0]]))["friction"], [0.2])
    (tmp_path / "deck.toml").write_text(text + "{ x = [0.0, 1.0], y = [0.1, 0.3] }\n")
    with pytest.raises(InputError, match="expected one coordinate and mu"):
        read(tmp_path / "deck.toml")
    (tmp_path / "deck.toml").write_text(text + '"tied"\n')
    assert read(tmp_path / "deck.toml").contacts[0].tied


@pytest.mark.parametrize("across", [(4, 4), (4, 7), (5, 3)])
def test_compliance_is_in_series_with_mortar(across):
    """A uniform pressure through a compliant seam: the overlap is compliance times pressure, everywhere."""
    model = stacked_blocks(across=across)
    soft = replace(model.contacts[0], normal_compliance=1e-7)
    contact = solve(replace(model, contacts=[soft])).contact("interface")
    pressure = 0.1 / (2.0 / 2e6 + 1e-7)
    np.testing.assert_allclose(contact.pressure, pressure, rtol=1e-9)
    np.testing.assert_allclose(contact.gap, -1e-7 * pressure, rtol=1e-9)
