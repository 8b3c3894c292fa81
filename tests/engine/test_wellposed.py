# SPDX-License-Identifier: BSD-3-Clause
"""What a solution says of other solutions, and the picture of why there is none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.cli import main
from signorini.gallery.blocks import dragged_block, stacked_blocks

EXAMPLE = Path(__file__).parents[2] / "examples" / "zhu_cylinder.toml"


def rough_block(lift, friction=4.0):
    """Clamped on the left, pressed on a rough floor, lifted on the right (its path jumps at lift 0.758)."""
    loads = [sg.Load("bottom", traction=(0.0, -2.0), name="press"), sg.Load("right", traction=(0.0, 2.0), name="lift")]
    return sg.Model(
        sg.rectangle(nx=2, ny=2),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=loads,
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=friction, name="floor")],
        steps=[sg.Step(scale={"press": 1.0}), sg.Step(scale={"lift": lift})],
    )


def test_little_friction_is_proved_unique():
    found = sg.solve(rough_block(0.2, friction=0.1), wellposed=True).wellposedness
    assert found.verdict == "unique"
    assert "is below" in found.words
    assert found.friction == 0.1 < found.bound
    assert sg.solve(rough_block(0.2)).wellposedness is None


def test_other_equilibria_before_a_jump_are_returned():
    """Just before the jump the state and what it jumps to are both in equilibrium."""
    solution = sg.solve(rough_block(0.757), wellposed=True)
    found = solution.wellposedness
    assert found.verdict == "several"
    assert "other equilibria" in found.words
    (floor,) = solution.last.contacts
    landing = sg.solve(rough_block(0.7582)).contact("floor")
    distances = [np.abs(other[0].pressure - landing.pressure).max() for other in found.others]
    assert min(distances) < 0.05 * floor.pressure.max()
    for other in found.others:
        assert np.abs(other[0].pressure - floor.pressure).max() > 1e-6 * floor.pressure.max()
        assert (np.abs(other[0].traction) <= 4.0 * other[0].pressure + 1e-9).all()


def test_the_states_of_few_pairs_decide():
    found = sg.solve(rough_block(0.2), wellposed=True).wellposedness
    assert found.verdict == "one"
    assert sg.solve(rough_block(0.2, friction=0.8), wellposed=True).wellposedness.verdict == "unique"


def test_bodies_held_by_contact_have_no_bound():
    found = sg.solve(dragged_block(), wellposed=True).wellposedness
    assert found.bound is None
    assert found.verdict == "not decided"


def test_the_command_line_asks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--wellposed", str(EXAMPLE)]) == 0
    assert "uniqueness\n  friction 0.4 is below 0.7341" in capsys.readouterr().out
    assert main(["run", "--wellposed", str(EXAMPLE), "-o", str(tmp_path)]) == 0
    assert "forces of every load and history are unique" in " ".join(capsys.readouterr().out.split())
    assert '"well_posedness": {' in (tmp_path / "summary.json").read_text()


def rough_slab(lift, friction=4.0):
    """`rough_block` in space, one cell thick, its sides held across."""
    plane = rough_block(lift, friction)
    x = np.linspace(0.0, 1.0, 3)
    return replace(
        plane,
        mesh=sg.box(x=x, y=[0.0, 1.0], z=x),
        kind="3d",
        supports=[sg.Support("left", u=(0.0, 0.0, 0.0))]
        + [sg.Support(side, u=("free", 0.0, "free")) for side in ("front", "back")],
        loads=[replace(load, traction=(0.0, 0.0, load.traction[1])) for load in plane.loads],
        contacts=[replace(plane.contacts[0], mortar=sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)))],
    )


def test_space_is_examined_as_the_plane_is():
    few = sg.solve(rough_slab(0.2, 0.1), wellposed=True).wellposedness
    assert few.verdict == "unique"
    assert few.friction == 0.1 < few.bound
    found = sg.solve(rough_slab(0.757), wellposed=True).wellposedness
    assert found.verdict == "several"
    planes = sg.solve(rough_block(0.757), wellposed=True).wellposedness
    for (other,) in planes.others:
        expected = (*other.normal_force, *other.tangential_force)
        distances = [
            np.abs(np.array([*each.normal_force[[0, 2]], *each.tangential_force[[0, 2]]]) - expected).max()
            for (each,) in found.others
        ]
        assert min(distances) < 1e-8


def test_what_is_not_examined_says_why():
    model = replace(rough_slab(0.2, 0.1), steps=[sg.Step(increments=1)])
    found = sg.solve(model, backend="iterative", wellposed=True).wellposedness
    assert (found.verdict, found.friction) == ("not decided", 0.1)
    assert "solved by iteration" in found.words


def test_the_motion_of_a_body_that_leaves_is_drawn():
    model = dragged_block()
    steps = [sg.Step(scale={"press": -1.0, "push": 0.0}, increments=1)]
    solution = sg.solve(replace(model, steps=steps), raise_on_failure=False)
    assert solution.status == "no_equilibrium"
    np.testing.assert_allclose(solution.escape[:, 1], 1.0, atol=1e-9)
    assert solution.plot_escape().axes
    slab = replace(
        rough_slab(0.0), supports=[], loads=[sg.Load("top", traction=(0.0, 0.0, 1.0))], steps=[sg.Step(increments=1)]
    )
    lifted = sg.solve(slab, raise_on_failure=False)
    np.testing.assert_allclose(lifted.escape[:, 2], 1.0, atol=1e-9)
    assert lifted.plot_escape().axes
    with pytest.raises(sg.InputError, match="no body runs away"):
        sg.solve(stacked_blocks()).plot_escape()


LAWS = [({"friction": "stick"}, False), ({"adhesion": 0.5}, False), ({"shear_limit": 0.5}, True)]


@pytest.mark.parametrize(("law", "unique"), LAWS)
def test_friction_without_pressure_is_not_claimed_to_be_unique(law, unique):
    """A pair that sticks or adheres may hold a load under which it could be open as well."""
    model = rough_block(0.2, 0.1)
    model = replace(model, contacts=[replace(model.contacts[0], **law)])
    found = sg.solve(model, wellposed=True).wellposedness
    assert (found.verdict == "unique") == unique
    assert np.isfinite(found.friction) == unique
    assert unique or "friction without pressure is above" in found.words
