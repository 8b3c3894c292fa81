# SPDX-License-Identifier: BSD-3-Clause
"""Closed forms of bodies that yield, each beside integrals or increments that it does not come from."""

import numpy as np
import pytest
from scipy.integrate import quad, trapezoid

from signorini.reference.hertz import HertzLine
from signorini.reference.plasticity import (
    HillTube,
    YieldingBeam,
    first_yield_line,
    first_yield_point,
    punch_limit,
    rolling_shakedown_limit,
    yielding_press_fit_pressure,
)
from tests.helpers.cyclic_bar import CyclicBar

TUBE = HillTube(inner=1.0, outer=2.0, shear_strength=1.0)


@pytest.mark.parametrize(
    ("nu", "line", "point"), [(0.2, 1.6439, 1.4986), (0.25, 1.7250, None), (0.4, 1.8895, 1.7385), (0.5, 1.9227, None)]
)
def test_first_yield_under_hertz(nu, line, point):
    assert first_yield_line(nu)[0] == pytest.approx(line, abs=5e-5)
    if point:
        assert first_yield_point(nu)[0] == pytest.approx(point, abs=5e-5)


def test_the_point_of_first_yield_carries_the_largest_stress():
    unit = HertzLine(force=0.5 * np.pi, radius=1.0, modulus=2.0)
    assert (unit.half_width, unit.peak_pressure) == pytest.approx((1.0, 1.0))
    z = np.linspace(0.0, 3.0, 3001)
    along, down = unit.axis_stress(z)
    for nu in (0.0, 0.1, 0.3, 0.5):
        principal = np.array([along, down, nu * (along + down)])
        deviator = principal - principal.mean(axis=0)
        equivalent = np.sqrt(1.5 * (deviator**2).sum(axis=0))
        pressure, depth = first_yield_line(nu)
        assert pressure == pytest.approx(1.0 / equivalent.max(), rel=1e-6)
        assert depth == pytest.approx(z[equivalent.argmax()], abs=1e-3)


def test_johnsons_numbers():
    """p0 = 1.79 Y = 3.1 k, p0 = 1.60 Y (rounded as he does), 5.14 k, 4 k."""
    assert first_yield_line(0.3)[0] * np.sqrt(3.0) == pytest.approx(3.107, abs=1e-3)
    assert first_yield_point(0.3)[0] == pytest.approx(1.61, abs=5e-3)
    assert punch_limit(2.0) == pytest.approx(2.0 * 5.1416, rel=1e-5)


def test_rolling_shears_by_a_quarter_of_the_pressure():
    """tau_xz below Hertz's pressure, integrated over the line loads that it consists of."""

    def shear(x, z):
        kernel = lambda s: np.sqrt(1.0 - s * s) * (x - s) / ((x - s) ** 2 + z * z) ** 2  # noqa: E731
        return 2.0 * z * z / np.pi * quad(kernel, -1.0, 1.0)[0]

    largest = max(shear(x, z) for x in np.linspace(0.8, 0.95, 16) for z in np.linspace(0.4, 0.6, 11))
    assert rolling_shakedown_limit(1.0) == pytest.approx(1.0 / largest, rel=1e-4)


def test_hills_tube_is_in_equilibrium_and_yields_to_its_radius():
    r = np.linspace(1.0, 2.0, 20001)
    for pressure in (0.5, 0.8, 1.2, 1.38):
        radial, hoop = TUBE.stress(r, pressure)
        assert radial[[0, -1]] == pytest.approx([-pressure, 0.0], abs=1e-12)
        np.testing.assert_allclose(np.gradient(radial, r), (hoop - radial) / r, atol=2e-4)
        c = TUBE.plastic_radius(pressure)
        np.testing.assert_allclose((hoop - radial)[r < c], 2.0)
        assert ((hoop - radial)[r > c] < 2.0 + 1e-12).all()
        assert trapezoid(hoop, r) == pytest.approx(pressure, rel=1e-6)
        assert trapezoid(TUBE.residual_stress(r, pressure)[1], r) == pytest.approx(0.0, abs=1e-6)
    assert TUBE.plastic_radius(1.2) == pytest.approx(1.4240, abs=5e-5)
    assert TUBE.limit == pytest.approx(2.0 * np.log(2.0))
    assert TUBE.plastic_radius(TUBE.limit) == pytest.approx(2.0)
    with pytest.raises(ValueError, match="different signs"):
        TUBE.plastic_radius(1.01 * TUBE.limit)


