# SPDX-License-Identifier: BSD-3-Clause
"""Sides that are bonded: torn off gradually and at once, in every kind of model, with their energy and certificate."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.engine.increments import measured
from signorini.engine.prepare import prepare
from signorini.gallery.cohesion import (
    ARM_HEIGHT,
    ARM_MODULUS,
    BAR_AREA,
    BAR_LENGTH,
    BAR_MODULUS,
    CRACK,
    bonded_bar,
    cantilever,
)
from signorini.reference.peeling import peel

STIFFNESS = BAR_MODULUS * BAR_AREA / BAR_LENGTH
GENTLE = sg.Cohesion(5.0, opening=0.02)  # its tension falls by 250 per length, that of the bar by 1000


def tension(step):
    """Of a bar, force per area, the same everywhere."""
    found = -step.contacts[0].pressure
    assert_allclose(found, found[0], atol=1e-12)
    return float(found[0])


@pytest.mark.parametrize("compliance", [0.0, 1e-3])
def test_a_bar_is_drawn_off_let_go_and_drawn_again_on_the_lines_of_its_bond(compliance):
    """Stretches, back and forth, with the tension and opening of bar, interface and bond in series by hand."""
    stretches = (0.004, 0.012, 0.003, 0.016, -0.002, 0.03, -0.001)
    steps = [sg.Step(scale={"pull": stretch}) for stretch in stretches]
    solution = sg.solve(bonded_bar(GENTLE, 1.0, compliance=compliance, steps=steps))
    soft, worst, taken = BAR_LENGTH / BAR_MODULUS + compliance, 0.0, 0.0
    for stretch, step in zip(stretches, solution.steps, strict=True):
        on_line = (stretch / soft - 5.0) / (1.0 / soft - 250.0)  # softening, where it is beyond the worst so far
        before, worst = worst, max(worst, min(on_line, 0.02))
        slope = 5.0 * (1.0 - worst / 0.02) / worst if worst else np.inf
        opening = max(stretch, 0.0) / (1.0 + soft * slope) if worst else 0.0
        expected = (stretch - opening) / soft
        assert tension(step) == pytest.approx(expected, abs=1e-12)
        assert_allclose(step.contacts[0].gap, opening + compliance * expected, atol=1e-15)
        assert_allclose(step.contacts[0].damage, worst / 0.02, atol=1e-12)
        assert step.dissipation == pytest.approx(BAR_AREA * 2.5 * (worst - before), abs=1e-14)
        assert step.released == 0.0
        assert abs(step.energy_defect) < 1e-14
        taken += step.work
    assert taken == pytest.approx(BAR_AREA * GENTLE.energy + 0.5 * BAR_AREA * 0.001**2 / soft, rel=1e-12)
    events = [(event.what, round(event.load_factor, 9)) for event in solution.steps[1].events]
    assert events == [("softens", round(1.0 + (5.0 * soft - 0.004) / 0.008, 9))]
    assert [event.what for event in solution.steps[5].events] == ["breaks"]


@pytest.mark.parametrize("kind", ["axisymmetric", "3d"])
def test_bonds_open_together_where_none_can_open_alone(kind):
    """Of few nodes one opens more than others in a motion that nothing resists, but these unload on a steeper line."""
    bond = sg.Cohesion(5.0, opening=0.02) if kind == "axisymmetric" else sg.Cohesion(5.0, opening=0.03)
    step = sg.solve(bonded_bar(bond, 0.012, kind=kind, compliance=1e-3)).steps[0]
    opening = (6.0 - 5.0) / (500.0 - 5.0 / bond.opening)
    assert_allclose(-step.contacts[0].pressure, (0.012 - opening) / 0.002, rtol=1e-12)
    assert step.released == 0.0


@pytest.mark.parametrize("opening", [0.0, 0.002])
def test_a_bond_that_is_stiffer_than_the_bar_lets_go_at_once(opening):
    bond = sg.Cohesion(5.0, opening=opening)
    step = sg.solve(bonded_bar(bond, 0.012, steps=[sg.Step()])).steps[0]
    stored = 0.5 * (5.0 * BAR_AREA) ** 2 / STIFFNESS
    assert step.work == pytest.approx(stored, rel=1e-12)
    assert step.dissipation == pytest.approx(BAR_AREA * bond.energy, rel=1e-12)
    assert step.released == pytest.approx(stored - BAR_AREA * bond.energy, rel=1e-12)
    assert {event.what for event in step.events} == {"softens", "breaks"}
    assert_allclose([event.load_factor for event in step.events], 5.0 / 12.0, rtol=1e-12)
    assert any("bonds that let go at once" in note for note in step.notes)
    assert [instant.what for instant in step.instants if instant.what == "landing"]


def test_a_history_may_end_where_bonds_let_go():
    with pytest.raises(sg.SolveFailed) as caught:
        sg.solve(bonded_bar(sg.Cohesion(5.0), 0.012, steps=[sg.Step(jump="stop")]))
    assert caught.value.status == "jump"
    assert "step 1 at 41.666667%: a jump: bonds let go at once" in str(caught.value)
    assert caught.value.solution.steps[0].load_factor == pytest.approx(5.0 / 12.0)


def test_a_load_that_the_bond_does_not_bear_has_no_equilibrium():
    model = replace(
        bonded_bar(GENTLE),
        supports=[sg.Support("left", u=(0, None))],
        loads=[sg.Load("top", traction=(0, 6.0), name="pull")],
    )
    with pytest.raises(sg.SolveFailed, match=r"step 1 at 83.333333%: a jump: bonds let go at once"):
        sg.solve(model)


@pytest.mark.slow
def test_an_arm_is_peeled_off_by_the_moment_of_beam_theory():
    """Once the bond softens along its whole length of softening the moment stays, M^2 = 2 E I G, as the crack grows."""
    bond = sg.Cohesion(2.5, opening=0.024, shear="free")
    limit = np.sqrt(2.0 * ARM_MODULUS * ARM_HEIGHT**3 / 12.0 * bond.energy)
    turns = (0.04, 0.06, 0.07, 0.08)
    steps = [sg.Step(scale={"peel": turn}) for turn in turns]
    first, *rest = sg.solve(cantilever(bond, rotation=1.0, steps=steps)).steps
    assert abs(first.rigid_bodies["grip"].moment) < 0.9 * limit
    for step in rest:
        assert abs(step.rigid_bodies["grip"].moment) == pytest.approx(limit, rel=5e-3)
        assert step.released == 0.0
        assert abs(step.energy_defect) < 1e-12 * step.work


def test_a_brittle_arm_lets_go_at_griffiths_load_in_first_order():
    bond, off = sg.Cohesion(3.0, shear="free"), []
    expected = peel(strength=3.0, compliance=0.02, crack=CRACK + 1.0, modulus=ARM_MODULUS, height=ARM_HEIGHT)
    for cells in (32, 64):
        step = sg.solve(cantilever(bond, lift=0.36, cells=cells, compliance=0.02)).steps[0]
        breaks = [event.load_factor for event in step.events if event.what == "breaks"]
        off.append(0.36 * breaks[cells // 16] / expected.lift - 1.0)
        assert abs(step.energy_defect) < 1e-12 * step.work
    assert off[1] == pytest.approx(0.5 * off[0], rel=0.05)
    assert 2.0 * off[1] == pytest.approx(off[0], abs=2e-3)


def test_a_certificate_asks_the_law_of_the_bond():
    model = bonded_bar(GENTLE, 0.012)
    prepared, state = prepare(model), sg.solve(model).end.state
    assert measured(prepared, state).passed
    worse = replace(state, bonds=replace(state.bonds, damage=state.bonds.damage + 1e-6))
    assert measured(prepared, worse).tension > 1e-8
    better = replace(state, bonds=replace(state.bonds, damage=state.bonds.damage * 0.0))
    assert measured(prepared, better).passed  # what the opening says counts
    cohesion = prepared.interface.cohesion
    stronger = replace(
        prepared, interface=replace(prepared.interface, cohesion=replace(cohesion, most=1.01 * cohesion.most))
    )
    assert measured(stronger, state).complementarity > 1e-8


def test_increments_are_ends_on_the_exact_path():
    step = sg.solve(bonded_bar(GENTLE, 0.012, steps=[sg.Step(increments=4)])).steps[0]
    whole = sg.solve(bonded_bar(GENTLE, 0.012)).steps[0]
    assert np.array_equal([i.load_factor for i in step.instants if i.what == "asked"], [0.25, 0.5, 0.75])
    assert tension(step) == pytest.approx(tension(whole), rel=1e-13)


def test_a_history_goes_on_from_a_file_and_not_with_another_bond(tmp_path):
    steps = [sg.Step(scale={"pull": stretch}) for stretch in (0.012, 0.004, 0.015)]
    whole = sg.solve(bonded_bar(GENTLE, 1.0, steps=steps))
    sg.solve(bonded_bar(GENTLE, 1.0, steps=steps[:2])).save_state(tmp_path / "start.npz")
    rest = sg.solve(bonded_bar(GENTLE, 1.0, steps=steps[2:]), start=tmp_path / "start.npz").steps[0]
    assert np.array_equal(rest.contacts[0].pressure, whole.steps[2].contacts[0].pressure)
    assert rest.dissipation == whole.steps[2].dissipation > 0.0
    with pytest.raises(sg.InputError, match=r"the opening of a bond 0.02"):
        sg.solve(bonded_bar(sg.Cohesion(5.0, opening=0.03), 1.0, steps=steps[2:]), start=tmp_path / "start.npz")


REFUSED = [
    ({"steps": [sg.Step(friction={"bond": 0.1})]}, "changes contacts of a model with bonds"),
]


@pytest.mark.parametrize("changed", [{"wear": sg.Wear(1e-6), "friction": 0.1}, {"sliding": "finite"}])
def test_a_bonded_side_neither_wears_nor_slides_far(changed):
    with pytest.raises(sg.InputError, match=r"^cohesion: is given, but the (contact wears|sides slide far)"):
        replace(bonded_bar(GENTLE).contacts[0], **changed)


@pytest.mark.parametrize(("changed", "told"), REFUSED)
def test_what_bonds_do_not_go_with(changed, told):
    with pytest.raises(sg.InputError, match=told):
        sg.solve(replace(bonded_bar(GENTLE, 0.001), **changed))


def test_bodies_as_they_are_have_no_exact_paths_and_modes_no_bonds():
    exactly = bonded_bar(GENTLE, 0.001, steps=[sg.Step(path="exact")])
    with pytest.raises(sg.InputError, match="an exact path needs the condensed interface"):
        sg.solve(exactly, backend="iterative")
    solution = sg.solve(bonded_bar(GENTLE, 0.001))
    with pytest.raises(sg.InputError, match="modes do not know bonds"):
        sg.natural_modes(solution, 1)


@pytest.mark.slow
def test_an_arm_is_peeled_off_a_base_that_does_not_match():
    """With forces along the sides too, much of the way by jumps, and all energy is there."""
    meshes = {
        "arm": sg.rectangle(x=np.linspace(0, 4, 17), y=[0, 0.5, 1]),
        "base": sg.rectangle(x=np.linspace(0, 4, 14), y=[-1, -0.5, 0]),
    }
    bond = sg.Cohesion(10.0, opening=0.006)
    model = sg.Model(
        sg.join(meshes),
        kind="plane stress",
        bodies=[sg.Body(name, sg.Elastic(E=1e4, nu=0.3), formulation="incompatible") for name in meshes],
        supports=[sg.Support("base.bottom", u=(0, 0)), sg.Support("arm.left", u=(None, 1.0), name="pull")],
        contacts=[sg.Contact("arm.bottom", "base.top", cohesion=bond, friction=0.3, name="bond")],
        steps=[sg.Step(scale={"pull": lift}) for lift in (0.01, 0.03, 0.005)],
    )
    begun, half, back = sg.solve(model).steps
    assert 0.0 < (begun.contacts[0].damage == 1.0).mean() < 1.0
    assert np.abs(begun.contacts[0].traction).max() > 0.1
    for step in (begun, half, back):
        assert abs(step.energy_defect) < 1e-14
        torn = float(step.contacts[0].area @ np.minimum(step.contacts[0].damage, 1.0))
    assert begun.dissipation + half.dissipation + back.dissipation == pytest.approx(bond.energy * torn, rel=1e-2)
    assert half.released > 0.0


def test_a_cube_is_torn_off_in_space():
    upper = sg.box(x=[0, 0.5, 1], y=[0, 0.5, 1], z=[0, 1])
    lower = sg.box(x=[0, 1 / 3, 2 / 3, 1], y=[0, 0.5, 1], z=[-0.5, 0])
    model = sg.Model(
        sg.join({"upper": upper, "lower": lower}),
        kind="3d",
        bodies=[sg.Body(name, sg.Elastic(E=1000.0, nu=0.3)) for name in ("upper", "lower")],
        supports=[sg.Support("lower.bottom", u=(0, 0, 0)), sg.Support("upper.top", u=(0, 0, 1.0), name="pull")],
        contacts=[sg.Contact("upper.bottom", "lower.top", cohesion=GENTLE, name="bond")],
        steps=[sg.Step(scale={"pull": stretch}) for stretch in (0.008, 0.03)],
    )
    held, gone = sg.solve(model).steps
    assert (held.contacts[0].pressure < 0.0).all()
    assert held.dissipation + gone.dissipation == pytest.approx(GENTLE.energy, rel=1e-12)
    assert abs(gone.energy_defect) < 1e-9


def lap(bond):
    """A block on a plane, drawn along it by its top."""
    return sg.Model(
        sg.rectangle(width=2.0, height=1.0, nx=4, ny=2),
        kind="plane stress",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.0))],
        supports=[sg.Support("top", u=(0.01, 0.0), name="slide")],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), cohesion=bond, friction=0.2)],
        steps=[sg.Step()],
    )


def test_forces_along_the_sides_break_bonds_that_let_go_at_once_and_end_other_histories():
    elastic = sg.solve(lap(sg.Cohesion(1e3))).steps[0].contacts[0]
    reached = 2.0 / np.abs(elastic.traction).max()
    step = sg.solve(lap(sg.Cohesion(1e3, shear_strength=2.0))).steps[0]
    assert (step.contacts[0].damage > 0).any()
    first = next(event for event in step.events if event.what == "breaks")
    assert first.load_factor == pytest.approx(reached, rel=1e-9)
    assert np.abs(step.contacts[0].traction[step.contacts[0].damage == 0.0]).max(initial=0.0) <= 2.0 + 1e-9
    assert abs(step.energy_defect) < 1e-14
    with pytest.raises(sg.SolveFailed, match="bears no more along the sides") as caught:
        sg.solve(lap(sg.Cohesion(1e3, opening=0.1, shear_strength=2.0)))
    assert caught.value.solution.steps[0].load_factor == pytest.approx(reached, rel=1e-9)


def test_a_deck_says_it_and_an_archive_keeps_it(tmp_path):
    model = replace(
        cantilever(sg.Cohesion.by_energy(10.0, energy=0.03, shear="free"), lift=0.05, cells=16), title="arm"
    )
    solution = sg.solve(model)
    solution.write(tmp_path / "arm.h5")
    again = sg.load(tmp_path / "arm.h5")
    assert again.model.contacts[0].cohesion == model.contacts[0].cohesion
    assert np.array_equal(again.steps[0].contacts[0].damage, solution.steps[0].contacts[0].damage)
    assert (again.steps[0].contacts[0].damage > 0.0).any()


def drawn_anyhow(seed):
    """A block on a plane or on another, bonded in a random way, drawn and pushed to and fro five times."""
    draw = np.random.default_rng(seed)
    cells, kind = int(draw.integers(2, 7)), str(draw.choice(["plane strain", "plane stress", "axisymmetric"]))
    upper = sg.rectangle(width=2.0, height=float(draw.choice([0.3, 1.0])), nx=cells, ny=2)
    modulus, opening = 10 ** draw.uniform(2, 4), float(draw.choice([0.0, 10 ** draw.uniform(-4, -1)]))
    two = draw.random() < 0.4
    bond = sg.Cohesion(5.0, opening=opening, shear=str(draw.choice(["held", "free"])))
    friction, compliance = float(draw.choice([0.0, 0.3, 1.0])), float(draw.choice([0.0, 1e-3]))
    mesh, part, other = upper, "", sg.Plane((0, 0), (0, 1))
    moduli, supports = {"block": modulus}, []
    if two:
        lower = sg.rectangle(width=2.0, height=0.5, nx=int(draw.integers(2, 7)), ny=2, origin=(0, -0.5))
        mesh, part, other = sg.join({"upper": upper, "lower": lower}), "upper.", "lower.top"
        moduli, supports = {"upper": modulus, "lower": 2.0 * modulus}, [sg.Support("lower.bottom", u=(0, 0))]
    side = (0, float(draw.uniform(-3, 3))) if kind == "axisymmetric" else (float(draw.uniform(-3, 3)), 0)
    size = 5.0 / modulus + opening + 5.0 * compliance
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body(name, sg.Elastic(E=E, nu=0.3)) for name, E in moduli.items()],
        supports=[*supports, sg.Support(f"{part}top", u=(0, size), name="pull")],
        loads=[sg.Load(f"{part}left", traction=side, name="side")],
        contacts=[
            sg.Contact(
                f"{part}bottom", other, cohesion=bond, friction=friction, normal_compliance=compliance, name="bond"
            )
        ],
        steps=[
            sg.Step(scale={"pull": float(draw.uniform(-0.5, 2.5)), "side": float(draw.uniform(-1, 1))})
            for _ in range(5)
        ],
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, 26, 45, 50])
def test_bonds_drawn_anyhow_are_followed_to_the_end(seed):
    """Of a hundred that were; these once were not. Energy is missing by rounding of the largest so far."""
    energy = 0.0
    for step in sg.solve(drawn_anyhow(seed)).steps:
        assert step.certificate.passed
        energy = max(energy, abs(step.work) + step.strain_energy + step.dissipation)
        assert abs(step.energy_defect) < 1e-10 * energy
