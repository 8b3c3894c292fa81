# SPDX-License-Identifier: BSD-3-Clause
"""Where the law of contact holds all along an increment no smaller ones are tried."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.blocks import stacked_blocks
from signorini.meshing.solid import box
from signorini.model.mesh import join

ALONG = "the law of contact holds all along"


def cubes(*ends, gap=0.0, increments="auto"):
    """A cube above another, the top moved to ``ends`` one after the other."""
    x = np.linspace(0.0, 1.0, 3)
    parts = {"lower": box(x=x, y=x, z=x - 1.0), "upper": box(x=x, y=x, z=x + gap)}
    return sg.Model(
        join(parts),
        bodies=[sg.Body(name, sg.Elastic(E=1.0, nu=0.3)) for name in parts],
        supports=[
            sg.Support("lower.bottom", u=(0, 0, 0)),
            sg.Support("upper.top", u=(1.0, None, None), name="x"),
            sg.Support("upper.top", u=(None, 1.0, None), name="y"),
            sg.Support("upper.top", u=(None, None, 1.0), name="z"),
        ],
        contacts=[sg.Contact("upper.bottom", "lower.top", friction=0.3, gap=gap)],
        steps=[sg.Step(scale=dict(zip("xyz", end, strict=True)), increments=increments) for end in ends],
    )


DOWN, ASIDE = (0.0, 0.0, -0.01), (0.02, 0.006, -0.01)


@pytest.mark.parametrize("backend", ["auto", "iterative"])
def test_a_straight_way_is_gone_once(backend):
    solution = sg.solve(cubes(ASIDE), backend=backend)
    assert len(solution.last.trace) == 1
    assert any(ALONG in note for note in solution.last.notes)
    fine = sg.solve(cubes(ASIDE, increments=4))
    np.testing.assert_allclose(solution.last.displacement, fine.last.displacement, atol=1e-9)
    size = fine.last.contacts[0].pressure.max()
    np.testing.assert_allclose(solution.last.contacts[0].traction, fine.last.contacts[0].traction, atol=1e-7 * size)


@pytest.mark.slow
@pytest.mark.parametrize(
    "model",
    [
        cubes(DOWN, gap=0.003),  # closes on the way
        cubes(DOWN, ASIDE),  # sticks first and slips then
        cubes(ASIDE, (-0.02, 0.02, -0.01)),  # turns
        cubes(ASIDE, (0.0, 0.0, 0.001)),  # opens
    ],
)
def test_what_happens_on_the_way_is_seen(model):
    solution = sg.solve(model, backend="iterative")
    assert not any(ALONG in note for note in solution.last.notes)
    assert len(solution.last.trace) > 1


def test_equal_increments_in_the_plane():
    model = stacked_blocks(friction=0.3)
    solution = sg.solve(replace(model, steps=[sg.Step(increments="auto")]))
    assert len(solution.last.trace) == 1
    assert any(ALONG in note for note in solution.last.notes)


def test_iterations_start_where_the_last_increment_leads():
    solution = sg.solve(cubes(ASIDE, increments=5), backend="iterative")
    rounds = [attempts[0].iterations for attempts in solution.last.trace]
    assert max(rounds[1:]) <= 2 < rounds[0]
