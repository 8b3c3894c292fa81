# SPDX-License-Identifier: BSD-3-Clause
"""Adhesion and shear limits on finite elements: in the plane and in space, in one solve, increments and exact paths."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from signorini.cli.main import main
from signorini.deck import read
from signorini.deck.write import write_deck
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.gallery.cubes import cubes
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.model.step import Step
from signorini.prepared import prepare
from signorini.reference.tresca import LimitedShear

GRID = np.linspace(0.0, 4.0, 17)
SOFT = [Body("block", Elastic(E=1000.0, nu=0.3))]
PRESS_AND_DRAG = [Step(name="press", scale={"press": 1.0, "top": 0.0}), Step(name="drag", scale={"top": 1.0})]
LAWS = {
    "limit": {"friction": 0.4, "shear_limit": 1.5},
    "Tresca": {"friction": "stick", "shear_limit": 0.5},
    "adhesion": {"friction": 0.3, "adhesion": 0.5},
    "all": {"friction": 0.3, "adhesion": 0.5, "shear_limit": 1.6},
}


def block(steps=PRESS_AND_DRAG, drag=0.05, **law):
    """Pressed by 5 on a plane, its top then dragged to the right."""
    return Model(
        rectangle(x=GRID, y=GRID[:5]),
        bodies=SOFT,
        supports=[Support("top", u=(drag, None))],
        loads=[Load("top", pressure=5.0, name="press")],
        contacts=[Contact("bottom", Plane((0.0, 0.0), (0.0, 1.0)), name="floor", **law)],
        steps=steps,
    )


def in_increments(model, number):
    return replace(model, steps=[replace(step, increments=number) for step in model.steps])


def most(contact, friction=0.0, adhesion=0.0, shear_limit=np.inf):
    """The bound of the traction where the pressure is not next to nothing."""
    rubbed = np.inf if friction == "stick" else friction * contact.pressure
    return np.minimum(rubbed + adhesion, np.full(len(contact.pressure), shear_limit))


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("increments", [None, 1, 5])
def test_a_dragged_block_obeys_the_bound(law, increments):
    history = solve(in_increments(block(**law), increments))
    floor = history.contact("floor")
    closed = floor.pressure > 1e-2
    bound = most(floor, **law)
    assert (np.abs(floor.traction) <= bound * (1 + 1e-9)).all()
    slips = (floor.status == "slip") & closed
    assert slips.any()
    np.testing.assert_allclose(floor.traction[slips], -bound[slips], rtol=1e-9)
    assert all(step.certificate.passed for step in history.steps)
    assert any("one increment" in note for step in history.steps for note in step.notes) == (increments == 1)
    if increments is None:
        for step in history.steps:
            assert abs(step.energy_defect) <= 1e-8 * abs(step.work)


def test_a_sliding_block_carries_its_limit_exactly():
    history = solve(block(friction="stick", shear_limit=0.3))
    floor = history.contact("floor")
    assert (floor.status == "slip").all()
    np.testing.assert_allclose(floor.tangential_force, [-0.3 * 4.0, 0.0], atol=1e-12)
    thick = solve(replace(block(friction="stick", shear_limit=0.3), thickness=2.5)).contact("floor")
    np.testing.assert_allclose(thick.tangential_force, [-0.3 * 4.0 * 2.5, 0.0], atol=1e-12)


def test_a_load_beyond_the_limit_slides():
    """Tresca holds 1.2 however hard it is pressed: Coulomb's law would hold 20 mu."""
    model = replace(
        block(friction=0.4, shear_limit=0.3),
        supports=[],
        steps=[Step(scale={"press": 1.0, "push": 0.0})],
        loads=[Load("top", pressure=5.0, name="press"), Load("top", traction=(1.0, 0.0), name="push")],
    )
    for push, held in ((0.29, True), (0.31, False)):
        steps = [Step(scale={"press": 1.0}), Step(scale={"push": push}, path="exact")]
        history = solve(replace(model, steps=steps), raise_on_failure=False)
        assert history.solved == held
        assert held or history.status == "jump"
        assert held or "gross sliding" in history.message
        single = replace(model, steps=[Step(scale={"press": 1.0, "push": push}, increments=1)])
        history = solve(single, raise_on_failure=False)
        assert history.status == ("solved" if held else "no_equilibrium")


@pytest.mark.parametrize("law", [{"friction": 0.4}, {"friction": 0.0}])
def test_limits_that_are_not_reached_change_nothing(law):
    one, two = (solve(block(**law, shear_limit=limit)).contact("floor") for limit in (None, 1e9))
    np.testing.assert_allclose(two.traction, one.traction, rtol=0, atol=1e-12)
    np.testing.assert_allclose(two.slip, one.slip, rtol=0, atol=1e-14)
    assert (one.status == two.status).all()


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_slab_in_space_is_the_plane_model(law):
    plane = in_increments(block(drag=0.02, **law), 3)
    solid = replace(
        plane,
        mesh=box(x=GRID, y=[0.0, 1.0], z=GRID[:5]),
        kind="3d",
        supports=[Support("front", u=(None, 0, None)), Support("back", u=(None, 0, None)),
                  Support("top", u=(0.02, 0.0, None))],
        contacts=[replace(plane.contacts[0], mortar=Plane((0, 0, 0), (0, 0, 1)))],
    )  # fmt: skip
    flat, deep = (solve(model).contact("floor") for model in (plane, solid))
    for x, pressure, traction in zip(flat.points[:, 0], flat.pressure, flat.traction, strict=True):
        own = np.isclose(deep.points[:, 0], x)
        np.testing.assert_allclose(deep.pressure[own], pressure, rtol=0, atol=5e-8)
        np.testing.assert_allclose(deep.shear[own], [[traction, 0, 0]] * own.sum(), rtol=0, atol=5e-8)


