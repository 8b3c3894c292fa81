# SPDX-License-Identifier: BSD-3-Clause
"""Classes of matrices, against definitions and against the bank."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from benchmarks import lcp_problems as problems
from signorini import lcp
from signorini.errors import InputError


@pytest.mark.parametrize("seed", range(40))
def test_p_against_all_principal_minors(seed):
    rng = np.random.default_rng(seed)
    M = rng.standard_normal((4, 4)) + np.diag(rng.uniform(0, 3, 4))
    minors = [np.linalg.det(M[np.ix_(s, s)]) for k in range(1, 5) for s in combinations(range(4), k)]
    assert lcp.is_p(M) == (min(minors) > 0)


@pytest.mark.parametrize("problem", [p for p in problems.bank() if p.n <= 12], ids=lambda p: p.name)
def test_traits_of_the_bank_are_true(problem):
    tests = {
        "P": lcp.is_p,
        "monotone": lcp.is_positive_semidefinite,
        "positive definite": lcp.is_positive_definite,
        "symmetric": lcp.is_symmetric,
        "copositive plus": lcp.is_copositive_plus,
    }
    for trait, test in tests.items():
        if trait in problem.traits:
            assert test(problem.M), trait


@pytest.mark.parametrize("problem", [p for p in problems.bank() if p.n <= 9], ids=lambda p: p.name)
def test_what_the_bank_says_about_solutions_is_true(problem):
    faces = lcp.all_solutions(problem.M, problem.q)
    assert bool(faces) is problem.solvable
    if problem.unique:
        assert {face.dimension for face in faces} == {0}
        assert np.ptp([face.z for face in faces], axis=0).max() < 1e-9
    if problem.answer is not None:
        assert lcp.natural_residual(problem.M, problem.q, problem.answer).worst < 1e-12


def test_copositive_plus_needs_its_plus():
    assert not lcp.is_copositive_plus([[0.0, 1.0], [1.0, 0.0]])
    assert not lcp.is_copositive_plus([[1.0, -2.0], [-2.0, 1.0]])
    assert lcp.is_copositive_plus([[1.0, 2.0], [2.0, 1.0]])


def test_k_is_z_and_p():
    laplacian = problems.obstacle(3).M
    assert lcp.is_z(laplacian)
    assert lcp.is_k(laplacian)
    assert not lcp.is_k(-np.eye(2))
    assert not lcp.is_k([[1.0, -1.0], [-1.0, 1.0]])


def test_exact_tests_refuse_large_matrices():
    with pytest.raises(InputError, match="2\\^n"):
        lcp.is_p(np.eye(21))
    with pytest.raises(InputError, match="2\\^n"):
        lcp.is_copositive_plus(np.ones((21, 21)) - 2 * np.diag(np.r_[1.0, np.zeros(20)]))


def test_three_answers_of_the_coulomb_node():
    node = next(p for p in problems.bank() if p.name == "one Coulomb node, mu = 3")
    points = [face.z for face in lcp.all_solutions(node.M, node.q) if len(face.support) < 3]
    np.testing.assert_allclose(points, [[0, 0, 0], [1 / 6, 4 / 3, 0], [0, 0.5, 0]], atol=1e-12)


def test_enumeration_of_a_face_and_of_an_exact_zero():
    line = lcp.all_solutions(np.ones((2, 2)), [-1.0, -1.0])
    edge = next(face for face in line if face.dimension == 1)
    assert abs(edge.directions[:, 0].sum()) < 1e-12
    assert lcp.all_solutions([[0.0]], [0.0])[0].support == ()
    assert lcp.all_solutions([[0.0]], [0.0])[1].dimension == 1
    with pytest.raises(InputError, match="n = 21"):
        lcp.all_solutions(np.eye(21), np.ones(21))
