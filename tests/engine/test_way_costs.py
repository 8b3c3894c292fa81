# SPDX-License-Identifier: BSD-3-Clause
"""Which way contact in space is solved where both fit: the cheaper one, told by sizes and by the past alone."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine import memory_check
from signorini.engine.way_costs import CONDENSED, Condensing, ContactWay, cheaper_way
from signorini.gallery.cubes import cubes

MEASURED = [
    # operations, rows, entries, increments, seconds condensed and iterated, as benchmarks/ways.py told them
    (2.04e09, 507, 823950, 1, 0.502, 0.423),  # cubes
    (1.11e10, 867, 1950304, 1, 1.26, 0.884),  # cubes
    (1.11e10, 867, 1950304, 4, 1.83, 1),  # cubes
    (1.18e10, 768, 1984374, 1, 1.5, 0.981),  # cubes, not matching
    (9.86e09, 675, 1998144, 1, 1.24, 0.628),  # 14
    (1.28e10, 2700, 1785000, 1, 3.29, 0.811),  # 29
    (1.11e10, 867, 1950304, 1, 1.1, 0.538),  # cubes without friction
    (5.43e09, 363, 2012210, 1, 0.683, 0.707),  # cubes, flat cells
    (5.56e10, 1452, 4451988, 1, 3.87, 1.91),  # cubes
    (5.16e10, 1200, 4195530, 1, 4.01, 2.03),  # cubes, not matching
    (5.3e10, 675, 7136910, 1, 4.45, 2.13),  # 14
    (1.52e11, 2700, 7160124, 1, 8.3, 2.98),  # 29
    (1.52e11, 2700, 7160124, 4, 10.5, 3.17),  # 29
    (1.77e11, 7500, 6264266, 1, 71.9, 2.35),  # 49
    (1.58e11, 2028, 7514196, 1, 7.78, 2.72),  # cubes
    (1.58e11, 2028, 7514196, 4, 9.9, 2.72),  # cubes
    (1.47e11, 1728, 7140922, 1, 8.27, 2.46),  # cubes, not matching
    (1.58e11, 2028, 7514196, 1, 7.78, 2.42),  # cubes without friction
    (5.77e10, 768, 6682716, 1, 3.92, 3.67),  # cubes, flat cells
    (8.29e10, 1083, 9631792, 1, 5.63, 5.89),  # block on a plate
]


def test_the_cheaper_way_is_chosen_in_19_of_20_measured_cases():
    """Or one that is as good to a tenth; and where it is not, it costs at most two and a half times the other."""
    lost = []
    for operations, rows, entries, increments, condensed, iterated in MEASURED:
        way = cheaper_way(Condensing(0.0, operations, rows), entries, increments)
        taken = iterated if way.worth else condensed
        lost.append(taken / min(condensed, iterated))
    assert np.mean(np.array(lost) <= 1.1) >= 0.95
    assert max(lost) < 2.5


def pressed(*numbers, scale=1.0, **how):
    """Cubes that are pressed further in every step, in some increments each."""
    model, last = cubes(3, 2), len(numbers)
    steps = [
        sg.Step(name=f"step {k}", increments=number, scale=dict.fromkeys(model.scaled_names, scale * k / last), **how)
        for k, number in enumerate(numbers, start=1)
    ]
    return replace(model, steps=steps)


def floating():
    """The upper cube is pressed by a force, and nothing else holds it."""
    model = cubes(3, 2)
    push = sg.Load("upper.top", force=(0.0, 0.0, -0.01), name="push")
    return replace(model, supports=model.supports[:1], loads=[push], steps=[sg.Step(increments=1)])


@pytest.fixture
def spared(monkeypatch):
    """Three increments are worth a factorisation, however small a model is."""
    asked = []

    def chosen(_, __, increments):
        asked.append(increments)
        return ContactWay(3.0) if increments < 3.0 else CONDENSED

    monkeypatch.setattr(memory_check, "cheaper_way", chosen)
    return asked


def test_a_step_of_few_increments_is_iterated_and_the_answer_is_the_same(spared):
    model = pressed(2)
    one, other = sg.solve(model), sg.solve(model, backend="multifrontal")
    assert (one.backend, other.backend, spared) == ("iterative", "multifrontal", [2.0])
    assert one.last.certificate.passed
    size = np.abs(other.last.displacement).max()
    np.testing.assert_allclose(one.last.displacement, other.last.displacement, rtol=0, atol=1e-9 * size)


def test_increments_add_up_and_a_history_that_is_cut_goes_the_same_way(spared):
    """Of steps of 1, 1 and 1 increments the last one is condensed, whether it follows in this run or in another."""
    whole = sg.solve(pressed(1, 1, 1))
    assert [step.trace[0][-1].method for step in whole.steps] == ["multipliers", "multipliers", "newton"]
    assert spared == [1.0, 3.0]
    begun = replace(pressed(1, 1, 1), steps=pressed(1, 1, 1).steps[:2])
    first = sg.solve(begun)
    assert (first.backend, first.end.increments) == ("iterative", 2.0)
    rest = sg.solve(replace(begun, steps=pressed(1, 1, 1).steps[2:]), start=first)
    assert (rest.backend, whole.backend) == ("multifrontal", "multifrontal")
    assert (rest.last.displacement == whole.last.displacement).all()
    assert rest.end.increments == whole.end.increments == np.inf


@pytest.mark.parametrize(
    "model",
    [
        pressed(3),
        pressed("auto"),
        pressed(None),
        pressed(1, at="events"),
        replace(pressed(1), contacts=[replace(pressed(1).contacts[0], facets=4)]),
        floating(),
    ],
    ids=["many", "auto", "to events", "at events", "facets", "floats"],
)
@pytest.mark.usefixtures("spared")
def test_what_needs_the_condensed_interface_has_it(model):
    assert sg.solve(model).backend == "multifrontal"


@pytest.mark.usefixtures("spared")
def test_what_is_solved_many_times_or_differentiated_is_condensed():
    model = pressed(1)
    assert sg.solve(model, tape=True).backend == "multifrontal"
    assert sg.solve(model, wellposed=True).backend == "multifrontal"
    assert sg.prepare(model).solve().backend == "multifrontal"


def test_what_iterations_do_not_settle_is_condensed_after_all(monkeypatch):
    """A budget of no iterations: nothing is lost but the time."""
    monkeypatch.setattr(memory_check, "cheaper_way", lambda *_: ContactWay(3.0, 0.0))
    model = pressed(2)
    found = sg.solve(model)
    assert (found.backend, found.end.increments) == ("multifrontal", np.inf)
    assert (found.last.displacement == sg.solve(model, backend="multifrontal").last.displacement).all()
