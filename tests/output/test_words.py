# SPDX-License-Identifier: BSD-3-Clause
"""What a user reads: data in a few words, and failures as one sentence, what to do, and evidence."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini import lcp
from signorini.cli.main import main
from signorini.gallery.cylinder import zhu_cylinder
from tests.helpers.block_deck import block_deck


def test_data_are_said_in_a_few_words():
    solution = sg.solve(zhu_cylinder())
    step, contact = solution.last, solution.contact("foundation")
    for data in (solution, solution.model, step, contact, solution.end, solution.stress("disk")):
        assert len(repr(data)) < 1500
    assert "pressure=array(11)" in repr(contact)
    assert "contacts=(foundation)" in repr(solution.model)


def test_the_answer_to_a_complementarity_problem_is_said_in_a_few_words():
    solution = lcp.solve(np.eye(500), -np.ones(500))
    assert len(repr(solution)) < 600
    assert "z=array(500)" in repr(solution)
    ray = lcp.solve(-np.eye(200), -np.ones(200), method="lemke")
    assert len(repr(ray)) < 1200


@pytest.fixture
def lifted() -> sg.Model:
    return sg.Model(
        sg.rectangle(width=1.0, height=1.0),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", traction=(0.0, 1.0))],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)))],
    )


def test_a_failure_is_one_sentence_what_to_do_and_evidence(lifted):
    with pytest.raises(sg.SolveFailed) as caught:
        sg.solve(lifted)
    sentence, remedy, evidence = str(caught.value).splitlines()
    assert sentence == caught.value.sentence
    assert "body 'block' can move along y: no equilibrium: the loads pull a body away" in sentence
    assert remedy == "  what to do: hold the body, or change the loads"
    assert evidence == "  evidence: nothing takes 1 of the load on the body"


def test_a_failure_is_printed_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """Also where steps were finished before it, whose table is printed."""
    deck = tmp_path / "lifted.toml"
    loads = {"name": "press", "pressure": 1.0}, {"name": "lift", "traction": [0.0, 1.0]}
    deck.write_text(block_deck(*loads, steps=({"scale": {"press": 1.0}}, {"scale": {"press": 0.0, "lift": 1.0}})))
    assert main(["run", str(deck), "-o", str(tmp_path / "out")]) == 3
    said = capsys.readouterr()
    assert "step 1" in said.out
    assert (said.out + said.err).count("the loads pull a body away") == 1
