# SPDX-License-Identifier: BSD-3-Clause
"""What the condensed matrix is, whatever the body: properties on random lattices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from signorini.linalg import factorise
from tests.helpers.lattices import lattice, rigid_motions

shapes = st.one_of(
    st.tuples(st.integers(2, 9), st.integers(2, 9)),
    st.tuples(st.integers(2, 4), st.integers(2, 4), st.integers(2, 5)),
)
bodies = st.builds(lattice, shapes, held=st.sampled_from(["bottom", "roller", "none"]), seed=st.integers(0, 99))
few = settings(max_examples=25, deadline=None)
BACKENDS = ["multifrontal", "superlu"]


def near(S, T, tolerance=1e-11):
    return np.abs(S - T).max(initial=0) <= tolerance * max(np.abs(S).max(initial=0), 1e-300)


def condensed(K, interface, nodes, backend):
    return factorise(K, interface, nodes=nodes, backend=backend).schur()


@few
@given(body=bodies, seed=st.integers(0, 99))
@pytest.mark.parametrize("backend", BACKENDS)
def test_the_order_of_the_unknowns_does_not_matter(backend, body, seed):
    rng = np.random.default_rng(seed)
    n = body.K.shape[0]
    new = rng.permutation(n)  # new[i]: the old unknown at i
    old = np.argsort(new)
    shuffled = rng.permutation(len(body.interface))
    S = condensed(body.K, body.interface, body.nodes, backend)
    T = condensed(body.K[new][:, new], old[body.interface[shuffled]], body.nodes[new], backend)
    assert near(S[np.ix_(shuffled, shuffled)], T)


@few
@given(body=bodies, seed=st.integers(0, 99))
@pytest.mark.parametrize("backend", BACKENDS)
def test_scaling_the_unknowns_is_a_congruence(backend, body, seed):
    scale = 10.0 ** np.random.default_rng(seed).uniform(-2, 2, body.K.shape[0])
    D = sparse.diags_array(scale, format="csr")
    S = condensed(body.K, body.interface, body.nodes, backend)
    T = condensed(D @ body.K @ D, body.interface, body.nodes, backend)
    edge = scale[body.interface]
    assert near(S, T / np.outer(edge, edge), 1e-9)


@few
@given(body=bodies)
@pytest.mark.parametrize("backend", BACKENDS)
def test_semidefinite_and_below_the_stiffness(backend, body):
    S = condensed(body.K, body.interface, body.nodes, backend)
    corner = body.K[body.interface][:, body.interface].toarray()
    tiny = 1e-12 * np.abs(corner).max()
    assert np.linalg.eigvalsh(S).min() >= -tiny
    assert np.linalg.eigvalsh(corner - S).min() >= -tiny


@few
@given(shape=shapes, seed=st.integers(0, 99))
@pytest.mark.parametrize("backend", BACKENDS)
def test_rigid_motions_are_in_the_kernel(backend, shape, seed):
    body = lattice(shape, held="none", seed=seed)
    S = condensed(body.K, body.interface, body.nodes, backend)
    R = rigid_motions(body)[body.interface]
    assert np.abs(S @ R).max() <= 1e-12 * np.abs(body.K).max() * np.abs(R).max()


@few
@given(body=bodies, seed=st.integers(0, 99))
@pytest.mark.parametrize("backend", BACKENDS)
def test_condensing_in_two_steps_is_condensing_once(backend, body, seed):
    rng = np.random.default_rng(seed)
    n = body.K.shape[0]
    extra = rng.choice(n, size=n // 4, replace=False)
    wide = np.concatenate([body.interface, np.setdiff1d(extra, body.interface)])
    first = condensed(body.K, wide, body.nodes, backend)
    m = len(body.interface)
    S = condensed(sparse.csr_array(first), np.arange(m), None, backend)
    assert near(condensed(body.K, body.interface, body.nodes, backend), S, 1e-10)


@few
@given(body=bodies, seed=st.integers(0, 99))
@pytest.mark.parametrize("backend", BACKENDS)
def test_work_is_symmetric(backend, body, seed):
    """Betti: the loads of one state do the same work on another as the other way round."""
    rng = np.random.default_rng(seed)
    factor = factorise(body.K, body.interface, nodes=body.nodes, backend=backend)
    f, g = rng.standard_normal((2, factor.n))
    held = np.zeros(factor.m)
    f[body.interface] = g[body.interface] = 0.0
    one, other = f @ factor.reduce(g).expand(held), g @ factor.reduce(f).expand(held)
    assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
