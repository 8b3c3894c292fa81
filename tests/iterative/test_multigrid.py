# SPDX-License-Identifier: BSD-3-Clause
"""Multigrid of bodies and the springs of their contacts."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from signorini.engine.prepare import prepare
from signorini.gallery.cubes import cubes
from signorini.iterative.aggregation import aggregated, largest_eigenvalue
from signorini.iterative.multigrid import Multigrid, _inverse
from signorini.iterative.springs import PairSprings
from signorini.linalg._sweeps import prolong, restrict, sweep_back, sweep_from_zero, with_lanes
from signorini.linalg.krylov import conjugate_gradients
from signorini.linalg.symmetric_blocks import SymmetricBlocks
from signorini.linalg.vcycle import _shares
from signorini.meshing.solid import box
from signorini.model.conditions import Support
from signorini.model.mesh import join

SINGLE = 3e-7  # of the largest entry: rounding of cycles, which are in single precision


@pytest.fixture(scope="module")
def bodies():
    return prepare(cubes(9, 7), backend="iterative").solver.bodies


def random_matrix(d):
    """Symmetric, in 20 rows of blocks, and the same dense."""
    rng = np.random.default_rng(d)
    whole = np.kron(sp.random_array((20, 20), density=0.2, rng=rng).toarray() != 0, np.ones((d, d)))
    whole *= rng.standard_normal(whole.shape)
    whole = whole + whole.T + 20.0 * d * np.eye(20 * d)
    return SymmetricBlocks.of(sp.bsr_array(whole, blocksize=(d, d))), whole


@pytest.mark.parametrize("d", [1, 2, 3, 6])
def test_half_of_a_matrix_is_the_matrix(d):
    A, whole = random_matrix(d)
    x = np.random.default_rng(7).standard_normal(20 * d)
    np.testing.assert_array_equal(A.whole.toarray(), whole)
    np.testing.assert_allclose(A @ x, whole @ x, atol=1e-12)


@pytest.mark.parametrize("d", [1, 2, 3, 6])
def test_sweeps_are_those_of_triangles(d):
    A, whole = random_matrix(d)
    parts = ((0,) * d, A.indptr, A.indices, A.lower, np.linalg.inv(A.diagonal))
    below = A.below.toarray()
    lower = below + A.on_diagonal.toarray()
    b = np.random.default_rng(8).standard_normal(20 * d)
    given = with_lanes(b.reshape(-1, d))
    x, residual = sweep_from_zero(*parts, given)
    first = x[:, :d].flatten()
    np.testing.assert_allclose(lower @ first, b, atol=1e-12)
    np.testing.assert_allclose(residual[:, :d].ravel(), b - whole @ first, atol=1e-12)
    sweep_back(*parts, given, x)
    np.testing.assert_allclose(lower.T @ x[:, :d].ravel(), b - below @ first, atol=1e-12)


@pytest.mark.parametrize(("d", "e"), [(1, 1), (2, 3), (3, 5), (3, 6), (6, 6)])
def test_prolongation_and_restriction_are_transposed(d, e):
    rng = np.random.default_rng(3)
    whole = np.kron(rng.random((7, 4)) < 0.4, np.ones((d, e))) * rng.random((7 * d, 4 * e))
    P = sp.bsr_array(whole, blocksize=(d, e))
    parts, fine, coarse = (d * (0,), e * (0,), P.indptr, P.indices, P.data), rng.random((7, d)), rng.random((4, e))
    up, down = with_lanes(fine), with_lanes(coarse)
    prolong(*parts, with_lanes(coarse), up)
    restrict(*parts, with_lanes(fine), down)
    np.testing.assert_allclose(up[:, :d].ravel(), fine.ravel() + P @ coarse.ravel(), atol=1e-14)
    np.testing.assert_allclose(down[:, :e].ravel(), coarse.ravel() + P.T @ fine.ravel(), atol=1e-14)


def test_coarser_matrices_are_what_prolongations_leave_of_finer_ones(bodies):
    near_null = np.random.default_rng(4).standard_normal((bodies.K.shape[0], 6))
    levels, coarsest = aggregated(bodies.K, near_null, 5)
    matrices = [each.A for each in levels] + [coarsest]
    assert len(levels) > 1
    for fine, coarse, (_, P) in zip(matrices[:-1], matrices[1:], levels, strict=True):
        np.testing.assert_allclose((P.T @ fine.whole @ P - coarse.whole).data, 0.0, atol=1e-12 * fine.diagonal.max())


def test_the_largest_eigenvalue_is_found_from_below(bodies):
    K = bodies.K.whole.toarray()
    exact = np.linalg.eigvals(K / np.diag(K)[:, None]).real.max()
    assert 0.9 * exact < largest_eigenvalue(bodies.K) <= exact * (1.0 + 1e-12)


def springs(bodies, normal, tangential):
    """Of all pairs, as parts of their stiffness."""
    across = np.eye(2)[:, :, None] * (tangential * bodies.stiffness)
    return PairSprings(normal=normal * bodies.stiffness, tangent=across)


def added(bodies, own):
    """What springs add to the stiffness."""
    return sp.csr_array(bodies.B.T @ own.matrix() @ bodies.B)


def test_a_cycle_is_symmetric_and_positive(bodies):
    cycle = bodies.preconditioner.under(bodies.B, springs(bodies, 1.0, 0.1))
    x, y = np.random.default_rng(1).standard_normal((2, bodies.K.shape[0]))
    assert x @ cycle(y) == pytest.approx(y @ cycle(x), rel=10 * SINGLE)
    assert x @ cycle(x) > 0


@pytest.mark.parametrize("force", [1e-60, 1e60])
@pytest.mark.parametrize("stiffness", [1e-60, 1e60])
def test_single_precision_shows_in_no_unit(bodies, stiffness, force):
    own = springs(bodies, 1.0, 0.1)
    b = np.random.default_rng(5).standard_normal(bodies.K.shape[0])
    cycle = bodies.preconditioner.under(bodies.B, own)
    K = replace(bodies.K, lower=stiffness * bodies.K.lower, diagonal=stiffness * bodies.K.diagonal)
    stiff = PairSprings(normal=stiffness * own.normal, tangent=stiffness * own.tangent)
    other = Multigrid(K, bodies.preconditioner._near_null, bodies.B).under(bodies.B, stiff)
    x = cycle(b)
    np.testing.assert_allclose(other(force * b) * (stiffness / force), x, atol=10 * SINGLE * np.abs(x).max())


def test_springs_replace_those_before_at_the_nodes_of_contacts(bodies):
    """On the finest level: the matrix is that of bodies and the last springs, whatever there was before."""
    for parts in ((1.0, 1.0), (0.3, 0.0)):
        own = springs(bodies, *parts)
        level = bodies.preconditioner.under(bodies.B, own).levels[0]
        whole = (bodies.K.whole + added(bodies, own)).toarray()
        unit = bodies.K.diagonal.max()
        np.testing.assert_allclose(unit * level.A.whole.toarray(), whole, atol=SINGLE * whole.max())
        np.testing.assert_allclose(
            level.inverses @ level.A.diagonal, np.tile(np.eye(3), (len(whole) // 3, 1, 1)), atol=10 * SINGLE
        )


def test_springs_of_some_pairs_are_those_of_fewer_bodies(bodies):
    """Where pairs are switched off, what was made for all of them serves."""
    kept = np.arange(len(bodies.active)) % 2 == 0
    fewer = bodies.among(kept)
    own = springs(fewer, 1.0, 0.5)
    level = bodies.preconditioner.under(fewer.B, own).levels[0]
    whole = (bodies.K.whole + added(fewer, own)).toarray()
    np.testing.assert_allclose(bodies.K.diagonal.max() * level.A.whole.toarray(), whole, atol=SINGLE * whole.max())


@pytest.mark.parametrize("rank", [0, 3, 17, 20])
def test_the_inverse_on_the_coarsest_level_solves_what_can_be_solved(rank):
    """Whatever motions nothing resists, and however stiff the others are."""
    rows = np.random.default_rng(6).standard_normal((rank, 20)) * np.geomspace(1e-30, 1e-28, rank)[:, None]
    A = rows.T @ rows
    found = _inverse(A)
    np.testing.assert_array_equal(found, found.T)
    np.testing.assert_allclose(A @ found @ A, A, atol=1e-9 * np.abs(A).max(initial=0.0))
    assert np.linalg.eigvalsh(found).min() >= -1e-12 * np.abs(found).max()


@pytest.mark.parametrize("parts", [(0.0, 0.0), (1.0, 0.0), (1.0, 0.1), (1.0, 1.0)])
def test_every_state_of_contact_takes_the_same_few_iterations(bodies, parts):
    own = springs(bodies, *parts)
    force = bodies.B.T @ np.random.default_rng(2).standard_normal(bodies.B.shape[0])
    cycle, more = bodies.preconditioner.under(bodies.B, own), added(bodies, own)
    _, count = conjugate_gradients(lambda v: bodies.K @ v + more @ v, cycle, force, 1e-8)
    assert count <= 32


def test_what_two_cycles_of_a_coarser_level_leave_is_least():
    """Over the eigenvalues that they are made for: the same at both ends and, with another sign, once between."""
    for least in (0.2, 0.4, 0.9):
        first, second = _shares(least)
        t = np.linspace(least, 1.0, 101)
        left = 1.0 - first * t - second * t**2
        np.testing.assert_allclose(left[[0, 50, 100]] / np.abs(left).max(), [1.0, -1.0, 1.0], rtol=1e-9)


@pytest.mark.slow
def test_a_thin_plate_takes_few_iterations():
    """Whose bending V-cycles, which go to coarse levels once, take 67 iterations for."""
    across, up = np.linspace(-2.0, 2.0, 61), np.linspace(0.0, 0.1, 4)
    top = np.linspace(-0.1, 0.1, 4)
    mesh = join({"lower": box(x=across, y=across, z=up - 0.1), "upper": box(x=top, y=top, z=top + 0.1)})
    edges = [Support(f"lower.{side}", u=(0.0, 0.0, 0.0)) for side in ("left", "right")]
    model = replace(cubes(2), mesh=mesh, supports=[*edges, Support("upper.top", u=(0.0, 0.0, -0.01))])
    plate = prepare(model, backend="iterative").solver.bodies
    own = springs(plate, 1.0, 1.0)
    force = np.random.default_rng(0).standard_normal(plate.K.shape[0])
    _, count = plate.solved(own, plate.preconditioner.under(plate.B, own), force, 1e-8)
    assert count <= 48
