# SPDX-License-Identifier: BSD-3-Clause
"""Wear of rings and of bodies in space: closed forms, what is kept, blocks, and runs that go on."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import signorini as sg
from signorini.cli.main import main
from signorini.deck.write import write_deck
from signorini.gallery.wearing import rubbed_cylinder, to_and_fro

STEEL = sg.Elastic(E=200.0, nu=0.3)
STROKE, PRESSURE, RATE = 0.1, 1.0, 1e-2


def ring_on_a_shaft(cycles: int) -> sg.Model:
    """A ring, 1 < r < 2 and 0.5 long, that a pressure from outside holds on a rigid shaft, pushed along it; smooth."""
    return sg.Model(
        sg.rectangle(x=np.linspace(1.0, 2.0, 9), y=np.linspace(0.0, 0.5, 4), cells="quad8"),
        kind="axisymmetric",
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support(end, u=(None, STROKE), name=f"push {end}") for end in ("bottom", "top")],
        loads=[sg.Load("right", pressure=PRESSURE, name="press")],
        contacts=[sg.Contact("left", sg.Plane((1.0, 0.0), (1.0, 0.0)), wear=sg.Wear(RATE), name="bore")],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}),
            sg.Step(
                name="rub",
                scale={f"push {end}": [1.0, 0.0] for end in ("bottom", "top")},
                repeat=cycles,
            ),
        ],
    )


@pytest.mark.slow
def test_a_ring_that_is_pushed_along_its_shaft_wears_as_pressure_times_distance():
    """Lame's ring: p = p_0 - d / b, so that every cycle wears k p s, and the next one as much less as p has fallen."""
    rub = sg.solve(ring_on_a_shaft(3)).last
    contact, way = rub.contacts[0], 2.0 * STROKE
    a, b = 1.0, 2.0
    inner = (1.0 + 0.3) / 200.0 * (a**2 * (1.0 - 0.6) + b**2) / (b**2 - a**2)  # bore widens by p, plane strain
    outer = (1.0 + 0.3) / 200.0 * 2.0 * (1.0 - 0.3) * b**2 / (b**2 - a**2)  # bore narrows by the pressure outside
    first = PRESSURE * outer / inner
    lasts = 1.0 - RATE * way / inner
    depth = RATE * first * way * (1.0 - lasts**3) / (1.0 - lasts)
    assert contact.wear.depth == pytest.approx(depth, rel=2e-4)
    assert np.ptp(contact.wear.depth) < 1e-9 * depth
    assert contact.pressure == pytest.approx(first * lasts**3, rel=2e-4)
    assert contact.wear.volume[0] == pytest.approx(2.0 * pi * 0.5 * contact.wear.depth[0], rel=1e-12)
    assert abs(rub.energy_defect) < 1e-12 * rub.released


def test_worn_volume_of_a_ring_on_a_shaft_that_wears_too():
    """Other meshes on both sides, friction: the volume is k times the work of friction over mu, all around."""
    hub = sg.rectangle(x=np.linspace(1.0, 2.0, 4), y=np.linspace(0.0, 0.6, 5))
    shaft = sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(-0.5, 1.1, 12))
    solution = sg.solve(
        sg.Model(
            sg.join({"hub": hub, "shaft": shaft}),
            kind="axisymmetric",
            bodies=[sg.Body("hub", STEEL), sg.Body("shaft", STEEL)],
            supports=[
                sg.Support("shaft.bottom", u=(None, 0.0)),
                sg.Support("hub.right", u=(None, STROKE), name="drive"),
            ],
            loads=[sg.Load("hub.right", pressure=PRESSURE, name="press")],
            contacts=[sg.Contact("hub.left", "shaft.right", friction=0.3, wear=sg.Wear(1e-4, mortar=3e-4))],
            steps=to_and_fro(2),
        )
    )
    wear = solution.end.state.wear
    rubbed = sum(step.dissipation for step in solution.steps) / 0.3
    assert (wear.volume + wear.loose).sum() == pytest.approx(4e-4 * rubbed, rel=1e-12)
    one, other = solution.last.contacts[0].wear.volume
    assert other == pytest.approx(3.0 * one, rel=1e-12)
    assert abs(solution.last.energy_defect) < 1e-12 * solution.last.work


