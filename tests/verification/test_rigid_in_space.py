# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles in space under forces and moments, and turned: balance, equivalence with a rigid body, decks."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.cli.main import main
from signorini.deck import read
from signorini.deck.write import write_deck
from signorini.engine.solve import solve
from signorini.errors import InputError, SolveFailed
from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.links import RigidBody
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane, Sphere
from signorini.model.rigid import Rigid
from signorini.model.step import Step

FORCE, MOMENT = (0.3, -0.2, -10.0), (0.4, -0.7, 0.5)
EVERY = {"u": (None,) * 3, "rotation": None, "force": FORCE, "moment": MOMENT, "point": (0.5, 0.5, 0.1)}


def pressed(shape, friction, **given):
    """A block on a fixed base under a rigid obstacle."""
    x = np.linspace(0, 1, 5)
    return Model(
        box(x=x, y=x, z=[-1, -0.5, -0.2, 0]),
        bodies=[Body("block", Elastic(E=1000.0, nu=0.3))],
        supports=[Support("bottom", u=(0, 0, 0))],
        contacts=[Contact("top", "tool", friction=friction)],
        obstacles=[Rigid("tool", shape, **given)],
        steps=[Step(increments=1)],
    )


def test_a_plane_that_sticks_is_a_rigid_face():
    """All pairs closed and stuck: it moves as a rigid body on the same nodes under the same load."""
    model = pressed(Plane((0, 0, 0), (0, 0, -1)), "stick", **EVERY)
    found = solve(model).last
    assert found.contacts[0].closed.all()
    body = RigidBody("tool", on="top", point=EVERY["point"])
    face = replace(model, obstacles=(), contacts=(), rigid_bodies=(body,), loads=(Load("tool", force=FORCE + MOMENT),))
    expected = solve(face).last.rigid_bodies["tool"]
    tool = found.obstacles["tool"]
    for key in ("displacement", "rotation", "force", "moment"):
        np.testing.assert_allclose(getattr(tool, key), getattr(expected, key), rtol=1e-8, atol=1e-10)


def test_contact_bears_force_and_moment_and_driving_there_takes_the_same():
    ball = Sphere((0.5, 0.45, 2.9), 3.0)
    free = solve(pressed(ball, 0.5, **EVERY | {"moment": (0.0, 0.0, 0.1), "rotation": (0.0, 0.0, None)})).last
    tool, contact = free.obstacles["tool"], free.contacts[0]
    np.testing.assert_allclose(contact.normal_force + contact.tangential_force, FORCE, atol=1e-8)
    np.testing.assert_allclose(contact.moment(EVERY["point"]), tool.moment, atol=1e-9)
    assert tool.moment[2] == pytest.approx(0.1)
    np.testing.assert_array_equal(tool.rotation[:2], 0.0)
    assert tool.rotation[2] > 0.0
    motion = {"u": tuple(tool.displacement), "rotation": tuple(tool.rotation), "point": EVERY["point"]}
    driven = solve(pressed(ball, 0.5, **motion)).last.obstacles["tool"]
    np.testing.assert_allclose(driven.force, FORCE, rtol=1e-7)
    np.testing.assert_allclose(driven.moment, tool.moment, rtol=1e-7)


def test_too_large_a_moment_turns_it_away():
    spun = pressed(Sphere((0.5, 0.5, 3.0), 3.0), 0.3, **EVERY | {"force": (0, 0, -10), "moment": (0, 0, 30.0)})
    with pytest.raises(SolveFailed, match=r"'tool' can rotate about the axis .* along \(0, 0, 1\)"):
        solve(spun)


def test_decks_say_it(tmp_path, capsys):
    model = pressed(Sphere((0.5, 0.5, 3.0), 3.0), 0.3, u=(0, 0, -0.1), rotation=(0.0, 0.0, None), moment=(0, 0, 0.1))
    write_deck(model, tmp_path / "deck.toml")
    assert read(tmp_path / "deck.toml").obstacles[0] == model.obstacles[0]
    assert main(["check", str(tmp_path / "deck.toml")]) == 0
    assert "rotation (0, 0, free)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"rotation": 0.1}, "rotation: is 0.1; expected a list of 3"),
        ({"rotation": (0.1, 0.0)}, "rotation: has 2 components"),
        ({"moment": 2.0}, "moment: is 2.0; expected a list of 3"),
        ({"moment": (0, 0, 1)}, "moment: acts on a prescribed rotation"),
        ({"moment": (1, 0, 0), "rotation": (0, None, None)}, "moment: acts on a prescribed rotation"),
        ({"moment": None}, "moment: is None; expected a number"),
    ],
)
def test_mistakes(given, said):
    with pytest.raises(InputError, match=said):
        Rigid("ball", Sphere((0, 0, 3), 3), **given)
