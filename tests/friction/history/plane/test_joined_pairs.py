# SPDX-License-Identifier: BSD-3-Clause
"""States of many pairs are sought on runs of pairs first: the same states, in a few systems."""

import numpy as np
import pytest

import signorini as sg
from signorini.friction.history.plane import find_rates
from signorini.friction.history.plane.joined_pairs import joined
from signorini.friction.problem import ContactProblem


def pressed(*, floats: bool, pairs: int = 330) -> sg.Model:
    """A block, all of whose base is in contact, pressed and dragged by its top or by loads on it."""
    top = sg.Support("top", u=(None, -1e-2), name="press"), sg.Support("top", u=(1.2e-2, None), name="drag")
    loads = sg.Load("top", pressure=1e-2, name="press"), sg.Load("top", force=(4e-3, None), name="drag")
    return sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=pairs - 1, ny=4),
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))],
        supports=[] if floats else top,
        loads=loads if floats else [],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), friction=0.4)],
    )


@pytest.mark.slow
@pytest.mark.parametrize("floats", [False, True], ids=["held", "held by contact alone"])
def test_states_are_those_without_them_in_fewer_systems(monkeypatch, floats):
    one = sg.solve(pressed(floats=floats)).last
    monkeypatch.setattr(find_rates, "_JOINED_FROM", 10**9)
    other = sg.solve(pressed(floats=floats)).last
    (here,), (there,) = one.contacts, other.contacts
    assert len({*here.status.tolist()}) > 1
    assert np.array_equal(here.status, there.status)
    assert here.pressure == pytest.approx(there.pressure, rel=1e-9, abs=1e-12)
    assert sum(one.iterations) <= 6
    assert sum(other.iterations) >= sum(one.iterations) + 3


def test_what_runs_of_one_pair_make_is_the_problem_itself():
    rng = np.random.default_rng(3)
    X = rng.standard_normal((8, 8))
    compliance, motions = X @ X.T, np.zeros((8, 1))
    motions[:4] = 1.0
    held = np.linalg.inv(np.eye(8) + compliance + 1e9 * motions @ motions.T)
    W = np.eye(8) - held
    W = (W + W.T) / 2
    P = np.eye(8) - motions @ motions.T / 4.0
    W = P @ W @ P + motions @ motions.T / 4.0
    problem = ContactProblem.of(W=W, b=rng.standard_normal(8), friction=np.full(4, 0.3), motions=motions, scale=1.0)
    same = joined(problem, np.arange(4))
    assert same is not None
    np.testing.assert_allclose(same.W, problem.W, atol=1e-8)
    np.testing.assert_allclose(same.b, problem.b, atol=1e-8)
