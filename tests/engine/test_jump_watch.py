# SPDX-License-Identifier: BSD-3-Clause
"""Equal increments in space never step over a slide in silence."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini import deck
from signorini.engine import automatic, jump_watch
from signorini.engine.increments import advance
from signorini.engine.step_parts import FollowedPart, Snapshot
from signorini.meshing.solid import box
from signorini.model.mesh import join

EXAMPLES = Path(__file__).parents[2] / "examples"

SLIDES = "step 'pull' at 50.000000%: gross sliding: body 'top' can move along x: no equilibrium continues the history"


def block(*, pull, increments, jump=None):
    """A cube that friction holds up to a pull of 0.3, half its size before a wall."""
    sides = np.linspace(0.0, 1.0, 3)
    return sg.Model(
        join({"top": box(x=sides, y=sides, z=sides)}),
        bodies=[sg.Body("top", sg.Elastic(E=1000.0, nu=0.3))],
        loads=[
            sg.Load("top.top", force=(0.0, 0.0, -1.0), name="press"),
            sg.Load("top.bottom", force=(pull, 0.0, 0.0), name="pull"),
        ],
        contacts=[
            sg.Contact("top.bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=0.3, name="floor"),
            sg.Contact("top.right", sg.Plane((1.5, 0, 0), (-1, 0, 0)), friction=0.3, name="wall"),
        ],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}, increments=1),
            sg.Step(name="pull", scale={"pull": 1.0}, increments=increments, jump=jump),
        ],
    )


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["auto", "iterative"])
@pytest.mark.parametrize(("increments", "words"), [(1, "1 increment"), (3, "3 increments")])
def test_the_equilibrium_behind_a_slide_is_called_a_candidate(increments, words, backend):
    solution = sg.solve(block(pull=0.6, increments=increments), backend=backend)
    assert solution.last.displacement[:, 0].min() > 0.49  # it stands at the wall
    notes = [note for note in solution.steps[-1].notes if note.startswith(SLIDES)]
    assert len(notes) == 1
    assert notes[0].endswith(f"; followed in {words} to what is a candidate")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("backend", "increments", "reached"),
    [("auto", 1, 1.5), ("auto", 3, 1.5), ("iterative", 1, 1.0), ("iterative", 3, 4 / 3)],
)
def test_a_step_that_stops_at_jumps_stops_at_the_slide(backend, increments, reached):
    """At it where events are followed, at the last increment before it where contact is iterated."""
    model = block(pull=0.6, increments=increments, jump="stop")
    solution = sg.solve(model, backend=backend, raise_on_failure=False)
    assert solution.status == "jump"
    assert solution.message.startswith(SLIDES)
    assert reached - 0.1 < (solution.steps[-1].load_factor if len(solution.steps) > 1 else 1.0) <= reached + 1e-12


def test_where_no_increment_goes_on_the_slide_is_named():
    """At half the pull any place is in equilibrium, and none is found."""
    solution = sg.solve(block(pull=0.6, increments=10), raise_on_failure=False)
    assert solution.status == "jump"
    assert solution.message.startswith(SLIDES)


@pytest.mark.parametrize("backend", ["auto", "iterative"])
@pytest.mark.parametrize("increments", [1, 3, 10])
def test_what_friction_holds_says_nothing(increments, backend):
    solution = sg.solve(block(pull=0.28, increments=increments), backend=backend)
    assert not [note for note in solution.steps[-1].notes if "gross sliding" in note]


def square(*, pull, wall, **step):
    """The same in the plane, with the wall or without."""
    sides = np.linspace(0.0, 1.0, 5)
    contacts = [
        sg.Contact("bottom", sg.Plane((0.0, 0.0), (0.0, 1.0)), friction=0.3, name="floor"),
        sg.Contact("right", sg.Plane((1.5, 0.0), (-1.0, 0.0)), friction=0.3, name="wall"),
    ]
    return sg.Model(
        sg.rectangle(x=sides, y=sides),
        kind="plane strain",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        loads=[sg.Load("top", force=(0.0, -1.0), name="press"), sg.Load("bottom", force=(pull, 0.0), name="pull")],
        contacts=contacts if wall else contacts[:1],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}, increments=1),
            sg.Step(name="pull", scale={"pull": 1.0}, **step),
        ],
    )


@pytest.mark.parametrize(("increments", "reached"), [(3, 100 / 3), (4, 25.0), ("auto", 49.95)])
@pytest.mark.parametrize("space", [False, True])
def test_where_contact_is_iterated_what_it_cannot_hold_is_proved_first(space, increments, reached):
    model = block(pull=0.6, increments=increments) if space else square(pull=0.6, wall=False, increments=increments)
    if space:
        model = replace(model, contacts=model.contacts[:1])
    solution = sg.solve(model, backend="iterative", raise_on_failure=False)
    assert solution.status == "no_equilibrium"
    said = f"step 'pull': no equilibrium beyond 50%, up to {reached:.6g}% it was followed: body "
    assert solution.message.startswith(said)
    assert solution.steps[-1].load_factor == pytest.approx(1.0 + 0.01 * reached, abs=1e-6)
    way = solution.escape / np.abs(solution.escape).max()
    np.testing.assert_allclose(way - [[1.0, *([0.0] * (way.shape[1] - 2)), 0.3]], 0.0, atol=1e-6)


def test_in_the_plane_an_iterated_slide_is_named_where_nothing_is_behind_it():
    """Two increments find the block at the wall, four are lost there: it has slid before."""
    solution = sg.solve(square(pull=0.6, wall=True, increments=4), backend="iterative", raise_on_failure=False)
    assert solution.status == "jump"
    assert solution.message.startswith("step 'pull' at 50.000000%: gross sliding: body 'block' can move along x: no")


def test_that_the_load_which_contact_holds_is_not_known_is_told(monkeypatch):
    monkeypatch.setattr("signorini.friction.overload.MAX_ROUNDS", 0)
    notes = sg.solve(block(pull=0.28, increments=None)).steps[-1].notes
    spent = "all 0 linear programmes about the load that contact can hold that may be tried are spent"
    assert [note for note in notes if "programmes" in note] == [f"step 'pull': {spent}"]


@pytest.mark.slow
@pytest.mark.parametrize("increments", [None, 4, 10])
def test_a_joint_that_slides_until_its_bend_bears_is_told_once_from_wherever_increments_begin(increments):
    """By 0.2 mm; the load is one number, whichever pairs are near where the look begins."""
    model = deck.read(EXAMPLES / "bolted_bracket.toml")
    loads = tuple(replace(load, force=(1600.0, 0.0, 0.0)) if load.name == "cable" else load for load in model.loads)
    contacts = tuple(replace(contact, friction=0.12) for contact in model.contacts)
    steps = (model.steps[0], replace(model.steps[1], increments=increments))
    solution = sg.solve(replace(model, loads=loads, contacts=contacts, steps=steps))
    notes = [note for note in solution.steps[-1].notes if "gross sliding: body 'bracket' can move along x" in note]
    assert len(notes) == 1
    assert notes[0].startswith("step 'pull' at 75.005319%: ")


def shelf(*, friction, pull):
    """A cell that is clamped on its left, lies on a floor, and is pulled at its bottom."""
    x, y, z = (np.array([0.0, end]) for end in (1.0, 0.5, 0.5))
    return sg.Model(
        join({"top": box(x=x, y=y, z=z)}),
        bodies=[sg.Body("top", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top.left", u=(0.0, 0.0, 0.0))],
        loads=[
            sg.Load("top.bottom", force=(0.0, 0.0, -1.0), name="press"),
            sg.Load("top.bottom", force=pull, name="pull"),
        ],
        contacts=[sg.Contact("top.bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=friction, name="floor")],
        steps=[
            sg.Step(name="press", scale={"press": 1.0}, increments=1),
            sg.Step(name="pull", scale={"pull": 1.0}, increments="auto", jump="stop"),
        ],
    )


def lifted(part, number, **_):  # noqa: ARG001
    """A part of a step in one increment, sought where all pairs are open."""
    y = np.zeros((3, int(part.prepared.solver.active.sum())))
    y[0] = -1e3
    after, certificate, tried = advance(part.prepared, part.before, part.end, part.where, start=y)
    assert certificate.passed
    assert not after.forces.any()
    shot = Snapshot(number=part.interval.number, fraction=1.0, what="segment", state=after)
    return FollowedPart(
        path="increments",
        before=part.before,
        after=after,
        certificates=(certificate,),
        trace=(tried,),
        snapshots=(shot,),
    )


def test_where_two_equilibria_are_certified_at_one_load_the_history_is_said_to_part(monkeypatch):
    """The cell has lifted off in the one, and sticks in the other, up to 80 % of a pull of (1, 0, 1)."""
    monkeypatch.setattr(automatic, "follow_to_events", lifted)
    model = shelf(friction=4.0, pull=(0.79, 0.0, 0.79))
    solution = sg.solve(model, settings=sg.SolverSettings(automatic_increments=1), raise_on_failure=False)
    assert solution.status == "jump"
    said = (
        "step 'pull' between 0.000000% and 100.000000%: the history parts: from one equilibrium two ways lead to others"
    )
    assert solution.message.startswith(f"{said} whose contact forces differ by 0.79 of the largest")


@pytest.mark.parametrize("pull", [(3.0, 0.0, 0.0), (-2.0, 0.0, 1.0)])
def test_what_changes_in_proportion_to_the_load_is_no_jump(pull):
    """A few increments are too few, but no pair acts where forces change most: shorter ones resolve that."""
    model = shelf(friction=2.0, pull=pull)
    solution = sg.solve(model, settings=sg.SolverSettings(automatic_increments=4), raise_on_failure=False)
    assert solution.status == "not_found"
    assert solution.message.startswith("step 'pull': 4 increments still change ")


def test_few_increments_that_end_where_pairs_begin_to_slip_are_enough():
    """All stick, then slip, then open: with sixteen increments at most the history is that of many.

    Four are enough or refused as too few: rounding decides whether the way of one increment passes over the slip.
    """
    few, many = (
        sg.solve(shelf(friction=2.0, pull=(2.0, 0.0, 0.5)), settings=sg.SolverSettings(automatic_increments=most))
        for most in (16, 64)
    )
    assert few.last.dissipation == pytest.approx(many.last.dissipation, rel=1e-9)
    assert few.contact("floor").slip == pytest.approx(many.contact("floor").slip, rel=1e-9)
    assert few.last.dissipation > 0.0


def test_a_look_begins_with_the_whole_state_on_the_way(monkeypatch):
    """On the way bodies, and pairs far from contact, are not recovered; a look that begins there needs both."""
    model = shelf(friction=0.3, pull=(-2.0, 1.0, 1.5))
    ceiling = sg.Contact("top.top", sg.Plane((0, 0, 3), (0, 0, -1)), friction=0.3, name="ceiling")
    looked, follow = [], jump_watch.follow_to_events

    def seen(part, number, **way):
        looked.append((part.prepared.interface, part.before, part.interval.low))
        return follow(part, number, **way)

    monkeypatch.setattr(jump_watch, "follow_to_events", seen)
    sg.solve(
        replace(model, contacts=[*model.contacts, ceiling]),
        settings=sg.SolverSettings(automatic_increments=4),
        raise_on_failure=False,
    )
    (interface, state, low), *_ = looked
    assert 0.3 < low < 0.4
    moved = interface.B @ state.displacement
    np.testing.assert_allclose(state.gap, interface.gap + moved[: len(interface)], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(state.tangential.ravel(), moved[len(interface) :], rtol=0.0, atol=1e-12)


def test_where_contact_is_iterated_no_change_is_looked_into():
    """There are no events to follow it to, and what is told is that it does not settle."""
    model = shelf(friction=2.0, pull=(2.0, 0.0, 0.5))
    settings = sg.SolverSettings(automatic_increments=2)
    solution = sg.solve(model, backend="iterative", settings=settings, raise_on_failure=False)
    assert solution.status == "not_found"
    assert solution.message.startswith("step 'pull': 1 increment still changes the answer")
