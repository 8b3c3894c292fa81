# SPDX-License-Identifier: BSD-3-Clause
"""Every back end does the same on every kind of matrix."""

import numpy as np
import pytest
from scipy import sparse

from signorini import blas_threads
from signorini.errors import InputError
from signorini.linalg import AUTOMATIC, BACKENDS, Factorisation, NotPositiveDefinite, factorise, pardiso
from tests.helpers.lattices import dense_schur, lattice, rigid_motions, together

PROBLEMS = {
    "2d": lattice((17, 12)),
    "2d rollers: uneven nodes": lattice((13, 9), held="roller"),
    "2d held by contact alone": lattice((11, 8), held="none"),
    "3d": lattice((7, 6, 5)),
    "3d held by contact alone": lattice((5, 5, 6), held="none"),
    "bodies": together(
        lattice((9, 7)), lattice((8, 9), held="none"), lattice((5, 4, 4)), lattice((6, 6), held="roller")
    ),
    "one layer: no interior": lattice((6, 1), held="none"),
}


@pytest.fixture(params=sorted(BACKENDS))
def backend(request):
    if request.param == "pardiso" and not pardiso.available():
        pytest.skip("pypardiso is not installed")
    return request.param


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("with_nodes", [True, False])
def test_condenses_as_dense_algebra_does(backend, name, with_nodes):
    p = PROBLEMS[name]
    rng = np.random.default_rng(3)
    interface = rng.permutation(p.interface)
    factor = factorise(p.K, interface, nodes=p.nodes if with_nodes else None, backend=backend)
    n, m = p.K.shape[0], len(interface)
    S = dense_schur(p.K, interface)
    assert isinstance(factor, Factorisation)
    assert (factor.name, factor.n, factor.m) == (backend, n, m)
    assert np.abs(factor.schur() - S).max() <= 1e-12 * np.abs(S).max()
    assert np.array_equal(factor.schur(), factor.schur().T)

    inside = np.setdiff1d(np.arange(n), interface)
    f, u_c = rng.standard_normal((n, 3)), rng.standard_normal((m, 3))
    reduced = factor.reduce(f)
    u = reduced.expand(u_c)
    assert np.array_equal(u[interface], u_c)
    residual = (p.K @ u - f)[inside]
    assert np.abs(residual).max(initial=0) <= 1e-11 * max(1, np.abs(u).max())
    reaction = (p.K @ u)[interface] - f[interface]
    assert np.allclose(reaction, S @ u_c - reduced.load, atol=1e-10)
    assert np.allclose(factor.reduce(f[:, 1]).expand(u_c[:, 1]), u[:, 1], atol=1e-12)
    assert np.allclose(factor.reduce(f[:, 1]).load, reduced.load[:, 1], atol=1e-12)
    assert factor.reduce(f[:, 1]).load.shape == (m,)


def test_entries_that_rounding_has_left_on_one_side_only(backend):
    """As sums of SciPy leave them where their other halves cancel: they neither count nor lead astray."""
    p = PROBLEMS["2d"]
    n, m = p.K.shape[0], len(p.interface)
    rng = np.random.default_rng(8)
    odd = sparse.csr_array((np.full(n, 1e-17), (rng.integers(n, size=n), rng.integers(n, size=n))), shape=(n, n))
    factor = factorise(p.K + odd, p.interface, nodes=p.nodes, backend=backend)
    S = dense_schur(p.K, p.interface)
    assert np.abs(factor.schur() - S).max() <= 1e-12 * np.abs(S).max()
    f = rng.standard_normal(n)
    u = factor.reduce(f).expand(np.zeros(m))
    inside = np.setdiff1d(np.arange(n), p.interface)
    assert np.abs((p.K @ u - f)[inside]).max() <= 1e-11 * max(1, np.abs(u).max())


@pytest.mark.parametrize("shape", [(14, 9), (5, 6, 4)])
def test_plain_solve_without_interface(backend, shape):
    p = lattice(shape)
    factor = factorise(p.K, [], nodes=p.nodes, backend=backend)
    f = np.random.default_rng(0).standard_normal(p.K.shape[0])
    u = factor.reduce(f).expand(np.empty(0))
    assert factor.schur().shape == (0, 0)
    assert factor.reduce(f).load.shape == (0,)
    assert np.abs(p.K @ u - f).max() <= 1e-11 * np.abs(u).max()


@pytest.mark.parametrize("shape", [(9, 8), (40, 30), (4, 5, 4)])
def test_a_free_body_is_refused_and_named(backend, shape):
    held, free = lattice(shape), lattice(shape, held="none")
    p = together(held, free)
    number_of_held_nodes = held.nodes.max() + 1
    interface = p.interface[p.nodes[p.interface] < number_of_held_nodes]
    with pytest.raises(NotPositiveDefinite, match="moves without resistance") as caught:
        factorise(p.K, interface, nodes=p.nodes, backend=backend)
    assert p.nodes[caught.value.dof] >= number_of_held_nodes


