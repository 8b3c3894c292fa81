# SPDX-License-Identifier: BSD-3-Clause
"""Sides that wear while they slide over many elements: what pairs of the moment rub off stays where it was worn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import signorini as sg
from signorini.engine import wear_steps
from signorini.gallery.sliding import driven_wheel
from signorini.gallery.wearing import FRICTION, block_in_space, fretting, rubbed_cylinder, to_and_fro

STEEL = sg.Elastic(E=200.0, nu=0.3)
WEAR = sg.Wear(1e-3, mortar=2e-3)


def block_on_bed(*, stroke: float = 0.2) -> sg.Model:
    """A block of length 1 that is pressed by 1 on a bed from -0.5 to 2 and driven along it."""
    top = sg.rectangle(x=np.linspace(0.0, 1.0, 4), y=np.linspace(0.0, 0.5, 3))
    bed = sg.rectangle(x=np.linspace(-0.5, 2.0, 10), y=np.linspace(-0.5, 0.0, 3))
    return sg.Model(
        mesh=sg.join({"top": top, "bed": bed}),
        kind="plane strain",
        bodies=[sg.Body("top", STEEL), sg.Body("bed", STEEL)],
        supports=[sg.Support("bed.bottom", u=(0.0, 0.0)), sg.Support("top.top", u=(stroke, None), name="drive")],
        loads=[sg.Load("top.top", force=(None, -1.0), spread="displacement", name="press")],
        contacts=[sg.Contact("top.bottom", "bed.top", friction=0.3, sliding="finite", wear=WEAR, name="sole")],
        steps=to_and_fro(1),
    )


@cache
def rubbed_block() -> sg.Solution:
    """The block in the plane, to and fro once."""
    return sg.solve(block_on_bed())


def hub_on_shaft() -> sg.Model:
    """A press fit that is pushed along its shaft."""
    shaft = sg.rectangle(x=np.linspace(0.0, 1.0, 3), y=np.linspace(-0.5, 1.5, 8))
    hub = sg.rectangle(x=np.linspace(1.0, 2.0, 3), y=np.linspace(0.0, 1.0, 4))
    fit = sg.Contact(
        "hub.left", "shaft.right", friction=0.2, sliding="finite", interference=0.002, wear=WEAR, name="fit"
    )
    return sg.Model(
        mesh=sg.join({"shaft": shaft, "hub": hub}),
        kind="axisymmetric",
        bodies=[sg.Body("shaft", STEEL), sg.Body("hub", STEEL)],
        supports=[sg.Support("shaft.bottom", u=(None, 0.0)), sg.Support("hub.bottom", u=(None, 0.2), name="push")],
        contacts=[fit],
        steps=[sg.Step(scale={"push": 0.0}), sg.Step(scale={"push": 1.0})],
    )


def rubbed(solution: sg.Solution, friction: float) -> float:
    """All that friction took over its coefficient: pressure times distance."""
    return float(sum(step.dissipation for step in solution.steps)) / friction


@pytest.mark.slow
@pytest.mark.parametrize(
    ("solved", "friction", "rounding"),
    [
        (rubbed_block, 0.3, 1e-12),
        (lambda: sg.solve(hub_on_shaft()), 0.2, 1e-4),
        (lambda: sg.solve(block_in_space(to_and_fro(1), wear=WEAR, stroke=0.05, modulus=200.0)), 0.3, 1e-4),
    ],
    ids=["plane", "axisymmetric", "space"],
)
def test_worn_volume_is_pressure_times_distance_of_both_sides(
    solved: Callable[[], sg.Solution], friction: float, rounding: float
) -> None:
    """To rounding, each side with its coefficient; a press fit is pressed in one increment, and in space increments
    are as short where pairs act as the energy balance wants."""
    solution = solved()
    wear, sides = solution.end.state.wear, solution.last.contacts[0].wear
    whole = wear.volume + wear.loose
    assert whole.sum() == pytest.approx(3e-3 * rubbed(solution, friction), rel=rounding)
    own, other = whole[~sides.on_mortar].sum(), whole[sides.on_mortar].sum()
    assert other == pytest.approx(2.0 * own, rel=1e-12)
    assert wear.depth.min() >= 0.0
    assert abs(solution.last.energy_defect) <= rounding * solution.last.work


@pytest.mark.slow
def test_the_bed_is_worn_where_the_block_has_been() -> None:
    """Beyond the reach of the block and its stroke nothing is worn."""
    wear = rubbed_block().last.contacts[0].wear
    x, depth = wear.points[wear.on_mortar, 0], wear.depths[wear.on_mortar]
    assert depth[(x > -0.2) & (x < 1.2)].min() > 0.0
    assert not depth[(x < -0.5) | (x > 1.5)].any()


def test_a_driven_wheel_with_creepage_wears_its_bed() -> None:
    """The bed loses k int p ds, to rounding, where the wheel slips on its way: nowhere as much as if it were locked."""
    model = driven_wheel(ratio=0.64, ways=(0.5, 0.25), across=4)
    worn = replace(model, contacts=[replace(model.contacts[0], wear=sg.Wear(1e-6))])
    solution = sg.solve(worn)
    wear = solution.end.state.wear
    whole = wear.volume.sum() + wear.loose.sum()
    assert whole == pytest.approx(1e-6 * rubbed(solution, 0.3), rel=1e-12)
    way = abs(worn.supports[0].u[0])
    assert 0.0 < wear.volume.sum() < 2e-3 * 1e-6 * 10.0 * way


@pytest.mark.slow
def test_sides_that_slid_and_wore_go_on_to_the_last_bit(tmp_path: Path) -> None:
    """From a file, in the step behind."""
    model = block_on_bed(stroke=0.1)
    steps = [model.steps[0], sg.Step(name="out", scale={"drive": 1.0}), sg.Step(name="back", scale={"drive": 0.0})]
    whole = sg.solve(replace(model, steps=steps))
    sg.solve(replace(model, steps=steps[:2])).save_state(tmp_path / "state.npz")
    rest = sg.solve(replace(model, steps=steps[2:]), start=tmp_path / "state.npz")
    assert np.array_equal(rest.end.state.wear.depth, whole.end.state.wear.depth)


@pytest.mark.slow
def test_cycles_go_through_the_strides_of_the_last_one() -> None:
    """As with all that is known of bodies, but for how far pairs have drifted; work of friction wears as Archard's."""
    archard, energy = sg.Wear(1.9e-6, mortar=2.9e-6), sg.Wear(energy=1.9e-6 / FRICTION, mortar=2.9e-6 / FRICTION)
    seen, unseen = (
        sg.solve(rubbed_cylinder(fretting(4, **way), wear=wear, spacing=0.1, stroke=0.02, sliding="finite"))
        for wear, way in ((archard, {"at": "events"}), (energy, {}))
    )
    one, two = (solution.end.state.wear for solution in (seen, unseen))
    assert [cycle.number for cycle in unseen.last.cycles] == [1, 2, 4]
    assert np.abs(two.depth - one.depth).max() < 2e-3 * one.depth.max()
    assert two.volume.sum() + two.loose.sum() == pytest.approx(4.8e-6 * rubbed(unseen, FRICTION), rel=1e-12)
    assert unseen.last.work == pytest.approx(seen.last.work, rel=1e-3)
    assert abs(unseen.last.energy_defect) < 1e-12 * unseen.last.work
    assert unseen.last.certificate.passed


