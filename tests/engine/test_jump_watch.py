# SPDX-License-Identifier: BSD-3-Clause
"""Equal increments in space never step over a slide in silence."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini import deck
from signorini.engine.jump_watch import UNWATCHED
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


@pytest.mark.parametrize(("increments", "words"), [(1, "1 increment"), (3, "3 increments")])
def test_the_equilibrium_behind_a_slide_is_called_a_candidate(increments, words):
    solution = sg.solve(block(pull=0.6, increments=increments))
    assert solution.last.displacement[:, 0].min() > 0.49  # it stands at the wall
    notes = [note for note in solution.steps[-1].notes if note.startswith(SLIDES)]
    assert len(notes) == 1
    assert notes[0].endswith(f"; followed in {words} to what is a candidate")


@pytest.mark.parametrize("increments", [1, 3])
def test_a_step_that_stops_at_jumps_stops_at_the_slide(increments):
    solution = sg.solve(block(pull=0.6, increments=increments, jump="stop"), raise_on_failure=False)
    assert solution.status == "jump"
    assert solution.message.startswith(SLIDES)
    assert 1.4 < solution.steps[-1].load_factor <= 1.5


def test_where_no_increment_goes_on_the_slide_is_named():
    """At half the pull any place is in equilibrium, and none is found."""
    solution = sg.solve(block(pull=0.6, increments=10), raise_on_failure=False)
    assert solution.status == "jump"
    assert solution.message.startswith(SLIDES)


@pytest.mark.parametrize("increments", [1, 3, 10])
def test_what_friction_holds_says_nothing(increments):
    solution = sg.solve(block(pull=0.28, increments=increments))
    assert not [note for note in solution.steps[-1].notes if "gross sliding" in note]


def test_where_contact_is_iterated_a_note_says_that_slides_are_not_looked_for():
    said = [
        sg.solve(block(pull=0.28, increments=1), backend=backend).steps[-1].notes for backend in ("auto", "iterative")
    ]
    assert [notes.count(UNWATCHED) for notes in said] == [0, 1]


def test_that_the_load_which_contact_holds_is_not_known_is_told(monkeypatch):
    monkeypatch.setattr("signorini.friction.overload.MAX_ROUNDS", 0)
    notes = sg.solve(block(pull=0.28, increments=None)).steps[-1].notes
    spent = "all 0 linear programmes about the load that contact can hold that may be tried are spent"
    assert [note for note in notes if "programmes" in note] == [f"step 'pull': {spent}"]


@pytest.mark.slow
@pytest.mark.parametrize("increments", [4, 10])
def test_a_joint_that_slides_until_its_bend_bears_is_told_once_from_wherever_increments_begin(increments):
    """One increment after the other it slides between 75.006 and 75.009 % of the pull, by 0.2 mm."""
    model = deck.read(EXAMPLES / "bolted_bracket.toml")
    loads = tuple(replace(load, force=(1600.0, 0.0, 0.0)) if load.name == "cable" else load for load in model.loads)
    contacts = tuple(replace(contact, friction=0.12) for contact in model.contacts)
    steps = (model.steps[0], replace(model.steps[1], increments=increments))
    solution = sg.solve(replace(model, loads=loads, contacts=contacts, steps=steps))
    notes = [note for note in solution.steps[-1].notes if "gross sliding: body 'bracket' can move along x" in note]
    assert len(notes) == 1
    assert notes[0].startswith("step 'pull' at 75.0")