def ball_in_partial_slip(cycles: int, **block: object) -> sg.Model:
    """A block with a round lower side on a rigid plane, pulled to and fro by 0.7 mu P."""
    x = np.linspace(-1.0, 1.0, 8)
    mesh = sg.box(x=x, y=x, z=np.array([0.0, 0.4, 1.0]))
    points = mesh.points.copy()
    points[:, 2] += (1.0 - points[:, 2]) * (points[:, 0] ** 2 + points[:, 1] ** 2) / 60.0
    steps = [
        sg.Step(name="press", scale={"press": 1.0}),
        sg.Step(name="pull", scale={"pull": 0.7}),
        sg.Step(name="cycles", scale={"pull": [-0.7, 0.7]}, repeat=cycles, **block),
    ]
    return sg.Model(
        replace(mesh, points=points),
        bodies=[sg.Body("block", STEEL)],
        loads=[
            sg.Load("top", force=(None, None, -1.0), spread="displacement", name="press"),
            sg.Load("top", force=(0.5, None, None), spread="displacement", name="pull"),
        ],
        supports=[sg.Support("top", u=(None, 0.0, None))],
        contacts=[
            sg.Contact(
                "bottom",
                sg.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
                friction=0.5,
                facets=4,
                friction_axis=(1.0, 0.0, 0.0),
                wear=sg.Wear(0.01),
            )
        ],
        steps=steps,
    )


@pytest.mark.slow
def test_partial_slip_in_space_wears_an_annulus_in_blocks_too():
    """Nothing is worn where it sticks; half of all cycles in blocks wear as all of them do."""
    every, blocks = (sg.solve(ball_in_partial_slip(9, **block)).last for block in ({}, {"block": 4}))
    for step in (every, blocks):
        contact = step.contacts[0]
        sticks = contact.status == "stick"
        assert sticks.any()
        assert contact.wear.depth[sticks].max() == 0.0
        assert contact.wear.depth[contact.status == "slip"].min() > 0.0
        assert step.cycles[-1].number == 9
    one, other = every.contacts[0].wear.depth, blocks.contacts[0].wear.depth
    assert np.abs(one - other).max() < 0.01 * one.max()


@pytest.mark.slow
@pytest.mark.parametrize("block", [3, "auto"])
def test_blocks_of_a_history_that_is_cut_go_on_to_the_last_bit(block, tmp_path):
    """From a solution, and on the command line from a folder, whose archives read what was worn to the last bit."""
    steps = to_and_fro(6, block=block)
    model = rubbed_cylinder([*steps, replace(steps[1], name="on")], wear=sg.Wear(1.9e-6, mortar=2.9e-6), spacing=0.05)
    whole = sg.solve(model)
    for name, part in (("one", model.steps[:2]), ("two", model.steps[2:])):
        write_deck(replace(model, steps=part), tmp_path / f"{name}.toml")
    run = ["run", "--quiet", "-o"]
    assert main([*run, str(tmp_path / "a"), str(tmp_path / "one.toml")]) == 0
    assert main([*run, str(tmp_path / "b"), str(tmp_path / "two.toml"), "--from", str(tmp_path / "a")]) == 0
    begun = sg.load(tmp_path / "a" / "solution.h5")
    for rest in (
        sg.solve(replace(model, steps=model.steps[2:]), start=begun),
        sg.load(tmp_path / "b" / "solution.h5"),
    ):
        assert np.array_equal(rest.end.state.wear.depth, whole.end.state.wear.depth)
        assert np.array_equal(rest.last.contacts[0].pressure, whole.last.contacts[0].pressure)
        assert rest.last.notes == whole.last.notes