@pytest.mark.slow
def test_cycles_of_a_hub_on_its_shaft_recur_and_go_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """An axisymmetric model: few cycles are followed with their bodies, and blocks of four are 2 % off or less."""
    hub, whole = hub_on_shaft(), list[int]()
    own = wear_steps.follow_sliding
    monkeypatch.setattr(wear_steps, "follow_sliding", lambda *given: whole.append(1) or own(*given))

    def worn(**way: object) -> tuple[sg.Solution, int]:
        fit = sg.Step(name="fit", scale={"push": 0.0})
        rub = sg.Step(name="rub", scale={"push": [1.0, 0.0]}, repeat=9, **way)  # type: ignore[arg-type]
        whole.clear()
        contact = replace(hub.contacts[0], wear=sg.Wear(1e-4, mortar=2e-4))
        return sg.solve(replace(hub, contacts=[contact], steps=[fit, rub])), len(whole)

    (every, few), (blocks, fewer) = worn(), worn(block=4)
    assert max(few, fewer) < 2 + 3 * 9 / 2  # the fit; of a cycle to, fro and the wear
    one, other = (solution.end.state.wear.depth for solution in (every, blocks))
    assert 0.0 < np.abs(one - other).max() < 0.02 * one.max()
    (note,) = (note for note in blocks.last.notes if note.startswith("sides wore in"))
    assert note.startswith("sides wore in 4 blocks of up to 4 cycles and in 0 single ones")
    fitted, rubs = blocks.steps
    wear = blocks.end.state.wear
    before = 3e-4 * fitted.dissipation / 0.2
    assert wear.volume.sum() + wear.loose.sum() - before == pytest.approx(3e-4 * rubs.dissipation / 0.2, rel=1e-5)
    assert abs(rubs.energy_defect) < 1e-12 * rubs.work


