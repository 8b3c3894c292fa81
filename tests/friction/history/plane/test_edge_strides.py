# SPDX-License-Identifier: BSD-3-Clause
"""Edges of long zones that creep by a pair a step are moved on, to the same states in far fewer steps."""

import numpy as np
import pytest

import signorini as sg
from signorini.friction.history.plane import find_rates
from signorini.friction.history.plane.edge_strides import EdgeStrides


def dragged(pairs: int) -> sg.Solution:
    """A block that is pressed and dragged, all of its base in contact."""
    model = sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=pairs - 1, ny=4),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        supports=[sg.Support("top", u=(None, -1e-2), name="press"), sg.Support("top", u=(1.2e-2, None), name="drag")],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), friction=0.4)],
    )
    return sg.solve(model)


@pytest.mark.slow
def test_creeping_edges_are_moved_on(monkeypatch):
    monkeypatch.setattr(
        find_rates, "_JOINED_FROM", 10**9
    )  # no start from runs of pairs, which leaves edges near their ends
    ahead = dragged(500)
    monkeypatch.setattr(find_rates, "_SETTLES", find_rates.NEWTON_STEPS)
    crept = dragged(500)
    assert np.array_equal(ahead.contact("bottom").status, crept.contact("bottom").status)
    assert ahead.contact("bottom").pressure == pytest.approx(crept.contact("bottom").pressure, rel=1e-9)
    assert sum(ahead.steps[-1].iterations) <= 20
    assert sum(crept.steps[-1].iterations) >= 50


def test_what_is_taken_back_makes_strides_shorter():
    """Where it turns out that an edge went too far, it goes a smaller part of the way next time."""
    strides, n = EdgeStrides(), 40

    def step(edge: int, lacking: float) -> int:
        state, following = (np.where(np.arange(n) < end, 2, 1) for end in (edge, edge + 1))
        return int((strides.ahead(state, following, np.full(n, lacking)) == 2).sum())

    assert step(3, 1.0) == 4
    far = step(4, 0.9) - 5
    strides.ahead(np.where(np.arange(n) < 5 + far, 2, 1), np.where(np.arange(n) < 5, 2, 1), np.zeros(n))
    assert step(5, 1.0) == 6
    assert 0 < step(6, 0.9) - 7 < far


def test_scattered_changes_are_left_alone():
    state, following = np.ones(200, dtype=np.int64), np.ones(200, dtype=np.int64)
    following[::3] = 2
    strides = EdgeStrides()
    for _ in range(3):
        assert np.array_equal(strides.ahead(state, following, np.ones(200)), following)
