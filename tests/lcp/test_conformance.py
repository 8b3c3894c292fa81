# SPDX-License-Identifier: BSD-3-Clause
"""Every method on every problem of its class: solved, right, and nothing claimed where there is nothing."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, aslinearoperator

from benchmarks import lcp_problems as problems
from signorini import lcp

BANK = problems.bank()
ALL = frozenset({"any"})

# A method solves the problems that carry all the traits of one of its sets; beside it, whatever it cannot do.
CLASSES = {
    "lemke": [{"P"}, {"monotone"}, {"contact"}],
    "lemke-howson": [{"game"}],
    "least-index": [{"P"}],
    "block-pivoting": [{"P"}],
    "newton": [{"P"}, {"monotone"}, {"contact"}],
    "projected-sor": [{"symmetric", "positive definite"}],
    "mprgp": [{"symmetric", "monotone"}],
    "multigrid": [{"sparse", "symmetric", "positive definite"}],
    "interior-point": [{"monotone"}],
    "enumeration": [{"small"}],
    "auto": [{"any"}],
}
# Exponential by design of the problem: Murty's triangle for single and block pivoting.
EXPONENTIAL = {("block-pivoting", "Murty's triangle, n = 100")}


def traits(problem: problems.PosedLCP) -> set[str]:
    found = set(problem.traits) | {"any"}
    found |= {"small"} if problem.n <= 10 else set()
    return found | ({"sparse"} if sp.issparse(problem.M) else set())


def pairs(*, solvable: bool) -> list[tuple[str, problems.PosedLCP]]:
    return [
        pytest.param(name, problem, id=f"{name}: {problem.name}")
        for name, sets in CLASSES.items()
        for problem in BANK
        if problem.solvable is solvable
        and (not solvable or any(kind <= traits(problem) for kind in sets))
        and (name, problem.name) not in EXPONENTIAL
    ]


def method_of(name: str, problem: problems.PosedLCP) -> str | lcp.Method:
    return lcp.Lemke(covering=problem.covering) if name == "lemke" else name


@pytest.mark.parametrize(("name", "problem"), pairs(solvable=True))
def test_solves_its_class(name, problem):
    solution = lcp.solve(problem.M, problem.q, method=method_of(name, problem))
    assert solution.solved, solution.message
    assert solution.z.min() >= 0
    np.testing.assert_array_equal(solution.w, problem.M @ solution.z + problem.q)
    assert lcp.natural_residual(problem.M, problem.q, solution.z).worst <= 1e-9
    if problem.unique and problem.answer is not None:
        scale = np.where(problem.answer > 0, problem.answer, np.abs(problem.answer).max() or 1.0)
        assert (np.abs(solution.z - problem.answer) / scale).max() <= 1e-6


@pytest.mark.parametrize(("name", "problem"), pairs(solvable=False))
def test_never_claims_what_does_not_exist(name, problem):
    options = {"mprgp": lcp.MPRGP(max_products=500), "projected-sor": lcp.ProjectedSOR(max_sweeps=500)}
    solution = lcp.solve(problem.M, problem.q, method=options.get(name, name))
    assert not solution.solved
    assert solution.z is None
    assert solution.w is None
    assert solution.status is not lcp.Status.SOLVED
    if name == "lemke":
        assert solution.status is lcp.Status.RAY_TERMINATION
        assert solution.ray is not None
    if name == "auto":
        assert solution.status in (lcp.Status.RAY_TERMINATION, lcp.Status.NO_SOLUTION)


@pytest.mark.parametrize(
    "name", [name for name in lcp.METHODS if name not in ("enumeration", "multigrid", "lemke-howson")]
)
def test_dense_sparse_and_operator_give_one_answer(name):
    rng = np.random.default_rng(7)
    B = rng.standard_normal((30, 30))
    M = np.where(np.abs(B @ B.T) > 4, B @ B.T, 0.0)
    M += np.diag(np.abs(M).sum(axis=1))
    q, z = problems.with_solution(M, rng)
    for form in (M, sp.csr_array(M), sp.coo_matrix(M), aslinearoperator(M)):
        solution = lcp.solve(form, q, method=name)
        if isinstance(form, LinearOperator) and name != "mprgp":
            assert solution.status is lcp.Status.NOT_APPLICABLE
        else:
            np.testing.assert_allclose(solution.z, z, atol=1e-7)


def test_auto_takes_an_operator_and_reports_its_chain():
    M = np.array([[2.0, 1.0], [1.0, 2.0]])
    solution = lcp.solve(aslinearoperator(M), [-5.0, -6.0])
    assert solution.method == "mprgp"
    assert solution.chain == (f"mprgp: SOLVED after {solution.iterations} iterations",)
    unsolvable = lcp.solve([[-1.0]], [-1.0])
    assert unsolvable.status is lcp.Status.NO_SOLUTION
    assert unsolvable.chain[0].startswith("lemke: RAY_TERMINATION")
    assert unsolvable.chain[-1].startswith("enumeration: NO_SOLUTION")


def test_obstacle_by_multigrid_and_by_conjugate_gradients():
    posed = problems.obstacle(60)
    first = lcp.solve(posed.M, posed.q, method="multigrid", tolerance=1e-12)
    second = lcp.solve(posed.M, posed.q, method="mprgp", tolerance=1e-12)
    np.testing.assert_allclose(first.z, second.z, atol=1e-9)


def test_multigrid_where_contacts_part_what_is_free():
    """A string held down in 30 places: coarse corrections that carried from span to span had nothing to gain."""
    n = 6000
    M = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n)).tocsr()
    solution = lcp.solve(M, np.where(np.arange(n) % 200 < 100, 1.05, -1.0))
    assert solution.solved
    assert solution.chain[0].startswith("multigrid: SOLVED")
    assert solution.iterations <= 8
    assert np.count_nonzero(np.diff(np.sign(solution.z))) == 59


@pytest.mark.parametrize("seed", range(40))
def test_frictional_contact_is_solved_by_lemke_in_both_forms(seed):
    rng = np.random.default_rng(seed)
    mu, m = rng.uniform(0.0, 2.0), int(rng.integers(2, 25))
    for make in (problems.frictional_contact, problems.gap_slip_contact):
        posed = make(m, rng, friction=mu)
        solution = lcp.solve(posed.M, posed.q, method=lcp.Lemke(covering=posed.covering))
        assert solution.solved, (posed.name, solution.message)
        assert solution.residual.worst < 1e-10
