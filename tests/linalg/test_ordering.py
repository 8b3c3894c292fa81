# SPDX-License-Identifier: BSD-3-Clause
"""Nested dissection: any places give an order and the same condensed matrix, true places one that fills in little."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from signorini import cores
from signorini.errors import InputError
from signorini.linalg import factorise, ordering
from signorini.linalg.ordering import nested_dissection
from signorini.linalg.plan import analyse
from signorini.linalg.system import checked_system, node_graph
from tests.helpers.lattices import lattice

few = settings(max_examples=25, deadline=None)
shapes = st.one_of(
    st.tuples(st.integers(2, 40), st.integers(2, 40)),
    st.tuples(st.integers(2, 6), st.integers(2, 6), st.integers(2, 8)),
)


def places(body):
    """Coordinates of the nodes 0, 1, ...; nodes without unknowns somewhere."""
    points = np.zeros((body.nodes.max() + 1, body.points.shape[1]))
    points[body.nodes] = body.points
    return points


@few
@given(shape=shapes, seed=st.integers(0, 99), kind=st.sampled_from(["true", "random", "equal", "one line"]))
def test_any_places_give_an_order_and_the_same_condensed_matrix(shape, seed, kind):
    body = lattice(shape, seed=seed)
    points = places(body)
    if kind == "random":
        points = np.random.default_rng(seed).normal(size=points.shape)
    elif kind == "equal":
        points[:] = 1.0
    elif kind == "one line":
        points[:, 1:] = 0.0
    graph = node_graph(checked_system(body.K, body.interface, body.nodes, points))
    assert np.array_equal(np.sort(nested_dissection(graph)), np.arange(graph.interior))
    S = factorise(body.K, body.interface, nodes=body.nodes, points=points).schur()
    T = factorise(body.K, body.interface, nodes=body.nodes).schur()
    assert np.abs(S - T).max() <= 1e-11 * np.abs(T).max()


@pytest.mark.parametrize("shape", [(90, 80), (300, 12), (14, 13, 12)])
@pytest.mark.parametrize(("degrees", "most"), [(0.0, 1.05), (30.0, 1.6)])
def test_work_beside_metis(shape, degrees, most):
    """A straight cut across a grid that is turned becomes a staircase."""
    body = lattice(shape)
    points = places(body)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    points[:, :2] = points[:, :2] @ np.array([[c, s], [-s, c]])
    system = checked_system(body.K, body.interface, body.nodes, points)
    assert analyse(system).flops <= most * analyse(replace(system, points=None)).flops


@pytest.mark.parametrize("shape", [(70, 60), (13, 12, 11)])
def test_pieces_side_by_side_give_the_order_of_the_whole(shape, monkeypatch):
    """Whatever the number of threads; pieces above and below the size from which fewer directions are tried."""
    body = lattice(shape)
    graph = node_graph(checked_system(body.K, body.interface, body.nodes, places(body)))
    monkeypatch.setattr(ordering, "SHARED_PIECE", graph.interior)
    whole = nested_dissection(graph)
    monkeypatch.setattr(ordering, "SHARED_PIECE", 150)
    for number in (1, 2, 5):
        with cores.threads(number):
            assert np.array_equal(nested_dissection(graph), whole)


def test_a_node_that_touches_all_others():
    """As a rigid loaded boundary makes one: it goes into the separators, and nothing runs out of room."""
    body = lattice((40, 40))
    n = body.K.shape[0]
    hub, to_all = np.zeros((n, 1)), np.full((1, n), 1e-3)
    hub[n // 2], to_all[0, n // 2] = 1.0, 5.0
    joined = sparse.csr_array(hub) @ sparse.csr_array(to_all)
    K = sparse.csr_array(body.K + joined + joined.T)
    points = places(body)
    S = factorise(K, body.interface, nodes=body.nodes, points=points).schur()
    T = factorise(K, body.interface, nodes=body.nodes).schur()
    assert np.abs(S - T).max() <= 1e-11 * np.abs(T).max()


@pytest.mark.parametrize(
    ("points", "message"),
    [(np.zeros(9), "shape"), (np.zeros((3, 2)), "a row for every node"), (np.full((99, 2), np.nan), "not finite")],
)
def test_points_that_are_not_those_of_the_nodes(points, message):
    body = lattice((4, 4))
    with pytest.raises(InputError, match=message):
        factorise(body.K, body.interface, nodes=body.nodes, points=points)
