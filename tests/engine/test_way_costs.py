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
    (2.04e09, 507, 823950, 1, 0.787, 0.227),  # cubes
    (1.11e10, 867, 1950304, 1, 0.971, 0.492),  # cubes
    (1.11e10, 867, 1950304, 4, 2.93, 0.501),  # cubes
    (1.18e10, 768, 1984374, 1, 1.35, 0.678),  # cubes, not matching
    (9.86e09, 675, 1998144, 1, 1, 0.459),  # 14
    (1.28e10, 2700, 1785000, 1, 2.78, 0.406),  # 29
    (1.11e10, 867, 1950304, 1, 1.05, 0.345),  # cubes without friction
    (5.43e09, 363, 2012210, 1, 0.847, 0.639),  # cubes, flat cells
    (5.56e10, 1452, 4451988, 1, 3.68, 1.35),  # cubes
    (5.16e10, 1200, 4195530, 1, 3.74, 1.45),  # cubes, not matching
    (5.3e10, 675, 7136910, 1, 4.25, 1.44),  # 14
    (1.52e11, 2700, 7160124, 1, 8.22, 1.92),  # 29
    (1.52e11, 2700, 7160124, 4, 10.2, 2.17),  # 29
    (1.77e11, 7500, 6264266, 1, 67.7, 2.17),  # 49
    (1.58e11, 2028, 7514196, 1, 9.36, 2.24),  # cubes
    (1.58e11, 2028, 7514196, 4, 10.4, 2.65),  # cubes
    (1.47e11, 1728, 7140922, 1, 7.65, 1.89),  # cubes, not matching
    (1.58e11, 2028, 7514196, 1, 9.18, 1.53),  # cubes without friction
    (5.77e10, 768, 6682716, 1, 4.35, 2.52),  # cubes, flat cells
    (8.29e10, 1083, 9631792, 1, 6.98, 2.94),  # block on a plate
    (1.91e08, 108, 334837, 1, 0.0862, 0.253),  # block on a plate
    (1.91e08, 108, 334837, 4, 0.143, 0.283),  # block on a plate
    (9.26e07, 192, 159750, 1, 0.0501, 0.0835),  # cubes
    (9.26e07, 192, 159750, 4, 0.0884, 0.104),  # cubes
    (9.26e07, 192, 159750, 20, 0.265, 0.259),  # cubes
    (9.26e07, 192, 159750, 1, 0.0579, 0.0792),  # cubes without friction
    (9.26e07, 192, 159750, 4, 0.0912, 0.0788),  # cubes without friction
    (4.38e07, 75, 133962, 1, 0.0408, 0.118),  # cubes, flat cells
    (4.38e07, 75, 133962, 4, 0.101, 0.194),  # cubes, flat cells
    (1.16e08, 147, 170620, 1, 0.0616, 0.108),  # cubes, not matching
    (1.16e08, 147, 170620, 4, 0.129, 0.151),  # cubes, not matching
    (2.22e08, 675, 228058, 1, 0.148, 0.0694),  # 14
    (2.22e08, 675, 228058, 4, 0.494, 0.115),  # 14
    (5.28e08, 192, 631469, 4, 0.25, 0.215),  # block on a plate
    (3.91e08, 300, 343718, 1, 0.0946, 0.221),  # cubes
    (3.91e08, 300, 343718, 4, 0.226, 0.254),  # cubes
    (3.91e08, 300, 343718, 20, 0.705, 0.923),  # cubes
    (3.91e08, 300, 343718, 1, 0.0958, 0.0961),  # cubes without friction
    (3.91e08, 300, 343718, 4, 0.0975, 0.111),  # cubes without friction
    (1.25e08, 108, 259794, 1, 0.0412, 0.0994),  # cubes, flat cells
    (1.25e08, 108, 259794, 4, 0.0709, 0.131),  # cubes, flat cells
    (1.25e08, 108, 259794, 20, 0.36, 0.37),  # cubes, flat cells
    (4.36e08, 243, 356854, 1, 0.118, 0.187),  # cubes, not matching
    (4.36e08, 243, 356854, 4, 0.158, 0.19),  # cubes, not matching
    (1.74e09, 675, 718720, 1, 0.399, 0.185),  # 14
    (1.74e09, 675, 718720, 4, 0.828, 0.242),  # 14
    (1.23e09, 300, 1051237, 1, 0.363, 0.351),  # block on a plate
    (1.23e09, 300, 1051237, 4, 0.614, 0.64),  # block on a plate
    (1.23e09, 300, 1051237, 20, 1.1, 1.11),  # block on a plate
    (2.04e09, 507, 823950, 1, 0.379, 0.218),  # cubes
    (2.04e09, 507, 823950, 4, 0.489, 0.272),  # cubes
    (2.04e09, 507, 823950, 20, 2.44, 0.877),  # cubes
    (2.04e09, 507, 823950, 1, 0.467, 0.294),  # cubes without friction
    (2.04e09, 507, 823950, 4, 0.648, 0.399),  # cubes without friction
    (7.66e08, 192, 696684, 1, 0.167, 0.295),  # cubes, flat cells
    (7.66e08, 192, 696684, 4, 0.287, 0.351),  # cubes, flat cells
    (7.66e08, 192, 696684, 20, 0.87, 0.583),  # cubes, flat cells
    (1.61e09, 432, 727384, 1, 0.514, 0.376),  # cubes, not matching
    (1.61e09, 432, 727384, 4, 0.586, 0.356),  # cubes, not matching
    (1.61e09, 432, 727384, 20, 1.67, 0.929),  # cubes, not matching
    (5.07e09, 675, 1307982, 1, 0.766, 0.368),  # 14
    (5.07e09, 675, 1307982, 4, 1.04, 0.466),  # 14
    (5.04e09, 2700, 961216, 1, 5.01, 0.366),  # 29
    (5.04e09, 2700, 961216, 4, 5.66, 0.275),  # 29
    (4.58e09, 432, 2132380, 1, 0.693, 0.562),  # block on a plate
    (4.58e09, 432, 2132380, 4, 0.795, 0.735),  # block on a plate
    (5.07e09, 675, 1307982, 1, 0.846, 0.323),  # cubes
    (5.07e09, 675, 1307982, 4, 0.938, 0.451),  # cubes
    (5.07e09, 675, 1307982, 1, 0.566, 0.243),  # cubes without friction
    (5.07e09, 675, 1307982, 4, 0.825, 0.331),  # cubes without friction
    (1.57e09, 243, 1032758, 1, 0.379, 0.323),  # cubes, flat cells
    (1.57e09, 243, 1032758, 4, 0.387, 0.323),  # cubes, flat cells
    (5.47e09, 588, 1327076, 1, 0.842, 0.486),  # cubes, not matching
    (5.47e09, 588, 1327076, 4, 1.03, 0.456),  # cubes, not matching
    (9.86e09, 675, 1998144, 1, 0.854, 0.354),  # 14
    (9.86e09, 675, 1998144, 4, 1.29, 0.426),  # 14
    (9.86e09, 675, 1998144, 20, 2.32, 1.14),  # 14
    (1.28e10, 2700, 1785000, 1, 3.19, 0.47),  # 29
    (1.28e10, 2700, 1785000, 4, 3.87, 0.453),  # 29
    (8.74e09, 588, 3006090, 1, 1, 0.794),  # block on a plate
    (8.74e09, 588, 3006090, 4, 1.21, 0.965),  # block on a plate
    (8.74e09, 588, 3006090, 20, 2.7, 1.88),  # block on a plate
    (1.11e10, 867, 1950304, 1, 0.97, 0.367),  # cubes
    (1.11e10, 867, 1950304, 4, 1.26, 0.485),  # cubes
    (1.11e10, 867, 1950304, 20, 3.08, 1.31),  # cubes
    (1.11e10, 867, 1950304, 1, 1.1, 0.333),  # cubes without friction
    (1.11e10, 867, 1950304, 4, 1.18, 0.388),  # cubes without friction
    (5.43e09, 363, 2012210, 1, 0.903, 0.704),  # cubes, flat cells
    (5.43e09, 363, 2012210, 4, 1.01, 0.898),  # cubes, flat cells
    (1.18e10, 768, 1984374, 1, 1.15, 0.587),  # cubes, not matching
    (1.18e10, 768, 1984374, 4, 1.21, 0.704),  # cubes, not matching
    (1.18e10, 768, 1984374, 20, 3.57, 1.62),  # cubes, not matching
    (2.93e10, 768, 5633045, 1, 2.91, 1.6),  # block on a plate
    (5.56e10, 1452, 4451988, 1, 4.27, 1.39),  # cubes
    (5.56e10, 1452, 4451988, 4, 5.17, 1.25),  # cubes
    (2.55e10, 588, 4381464, 1, 2.15, 1.25),  # cubes, flat cells
    (5.16e10, 1200, 4195530, 1, 4.1, 1.22),  # cubes, not matching
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