@pytest.mark.parametrize("held_unknowns", [0, 1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_one_free_motion_is_enough(backend, held_unknowns, seed):
    p = lattice((25, 20), held="none", seed=seed)
    kept = np.arange(held_unknowns, p.K.shape[0])  # both components of a corner: it still turns
    with pytest.raises(NotPositiveDefinite):
        factorise(p.K[kept][:, kept], [], nodes=p.nodes[kept], backend=backend)


def test_a_slender_held_body_is_accepted(backend):
    p = lattice((3, 900))
    assert np.isfinite(
        factorise(p.K, [], nodes=p.nodes, backend=backend).reduce(np.ones(p.K.shape[0])).expand([])
    ).all()


@pytest.mark.parametrize("matrix", [[[1.0, 2.0], [2.0, 1.0]], [[1.0, 1.0], [1.0, 1.0]], [[-1.0, 0.0], [0.0, 1.0]]])
def test_not_positive_definite(backend, matrix):
    with pytest.raises(NotPositiveDefinite):
        factorise(sparse.csr_array(np.array(matrix)), [], backend=backend)


@pytest.mark.parametrize("name", ["2d held by contact alone", "3d held by contact alone"])
def test_rigid_motions_need_no_force(backend, name):
    p = PROBLEMS[name]
    S = factorise(p.K, p.interface, nodes=p.nodes, backend=backend).schur()
    R = rigid_motions(p)[p.interface]
    assert np.abs(S @ R).max() <= 1e-12 * np.abs(S).max() * np.abs(R).max()
    assert np.linalg.eigvalsh(S)[R.shape[1]] > 1e-4 * np.abs(S).max()


def test_automatic_choice_is_reported():
    assert factorise(sparse.eye_array(3, format="csr"), [0]).name == AUTOMATIC == "multifrontal"


def test_a_back_end_that_is_not_installed_says_how_to_get_it(monkeypatch):
    monkeypatch.setattr(pardiso, "available", lambda: False)
    with pytest.raises(InputError, match="pip install"):
        factorise(sparse.eye_array(3, format="csr"), [0], backend="pardiso")


def test_failures_of_mkl_are_told(monkeypatch):
    if not pardiso.available():
        pytest.skip("pypardiso is not installed")
    solver = type(pardiso._solver())
    from pypardiso import pardiso_wrapper

    def out_of_memory(*_):
        raise pardiso_wrapper.PyPardisoError(-2)

    monkeypatch.setattr(solver, "_call_pardiso", out_of_memory)
    with pytest.raises(InputError, match=r"error -2 \(not enough memory\); expected another back end"):
        factorise(sparse.eye_array(3, format="csr"), [0], backend="pardiso")


def test_no_unknowns_at_all(backend):
    factor = factorise(sparse.csr_array((0, 0)), [], backend=backend)
    assert factor.schur().shape == (0, 0)
    assert factor.reduce(np.empty(0)).expand(np.empty(0)).shape == (0,)


def test_the_plan_counts_what_is_stored():
    p = lattice((30, 20))
    plan = factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal").plan
    K_ii = np.delete(np.delete(p.K.toarray(), p.interface, axis=0), p.interface, axis=1)
    assert np.count_nonzero(np.tril(K_ii)) < plan.nnz_factor < len(K_ii) ** 2 / 4
    assert plan.peak_bytes >= 8 * (plan.nnz_factor + len(p.interface) ** 2)
    assert sorted(plan.order) == list(range(p.K.shape[0]))


def test_repeats_to_the_last_bit():
    p = lattice((6, 7, 5))
    one, two = (factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal") for _ in range(2))
    assert np.array_equal(one.schur(), two.schur())


def test_blas_keeps_its_threads():
    p = lattice((8, 8))
    before = [get() for _, get in blas_threads._found]
    factorise(p.K, p.interface, nodes=p.nodes, backend="multifrontal").reduce(np.ones(p.K.shape[0]))
    assert [get() for _, get in blas_threads._found] == before


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"interface": [0, 0]}, "twice"),
        ({"interface": [4]}, "range 0 .. 3"),
        ({"nodes": [0, 1]}, r"expected \(4,\)"),
        ({"K": np.eye(4)}, "square sparse"),
        ({"K": sparse.csr_array((4, 3))}, "square sparse"),
        ({"K": sparse.csr_array(np.full((4, 4), np.nan))}, "finite"),
        ({"backend": "superl"}, "did you mean 'superlu'"),
    ],
)
def test_wrong_input_is_told(arguments, message):
    given = {"K": sparse.eye_array(4, format="csr"), "interface": [0], **arguments}
    with pytest.raises(InputError, match=message):
        factorise(given.pop("K"), given.pop("interface"), **given)


def test_wrong_loads_are_told(backend):
    factor = factorise(sparse.eye_array(4, format="csr"), [0], backend=backend)
    with pytest.raises(InputError, match=r"\(3,\); expected \(4,\)"):
        factor.reduce(np.ones(3))
