# SPDX-License-Identifier: BSD-3-Clause
"""The one-node Coulomb problem: K = [[2, 1], [1, 2]] in (t, n), pressed by 1 and pushed by f_t; critical mu = 2.

Unknown displacements u solve K u = f + r with the forces r = (r_t, -N); the node is open where u_n <= 0, so the gap
is -u_n. Three solutions at mu = 3, f_t = 2.5; exactly one below the critical coefficient.
"""

import itertools

import numpy as np
import pytest

from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK

K = np.array([[2.0, 1.0], [1.0, 2.0]])
PRESSING = 1.0


def condensed(f_t, mu):
    """The problem in (gap, slip), (N, r_t): B = diag(-1, 1) on (u_n, u_t), interface stiffness D = 1."""
    B = np.array([[0.0, -1.0], [1.0, 0.0]])
    A = B @ np.linalg.inv(K + B.T @ B) @ B.T
    b = B @ np.linalg.inv(K + B.T @ B) @ np.array([f_t, PRESSING])
    return ContactProblem.of(W=A, b=b, friction=[mu], motions=np.zeros((2, 0)), scale=1.0)


def solutions(f_t, mu):
    """All of them, by hand: (state, gap, slip, N, r_t)."""
    found = []
    u = np.linalg.solve(K, [f_t, PRESSING])
    if u[1] <= 0:
        found.append((OPEN, -u[1], u[0], 0.0, 0.0))
    if abs(f_t) <= mu * PRESSING:
        found.append((STICK, 0.0, 0.0, PRESSING, -f_t))
    for state, sign in ((SLIP_PLUS, 1.0), (SLIP_MINUS, -1.0)):
        # 2 u_t = f_t + sign mu N and u_t = 1 - N, against the motion
        N = (2.0 - f_t) / (2.0 + sign * mu) if 2.0 + sign * mu else np.nan
        slip = 1.0 - N
        if N > 0 and sign * slip < 0:
            found.append((state, 0.0, slip, N, sign * mu * N))
    return found


def test_the_three_solutions_of_the_catalogue():
    assert {s[0] for s in solutions(2.5, 3.0)} == {OPEN, STICK, SLIP_MINUS}
    by_state = {s[0]: s[1:] for s in solutions(2.5, 3.0)}
    np.testing.assert_allclose(by_state[STICK], (0, 0, 1, -2.5))
    np.testing.assert_allclose(by_state[SLIP_MINUS], (0, 0.5, 0.5, -1.5))
    np.testing.assert_allclose(by_state[OPEN], (1 / 6, 4 / 3, 0, 0))


@pytest.mark.parametrize(
    ("mu", "f_t"),
    [*itertools.product([1.0], np.linspace(-4.1, 3.9, 17)), *itertools.product([3.0], [-2, 1.9, 2.5, 2.9])],
)
def test_the_answer_is_a_solution(mu, f_t):
    known = solutions(f_t, mu)
    assert mu > 2 or len(known) == 1
    result = solve_contact(condensed(f_t, mu))
    assert result.solved
    found = [*result.h[:, 0], *result.r[:, 0]]
    distances = [np.abs(np.subtract(found, solution[1:])).max() for solution in known]
    assert min(distances) < 1e-12
    assert result.state[0] == known[int(np.argmin(distances))][0]


@pytest.mark.parametrize("before", [OPEN, STICK, SLIP_MINUS])
def test_the_previous_state_decides_among_several(before):
    assert solve_contact(condensed(2.5, 3.0), np.array([before])).state.tolist() == [before]


def test_past_the_limit_load_only_open_is_left():
    result = solve_contact(condensed(10.0 / 3.0, 3.0), np.array([STICK]))
    np.testing.assert_allclose(result.h[::-1, 0], (17 / 9, 4 / 9), rtol=1e-12)
    # the catalogue's end of the jump, just past f_t = 3
    result = solve_contact(condensed(3.0 + 1e-9, 3.0), np.array([STICK]))
    np.testing.assert_allclose(result.h[::-1, 0], (5 / 3, 1 / 3), rtol=1e-8)
