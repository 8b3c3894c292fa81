# SPDX-License-Identifier: BSD-3-Clause
"""Two coefficients of friction in one contact beside a law of its own in another: each keeps its own."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg


def two_blocks(other, facets=0, first=(0.5, 0.1), **step):
    """Two cells on planes, pushed across their first tangents; ``other`` is the friction of the second."""
    cells = {name: sg.box(x=[at, at + 1.0], y=[0, 1.0], z=[0, 0.5]) for name, at in (("first", 0.0), ("second", 2.0))}
    floor = sg.Plane((0, 0, 0), (0, 0, 1))
    return sg.Model(
        sg.join(cells),
        kind="3d",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in cells],
        supports=[sg.Support("first.top", u=(None, None, -0.002)), sg.Support("second.top", u=(0, 0, -0.002))],
        loads=[sg.Load("first.top", traction=(0.05, 0.3, 0), name="q")],
        contacts=[
            sg.Contact("first.bottom", floor, friction=first, friction_axis=(1, 0, 0), facets=facets),
            sg.Contact("second.bottom", floor, friction=other, facets=facets),
        ],
        steps=[sg.Step(increments=2, **step)],
    )


@pytest.mark.parametrize("facets", [0, 8])
def test_an_ellipse_stays_one_beside_a_law_of_its_own(facets):
    plain, own = (sg.solve(two_blocks(law, facets)).steps[0] for law in (0.3, sg.TabularFriction([1.0], [0.3])))
    assert plain.dissipation > 0.0
    assert own.dissipation == pytest.approx(plain.dissipation, rel=1e-9)
    for one, two in zip(plain.contacts, own.contacts, strict=True):
        assert_allclose(two.traction, one.traction, rtol=0, atol=1e-9)


def test_a_step_gives_two_coefficients_beside_a_law_of_its_own():
    table = sg.TabularFriction([1.0], [0.3])
    given, changed = (
        sg.solve(two_blocks(table, first=first, friction=friction)).steps[0]
        for first, friction in (((0.5, 0.1), {}), (0.5, {"first.bottom": (0.5, 0.1)}))
    )
    assert np.array_equal(given.contacts[0].traction, changed.contacts[0].traction)