@pytest.mark.slow
def test_cycles_of_a_block_in_space_recur_and_go_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of four cycles three are followed with their bodies, which hardly strain: they lose k P s along all the way."""
    cycles, stroke, k, whole = 4, 0.05, 1e-6, list[int]()
    own = wear_steps.follow_sliding
    monkeypatch.setattr(wear_steps, "follow_sliding", lambda *given: whole.append(1) or own(*given))
    press = sg.Step(name="press", scale={"press": 1.0, "drive": 0.0})
    rub = sg.Step(name="rub", scale={"press": [1.0, 1.0], "drive": [1.0, 0.0]}, repeat=cycles, block=2)
    both = sg.Wear(k, mortar=2.0 * k)
    solution = sg.solve(block_in_space([press, rub], wear=both, stroke=stroke, modulus=2e5))
    assert len(whole) == 2 + 3 * 3
    wear, last = solution.end.state.wear, solution.last
    volume = float(wear.volume.sum() + wear.loose.sum())
    assert volume == pytest.approx(3.0 * k * 2.0 * stroke * cycles, rel=4e-4)
    assert volume == pytest.approx(3.0 * k * rubbed(solution, 0.3), rel=1e-4)
    assert abs(last.energy_defect) < 1e-9 * last.work
    assert last.certificate.passed
    assert any(note.startswith("sides wore in 2 blocks of up to 2 cycles") for note in last.notes)


def test_blocks_of_strides_that_do_not_recur_are_refused() -> None:
    rub = sg.Step(name="rub", scale={"press": [1.0, 1.0], "drive": [1.0, 0.0]}, repeat=4, block=2, at="events")
    with pytest.raises(sg.SolveFailed) as caught:
        sg.solve(replace(block_on_bed(), steps=[rub]))
    assert str(caught.value).startswith("step 'rub': blocks of cycles that slide far need strides that recur: no 'inc")


def test_given_increments_that_leave_much_of_the_work_are_refused() -> None:
    """One for a stride in which all pairs begin to slip."""
    with pytest.raises(sg.SolveFailed) as caught:
        sg.solve(replace(block_on_bed(stroke=0.1), steps=[replace(step, increments=1) for step in to_and_fro(1)]))
    words = "step 'rub': increments are too long where sides wear: "
    assert str(caught.value).startswith(words)
    assert "of the work is missing in the energy balance; expected more of them, or none given" in str(caught.value)


def test_sides_may_slide_by_strides_while_they_lose_what_has_rubbed() -> None:
    """Much of it at once, at constant loads: volume and energies are exact."""
    model = block_on_bed(stroke=0.05)
    worn = replace(model, contacts=[replace(model.contacts[0], wear=sg.Wear(0.1, mortar=0.2))])
    solution = sg.solve(worn)
    wear, last = solution.end.state.wear, solution.last
    assert (wear.volume + wear.loose).sum() == pytest.approx(0.3 * rubbed(solution, 0.3), rel=1e-12)
    assert last.energy_defect == pytest.approx(0.0, abs=1e-12 * last.work)
    assert last.released > 0.1 * last.work
    factors = [instant.load_factor for instant in last.instants]
    assert factors == sorted(factors)