@pytest.mark.parametrize("nu", [0.3, 0.4999])
def test_the_volume_of_hills_tube_changes_elastically(nu):
    """r u between both surfaces is the integral of r times the volume strain, which is elastic everywhere."""
    r = np.linspace(1.0, 2.0, 20001)
    for pressure in (0.5, 1.2):
        radial, hoop = TUBE.stress(r, pressure)
        change = trapezoid(r * (1.0 + nu) * (1.0 - 2.0 * nu) * (radial + hoop), r)
        outside = 2.0 * (1.0 - nu**2) * hoop[-1]  # u = r eps_t, elastic
        assert TUBE.expansion(pressure, (1.0, nu)) == pytest.approx(2.0 * outside - change, rel=1e-6)
    first = TUBE.first_yield
    assert TUBE.expansion(first * (1 + 1e-9), (1.0, nu)) == pytest.approx(TUBE.expansion(first, (1.0, nu)), rel=1e-8)


def test_press_fits_beyond_yield():
    """A shaft 1..2 in a hub 2..3; between first yield and limit the motions of both make up the interference."""
    hub = HillTube(inner=2.0, outer=3.0, shear_strength=1.0)
    given = {"bore": 1.0, "inner_body": (2000.0, 0.4999), "outer_body": (1000.0, 0.4999)}
    expected = {0.004: 0.6580, 0.0055: 0.7756, 0.0065: 0.8059, 0.007: 0.8107, 0.012: 0.8109}
    for interference, pressure in expected.items():
        found = yielding_press_fit_pressure(hub, interference=interference, **given)
        assert found == pytest.approx(pressure, abs=5e-5)
    elastic = yielding_press_fit_pressure(hub, interference=0.002, **given)
    assert elastic == pytest.approx(2.0 * yielding_press_fit_pressure(hub, interference=0.001, **given))
    assert elastic < hub.first_yield


@pytest.mark.parametrize("plane_strain", [False, True])
def test_moments_are_those_of_the_stress_over_the_height(plane_strain):
    beam = YieldingBeam(height=2.0, E=200.0, nu=0.5, yield_stress=3.0, plane_strain=plane_strain)
    y = np.linspace(-1.0, 1.0, 40001)
    for part in (0.5, 1.0, 1.5, 10.0, -3.0):
        curvature = part * beam.yield_curvature
        stress = np.clip(beam.modulus * curvature * y, -beam.strength, beam.strength)
        moment = beam.moment(curvature)
        assert moment == pytest.approx(trapezoid(stress * y, y), rel=1e-6)
        if abs(part) >= 1.0:
            assert beam.core(moment) == pytest.approx(1.0 / abs(part))
        left = stress - beam.modulus * moment / beam.first_yield * beam.yield_curvature * y  # springs back
        assert trapezoid(left * y, y) == pytest.approx(0.0, abs=1e-6)
    assert beam.limit == pytest.approx(1.5 * beam.first_yield)


@pytest.mark.parametrize("recall", [0.0, 25.0])
def test_bars_under_cycles_follow_their_rates(recall):
    """Many small steps of the law's rates, d sigma = E (d eps - s dp), with the stress kept at the yield stress."""
    bar = CyclicBar(E=200.0, yield_stress=1.0, hardening=50.0, recall=recall)
    turns = [0.05, -0.05, 0.002, 0.05]
    stress = back = p = last = 0.0
    for strain, (expected, accumulated) in zip(turns, bar.follow(turns), strict=True):
        count = 40000
        for _ in range(count):
            stress += bar.E * (strain - last) / count
            s = np.sign(stress - back)
            over = abs(stress - back) - bar.yield_stress
            if over > 0.0:
                flow = over / (bar.E + bar.hardening - s * recall * back)
                stress, back, p = stress - bar.E * s * flow, back + (bar.hardening * s - recall * back) * flow, p + flow
        last = strain
        assert (stress, p) == pytest.approx((expected, accumulated), rel=1e-4)


def test_a_bar_within_its_yield_stress_is_elastic():
    bar = CyclicBar(E=200.0, yield_stress=1.0, hardening=50.0, recall=25.0)
    assert bar.follow([0.004, -0.004]) == [(pytest.approx(0.8), 0.0), (pytest.approx(-0.8), 0.0)]
