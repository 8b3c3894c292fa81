# SPDX-License-Identifier: BSD-3-Clause
"""Mortar weights in space: linear fields, exact integrals, partial cover, rotation, cost; the simpler couplings."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini.errors import InputError
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import outward_normals
from signorini.fem.facets import facet_shapes, gauss_rule
from signorini.interface.coupling import geometric_gap
from signorini.interface.facing import near_pairs
from signorini.interface.gaps import resolved
from signorini.interface.matching import match_nodes
from signorini.interface.mortar import mortar_coupling
from signorini.interface.points import node_pairs, node_to_facet
from tests.helpers.face_samples import grid, rotation, turned, two_sides

KINDS = (3, 4, 6, 8, 9)

knots = st.lists(st.floats(0.05, 0.95), min_size=0, max_size=3).map(
    lambda inner: np.unique(np.round([0.0, *inner, 1.0], 1))
)


def fields(points):
    """1, x, y, z."""
    return np.column_stack([np.ones(len(points)), points])


def passed(coupling):
    """Forces of a unit pressure on all nodes, (n,)."""
    return coupling.area @ coupling.relative


def on_facets(side, other, **given):
    """Corners of a side on the faces opposite."""
    nodes = side.corner_nodes
    areas = -side.nodal((block.outward for block in side.blocks), corners=True)[np.searchsorted(side.nodes, nodes)]
    return node_to_facet(side, other, nodes, areas, **given)


def nodal_integrals(side):
    """``int N`` of every shape function of a side, (n,)."""
    total = np.zeros(len(side.points))
    for block in side.blocks:
        places, weights = gauss_rule(block.corners, 6)
        shapes, slopes = facet_shapes(block.count, places)
        size = np.linalg.norm(outward_normals(block.points, slopes), axis=2) * weights
        np.add.at(total, block.facets, size @ shapes)
    return total


def pushed(coupling):
    """Forces of a unit pressure on all nodes, (n, 3)."""
    return np.column_stack([force.sum(axis=0) for force in coupling.forces])


def nodal_pushes(side):
    """``- int N n`` of every shape function of a side, n outward, (n, 3)."""
    total = np.zeros((len(side.points), 3))
    for block in side.blocks:
        places, weights = gauss_rule(block.corners, 6)
        shapes, slopes = facet_shapes(block.count, places)
        outward = outward_normals(block.points, slopes)
        np.add.at(total, block.facets, -np.einsum("mqd,q,qa->mad", outward, weights, shapes))
    return total


@settings(deadline=None, derandomize=True, max_examples=40)
@given(
    kinds=st.tuples(st.sampled_from(KINDS), st.sampled_from(KINDS)),
    x=st.tuples(knots, knots, knots, knots),
    jiggle=st.sampled_from([0.0, 0.7]),
    seed=st.integers(0, 99),
)
def test_covered_sides_reproduce_linear_fields_and_integrals(kinds, x, jiggle, seed):
    upper, lower = grid(x[0], x[1], kinds[0], jiggle, seed), grid(x[2], x[3], kinds[1], jiggle, seed + 1)
    points, side, other = two_sides(upper, lower, turn=rotation(seed))
    coupling = mortar_coupling(side, other)
    np.testing.assert_array_equal(coupling.nodes, side.corner_nodes)
    assert (coupling.area > 0).all()
    full = side.nodal((block.weights for block in side.blocks), corners=True)[
        np.searchsorted(side.nodes, coupling.nodes)
    ]
    np.testing.assert_allclose(coupling.relative @ fields(points), 0.0, atol=1e-12)
    # on quadrilaterals that are no parallelograms the integrands are rational functions
    near = {"atol": 1e-11 if jiggle else 1e-14}
    np.testing.assert_allclose(coupling.area, full, **near)
    np.testing.assert_allclose(passed(coupling), nodal_integrals(side) - nodal_integrals(other), **near)
    above = coupling.relative[:, side.nodes].sum(axis=1)
    np.testing.assert_allclose(above, 1.0, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_a_gap_between_planes_is_found_exactly(kind):
    points, side, other = two_sides(grid([0, 0.4, 1], [0, 1], kind), grid([0, 0.3, 1], [0, 0.8, 1], 4), gap=0.25)
    coupling = mortar_coupling(side, other)
    np.testing.assert_allclose(coupling.relative @ points, np.tile([0, 0, 0.25], (len(coupling.nodes), 1)), atol=1e-13)


def test_a_side_of_triangles_and_quadrilaterals_is_one_side():
    flat, quads = grid([0, 0.5, 1], [0, 0.5, 1], 4, 0.4)
    mixed = [quads[:2], quads[2:, [0, 1, 2]], quads[2:, [0, 2, 3]]]
    below, lower = grid(np.linspace(0, 1, 4), [0, 0.35, 1], 3, 0.4)
    points = np.zeros((len(flat) + len(below), 3))
    points[:, :2] = np.concatenate([flat, below])
    upper = Boundary.of(points, *(turned(faces) for faces in mixed))
    for one, two in (
        (upper, Boundary.of(points, lower + len(flat))),
        (Boundary.of(points, turned(lower + len(flat))), Boundary.of(points, *mixed)),
    ):
        coupling = mortar_coupling(one, two)
        np.testing.assert_allclose(coupling.relative @ fields(points), 0.0, atol=1e-13)
        np.testing.assert_allclose(passed(coupling), nodal_integrals(one) - nodal_integrals(two), atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("edge", [0.31, 0.52, 0.9])
def test_partly_covered_faces_pass_uniform_pressure(kind, edge):
    # the mortar side ends inside nonmortar faces: weights are those of the covered part
    points, side, other = two_sides(
        grid([0, 0.5, 1], [0, 0.5, 1], kind, 0.5), grid([0, edge / 2, edge], [0, 0.6, 1], 4)
    )
    coupling = mortar_coupling(side, other)
    assert (coupling.area > 0).all()
    np.testing.assert_allclose(coupling.area.sum(), edge, rtol=1e-12)
    np.testing.assert_allclose(coupling.relative @ fields(points), 0.0, atol=1e-9)
    np.testing.assert_allclose(passed(coupling)[other.nodes], -nodal_integrals(other)[other.nodes], atol=1e-12)


def test_turning_and_shifting_space_changes_no_weight():
    upper, lower = grid([0, 0.4, 1], [0, 0.7, 1], 4, 0.6), grid([0, 0.3, 1], [0, 0.2, 1], 6, 0.6)
    points, side, other = two_sides(upper, lower, gap=0.1)
    before = mortar_coupling(side, other)
    moved = points @ rotation(7).T + [5.0, -3.0, 2.0]
    after = mortar_coupling(
        Boundary.of(moved, *(b.facets for b in side.blocks)), Boundary.of(moved, *(b.facets for b in other.blocks))
    )
    np.testing.assert_allclose(after.relative.toarray(), before.relative.toarray(), atol=1e-12)
    np.testing.assert_allclose(after.area, before.area, rtol=1e-13)


def test_uniform_pressure_presses_curved_faces_where_they_are():
    flat, faces = grid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5), 9)
    below, lower = grid(np.linspace(-1, 1, 7), np.linspace(-1, 1, 7), 9)
    xy = np.concatenate([flat, below])
    points = np.column_stack([xy, 0.2 * (xy**2).sum(axis=1)])
    side, other = Boundary.of(points, turned(faces)), Boundary.of(points, lower + len(flat))
    coupling = mortar_coupling(side, other)
    # rim faces overhang by what chords cut off; inside only the quadrature of rational functions is left
    inner = side.nodes[(np.abs(points[side.nodes, :2]) < 0.6).all(axis=1)]
    np.testing.assert_allclose(pushed(coupling)[inner], nodal_pushes(side)[inner], atol=1e-7)
    np.testing.assert_allclose(coupling.normal_areas.sum(axis=0)[2], 4.0, rtol=2e-3)
    np.testing.assert_allclose(sum(force.sum() for force in coupling.forces), 0.0, atol=1e-12)
    assert np.abs(geometric_gap(coupling, side.points)).max() < 0.2 * 0.25**2


def on_a_surface(height, upper, lower):
    """Both sides lifted onto z = height(x, y)."""
    points, side, other = two_sides(upper, lower)
    points[:, 2] = height(points[:, 0], points[:, 1])
    return tuple(Boundary.of(points, *(block.facets for block in part.blocks)) for part in (side, other))


def gaps(side, coupling):
    """Of the faces, and of the surfaces that they stand for."""
    return geometric_gap(replace(coupling, smoothing=None), side.points), geometric_gap(coupling, side.points)


def test_warped_faces_on_one_surface_reproduce_linear_fields():
    # z = xy holds every quadrilateral along the axes: two nets of warped faces, one surface
    side, other = on_a_surface(lambda x, y: x * y, grid([0, 0.4, 1], [0, 0.7, 1], 4), grid([0, 0.3, 1], [0, 0.2, 1], 4))
    coupling = mortar_coupling(side, other)
    np.testing.assert_allclose(coupling.relative @ fields(side.points), 0.0, atol=1e-12)
    np.testing.assert_allclose(pushed(coupling), nodal_pushes(side) + nodal_pushes(other), atol=1e-9)


@pytest.mark.parametrize("kinds", [(4, 4), (3, 4), (3, 3)])
@pytest.mark.parametrize(
    "height",
    [lambda x, y: 0.2 * (x**2 + y**2), lambda x, y: 0.2 * x**2 - 0.3 * y**2, lambda x, _: -0.3 * x**2],
    ids=["paraboloid", "saddle", "cylinder"],
)
def test_chords_of_surfaces_that_match_leave_no_gap(height, kinds):
    upper = grid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), kinds[0], 0.3)
    side, other = on_a_surface(height, upper, grid(np.linspace(-1, 1, 13), np.linspace(-1, 1, 12), kinds[1], 0.3))
    coupling = mortar_coupling(side, other)
    faces, gap = gaps(side, coupling)
    assert np.abs(faces).max() > 1e-4
    assert np.abs(gap).max() < 0.1 * np.abs(faces).max()


@pytest.mark.slow
@pytest.mark.parametrize("kinds", [(6, 6), (8, 8), (9, 9), (8, 6)])
@pytest.mark.parametrize("jiggle", [0.0, 0.4])
def test_quadratic_faces_on_one_sphere_leave_no_gap(kinds, jiggle):
    """They are off it by h^4, by h^3 where they are skew."""
    upper = grid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 4), kinds[0], jiggle)
    lower = grid(np.linspace(-1, 1, 6), np.linspace(-1, 1, 7), kinds[1], jiggle, 1)
    side, other = on_a_surface(lambda x, y: 3.0 - np.sqrt(9.0 - x**2 - y**2), upper, lower)
    coupling = mortar_coupling(side, other)
    faces, gap = gaps(side, coupling)
    assert 1e-5 < np.abs(faces).max() < 1e-3
    np.testing.assert_allclose(gap, 0.0, atol=1e-7)


@pytest.mark.parametrize("kinds", [(3, 4), (8, 6)])
@pytest.mark.parametrize("clearance", [0.02, -0.001])
def test_a_ball_in_a_socket_has_its_clearance(kinds, clearance):
    """Faces of the two spheres, as far as they overlap, leave up to 0.01; measured along faces it is a per cent off."""
    x = np.linspace(-1, 1, 5)
    points, side, other = two_sides(grid(x, x, kinds[0], 0.3), grid(1.1 * x, 1.1 * x, kinds[1], 0.3, 1))
    below = np.column_stack([points[:, :2], np.full(len(points), -2.6)])
    radius = np.where(np.isin(np.arange(len(points)), side.nodes), 3.0, 3.0 + clearance)
    points = below / np.linalg.norm(below, axis=1, keepdims=True) * radius[:, None]
    side, other = (Boundary.of(points, *(block.facets for block in part.blocks)) for part in (side, other))
    faces, gap = gaps(side, mortar_coupling(side, other))
    assert np.abs(faces - clearance).max() > 3e-4
    np.testing.assert_allclose(gap, clearance, rtol=0.01)


@pytest.mark.parametrize("kind", [8, 9])
def test_points_of_curved_faces_are_opposite_each_other_on_the_faces(kind):
    """On a parabolic cylinder, which every mesh holds: what is left is where straight cuts miss curved edges."""
    upper, lower = grid(np.linspace(-1, 1, 4), [-1, 0, 1], kind), grid(np.linspace(-1, 1, 6), [-1, 0.2, 1], kind)
    side, other = on_a_surface(lambda x, _: 0.3 * x**2, upper, lower)
    coupling = mortar_coupling(side, other)
    np.testing.assert_allclose(coupling.relative @ np.ones(len(side.points)), 0.0, atol=1e-12)
    np.testing.assert_allclose(coupling.relative @ side.points, 0.0, atol=2e-5)


def test_a_curved_side_on_a_flat_one_keeps_its_gaps():
    upper, lower = grid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), 4), grid([-1, 0, 1], [-1, 0, 1], 4)
    points, side, other = two_sides(upper, lower)
    points[: len(upper[0]), 2] = 1e-4 * (points[: len(upper[0]), :2] ** 2).sum(axis=1)
    side, other = (Boundary.of(points, *(block.facets for block in part.blocks)) for part in (side, other))
    coupling = mortar_coupling(side, other)
    faces, gap = gaps(side, coupling)
    np.testing.assert_allclose(gap, faces, atol=1e-6)


@pytest.mark.parametrize("bulge", np.linspace(0.15, 0.45, 13))
def test_it_does_not_matter_which_corner_of_a_face_is_the_first(bulge):
    """Where sides are tilted normals lie between both: how much a curved side turns has nothing to do with numbers."""
    upper, lower = grid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5), 6), grid([-1, 0, 1], [-1, 0, 1], 4)
    points, side, other = two_sides(upper, lower)
    points[: len(upper[0]), 2] = bulge * (upper[0] ** 2).sum(axis=1)
    (block,), (below,) = side.blocks, other.blocks
    one, two = (
        mortar_coupling(Boundary.of(points, block.facets[:, order]), Boundary.of(points, below.facets))
        for order in (np.arange(6), [1, 2, 0, 4, 5, 3])
    )
    np.testing.assert_allclose(two.normal_areas, one.normal_areas, atol=1e-12)


def test_of_faces_behind_each_other_only_the_nearest_are_opposite():
    flat, faces = grid([0, 0.5, 1], [0, 0.5, 1], 4)
    n = len(flat)
    layers = [np.column_stack([flat, np.full(n, z)]) for z in (0.0, -0.1, -0.2)]
    points = np.concatenate(layers)
    coupling = mortar_coupling(Boundary.of(points, turned(faces)), Boundary.of(points, faces + n, faces + 2 * n))
    np.testing.assert_allclose(coupling.area.sum(), 1.0)
    np.testing.assert_allclose((coupling.relative @ points)[:, 2], 0.1)


def test_faces_that_look_the_same_way_or_are_too_far_apart_are_refused():
    flat, faces = grid([0, 1], [0, 1], 4)
    points = np.concatenate([np.column_stack([flat, np.full(4, z)]) for z in (0.0, 0.5)])
    up, down = Boundary.of(points, faces), Boundary.of(points, turned(faces) + 4)
    with pytest.raises(InputError, match="no face of the nonmortar side has one of the mortar side opposite"):
        mortar_coupling(up, Boundary.of(points, faces + 4), where=("contact", 0))
    with pytest.raises(InputError, match=r"within 0\.1 along its normal"):
        mortar_coupling(up, down, search=0.1)
    assert len(mortar_coupling(up, down, search=0.6).nodes) == 4


def test_the_number_of_pairs_tested_grows_like_that_of_the_faces():
    per_face = []
    for n in (8, 16, 32):
        _, side, other = two_sides(
            grid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), 4, 0.5),
            grid(np.linspace(0, 1, 3 * n // 2 + 1), np.linspace(0, 1, 3 * n // 2 + 1), 4, 0.5),
        )
        corners = [part.blocks[0].plane_pieces for part in (side, other)]
        per_face.append(len(near_pairs(*corners, search=0.5)[0]) / n**2)
    assert max(per_face) < 16
    assert per_face[2] < 1.1 * per_face[1]


@pytest.mark.parametrize("kinds", [(3, 3), (4, 4), (6, 9), (8, 3)])
def test_nodes_on_faces_reproduce_linear_fields_but_not_pressure(kinds):
    upper, lower = grid([0, 0.4, 1], [0, 0.7, 1], kinds[0], 0.6), grid([0, 0.3, 1], [0, 0.2, 1], kinds[1], 0.6)
    points, side, other = two_sides(upper, lower, turn=rotation(2))
    coupling = on_facets(side, other)
    np.testing.assert_array_equal(coupling.nodes, side.corner_nodes)
    np.testing.assert_allclose(coupling.relative @ fields(points), 0.0, atol=1e-12)
    assert np.abs(passed(coupling)[other.nodes] + nodal_integrals(other)[other.nodes]).max() > 1e-3


def test_a_node_meets_a_curved_face_where_its_normal_does():
    below, lower = grid([-1, 1], [-1, 1], 9)
    points = np.concatenate(
        [[[0.3, 0.2, 1.0], [0.4, 0.2, 1.0], [0.3, 0.4, 1.0]], np.column_stack([below, 0.25 * (below**2).sum(axis=1)])]
    )
    coupling = on_facets(Boundary.of(points, [[0, 2, 1]]), Boundary.of(points, lower + 3), search=2.0)
    np.testing.assert_allclose((coupling.relative @ points)[0], [0, 0, 1 - 0.25 * 0.13], atol=1e-14)
    with pytest.raises(InputError, match="no node of the nonmortar side meets"):
        on_facets(Boundary.of(points, [[0, 1, 2]]), Boundary.of(points, lower + 3))


@pytest.mark.parametrize("kind", [3, 4])
def test_matching_sides_pair_their_nodes(kind):
    upper = grid([0, 0.4, 1], [0, 0.7, 1], kind, 0.6)
    order = np.random.default_rng(0).permutation(len(upper[0]))
    lower = upper[0][order], np.argsort(order)[upper[1]]
    points, side, other = two_sides(upper, lower, gap=0.05, turn=rotation(1))
    partner, reason = match_nodes(side, other, np.arange(len(points)))
    assert not reason
    coupling = node_pairs(side, other, partner, -side.nodal((block.outward for block in side.blocks), corners=True))
    np.testing.assert_allclose(
        coupling.relative @ points, np.tile(0.05 * rotation(1)[:, 2], (len(side.nodes), 1)), atol=1e-15
    )
    mortar = mortar_coupling(side, other)
    np.testing.assert_allclose(mortar.relative.toarray(), coupling.relative.toarray(), atol=1e-12)
    np.testing.assert_allclose(mortar.area, coupling.area, rtol=1e-12)


def test_sides_that_do_not_match_say_so():
    for upper, lower, reason in (
        (grid([0, 0.4, 1], [0, 1], 4), grid([0, 0.6, 1], [0, 1], 4), "has no partner across the gap"),
        (grid([0, 1], [0, 1], 4), grid([0, 0.6, 1], [0, 1], 4), "4 nodes and the mortar side 6"),
        (grid([0, 1], [0, 1], 8), grid([0, 1], [0, 1], 8), "quadratic faces have no pairs"),
        (grid([0, 1], [0, 1], 3), grid([0, 1], [0, 1], 4), "not faces opposite faces"),
    ):
        points, side, other = two_sides(upper, lower)
        assert reason in match_nodes(side, other, np.arange(len(points)), faces=True)[1]


@pytest.mark.parametrize("kinds", [(6, 6), (8, 4), (9, 3), (6, 9)])
def test_a_fillet_beside_a_flat_feigns_no_overlap(kinds):
    """Mean gaps are negative where a fillet starts, though no point overlaps; a bulge begins where it touches."""

    def sides(rise):
        points, side, other = two_sides(
            grid([0, 0.5, 1, 1.5, 2], [0, 1], kinds[0], 0.0), grid([0, 0.7, 2], [0, 0.4, 1], kinds[1], 0.0)
        )
        points = points.copy()
        points[side.nodes, 2] += rise(points[side.nodes, 0])
        surfaces = [Boundary.of(points, *(block.facets for block in part.blocks)) for part in (side, other)]
        coupling = mortar_coupling(*surfaces)
        mean = np.einsum("ki,ki->k", coupling.relative @ points, coupling.normals)
        return points[coupling.nodes, 0], mean, resolved(mean, coupling, np.ones(len(mean))), coupling.facets

    x, mean, gap, facets = sides(lambda x: 0.2 * np.maximum(x - 1.0, 0.0) ** 2)
    assert mean[x == 1.0].max() < -0.001
    np.testing.assert_allclose(gap[x <= 1.0], 0.0, atol=1e-8)
    np.testing.assert_allclose(facets.low.min(), 0.0, atol=1e-8)
    x, mean, gap, _ = sides(lambda x: 0.2 * (x - 1.0) ** 2)
    np.testing.assert_allclose(gap - mean, -mean.min(), atol=1e-12)
