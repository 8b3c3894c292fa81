# SPDX-License-Identifier: BSD-3-Clause
"""Rigid surfaces of triangles: distances beside exact ones and brute force, borders, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from signorini.errors import InputError
from signorini.model.boxes import BoxTree, closest
from signorini.model.obstacle import Plane, Sphere
from signorini.model.triangulated import Surface
from tests.helpers.rigid_surfaces import sphere

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HALVES = [[0, 1, 2], [0, 2, 3]]


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(1, 70), slender=st.floats(0.01, 30.0))
def test_the_tree_finds_what_all_triangles_have_nearest(seed, count, slender):
    """Small and slender triangles anywhere, such as STL files hold."""
    rng = np.random.default_rng(seed)
    corners = rng.normal(size=(count, 1, 3)) + rng.normal(size=(count, 3, 3)) * rng.choice(
        [0.1, slender], (count, 1, 1)
    )
    x = rng.normal(size=(20, 3)) * 3
    triangle, weights = BoxTree(corners).nearest(x)
    every = closest(np.repeat(x, count, axis=0), np.tile(corners, (20, 1, 1)))[1].reshape(20, count)
    foot = np.einsum("na,nae->ne", weights, corners[triangle])
    np.testing.assert_allclose(np.linalg.norm(x - foot, axis=1), np.sqrt(every.min(axis=1)), rtol=1e-9, atol=1e-12)
    assert (weights >= -1e-12).all()
    # no place of any triangle is nearer
    somewhere = rng.dirichlet([0.4] * 3, (count, 50))
    places = np.einsum("mka,mae->mke", somewhere, corners).reshape(-1, 3)
    sampled = np.linalg.norm(x[:, None] - places, axis=2).min(axis=1)
    assert (sampled >= np.sqrt(every.min(axis=1)) - 1e-9).all()


def test_distances_from_a_sphere_converge_with_the_square_of_the_edges():
    x = np.random.default_rng(3).normal(size=(400, 3))
    exact = Sphere(centre=(0, 0, 0), radius=1).nearest(x)
    error = {"distance": [], "normal": []}
    for times in (2, 3, 4):
        distance, normals = sphere(times).nearest(x)
        off = np.abs(exact[0]) > 0.2
        error["distance"].append(np.abs(distance - exact[0]).max())
        error["normal"].append(np.abs(normals - exact[1])[off].max())
    rate = {name: np.log2(np.array(found[:-1]) / found[1:]) for name, found in error.items()}
    assert (rate["distance"] > 1.8).all(), rate
    assert (rate["normal"] > 0.8).all(), rate


def test_a_plane_of_any_triangles_is_the_plane():
    rng = np.random.default_rng(5)
    inner = np.column_stack([rng.uniform(-9, 9, (60, 2)), np.zeros(60)])
    points = np.vstack([inner, [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]])
    triangles = Delaunay(points[:, :2]).simplices
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    surface, plane = Surface(points @ turn.T, triangles), Plane(point=(0, 0, 0), normal=tuple(turn[:, 2]))
    x = rng.uniform(-3, 3, (300, 3)) @ turn.T
    for found, exact in zip(surface.nearest(x), plane.nearest(x), strict=True):
        np.testing.assert_allclose(found, exact, atol=1e-12)
    distance, normals = surface.reverse().nearest(x)
    np.testing.assert_allclose(distance, -plane.nearest(x)[0], atol=1e-12)
    np.testing.assert_allclose(normals, -plane.nearest(x)[1], atol=1e-12)


def test_beyond_the_border_there_is_no_obstacle():
    square = Surface(SQUARE, HALVES)
    assert square.open
    assert not sphere(0).open
    distance, normals = square.nearest([[1.5, 0.5, -0.01], [1.5, 0.5, 0.0], [1.0, 0.5, -0.2], [0.0, 0.0, -0.1]])
    np.testing.assert_allclose(distance, [np.hypot(0.5, 0.01), 0.5, -0.2, -0.1], atol=1e-15)
    np.testing.assert_allclose(normals[1:], [[1, 0, 0], [0, 0, 1], [0, 0, 1]], atol=1e-15)


def test_points_at_one_place_are_one():
    """Every triangle with corners of its own, as in STL files."""
    whole = sphere(2)
    apart = Surface(whole.points[whole.triangles].reshape(-1, 3), np.arange(3 * len(whole.triangles)).reshape(-1, 3))
    assert len(apart.points) == len(whole.points) == len(whole.triangles) // 2 + 2  # Euler
    assert not apart.open


@pytest.mark.parametrize(
    ("points", "triangles", "said"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], r"points: has shape \(3, 2\); expected \(n, 3\)"),
        ([[0, 0, np.nan], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "points: holds what is no finite number"),
        (SQUARE, [[0, 1, 2, 3]], r"triangles: has shape \(1, 4\); expected \(n, 3\)"),
        (SQUARE, [[0, 1, 2.5]], "triangles: holds what is no index"),
        (SQUARE, [[0, 1, 4]], "triangles: names point 4; expected 0 to 3"),
        (SQUARE, [[0, 1, -1]], "triangles: names point -1; expected 0 to 3"),
        ([[0, 0, 0], [1, 0, 0], [0.3, 0, 0]], [[0, 1, 2]], r"triangle 0 at \(0.43333, 0, 0\) has no area"),
        (SQUARE, [[0, 1, 2], [0, 3, 2]], r"0 and 1 are neighbours at \(0.66667, 0.33333, 0\), one of them turned over"),
        ([*SQUARE, [0.5, 0.5, 1]], [*HALVES, [0, 2, 4]], "3 meet at one edge at"),
    ],
)
def test_what_is_no_surface_is_refused(points, triangles, said):
    with pytest.raises(InputError, match=said):
        Surface(points, triangles)
