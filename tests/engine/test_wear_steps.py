# SPDX-License-Identifier: BSD-3-Clause
"""Sides that wear: what is worn, that nothing is factorised for it, that the energy balance closes, that runs go on."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import signorini as sg
from signorini.condense import condensed
from signorini.gallery.wearing import FORCE, FRICTION, WEAR, rubbed_cylinder, to_and_fro

COARSE, FAST = 0.02, sg.Wear(1.9e-6, mortar=2.9e-6)
"""Spacing of nodes, and wear a hundred times as fast."""


def worn_volume(solution):
    return solution.end.state.wear.volume.sum()


def pending(solution):
    """What the last redistribution of pressure has rubbed and not worn yet."""
    return (solution.end.state.wear.rubbed * solution.last.contacts[0].area).sum()


def test_worn_volume_is_pressure_times_distance_whatever_the_meshes():
    for ratio, coupling in ((1.0, "nodes"), (0.75, "mortar"), (1.25, "mortar")):
        solution = sg.solve(rubbed_cylinder(to_and_fro(3), wear=FAST, spacing=COARSE, ratio=ratio))
        assert solution.last.contacts[0].coupling == coupling
        rubbed = sum(step.dissipation for step in solution.steps) / FRICTION  # everything that slides is at mu p
        assert worn_volume(solution) + 4.8e-6 * pending(solution) == pytest.approx(4.8e-6 * rubbed, rel=1e-12)
        assert sum(cycle.worn for cycle in solution.last.cycles) == pytest.approx(worn_volume(solution), rel=1e-2)


def test_both_sides_widen_the_gap_by_what_they_have_lost():
    solution = sg.solve(rubbed_cylinder(to_and_fro(2), wear=FAST, spacing=COARSE, ratio=0.75))
    wear, gap = solution.end.state.wear, solution.end.state.point.gap
    unworn = sg.solve(rubbed_cylinder(to_and_fro(1), wear=None, spacing=COARSE, ratio=0.75)).end.state.point.gap
    n = len(gap)
    assert wear.depth.min() >= 0.0
    own = gap - unworn - wear.depth[:n]  # what is left is the flat's, as the pairs see it
    assert own @ solution.last.contacts[0].area == pytest.approx(wear.volume[n:].sum(), rel=1e-12)
    assert wear.volume[n:].sum() == pytest.approx(2.9 / 1.9 * wear.volume[:n].sum(), rel=1e-12)


def test_energy_law_is_archards_where_friction_is_constant():
    archard, energy = (
        sg.solve(rubbed_cylinder(to_and_fro(3), wear=wear, spacing=COARSE)).end.state.wear
        for wear in (FAST, sg.Wear(energy=1.9e-6 / FRICTION, mortar=2.9e-6 / FRICTION))
    )
    assert np.abs(energy.depth - archard.depth).max() < 1e-12 * archard.depth.max()


def test_nothing_is_factorised_for_what_is_worn(monkeypatch):
    made = []
    own = condensed.factorise
    monkeypatch.setattr(condensed, "factorise", lambda *given, **named: made.append(1) or own(*given, **named))
    sg.solve(rubbed_cylinder(to_and_fro(4), wear=FAST, spacing=COARSE))
    assert len(made) == 1


def test_work_of_the_loads_is_stored_dissipated_or_gone_with_what_is_worn():
    solution = sg.solve(rubbed_cylinder(to_and_fro(2, at="events"), wear=FAST, spacing=COARSE))
    press, rub = solution.steps
    cut = solution.model.mesh.nodes_of("pad.cut")[0]
    states = [(press.displacement[cut, 1], press.contacts[0], 0.0)]
    states += [(i.displacement[cut, 1], i.contacts[0], 0.0025 * i.factors["drive"]) for i in rub.instants]
    work = 0.0
    for (y, one, x), (y_next, two, x_next) in pairwise(states):
        friction = [(c.normal_force + c.tangential_force)[0] for c in (one, two)]
        work += -FORCE * (y_next - y) + 0.5 * sum(friction) * (x_next - x)
    assert rub.work == pytest.approx(work, rel=1e-9)
    assert abs(rub.energy_defect) < 1e-12 * rub.work
    assert rub.released == pytest.approx(solution.end.state.wear.energy)
    assert 0.0 < rub.released < 0.1 * rub.work


def test_a_history_that_is_cut_goes_on_to_the_last_bit(tmp_path):
    model = rubbed_cylinder([*to_and_fro(2), replace(to_and_fro(3)[1], name="on")], wear=FAST, spacing=COARSE)
    whole = sg.solve(model)
    begun = sg.solve(replace(model, steps=model.steps[:2]))
    begun.save_state(tmp_path / "state.npz")
    rest = sg.solve(replace(model, steps=model.steps[2:]), start=tmp_path / "state.npz")
    assert np.array_equal(rest.end.state.wear.depth, whole.end.state.wear.depth)
    assert np.array_equal(rest.last.contacts[0].pressure, whole.last.contacts[0].pressure)


def test_certificate_is_that_of_the_worn_gap():
    solution = sg.solve(rubbed_cylinder(to_and_fro(2), wear=FAST, spacing=COARSE))
    assert solution.last.certificate.passed
    assert worn_volume(solution) > 0.0
    fresh = sg.solve(rubbed_cylinder(to_and_fro(2), wear=WEAR, spacing=COARSE))
    assert fresh.last.contacts[0].pressure.max() > 1.05 * solution.last.contacts[0].pressure.max()
