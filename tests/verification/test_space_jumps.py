# SPDX-License-Identifier: BSD-3-Clause
"""A jump of finite elements in space: that of plane strain, on facets exactly and on the exact cone."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.solve import solve
from signorini.errors import SolveFailed
from signorini.meshing.solid import box

GRID = [0.0, 0.5, 1.0]
SOFT = [sg.Body("block", sg.Elastic(E=100.0, nu=0.3))]
PRESS, LIFT = sg.Step(scale={"press": 1.0}), sg.Step(name="lift", scale={"lift": 1.0})


def rough_block():
    """Clamped on the left, pressed on a very rough floor, lifted on the right: a node cannot let go gradually."""
    return sg.Model(
        sg.rectangle(nx=2, ny=2),
        bodies=SOFT,
        supports=[sg.Support("left", u=(0.0, 0.0))],
        loads=[
            sg.Load("bottom", traction=(0.0, -2.0), name="press"),
            sg.Load("right", traction=(0.0, 2.0), name="lift"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=4.0, name="floor")],
        steps=[PRESS, replace(LIFT, path="exact", jump="follow")],
    )


def rough_slab(facets, **lift):
    """The same as a slab in plane strain."""
    contact = sg.Contact(
        "bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=4.0, friction_axis=(1, 0, 0), facets=facets, name="floor"
    )
    return sg.Model(
        box(x=GRID, y=[0.0, 1.0], z=GRID),
        bodies=SOFT,
        supports=[
            sg.Support("left", u=(0.0, 0.0, 0.0)),
            *(sg.Support(side, u=(None, 0.0, None)) for side in ("front", "back")),
        ],
        loads=[
            sg.Load("bottom", traction=(0.0, 0.0, -2.0), name="press"),
            sg.Load("right", traction=(0.0, 0.0, 2.0), name="lift"),
        ],
        contacts=[contact],
        steps=[PRESS, replace(LIFT, **lift)],
    )


@pytest.mark.parametrize(("facets", "lift"), [(8, {"path": "exact", "jump": "follow"}), (8, {}), (0, {})])
def test_a_slab_jumps_and_lands_as_plane_strain_does(facets, lift):
    plane, space = solve(rough_block()).last, solve(rough_slab(facets, **lift)).last
    for one, two in zip(plane.instants[-3:], space.instants[-3:], strict=True):
        assert one.what == two.what
        assert two.load_factor == pytest.approx(one.load_factor, abs=1e-10)
    assert [instant.what for instant in space.instants[-3:]] == ["jump", "landing", "segment"]
    assert space.released == pytest.approx(plane.released, rel=1e-9)
    exact = "path" in lift
    assert space.dissipation == pytest.approx(plane.dissipation, rel=1e-9 if exact else 1e-2)
    assert abs(space.energy_defect) < (1e-12 if exact else 1e-3) * space.work
    assert any("a jump, followed through 2 events" in note and "candidate" in note for note in space.notes)
    size = np.abs(plane.displacement).max()
    np.testing.assert_allclose(np.abs(space.displacement).max(), size, rtol=1e-9)


@pytest.mark.parametrize(("facets", "lift"), [(8, {"path": "exact"}), (0, {"jump": "stop"})])
def test_a_jump_stops_a_step_that_does_not_follow_it(facets, lift):
    words = (
        r"at 75.811089%: a jump: no equilibrium .*\n  what to do: .*\n  evidence: .*combinations of states has rates"
    )
    with pytest.raises(SolveFailed, match=words) as caught:
        solve(rough_slab(facets, **lift))
    assert caught.value.status == "jump"
