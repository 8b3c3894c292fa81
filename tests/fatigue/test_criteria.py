# SPDX-License-Identifier: BSD-3-Clause
"""Criteria against closed forms, against dense sampling of random histories, and the constants that they refuse."""

import itertools

import numpy as np
import pytest

import signorini as sg
from signorini.fatigue.ball import smallest_ball
from signorini.fatigue.damage import cycles_to_failure, damage

E, NU = 200e3, 0.3
G = E / (2.0 * (1.0 + NU))
YIELD, K = 350.0, 0.8


def strains(stress):
    """Strains of an isotropic body, as tensors."""
    found = (1.0 + NU) / E * stress
    found[..., :3] -= NU / E * stress[..., :3].sum(axis=-1, keepdims=True)
    return found


def of(criterion, *times):
    """The one point of a history; ``times`` are stresses."""
    stress = np.array([times], float)
    return damage(criterion, stress, strains(stress))


def pulled(*sizes):
    return [(size, 0, 0, 0, 0, 0) for size in sizes]


def sheared(*sizes):
    return [(0, 0, 0, size, 0, 0) for size in sizes]


FATEMI_SOCIE = sg.fatigue.FatemiSocie(yield_stress=YIELD, sensitivity=K)
CROSSLAND = sg.fatigue.Crossland(bending_limit=300.0, torsion_limit=190.0)
DANG_VAN = sg.fatigue.DangVan(bending_limit=300.0, torsion_limit=190.0)


def test_smith_watson_topper_of_a_bar():
    found = of(sg.fatigue.SWT(), *pulled(250.0, -50.0))
    assert found.parameter[0] == pytest.approx(250.0 * 150.0 / E, rel=1e-14)
    np.testing.assert_allclose(found.plane[0], [1, 0, 0], atol=1e-7)
    assert of(sg.fatigue.SWT(), *pulled(-10.0, -50.0)).parameter[0] >= 0.0


