# SPDX-License-Identifier: BSD-3-Clause
"""Endings in one vocabulary: words that files hold, with their advice."""

import json

import pytest

import signorini as sg
from signorini.errors import SolveFailed
from signorini.gallery.cylinder import zhu_cylinder
from signorini.outcome import Outcome


def test_words_are_those_of_files():
    assert json.dumps([*Outcome]) == (
        '["solved", "followed", "no_equilibrium", "not_found", "jump", "disturbed", "interrupted", "running"]'
    )
    assert all(ending.advice.endswith(".") for ending in Outcome)


def test_histories_and_failures_know_their_advice(tmp_path):
    solution = sg.solve(zhu_cylinder())
    solution.write(tmp_path / "solved.h5")
    assert sg.load(tmp_path / "solved.h5").status.advice == solution.status.advice == Outcome.SOLVED.advice
    assert "lower the friction" in SolveFailed("slides", status="jump").status.advice
    with pytest.raises(ValueError, match="lost"):
        SolveFailed("nobody knows this ending", status="lost")
