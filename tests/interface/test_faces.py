# SPDX-License-Identifier: BSD-3-Clause
"""Reference faces: nodal values, sums, derivatives, pieces, normals and areas."""

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.fem.boundary import Boundary
from signorini.fem.facets import facet_nodes, facet_pieces, facet_shapes
from signorini.interface.frames import frames
from signorini.meshing.facets import FACE_CORNERS
from tests.helpers.face_samples import grid, rotation, turned

KINDS = tuple(FACE_CORNERS)


@pytest.mark.parametrize("count", KINDS)
def test_shape_functions_interpolate_their_polynomials(count):
    np.testing.assert_allclose(facet_shapes(count, facet_nodes(3, count))[0], np.eye(count), atol=1e-15)
    x = np.random.default_rng(count).uniform(-0.2, 0.8, (20, 2))
    degree = {3: 1, 4: 1, 6: 2, 8: 2, 9: 2}[count]
    for i in range(degree + 1):
        for j in range(degree + 1 - i):
            f = facet_nodes(3, count)[:, 0] ** i * facet_nodes(3, count)[:, 1] ** j
            np.testing.assert_allclose(facet_shapes(count, x)[0] @ f, x[:, 0] ** i * x[:, 1] ** j, atol=1e-14)


@pytest.mark.parametrize("count", KINDS)
def test_slopes_are_derivatives(count):
    x, h = np.random.default_rng(count).uniform(-0.2, 0.8, (5, 2)), 1e-6
    for e, step in enumerate(h * np.eye(2)):
        difference = (facet_shapes(count, x + step)[0] - facet_shapes(count, x - step)[0]) / (2 * h)
        np.testing.assert_allclose(facet_shapes(count, x)[1][..., e], difference, atol=1e-8)


@pytest.mark.parametrize("count", KINDS)
def test_pieces_tile_the_reference_face(count):
    corners = facet_pieces(count)
    a, b = corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1]
    areas = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert (areas > 0).all()
    np.testing.assert_allclose(areas.sum(), 0.5 if FACE_CORNERS[count] == 3 else 4.0)


@pytest.mark.parametrize("count", KINDS)
def test_normals_and_areas_of_a_turned_rectangle(count):
    flat, faces = grid([0, 0.5, 2], [0, 0.3, 1], count, 0.5)
    Q = rotation(count)
    side = Boundary.of(np.column_stack([flat, np.zeros(len(flat))]) @ Q.T, turned(faces))
    np.testing.assert_allclose(side.nodal_normals, np.tile(-Q[:, 2], (len(side.nodes), 1)), atol=1e-14)
    np.testing.assert_allclose(side.nodal((block.weights for block in side.blocks), corners=True).sum(), 2.0)


@pytest.mark.parametrize("count", [6, 8, 9])
def test_normals_of_a_curved_quadratic_face_are_those_of_its_surface(count):
    flat, faces = grid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5), count)
    x, y = flat.T
    side = Boundary.of(np.column_stack([flat, x**2 + 0.5 * x * y - 0.3 * y**2]), faces)
    exact = np.column_stack([-2 * x - 0.5 * y, -0.5 * x + 0.6 * y, np.ones(len(x))])
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    np.testing.assert_allclose(side.nodal_normals, exact, atol=1e-13)


def test_frames_are_right_handed_and_follow_an_axis():
    normals = np.array([[0, 0, 1.0], [1, 0, 0], [0.6, 0, 0.8], [0, -1, 0]])
    found = frames(normals, axis=(1, 0, 0))
    np.testing.assert_allclose(np.linalg.det(found), 1.0)
    np.testing.assert_allclose(found @ found.transpose(0, 2, 1), np.tile(np.eye(3), (4, 1, 1)), atol=1e-15)
    np.testing.assert_allclose(found[[0, 2, 3], 1], [[1, 0, 0], [0.8, 0, -0.6], [1, 0, 0]], atol=1e-15)
    with pytest.raises(InputError, match="axis: is zero"):
        frames(normals, axis=(0, 0, 0))


def test_normals_weigh_faces_by_their_areas():
    """A roof of a square and a triangle of one area looks up at its ridge, an arch of both kinds outward."""
    s = 2**-0.5
    points = np.array([[0, 0, 0], [0, 1, 0], [-s, 1, -s], [-s, 0, -s], [2 * s, 0.5, -2 * s]])
    side = Boundary.of(points, [[0, 1, 2, 3]], [[1, 0, 4]])
    np.testing.assert_allclose(side.nodal_normals[:2], [[0, 0, 1]] * 2, atol=1e-15)

    angle = np.radians(np.arange(0, 100, 10.0))
    points = np.concatenate([np.column_stack([np.sin(angle), np.full(10, y), np.cos(angle)]) for y in (0.0, 1.0)])
    i = np.arange(9)
    squares = np.column_stack([i, i + 1, i + 11, i + 10])
    halves = np.concatenate([squares[::2][:, [0, 1, 2]], squares[::2][:, [0, 2, 3]]])
    side = Boundary.of(points, squares[1::2], halves)
    meet = [2, 4, 6, 8]  # both halves of one square and another whole one
    radial = side.points[meet] * [1, 0, 1]
    np.testing.assert_allclose(side.nodal_normals[meet], radial, atol=1e-12)