def test_smith_watson_topper_of_a_shaft():
    """On planes at 45 degrees the normal stress is tau, the normal strain tau (1 + nu) / E."""
    found = of(sg.fatigue.SWT(), *sheared(100.0, -100.0))
    assert found.parameter[0] == pytest.approx(100.0**2 * (1.0 + NU) / E, rel=1e-13)
    assert abs(found.plane[0, 0]) == pytest.approx(abs(found.plane[0, 1]), rel=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_smith_watson_topper_of_a_sheet_that_is_pulled_nearly_alike_in_all_directions(seed):
    """Planes across the sheet have nearly the same parameter: a ridge that steps in eight directions creep along."""
    axes = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    most, least = 100.0, 100.0 * (1.0 - 1e-5)
    tensor = axes @ np.diag([most, least, 0.0]) @ axes.T
    stress = tensor[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    found = of(sg.fatigue.SWT(), stress, -stress)
    assert found.parameter[0] == pytest.approx(most * (most - NU * least) / E, rel=5e-9)


def test_fatemi_socie_of_a_bar():
    """``sin(2 a) (1 + nu) s / E (1 + k s (1 + cos(2 a)) / (2 Y))`` over all angles a."""
    size = 200.0
    kappa = 0.5 * K * size / YIELD
    cosine = (-(1.0 + kappa) + np.sqrt((1.0 + kappa) ** 2 + 8.0 * kappa**2)) / (4.0 * kappa)
    expected = (1.0 + NU) * size / E * np.sqrt(1.0 - cosine**2) * (1.0 + kappa * (1.0 + cosine))
    found = of(FATEMI_SOCIE, *pulled(size, -size))
    assert found.parameter[0] == pytest.approx(expected, rel=1e-12)
    assert 2.0 * found.plane[0, 0] ** 2 - 1.0 == pytest.approx(cosine, abs=1e-5)


def test_fatemi_socie_of_a_shaft_that_is_pulled_a_quarter_later():
    """Its planes across and along the axis are sheared by tau; with s = 0 the plane across sees no normal stress."""
    found = of(FATEMI_SOCIE, *sheared(100.0, -100.0))
    kappa = K * 100.0 / YIELD
    angles = np.linspace(0.0, np.pi, 200001)
    course = np.abs(np.cos(2.0 * angles)) * (1.0 + kappa * np.abs(np.sin(2.0 * angles)))
    assert found.parameter[0] == pytest.approx(100.0 / G * course.max(), rel=1e-8)


def test_limits_are_reached_in_bending_and_in_torsion_at_once():
    for criterion in (CROSSLAND, DANG_VAN):
        assert of(criterion, *pulled(300.0, -300.0)).parameter[0] == pytest.approx(1.0, rel=1e-12)
        assert of(criterion, *sheared(190.0, -190.0)).parameter[0] == pytest.approx(1.0, rel=1e-12)


def test_crossland_of_a_shaft_that_is_pulled_a_quarter_later():
    """Out of phase by 90 degrees the ball around the ellipse is that of its longer axis, not of the sum of both."""
    turn = np.linspace(0.0, 2.0 * np.pi, 721)
    for size, shear in ((200.0, 80.0), (100.0, 150.0)):
        times = [(size * np.cos(a), 0, 0, shear * np.sin(a), 0, 0) for a in turn]
        amplitude = max(size / np.sqrt(3.0), shear)
        found = of(CROSSLAND, *times)
        assert found.amplitude[0] == pytest.approx(amplitude, rel=1e-9)
        assert found.parameter[0] == pytest.approx((amplitude + CROSSLAND.slope * size / 3.0) / 190.0, rel=1e-9)
    # Dang Van's grains see Tresca's shear of each of them: sqrt(s^2 / 4 + tau^2) along the ellipse
    times = [(200.0 * np.cos(a), 0, 0, 80.0 * np.sin(a), 0, 0) for a in turn]
    tension = 200.0 * np.cos(turn)
    course = np.sqrt(0.25 * tension**2 + (80.0 * np.sin(turn)) ** 2) + DANG_VAN.slope * tension / 3.0
    assert of(DANG_VAN, *times).parameter[0] == pytest.approx(course.max() / 190.0, rel=1e-9)


def sampled(stress, count):
    """A history with so many times in every straight part."""
    t = np.linspace(0.0, 1.0, count, endpoint=False)[:, None]
    parts = [one + t * (two - one) for one, two in itertools.pairwise(stress)]
    return np.concatenate([*parts, stress[-1:]])


def matrices(tensors):
    return tensors[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_random_histories_beside_dense_sampling_of_times_and_planes(seed):
    """Sampling never finds more, and with 60 times a part and 20000 planes hardly less."""
    rng = np.random.default_rng(seed)
    stress = rng.normal(size=(rng.integers(2, 9), 6)) * 100.0
    dense = sampled(stress, 60)
    s, e = matrices(dense), matrices(strains(dense))
    n = rng.normal(size=(20000, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    normal = np.einsum("pi,tij,pj->pt", n, s, n, optimize=True)
    strain = np.einsum("pi,tij,pj->pt", n, e, n, optimize=True)
    swt = np.maximum(normal.max(axis=1), 0.0) * 0.5 * np.ptp(strain, axis=1)
    found = of(sg.fatigue.SWT(), *stress).parameter[0]
    assert swt.max() <= found * (1.0 + 1e-12)
    assert swt.max() >= found * (1.0 - 2e-3)
    some = n[:: len(n) // 1500]
    pulls = 2.0 * np.einsum("tij,pj->pti", matrices(strains(stress)), some)
    pulls -= np.einsum("pti,pi->pt", pulls, some)[..., None] * some[:, None]
    most = np.einsum("pi,tij,pj->pt", some, matrices(stress), some, optimize=True).max(axis=1)
    radii = np.array([brute_radius(path) for path in pulls])
    sampling = (radii * np.maximum(1.0 + K * most / YIELD, 0.0)).max()
    found = of(FATEMI_SOCIE, *stress).parameter[0]
    assert sampling <= found * (1.0 + 1e-9)
    assert sampling >= found * (1.0 - 1e-2)
    times = of(CROSSLAND, *dense), of(DANG_VAN, *dense)
    for criterion, more in zip((CROSSLAND, DANG_VAN), times, strict=True):
        assert of(criterion, *stress).parameter[0] == pytest.approx(more.parameter[0], rel=1e-9)


def brute_radius(path):
    """Radius of the smallest circle around a path in a plane of space: of all pairs and triples the largest."""
    largest = 0.0
    for one, two in itertools.combinations(path, 2):
        largest = max(largest, 0.5 * np.linalg.norm(two - one))
    for one, two, three in itertools.combinations(path, 3):
        a, b, c = (np.linalg.norm(p - q) for p, q in ((two, three), (one, three), (one, two)))
        if a**2 + b**2 + c**2 > 2.0 * max(a, b, c) ** 2 * (1.0 + 1e-12):  # acute: all three hold it
            area = 0.5 * np.linalg.norm(np.cross(two - one, three - one))
            largest = max(largest, a * b * c / (4.0 * area))
    return largest


@pytest.mark.parametrize("d", [1, 2, 3, 5])
def test_smallest_balls_hold_all_points_and_are_held_by_them(d):
    rng = np.random.default_rng(d)
    for trial in range(200):
        points = rng.normal(size=(rng.integers(1, 30), d))
        if trial % 3 == 0:  # on a line, on a sphere, several times the same
            points = points[:, :1] * np.ones(d)
        elif trial % 3 == 1:
            points /= np.linalg.norm(points, axis=1)[:, None]
            points = np.concatenate([points, points[::2]])
        centre, radius = smallest_ball(points)
        away = np.linalg.norm(points - centre, axis=1)
        assert away.max() <= radius * (1.0 + 1e-12)
        # no direction leads away from all points on it: the centre is in their hull
        outside = points[away > radius * (1.0 - 1e-9)] - centre
        if radius > 0.0:
            weights = nearest_in_hull(outside)
            assert np.linalg.norm(weights @ outside) < 1e-5 * radius


def nearest_in_hull(points):
    """Weights of the point of the hull that is nearest to the origin."""
    from scipy.optimize import nnls

    size = 1e3 * np.abs(points).max()
    weights, _ = nnls(np.vstack([points.T, np.full(len(points), size)]), np.append(np.zeros(points.shape[1]), size))
    return weights


def test_lives_are_those_whose_parameter_is_asked():
    law = {"strength": 917.0, "strength_exponent": -0.095, "ductility": 0.26, "ductility_exponent": -0.47}
    life = np.array([1e2, 1e4, 1e7, 1e12])
    parameter = 917.0**2 / E * (2.0 * life) ** -0.19 + 917.0 * 0.26 * (2.0 * life) ** -0.565
    np.testing.assert_allclose(cycles_to_failure(sg.fatigue.SWT(**law), parameter, np.array([E])), life, rtol=1e-10)
    shear = sg.fatigue.FatemiSocie(yield_stress=YIELD, **law)
    parameter = 917.0 / G * (2.0 * life) ** -0.095 + 0.26 * (2.0 * life) ** -0.47
    np.testing.assert_allclose(cycles_to_failure(shear, parameter, np.array([G])), life, rtol=1e-10)
    assert cycles_to_failure(shear, np.zeros(1), np.array([G]))[0] == np.inf


@pytest.mark.parametrize(
    ("criterion", "constants", "message"),
    [
        ("SWT", {"strength": 900.0}, "strength_exponent: is missing beside strength; expected all four constants"),
        ("FatemiSocie", {"yield_stress": 0.0}, "yield_stress: is 0.0; expected a number > 0"),
        ("FatemiSocie", {"yield_stress": 1.0, "sensitivity": -1}, "sensitivity: is -1; expected a number >= 0"),
        ("Crossland", {"bending_limit": 3.0, "torsion_limit": 1.0}, "torsion_limit: is 1.0; expected a number >= 1.73"),
        ("DangVan", {"bending_limit": 3.0, "torsion_limit": 1.0}, "torsion_limit: is 1.0; expected a number >= 1.5"),
    ],
)
def test_constants_that_make_no_sense_are_refused(criterion, constants, message):
    with pytest.raises(sg.InputError) as refused:
        getattr(sg.fatigue, criterion)(**constants)
    assert str(refused.value).startswith(message)
