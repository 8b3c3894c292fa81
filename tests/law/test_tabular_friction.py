# SPDX-License-Identifier: BSD-3-Clause
"""Friction over pressure by a table: refusals, its bound, exact paths, Coulomb's law beside it, decks, restarts."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.deck.load import read
from signorini.deck.write import write_deck
from signorini.law.friction import PairFriction

FALLING = sg.TabularFriction([2.0, 5.0, 10.0], [0.4, 0.3, 0.2])


def traction(pressure):
    """On the lines of FALLING, and on as it ends."""
    return np.interp(pressure, [0.0, 2.0, 5.0, 10.0, 110.0], [0.0, 0.8, 1.5, 2.0, 12.0])


@pytest.mark.parametrize(
    ("pressures", "coefficients", "said"),
    [
        ("steep", [0.1], "pressures: is 'steep'; expected a list of numbers"),
        ([], [], "pressures: is []; expected a list of numbers"),
        ([1.0], [0.1, 0.2], "coefficients: has 2 for 1 pressures; expected as many, at most 8"),
        ([0.0], [0.1], "pressures[0]: is 0; expected pressures > 0 that grow"),
        ([1.0, 1.0], [0.2, 0.1], "pressures[1]: is 1; expected pressures > 0 that grow"),
        ([1.0], [-0.1], "coefficients[0]: is -0.1; expected a number >= 0"),
        (
            [1.0, 2.0],
            [0.2, 0.3],
            "coefficients[1]: is 0.3 at 2, up to which friction grows faster than before; "
            "expected friction that grows less and less",
        ),
        (
            [1.0, 2.0],
            [0.2, 0.05],
            "coefficients[1]: is 0.05 at 2, up to which friction falls; expected friction that grows less and less",
        ),
    ],
)
def test_what_is_no_table(pressures, coefficients, said):
    with pytest.raises(sg.InputError) as caught:
        sg.TabularFriction(pressures, coefficients)
    assert str(caught.value) == said


def test_laws_of_straight_branches_are_one_bound():
    others = [sg.Contact("a", "b", friction=0.3).law, FALLING, sg.TabularFriction([1.0], [0.1])]
    points, area = np.zeros((4, 2)), np.arange(1.0, 13.0)
    friction = PairFriction.of(others, [points] * 3)
    pressure = np.linspace(0.5, 15.0, 12)
    expected = np.concatenate([0.3 * pressure[:4], traction(pressure[4:8]), 0.1 * pressure[8:]])
    bound = friction.bound(area)
    assert bound.branches == 3
    assert bound.branch_counts.tolist() == [1] * 4 + [3] * 4 + [1] * 4
    assert_allclose(bound.at(pressure * area), expected * area, rtol=1e-14)


def block(friction, steps, **given):
    """A block with a table below it, and a wall in Coulomb's law beside it."""
    return sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=6, ny=3),
        kind="plane strain",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        loads=[sg.Load("top", pressure=sg.Formula("1 + 6*x"), name="p"), sg.Load("top", traction=(2.0, 0), name="q")],
        contacts=[
            sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=friction, name="bed"),
            sg.Contact("right", sg.Plane((2.001, 0), (-1, 0)), friction=0.1, name="wall"),
        ],
        steps=steps,
        **given,
    )


STEPS = [sg.Step(scale={"p": 1.0, "q": 0.0}), sg.Step(scale={"q": 1.0}), sg.Step(scale={"q": -0.3})]


def test_an_exact_path_comes_to_the_points_of_the_table(tmp_path):
    solution = sg.solve(block(FALLING, STEPS))
    for step in solution.steps:
        bed = step.contacts[0]
        slips = bed.status == "slip"
        assert_allclose(np.abs(bed.traction)[slips], traction(bed.pressure)[slips], rtol=1e-12)
        assert (np.abs(bed.traction) <= traction(bed.pressure) + 1e-12).all()
        assert abs(step.energy_defect) < 1e-13
    assert "kinks" in {event.what for step in solution.steps for event in step.events}
    sg.solve(block(FALLING, STEPS[:2])).save_state(tmp_path / "start.npz")
    rest = sg.solve(block(FALLING, STEPS[2:]), start=tmp_path / "start.npz")
    assert np.array_equal(rest.steps[0].contacts[0].traction, solution.steps[2].contacts[0].traction)
    with pytest.raises(sg.InputError, match="the tabular coefficient 3"):
        sg.solve(block(sg.TabularFriction([2, 5, 10], [0.4, 0.3, 0.19]), STEPS[2:]), start=tmp_path / "start.npz")


@pytest.mark.parametrize("backend", ["auto", "iterative"])
def test_increments_come_to_the_same(backend):
    one = sg.solve(block(FALLING, [sg.Step(scale={"p": 1.0, "q": 0.5}, increments=1)]), backend=backend)
    bed = one.contact("bed")
    slips = bed.status == "slip"
    assert slips.any()
    assert_allclose(np.abs(bed.traction)[slips], traction(bed.pressure)[slips], rtol=1e-8)


def test_a_deck_has_it(tmp_path):
    write_deck(block(FALLING, STEPS), tmp_path / "deck.toml")
    assert read(tmp_path / "deck.toml").contacts[0].friction == FALLING


def test_in_space_on_facets_it_is_followed_exactly():
    model = sg.Model(
        sg.box(x=[0, 0.5, 1.0], y=[0, 0.5, 1.0], z=[0, 0.5]),
        kind="3d",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.02, 0.005, None), name="drag")],
        loads=[sg.Load("top", pressure=sg.Formula("1 + 8*x"), name="p")],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=FALLING, facets=8)],
        steps=[sg.Step(scale={"p": 1.0, "drag": 0.0}, path="exact"), sg.Step(scale={"drag": 1.0}, path="exact")],
    )
    step = sg.solve(model).steps[1]
    bed = step.contacts[0]
    share = np.linalg.norm(bed.traction, axis=1)[bed.pressure > 0] / traction(bed.pressure)[bed.pressure > 0]
    assert (share < 1.0 + 1e-12).all()
    assert share.min() > np.cos(np.pi / 8) - 1e-12  # the polygon is inscribed
    assert abs(step.energy_defect) < 1e-13