@pytest.mark.parametrize("facets", [0, 8])
@pytest.mark.parametrize(
    ("friction", "ratios"), [((0.1, 0.4), (0.25, 1.0)), (0.4, (1.0, 1.0)), ("stick", (1.0, 1.0))], ids=str
)
def test_every_cone_in_space_has_its_limit(friction, ratios, facets):
    """Sections keep their shape: an ellipse or a polygon, the larger friction bounded by the limit."""
    model = cubes(3)
    axis = (1.0, 0.0, 0.0) if isinstance(friction, tuple) else None
    contact = replace(model.contacts[0], friction=friction, friction_axis=axis, facets=facets)
    plain = solve(replace(model, contacts=[replace(contact, friction=0.4, friction_axis=None)]))
    limit = 0.15 * plain.last.contacts[0].pressure.mean()
    step = solve(replace(model, contacts=[replace(contact, shear_limit=limit)])).last
    found, (one, two) = step.contacts[0], ratios
    assert step.certificate.passed
    assert step.certificate.facets == facets
    rubbed = np.where(found.pressure > 0, np.inf, 0.0) if friction == "stick" else 0.4 * found.pressure
    effort, most = np.hypot(found.traction[:, 0] / one, found.traction[:, 1] / two), np.minimum(rubbed, limit)
    assert (effort <= most * (1 + 1e-9)).all()
    slips = found.status == "slip"
    assert (effort[slips] >= most[slips] * (np.cos(np.pi / facets) if facets else 1.0) * (1 - 1e-9)).all()
    assert (slips & (most == limit)).any()


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_iterated_contact_is_the_condensed_one(law):
    model = in_increments(block(drag=0.02, **law), 2)
    one, two = (solve(model, backend=backend).contact("floor") for backend in ("auto", "iterative"))
    np.testing.assert_allclose(two.pressure, one.pressure, rtol=0, atol=1e-7)
    np.testing.assert_allclose(two.traction, one.traction, rtol=0, atol=1e-7)


def test_a_history_goes_on_from_a_checkpoint():
    back = [*PRESS_AND_DRAG, Step(name="back", scale={"top": -1.0})]
    whole = solve(block(back, **LAWS["all"]))
    first = solve(block(back[:2], **LAWS["all"]))
    rest = block([Step(scale={"top": -1.0, "press": 1.0})], **LAWS["all"])
    second = solve(rest, start=first.end)
    np.testing.assert_allclose(second.contact("floor").traction, whole.contact("floor").traction, atol=1e-12)


def test_a_prepared_model_keeps_the_limit():
    prepared = prepare(in_increments(block(**LAWS["limit"]), 1))
    floor = prepared.solve(friction=0.6).contact("floor")
    one = solve(in_increments(block(friction=0.6, shear_limit=1.5), 1)).contact("floor")
    np.testing.assert_allclose(floor.traction, one.traction, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("law", "said"),
    [
        ({"shear_limit": -1.0}, r"shear_limit: is -1.0; expected a number > 0"),
        ({"shear_limit": 0}, r"shear_limit: is 0; expected a number > 0"),
        ({"shear_limit": "much"}, r"shear_limit: is 'much'; expected a number > 0"),
        ({"adhesion": -1.0}, r"adhesion: is -1.0; expected a number >= 0"),
        ({"friction": "tied", "shear_limit": 1.0}, "shear_limit: is given, but the contact is tied"),
        ({"friction": "tied", "adhesion": 1.0}, "adhesion: is given, but the contact is tied"),
        ({"friction": "stick", "adhesion": 1.0}, "adhesion: is given, but the contact never slips"),
    ],
)
def test_wrong_laws_are_refused(law, said):
    with pytest.raises(InputError, match=said):
        block(**law)


def test_decks_and_the_check_say_the_law(tmp_path, capsys):
    written = block(**LAWS["all"])
    write_deck(written, tmp_path / "deck.toml")
    contact = read(tmp_path / "deck.toml").contacts[0]
    assert (contact.friction, contact.adhesion, contact.shear_limit) == (0.3, 0.5, 1.6)
    assert main(["check", str(tmp_path / "deck.toml")]) == 0
    assert "friction 0.3, adhesion 0.5, shear limit 1.6" in capsys.readouterr().out
    write_deck(block(friction="stick", shear_limit=2.0), tmp_path / "tresca.toml")
    assert main(["check", str(tmp_path / "tresca.toml")]) == 0
    assert "sticks up to shear limit 2" in capsys.readouterr().out
    write_deck(block(shear_limit=2.0), tmp_path / "none.toml")
    assert main(["check", str(tmp_path / "none.toml")]) == 0
    assert "no friction that it could limit" in capsys.readouterr().out


@pytest.mark.parametrize("Q", [0.3, 1.0, 1.9])
def test_the_closed_form_of_tresca_is_one(Q):
    """Off the singular integrals: no strain where it sticks, the limit where it slips, and the force in all."""
    law = LimitedShear(half_width=1.0, limit=1.0)
    c = law.stick_half_width(Q)

    def inner(s):
        return float(law.traction(s, Q))

    force = 2.0 * (quad(inner, 0.0, c, limit=200)[0] + 1.0 - c)
    assert force == pytest.approx(Q, abs=1e-7)
    for x in (0.0, 0.3 * c, 0.8 * c):
        principal = quad(inner, -c, c, weight="cauchy", wvar=x, limit=400)[0]
        outer = np.log((1.0 - x) / (c - x)) - np.log((1.0 + x) / (c + x))
        assert principal + outer == pytest.approx(0.0, abs=1e-5)
