"""The pieces of a mesh that ranks assemble: together they are the whole, to the last bit, however it is cut."""

import numpy as np
import pytest
import scipy.sparse as sp

import signorini as sg
from signorini.distributed.partition import owners, pair_owners
from signorini.distributed.pieces import pieces, whole_nodes
from signorini.engine.condensation import whole_stiffness
from signorini.engine.examine import examine
from signorini.fem.internal_forces import internal_forces
from tests.helpers.on_ranks import MODELS

RANKS = 3


def rows_of_ranks(examined, owner):
    """Forces of random displacements by the pieces, plain and as if in twice the digits; and the displacements."""
    space, constraints = examined.space, examined.constraints
    d = space.components
    by = np.append(owner, 0)[np.minimum(constraints.nodes, len(owner))]
    whole = whole_nodes(constraints.transform, d, owner, by, RANKS)
    u = np.random.default_rng(5).standard_normal(space.number_of_dofs)
    plain, sharp = np.zeros_like(u), np.zeros_like(u)
    for rank, piece in enumerate(pieces(space, examined.model, constraints, owner, whole)):
        dofs = (d * piece.nodes[:, None] + np.arange(d)).ravel()
        own = dofs[np.repeat(piece.own, d)]
        np.testing.assert_array_equal(np.unique(own // d), np.flatnonzero(owner == rank))
        held = piece.assembled()
        plain[own], sharp[own] = held.forces(u[dofs], "plain"), held.forces(u[dofs], "sharp")
    return plain, sharp, u


@pytest.mark.parametrize("name", ["cubes", "several steps", "coupled unknowns", "twist", "mortar"])
def test_rows_have_the_bits_of_the_whole(name):
    """Of a cut by METIS, and of one in which no node is by the side of another of its rank."""
    examined = examine(MODELS[name]())
    K = whole_stiffness(examined)
    scattered = np.random.default_rng(3).integers(0, RANKS, len(examined.space.mesh.points))
    for owner in (owners(examined.space, examined.interface.B, RANKS), scattered):
        plain, sharp, u = rows_of_ranks(examined, owner)
        np.testing.assert_array_equal(plain, K @ u)
        np.testing.assert_array_equal(sharp, internal_forces(K, u))


def test_entries_are_shared_evenly_where_a_contact_is():
    """Neighbours of every node through cells and pairs, counted one by one: no rank has 5 % more than the mean."""
    examined = examine(MODELS["cubes"]())
    mesh, B, d = examined.space.mesh, examined.interface.B, examined.space.components
    pairs = [np.unique(B[[row]].indices // d) for row in range(B.shape[0])]
    seen = [set() for _ in mesh.points]
    for group in (*(nodes for cells in mesh.cells.values() for nodes in cells), *pairs):
        for node in group:
            seen[node].update(group.tolist())
    shares = np.bincount(owners(examined.space, B, RANKS), weights=[len(near) for near in seen])
    assert shares.max() <= 1.05 * shares.mean()


@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 7])
@pytest.mark.parametrize("a", [0, 1, 5, 169])
def test_pairs_are_shared_evenly_wherever_the_cut_is(a, ranks):
    """A contact on the first rank as a whole, on the last one, and one whose pairs see anything."""
    random = np.random.default_rng(a + ranks)
    centres = random.random((ranks, 3))
    alone = np.tile(np.eye(ranks)[0], (a, 1))
    for seen in (alone, alone[:, ::-1], random.integers(0, 3, (a, ranks))):
        owner = pair_owners(sp.csr_array(seen), random.random((a, 3)), centres)
        assert owner.shape == (a,)
        assert np.bincount(owner, minlength=ranks).max() <= -(-a // ranks)


def test_pairs_stay_where_their_nodes_are_as_far_as_shares_allow():
    """Even shares are left as they are; what is over goes where some of its nodes are, or to the nearest rank."""
    at, centres = np.arange(6.0)[:, None], np.array([[2.0], [9.0], [-9.0]])
    own = np.array([2, 0, 1, 1, 2, 0])
    np.testing.assert_array_equal(pair_owners(sp.csr_array(4 * np.eye(3)[own]), at, centres), own)
    whole = np.array([[4, 0, 0]] * 6)
    np.testing.assert_array_equal(pair_owners(sp.csr_array(whole), at, centres), [2, 2, 0, 0, 1, 1])
    whole[[0, 2], 1] = 1
    np.testing.assert_array_equal(pair_owners(sp.csr_array(whole), at, centres), [1, 2, 1, 2, 0, 0])


def test_too_many_ranks_for_a_mesh():
    block = sg.rectangle(width=1.0, height=1.0, nx=1, ny=1)
    few = examine(
        sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.3))], supports=[sg.Support("left", u=(0, 0))])
    )
    with pytest.raises(sg.InputError, match=r"^4 nodes are too few for 9 ranks: one would own none; expected fewer"):
        owners(few.space, few.interface.B, 9)
