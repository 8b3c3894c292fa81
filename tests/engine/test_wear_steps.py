# SPDX-License-Identifier: BSD-3-Clause
"""Sides that wear: what is worn, that nothing is factorised for it, that the energy balance closes, that runs go on."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import signorini as sg
from signorini.condense import condensed
from signorini.gallery.half_planes import equal_half_planes
from signorini.gallery.wearing import FORCE, FRICTION, WEAR, rubbed_cylinder, to_and_fro

COARSE, FAST = 0.02, sg.Wear(1.9e-6, mortar=2.9e-6)
"""Spacing of nodes, and wear a hundred times as fast."""


def worn_volume(solution):
    return solution.end.state.wear.volume.sum()


def pending(solution):
    """What the last redistribution of pressure has rubbed off and the depth does not know yet."""
    return solution.end.state.wear.loose.sum()


def test_worn_volume_is_pressure_times_distance_whatever_the_meshes():
    for ratio, coupling in ((1.0, "nodes"), (0.75, "mortar"), (1.25, "mortar")):
        solution = sg.solve(rubbed_cylinder(to_and_fro(3), wear=FAST, spacing=COARSE, ratio=ratio))
        assert solution.last.contacts[0].coupling == coupling
        rubbed = sum(step.dissipation for step in solution.steps) / FRICTION  # everything that slides is at mu p
        assert worn_volume(solution) + pending(solution) == pytest.approx(4.8e-6 * rubbed, rel=1e-12)
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


@pytest.mark.slow
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


def times_as_fast(factor):
    return sg.Wear(1.9e-8 * factor, mortar=2.9e-8 * factor)


@pytest.mark.slow
def test_cycles_that_nobody_looks_at_are_those_that_somebody_does():
    seen, unseen = (sg.solve(rubbed_cylinder(to_and_fro(8, at=at), wear=FAST, spacing=COARSE)) for at in ("events", ()))
    assert [cycle.number for cycle in unseen.last.cycles] == [1, 2, 5, 8]
    assert len(seen.last.cycles) == 8
    one, two = seen.end.state, unseen.end.state
    assert np.abs(one.wear.depth - two.wear.depth).max() < 1e-12 * one.wear.depth.max()
    assert two.work == pytest.approx(one.work, rel=1e-12)
    assert two.wear.energy == pytest.approx(one.wear.energy, rel=1e-12)
    assert abs(unseen.last.energy_defect) < 1e-12 * unseen.last.work


@pytest.mark.slow
def test_implicit_blocks_are_of_first_order():
    """Blocks of a cycle, of ten and of a hundred: with the numbers of cycles their errors grow alike."""
    model = {
        block: sg.solve(
            rubbed_cylinder(to_and_fro(201, block=block), wear=times_as_fast(4), spacing=0.025)
        ).end.state.wear
        for block in (1, 10, 20, 100)
    }
    exact = model[1].depth
    errors = {block: np.abs(wear.depth - exact).max() / exact.max() for block, wear in model.items()}
    assert all(wear.cycles == 202 for wear in model.values())  # the press is one
    assert errors[20] / errors[10] == pytest.approx(2.0 + 1.0 / 9.0, rel=0.1)  # less than that of a cycle: 19 / 9
    assert errors[100] / errors[10] == pytest.approx(11.0, rel=0.3)
    assert errors[100] < 0.03


@pytest.mark.slow
def test_implicit_blocks_are_stable_where_explicit_ones_oscillate():
    """As much wear in a cycle as in a thousand: explicit, pressures jump from node to node and do not flatten."""

    def roughness(**block):
        contact = sg.solve(
            rubbed_cylinder(to_and_fro(6, **block), wear=times_as_fast(3000), spacing=COARSE)
        ).last.contacts[0]
        p = contact.pressure[np.argsort(contact.points[:, 0])]
        return np.abs(np.diff(p, 2)).sum() / p.max(), p.max()

    (explicit, most), (implicit, least) = roughness(), roughness(block=1)
    assert explicit > 4.0 * implicit
    assert most > 2.0 * least


@pytest.mark.slow
def test_a_block_keeps_the_books_of_all_its_cycles():
    solution = sg.solve(rubbed_cylinder(to_and_fro(30, block=10), wear=FAST, spacing=COARSE))
    step, rubbed = solution.last, sum(step.dissipation for step in solution.steps) / FRICTION
    assert abs(step.energy_defect) < 1e-12 * step.work
    assert worn_volume(solution) + pending(solution) == pytest.approx(4.8e-6 * rubbed, rel=1e-12)
    assert solution.end.state.wear.distance.max() == pytest.approx(30 * step.cycles[-1].sliding, rel=0.05)
    assert [cycle.number for cycle in step.cycles] == [1, 2, 5, 10, 20, 30]


@pytest.mark.slow
def test_automatic_blocks_keep_to_their_tolerance():
    every, automatic = (
        sg.solve(rubbed_cylinder(to_and_fro(60, **way), wear=times_as_fast(20), spacing=COARSE)).end.state.wear
        for way in ({"block": 1}, {"block": "auto", "tolerance": 0.02})
    )
    assert np.abs(every.depth - automatic.depth).max() < 0.02 * every.depth.max()


def partial_slip(cycles, *, share, wear, **block):
    """Two equal cylinders to and fro below sliding, the middle of the contact sticks; cycles followed for them."""
    steps = [
        sg.Step(name="press", scale={"press": 1.0}),
        sg.Step(name="pull", scale={"pull": share}),
        sg.Step(name="cycles", scale={"pull": [-share, share]}, repeat=cycles, **block),
    ]
    model = equal_half_planes(steps[:2], spacing=0.2)
    contact = replace(model.contacts[0], wear=sg.Wear(wear, mortar=wear))
    solution = sg.solve(replace(model, steps=steps, contacts=[contact]))
    (note,) = (note for note in solution.last.notes if note.startswith("sides wore in"))
    return solution.end.state.wear.depth, int(re.search("for which ([0-9]+) cycles", note)[1])


@pytest.mark.slow
def test_blocks_of_partial_slip_settle_in_a_few_cycles():
    short, cost = partial_slip(21, share=0.9, wear=0.2, block=1)
    assert cost < 2.5 * 21
    long, few = partial_slip(21, share=0.9, wear=0.2, block=10)
    assert few < 21
    assert np.abs(long - short).max() < 0.05 * short.max()


@pytest.mark.slow
def test_where_no_block_is_found_cycles_go_by_themselves():
    """As much wear in a cycle as in tens of them: pairs at the edge of what sticks double their wear in each."""
    _, cost = partial_slip(30, share=0.7, wear=10.0, block=10)
    assert 30 < cost < 3 * 30


@pytest.mark.slow
def test_automatic_blocks_cost_no_more_than_every_cycle():
    _, cost = partial_slip(30, share=0.7, wear=10.0, block="auto")
    assert cost <= 1.1 * 30 + 20


@pytest.mark.slow
def test_a_block_in_space_wears_as_the_force_times_the_way():
    """Increments that end at events: dissipation is that of forces at their ends, what is worn that of their means."""
    mesh = sg.box(x=np.linspace(0.0, 1.0, 4), y=np.linspace(0.0, 1.0, 4), z=np.linspace(0.0, 0.5, 3))
    floor = sg.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    solution = sg.solve(
        sg.Model(
            mesh,
            bodies=[sg.Body("block", sg.Elastic(200e3, 0.3))],
            supports=[sg.Support("top", u=(0.01, 0.0, None), name="drive")],
            loads=[sg.Load("top", force=(None, None, -100.0), spread="displacement", name="press")],
            contacts=[sg.Contact("bottom", floor, friction=0.3, wear=sg.Wear(1e-6))],
            steps=to_and_fro(3),
        )
    )
    rubbed = sum(step.dissipation for step in solution.steps) / 0.3
    assert worn_volume(solution) + pending(solution) == pytest.approx(1e-6 * rubbed, rel=1e-5)
    assert worn_volume(solution) == pytest.approx(3 * 1e-6 * 100.0 * 0.04, rel=0.05)
