# SPDX-License-Identifier: BSD-3-Clause
"""How much of the load contact can hold on floating bodies, and searches that end."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from signorini import deck
from signorini.api import solve
from signorini.arrays import frozen
from signorini.clock import Clock
from signorini.friction.history import initial_state
from signorini.friction.history.space.bearing import Bearing
from signorini.friction.history.space.no_rates_proof import Exhausted, search_regions
from signorini.friction.history.space.smooth_cones import ConeProblem
from signorini.friction.overload import overload
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import GAIN, pulled_away

HERE, EXAMPLES = Path(__file__).parent, Path(__file__).parents[3] / "examples"


def floating(rng, pairs, friction):
    """A body with its six motions, which random points of contact hold at random normals, pressed."""
    x = rng.normal(size=(pairs, 3))
    frames = np.linalg.qr(rng.normal(size=(pairs, 3, 3)))[0].transpose(0, 2, 1)
    turns = np.cross(x[:, None], frames)
    rows = np.concatenate([frames, turns], axis=2).transpose(1, 0, 2).reshape(3 * pairs, 6)
    motions = np.linalg.qr(rows)[0]
    rigid = motions @ motions.T
    return ContactProblem.of(
        W=rigid + 0.5 * (np.eye(3 * pairs) - rigid),
        b=np.concatenate([-rng.uniform(0.5, 1.5, pairs), np.zeros(2 * pairs)]),
        friction=np.full(pairs, friction),
        motions=motions,
        scale=1.0,
    )


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.integers(3, 12), st.sampled_from([0.1, 0.4, 1.0]))
@example(1782, 3, 0.1)  # a motion 15 times the load: what resists it by 1e-9 of its size is too much for a proof
def test_beyond_an_overload_a_rigid_motion_proves_that_nothing_holds_and_none_does_before(seed, pairs, friction):
    rng = np.random.default_rng(seed)
    problem = floating(rng, pairs, friction)
    end = problem.b + 10.0 * rng.normal(size=3 * pairs)
    found = overload(problem, -problem.by_pair(problem.b), end)

    def at(s):
        return replace(problem, b=frozen(problem.b + s * (end - problem.b)))

    if found is None:
        assert pulled_away(at(1.0)) is None
        return
    assert 0.0 < found.factor < 1.0
    assert pulled_away(at(found.factor * (1.0 - 1e-5))) is None
    assert pulled_away(at(found.factor * (1.0 + 1e-2))) is not None
    assert found.factor <= found.proved < found.factor + 1e-2
    assert 0.0 < found.share <= pulled_away(at(1.0)).share + 1e-9
    edge, beyond = (
        overload(problem, -problem.by_pair(problem.b), at(found.factor * (1.0 + part)).b) for part in (1e-11, 1e-2)
    )
    assert edge is None or edge.share <= GAIN
    assert beyond.share > GAIN


@pytest.mark.parametrize("behind", [0.25, 0.5, 0.7])
def test_a_limit_is_looked_at_from_as_near_wherever_on_the_way_the_look_begins(behind):
    rng = np.random.default_rng(5)
    problem = floating(rng, 6, 0.4)
    growth = rng.normal(size=18)
    way = (
        growth * 100.0 * overload(problem, -problem.by_pair(problem.b), problem.b + 100.0 * growth).factor / 0.75
    )  # it ends at 75 %

    def seen(since, before):
        b = problem.b + since * way
        now = replace(initial_state(problem, np.zeros(18), motion=np.zeros((3, 6))), b=b, r=-problem.by_pair(problem.b))
        look = Bearing(problem, problem.b + way, before)
        return [since + (1.0 - since) * part for part in (look.reach(now, 0.0), look.limit, look.beyond)]

    whole = seen(0.0, 0.0)
    assert np.allclose(whole, [0.74925, 0.75, 0.75075], rtol=1e-6)
    assert np.allclose(seen(behind, behind / (1.0 - behind)), whole, rtol=1e-6)


def test_linear_programmes_end_where_bodies_nearly_roll():
    data = np.load(HERE / "nearly_rolling.npz")
    found = search_regions(ConeProblem(M=data["M"], q=data["q"], friction=data["friction"].T, closed=data["closed"]))
    assert isinstance(found, Exhausted)


@pytest.mark.slow
def test_an_overloaded_joint_slides_at_the_load_that_friction_holds_and_what_was_solved_is_kept():
    """10 kN press, friction 0.02 holds 200 N of the 1600 N; farther on the bend would bear, up to 74.8 %."""
    model = deck.read(EXAMPLES / "bolted_bracket.toml")
    loads = tuple(replace(load, force=(1600.0, 0.0, 0.0)) if load.name == "cable" else load for load in model.loads)
    contacts = tuple(replace(contact, friction=0.02) for contact in model.contacts)
    said = []
    clock = Clock(lambda words, done: said.append(words))  # noqa: ARG005  # words alone are looked at
    solution = solve(replace(model, loads=loads, contacts=contacts), raise_on_failure=False, clock=clock)
    assert solution.status == "no_equilibrium"
    assert "at 12.500000%: gross sliding: body 'bracket' can move along x: " in solution.message
    assert "beyond 74.78" in solution.message
    assert re.search(r"nothing takes 0\.\d+ of the load at the end", solution.message)
    finished, cut = solution.steps
    assert finished.finished
    assert not cut.finished
    assert cut.certificate.passed
    assert np.isclose(cut.load_factor, 1.125, rtol=1e-9)
    motion = solution.escape
    assert np.abs(motion[:, 1:]).max() < 1e-3 * np.abs(motion[:, 0]).max()
    assert any("with the pairs that seemed too far apart" in words for words in said)
    assert any(words.startswith("step 'pull' at 6.2%") for words in said)
