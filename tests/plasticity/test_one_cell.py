# SPDX-License-Identifier: BSD-3-Clause
"""One cell whose strains are homogeneous, beside closed forms: pulled, squeezed, sheared, in cycles."""

import numpy as np
import pytest

import signorini as sg
from tests.helpers.cyclic_bar import CyclicBar
from tests.helpers.yielding import LAWS, pulled, sheared

E, NU = 200.0, 0.3
G, K = E / 2.6, E / 1.2  # shear and bulk modulus
ONCE = [sg.Step(increments=1)]


def stress_of(solution, name="pull"):
    """Force on the moved side of area 1 (the ring 0 .. 1: pi) along the last axis."""
    area = np.pi if solution.model.kind == "axisymmetric" else 1.0
    return float(solution.last.reactions[name][-1]) / area


def uniaxial(law, strain):
    """Stress of a bar under a strain that has grown from 0, law by law."""

    def strain_of(p):
        stress = law.at(np.array(p))[0] + sum(C for C, _ in law.backstresses) * p
        return stress / E + p, stress

    low, high = 0.0, strain
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if strain_of(middle)[0] < strain else (low, middle)
    return float(strain_of(low)[1])


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("kind", ["axisymmetric", "space"])
def test_a_bar_follows_its_curve_in_one_increment(kind, law):
    solution = sg.solve(pulled(kind, LAWS[law], along=0.03, steps=ONCE))
    assert stress_of(solution) == pytest.approx(uniaxial(LAWS[law], 0.03), rel=1e-8)
    plastic = solution.end.state.plastic
    assert plastic.equivalent == pytest.approx(0.03 - stress_of(solution) / E, rel=1e-8)


@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric", "space"])
def test_a_block_held_on_all_sides_carries_any_pressure(kind):
    """``sigma = K eps - 2/3 Y`` beyond ``eps = Y / 2G``."""
    solution = sg.solve(pulled(kind, LAWS["perfect"], sides="held", along=-0.04, steps=ONCE))
    assert stress_of(solution) == pytest.approx(-K * 0.04 - 2.0 / 3.0, rel=1e-9)
    assert solution.end.state.plastic.equivalent == pytest.approx(2.0 / 3.0 * (0.04 - 1.0 / (2.0 * G)), rel=1e-9)


@pytest.mark.parametrize("kind", ["plane strain", "space"])
@pytest.mark.parametrize("law", ["perfect", "linear", "prager"])
def test_simple_shear(kind, law):
    """``tau = (k + H g / 3) / (1 + H / 3G)``, isotropic or kinematic alike."""
    H = {"perfect": 0.0, "linear": 20.0, "prager": 50.0}[law]
    angle = 0.03
    solution = sg.solve(sheared(kind, LAWS[law], angle, ONCE))
    expected = (1.0 / np.sqrt(3.0) + H * angle / 3.0) / (1.0 + H / (3.0 * G))
    assert float(solution.last.reactions["shear"][0]) == pytest.approx(expected, rel=1e-9)


def cycle(law, number, kind="axisymmetric"):
    """Stresses where the strain turns, in increments."""
    scales = (1.0, -1.0, 0.5)
    steps = [sg.Step(scale={"pull": scale}, increments=number) for scale in scales]
    solution = sg.solve(pulled(kind, law, along=0.05, steps=steps))
    assert solution.solved
    assert all(step.certificate.passed for step in solution.steps)
    return np.array([float(step.reactions["pull"][-1]) for step in solution.steps]) / np.pi


@pytest.mark.slow
def test_armstrong_fredericks_bar_under_cycles_with_an_error_of_first_order():
    bar = CyclicBar(E=E, yield_stress=1.0, hardening=50.0, recall=25.0)
    exact = np.array([stress for stress, _ in bar.follow([0.05, -0.05, 0.025])])
    law = sg.Plastic(1.0, backstresses=[(50.0, 25.0)])
    errors = np.array([np.abs(cycle(law, number) / exact - 1.0) for number in (8, 16)])
    assert (errors[-1] < 0.04).all()
    np.testing.assert_allclose(errors[1:] / errors[:-1], 0.5, atol=0.08)


def test_pragers_bar_under_cycles_is_exact_in_any_increments():
    bar = CyclicBar(E=E, yield_stress=1.0, hardening=50.0, recall=0.0)
    exact = [stress for stress, _ in bar.follow([0.05, -0.05, 0.025])]
    np.testing.assert_allclose(cycle(LAWS["prager"], 1), exact, rtol=1e-8)


def test_where_nothing_flows_back_a_cycle_is_elastic():
    """Unloading and loading again below twice the yield stress: the path of the stress is a straight line."""
    steps = [sg.Step(scale={"pull": scale}) for scale in (1.0, 0.97, 1.0)]
    solution = sg.solve(pulled("axisymmetric", LAWS["linear"], along=0.03, steps=steps))
    loaded, less, again = (float(step.reactions["pull"][-1]) / np.pi for step in solution.steps)
    assert loaded - less == pytest.approx(E * 0.03 * 0.03, rel=1e-8)
    assert again == pytest.approx(loaded, rel=1e-9)
    assert [step.path for step in solution.steps[1:]] == ["exact", "exact"]


@pytest.mark.parametrize("law", LAWS)
def test_work_is_what_is_stored_and_dissipated(law):
    """A ring pulled, pushed and let go: the balance closes to rounding in any increments."""
    steps = [sg.Step(scale={"pull": scale}, increments=3) for scale in (1.0, -1.0, 0.0)]
    solution = sg.solve(pulled("axisymmetric", LAWS[law], along=0.02, steps=steps))
    work, spent = (step.work for step in solution.steps), solution.end.state.plastic.dissipation
    assert sum(work) == pytest.approx(solution.last.strain_energy + spent, rel=1e-9)
    assert max(abs(step.energy_defect) for step in solution.steps) < 1e-9 * spent
    assert solution.last.strain_energy == pytest.approx(np.pi * stress_of(solution) ** 2 / (2.0 * E), rel=1e-8)


@pytest.mark.parametrize(("law", "H"), [("perfect", 0.0), ("linear", 20.0), ("prager", 50.0), ("both", 80.0)])
def test_plastic_work_is_the_area_below_the_curve(law, H):
    solution = sg.solve(pulled("space", LAWS[law], along=0.03, steps=[sg.Step(increments=2)]))
    plastic = solution.end.state.plastic
    p = plastic.equivalent[0]
    assert plastic.dissipation == pytest.approx(p + 0.5 * H * p**2, rel=1e-8)


@pytest.mark.parametrize(("along", "told"), [(0.04, False), (0.07, True)])
def test_a_note_says_where_strains_are_no_longer_small(along, told):
    notes = sg.solve(pulled("axisymmetric", LAWS["linear"], along=along, steps=ONCE)).last.notes
    assert any("its law is one of small strains, which holds to about 5%" in note for note in notes) == told
