# SPDX-License-Identifier: BSD-3-Clause
"""Limits of the methods: reached by everyone, from Python and from decks, and every one of them felt."""

from pathlib import Path

import pytest

import signorini as sg
from signorini.deck import DeckError, load_deck
from signorini.gallery.cylinder import zhu_cylinder
from signorini.iterative import solve

DECK = Path(__file__).parents[1] / "examples" / "zhu_cylinder.toml"


def deck(folder, table):
    path = folder / "deck.toml"
    path.write_text(f"{DECK.read_text()}\n[solver]\n{table}\n", encoding="utf-8")
    return path


def test_defaults_change_nothing():
    plain, given = (
        sg.solve(zhu_cylinder(), **more).contact("foundation") for more in ({}, {"settings": sg.SolverSettings()})
    )
    assert (plain.pressure == given.pressure).all()


def test_a_limit_of_newtons_method_is_felt():
    model = zhu_cylinder(refine=2, steps=[sg.Step(increments=1)])
    (free,), (bound,) = (
        sg.solve(model, settings=sg.SolverSettings(newton_steps=steps)).last.trace for steps in (200, 1)
    )
    assert [run.method for run in free] == ["newton"]
    assert [run.iterations for run in bound if run.method == "newton"] == [1]
    assert bound[-1].method.startswith("path")


def test_a_limit_of_multipliers_is_felt(monkeypatch):
    monkeypatch.setattr(solve, "newton_on_all", lambda _: None)  # without it few rounds are needed
    model, few = zhu_cylinder(), sg.SolverSettings(multiplier_rounds=2)
    assert sg.prepare(model, backend="iterative").solve().solved
    with pytest.raises(sg.SolveFailed, match="multipliers did not settle"):
        sg.prepare(model, backend="iterative", settings=few).solve()


def test_a_deck_says_them(tmp_path):
    found = load_deck(deck(tmp_path, "newton_steps = 40\npivots_per_pair = [5]")).settings
    assert found == sg.SolverSettings(newton_steps=40, pivots_per_pair=(5,))
    assert load_deck(DECK).settings == sg.SolverSettings()


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("newton_step = 3", "solver.newton_step: unknown key; did you mean 'newton_steps'?"),
        ("tolerance = 1e-3", "solver.tolerance: is 0.001; expected at most 1e-08"),
        ("tree_pairs = -1", "solver.tree_pairs: is -1; expected a whole number >= 0"),
        ("springs = [1e-3, 0]", "solver.springs[1]: is 0; expected a number > 0"),
        ("pivots_per_pair = 10", "solver.pivots_per_pair: is 10; expected a list of numbers"),
    ],
)
def test_wrong_limits_are_named_with_their_line(tmp_path, table, words):
    path = deck(tmp_path, table)
    line = path.read_text(encoding="utf-8").splitlines().index(table) + 1
    with pytest.raises(DeckError) as caught:
        load_deck(path)
    assert str(caught.value).startswith(f"{path}:{line}: {words}")
