# SPDX-License-Identifier: BSD-3-Clause
"""One pair, and laws that are known otherwise: no friction, Tresca, unlimited friction, the plane."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.spatial_problems import from_compliance
from signorini import lcp
from signorini.condense.operator import InterfaceOperator
from signorini.errors import InputError
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN, SLIP, STICK
from tests.helpers.contact_samples import HELD, pressed_punch, random_problem
from tests.helpers.violations import violations


def in_space(seed, pairs, friction, **law):
    """A random problem of held bodies."""
    return random_problem(seed, pairs, HELD, friction, directions=3, **law)


def one_pair(b, friction, **more):
    return ContactProblem.of(
        W=0.5 * np.eye(3), b=np.array(b, float), friction=friction, motions=np.zeros((3, 0)), scale=1.0, **more
    )


@pytest.mark.parametrize(
    ("b", "state", "force"),
    [
        ((0.5, 0.3, 0.1), OPEN, (0.0, 0.0, 0.0)),
        ((-1.0, 0.12, -0.16), STICK, (2.0, -0.24, 0.32)),
        ((-1.0, 0.3, -0.4), SLIP, (2.0, -0.36, 0.48)),
    ],
)
def test_one_pair_opens_sticks_or_slips_against_its_motion(b, state, force):
    result = solve_contact(one_pair(b, [0.3]))
    assert result.state.tolist() == [state]
    np.testing.assert_allclose(result.r[:, 0], force, atol=1e-14)


def test_one_pair_of_coupled_directions():
    # slip along t1 alone is forced by the coupling: p presses, and drags with A_tn
    A = np.array([[2.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 1.0]])
    problem, root = from_compliance(A, [-1.0, 1.0, 0.0], [0.2])
    r = solve_contact(problem).r.ravel() * root
    p = 1.0 / (2.0 - 0.5 * 0.2)  # gap 2 p + .5 r_t = 1 with r_t = -.2 p
    np.testing.assert_allclose(r, [p, -0.2 * p, 0.0], atol=1e-14)


def test_slip_on_an_ellipse_is_normal_to_it_and_more_along_the_slippery_axis():
    result = solve_contact(one_pair((-1.0, 1.0, 1.0), [[0.1], [0.4]]))
    r, slip = result.tangential_force[:, 0], result.slip[:, 0]
    np.testing.assert_allclose(np.linalg.norm(r / [0.2, 0.8]), 1.0, rtol=1e-14)
    normal = r / np.array([0.2, 0.8]) ** 2
    np.testing.assert_allclose(slip[0] * normal[1], slip[1] * normal[0], rtol=1e-12)
    assert (slip * r).sum() < 0
    assert abs(slip[0]) > abs(slip[1])


def test_equal_axes_are_a_circle_and_exchanged_axes_exchange_the_answer():
    circle = solve_contact(in_space(3, 6, 0.4))
    equal = solve_contact(in_space(3, 6, np.full((2, 6), 0.4)))
    np.testing.assert_array_equal(circle.y, equal.y)
    problem = in_space(4, 6, np.outer([0.2, 0.7], np.ones(6)))
    swap = np.concatenate([np.arange(6), np.arange(12, 18), np.arange(6, 12)])
    exchanged = ContactProblem.of(
        W=problem.W[np.ix_(swap, swap)], b=problem.b[swap], friction=problem.friction[::-1],
        motions=np.zeros((18, 0)), scale=1.0,
    )  # fmt: skip
    np.testing.assert_allclose(solve_contact(exchanged).y.ravel(), solve_contact(problem).y.ravel()[swap], atol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_without_friction_the_normal_forces_are_those_of_an_lcp(seed):
    problem = in_space(seed, 8, 0.0)
    result = solve_contact(problem)
    A, c = problem.image.A, problem.free_motion()
    z = lcp.solve(A[:8, :8], c[:8]).z
    np.testing.assert_allclose(result.normal_force, z, atol=1e-9)
    assert not result.tangential_force.any()
    assert STICK not in result.state


@pytest.mark.parametrize("seed", range(5))
def test_tresca_with_the_bounds_that_coulomb_found_gives_the_same(seed):
    coulomb = solve_contact(in_space(seed, 8, 0.4))
    tresca = solve_contact(in_space(seed, 8, 0.4 * coulomb.normal_force, tresca=np.ones(8, bool)))
    assert tresca.solved
    np.testing.assert_allclose(tresca.y, coulomb.y, atol=1e-8)


def test_a_pair_in_trescas_law_resists_also_where_it_is_open():
    result = solve_contact(one_pair((0.5, 1.0, 0.0), [0.3], tresca=[True]))
    assert result.state.tolist() == [OPEN]
    np.testing.assert_allclose(result.tangential_force, [[-0.3], [0.0]], atol=1e-14)


def test_a_tresca_bound_is_a_force_of_any_size():
    force = 1e9
    problem = ContactProblem.of(
        W=0.5 * np.eye(3), b=force * np.array([-1.0, 5.0, 0.0]), friction=[2 * force], motions=np.zeros((3, 0)),
        scale=force, tresca=[True],
    )  # fmt: skip
    np.testing.assert_allclose(solve_contact(problem).tangential_force, [[-2 * force], [0.0]], rtol=1e-14)
    with pytest.raises(InputError, match="is infinite at a pair in Tresca's law"):
        one_pair((0, 0, 0), [np.inf], tresca=[True])


def test_unlimited_friction_sticks_wherever_it_is_closed():
    result = solve_contact(pressed_punch(25, np.inf)[2])
    assert result.solved
    assert set(result.state.tolist()) == {OPEN, STICK}
    assert not result.slip[:, result.state == STICK].any()


@pytest.mark.parametrize("guided", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_motion_in_a_plane_is_the_plane_problem(seed, guided):
    n, axis = 6, seed % 2
    plane = random_problem(seed, n, friction=0.5)
    inside = np.concatenate([np.arange(n), (1 + axis) * n + np.arange(n)])
    W, b = (0.0 if guided else 0.5) * np.eye(3 * n), np.zeros(3 * n)
    W[np.ix_(inside, inside)], b[inside] = plane.W, plane.b
    problem = ContactProblem.of(W=W, b=b, friction=plane.friction, motions=np.zeros((3 * n, 0)), scale=1.0)
    flat, spatial = solve_contact(plane), solve_contact(problem)
    assert flat.solved
    assert spatial.solved
    np.testing.assert_allclose(spatial.normal_force, flat.normal_force, atol=1e-12)
    np.testing.assert_allclose(spatial.tangential_force[axis], flat.tangential_force[0], atol=1e-12)
    np.testing.assert_allclose(spatial.slip[axis], flat.slip[0], atol=1e-12)
    assert not spatial.tangential_force[1 - axis].any()


@pytest.mark.parametrize("friction", [0.5, np.outer([0.3, 0.6], np.ones(4))])
def test_a_pair_that_supports_drag_slips_as_it_is_dragged(friction):
    problem = in_space(1, 4, friction)
    W, b = problem.W.copy(), problem.b.copy()
    for row in (4, 8):
        W[row], W[:, row] = 0.0, 0.0
    b[[0, 4, 8]] = -2.0, 0.3, 0.4
    result = solve_contact(ContactProblem.of(W=W, b=b, friction=problem.friction, motions=np.zeros((12, 0)), scale=1.0))
    assert result.solved
    np.testing.assert_allclose(result.slip[:, 0], [0.3, 0.4], atol=1e-12)
    found = violations(
        result.gap, result.slip, result.normal_force, result.tangential_force, problem.friction, length=1.0, force=1.0
    )
    assert found.worst < 1e-10


@pytest.mark.parametrize("push", [1e-3, 0.3, 3.0])
@pytest.mark.parametrize("facets", [0, 8])
def test_a_pair_that_supports_drag_along_one_tangent_turns_its_friction(push, facets):
    problem = in_space(1, 4, 0.5, facets=facets)
    W, b = problem.W.copy(), problem.b.copy()
    W[4], W[:, 4] = 0.0, 0.0
    b[[0, 4, 8]] = -2.0, push, 0.4
    result = solve_contact(replace(problem, image=InterfaceOperator.of_form(W, problem.motions), b=b))
    assert result.solved
    np.testing.assert_allclose(result.slip[0, 0], push, atol=1e-10)
    found = violations(
        result.gap, result.slip, result.normal_force, result.tangential_force, problem.friction, length=1.0, force=1.0,
        facets=facets,
    )  # fmt: skip
    assert found.worst < 1e-10


def test_bad_input_says_what_is_wrong():
    with pytest.raises(InputError, match="friction: has negative entries"):
        one_pair((0, 0, 0), [-0.1])
    with pytest.raises(InputError, match="facets: is 6; expected 0 or a multiple of 4"):
        one_pair((0, 0, 0), [0.1], facets=6)
    with pytest.raises(InputError, match="W: has 3 rows; expected 4 or 6 for 2 pairs"):
        one_pair((0, 0, 0), [0.1, 0.2])
    with pytest.raises(InputError, match="start: has shape"):
        solve_contact(one_pair((0, 0, 0), [0.1]), np.zeros(2))
    with pytest.raises(InputError, match="pair 0 has no positive compliance"):
        from_compliance(np.zeros((3, 3)), np.zeros(3), [0.1])
