# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that are left out, and one factorisation for many laws and loads."""

from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.engine import prepare as preparing
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit
from signorini.memory import available_memory


def pressures(history):
    return np.concatenate([contact.pressure for contact in history.last.contacts])


@pytest.mark.parametrize("friction", [0.0, 0.4])
@pytest.mark.parametrize("force", [156.0, 1.0])
def test_pairs_too_far_apart_change_nothing(friction, force):
    prepared = prepare(zhu_cylinder(friction=friction, refine=4, force=force))
    assert prepared.limited
    limited, everything = solve_prepared(prepared), solve_prepared(prepared.widened())
    np.testing.assert_allclose(pressures(limited), pressures(everything), rtol=0, atol=1e-9 * pressures(limited).max())
    gaps = [history.contact("foundation").gap for history in (limited, everything)]
    np.testing.assert_allclose(*gaps, rtol=0, atol=1e-12 * gaps[0].max())


def test_a_pair_left_out_that_meets_the_other_side_is_noticed(monkeypatch):
    """With a reach far too short the first pass penetrates; the second one, with all pairs, does not."""
    right = sg.solve(zhu_cylinder(refine=4))
    monkeypatch.setattr("signorini.engine.candidate_pairs._REACH", 0.3)
    prepared = prepare(zhu_cylinder(refine=4))
    assert prepared.paths.condensed.active.sum() < right.contact("foundation").closed.sum()
    found = solve_prepared(prepared)
    assert prepared.widened().paths.condensed.active.all()
    assert found.solved
    np.testing.assert_allclose(pressures(found), pressures(right), rtol=0, atol=1e-9 * pressures(right).max())


def test_many_laws_and_loads_cost_one_factorisation(monkeypatch):
    prepared = sg.prepare(zhu_cylinder())
    monkeypatch.setattr(preparing, "condense_bodies", None)  # a second factorisation would fail
    for friction in (0.0, 0.1, 0.4):
        for factor in (1.0, 0.5):
            found = prepared.solve(friction=friction, loads={"cut": factor})
            again = found.contact("foundation")
            assert again.normal_force[1] == pytest.approx(78.0 * factor, rel=1e-12)
            assert found.last.certificate.passed
            monkeypatch.undo()
            fresh = sg.solve(zhu_cylinder(friction=friction, force=156.0 * factor)).contact("foundation")
            np.testing.assert_allclose(again.pressure, fresh.pressure, rtol=0, atol=1e-9 * fresh.pressure.max())
            np.testing.assert_allclose(again.traction, fresh.traction, rtol=0, atol=1e-9 * fresh.pressure.max())
            monkeypatch.setattr(preparing, "condense_bodies", None)


def test_steps_that_reach_farther_are_factorised_once(monkeypatch):
    steps = [sg.Step(scale={"cut": factor}) for factor in (0.01, 1.0, 0.1)]
    prepared, fresh = sg.prepare(zhu_cylinder(refine=2, steps=steps)), sg.solve(zhu_cylinder(refine=2, steps=steps))
    first = prepared.solve()
    assert first.end.near.sum() > 2 * prepare(zhu_cylinder(refine=2, steps=steps)).candidates.sum()
    monkeypatch.setattr(preparing, "condense_bodies", None)
    again = prepared.solve()
    for one, two, three in zip(fresh.steps, first.steps, again.steps, strict=True):
        assert (one.displacement == two.displacement).all()
        assert (one.displacement == three.displacement).all()


def test_pressure_of_a_press_fit_is_linear_in_the_interference():
    prepared = sg.prepare(press_fit(interference=0.01))
    once = prepared.solve().contact("fit").pressure
    np.testing.assert_allclose(prepared.solve(interference=0.03).contact("fit").pressure, 3.0 * once, rtol=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"loads": {"cutt": 1.0}}, "loads: unknown load or moving support 'cutt'; did you mean 'cut'? Known: cut"),
        ({"friction": {"floor": 0.1}}, "friction: unknown contact 'floor'. Known: foundation"),
        ({"friction": -0.1}, "friction: is -0.1; expected a number >= 0"),
        ({"loads": {"cut": float("nan")}}, "loads.cut: is nan; expected a number"),
    ],
)
def test_wrong_changes_are_said(change, message):
    with pytest.raises(sg.InputError) as caught:
        sg.prepare(zhu_cylinder()).solve(**change)
    assert str(caught.value) == message


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the system does not tell")
def test_memory_that_a_limit_leaves_is_what_there_is():
    """``ulimit -v`` counts, as the machine's memory does."""
    import resource

    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    limits = resource.getrlimit(resource.RLIMIT_AS)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (used + 50_000_000, limits[1]))
        assert 0 < available_memory() <= 50_000_000
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
    assert available_memory() > 50_000_000
