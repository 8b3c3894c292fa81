# SPDX-License-Identifier: BSD-3-Clause
"""Round rigid obstacles, and one of triangles: distances are distances and normals their gradients."""

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.model.obstacle import Circle, Plane
from signorini.model.revolved import Cone, Cylinder, Torus
from signorini.model.triangulated import Surface

AXIS = (0.3, -0.5, 0.8)
SHAPES = [
    Plane(point=(1, 0, 2), normal=AXIS),
    Circle(centre=(0.1, 0.2, 0.3), radius=0.7),
    Cylinder(point=(0.1, 0, 0), axis=AXIS, radius=0.8),
    Cone(point=(0, 0.2, 0), axis=AXIS, angle=0.6),
    Torus(point=(0, 0, 0.1), axis=AXIS, radius=1.1, tube=0.4),
]


def cube():
    """The unit cube, outward."""
    corners = np.array([[i, j, k] for i in (0.0, 1) for j in (0.0, 1) for k in (0.0, 1)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return Surface(corners, [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])


@pytest.mark.parametrize("shape", [*SHAPES, cube()], ids=lambda shape: type(shape).__name__)
def test_normals_are_the_gradient_of_the_distance_and_lead_to_the_surface(shape):
    x = np.random.default_rng(1).uniform(-2, 2, (200, 3))
    distance, normals = shape.nearest(x)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=1e-12)
    foot = x - distance[:, None] * normals
    np.testing.assert_allclose(shape.nearest(foot)[0], 0.0, atol=1e-12)
    h = 1e-6
    gradient = np.stack([(shape.nearest(x + s)[0] - shape.nearest(x - s)[0]) / (2 * h) for s in h * np.eye(3)], axis=1)
    smooth = np.abs(np.linalg.norm(gradient, axis=1) - 1) < 1e-4  # not where two feet are equally near
    assert smooth.mean() > 0.9
    np.testing.assert_allclose(normals[smooth], gradient[smooth], atol=1e-4)


@pytest.mark.parametrize("kind", [Cylinder, Cone, Torus])
def test_a_hole_is_the_solid_with_sides_exchanged(kind):
    data = {"point": (0, 0, 0), "axis": AXIS}
    data |= {Cylinder: {"radius": 0.8}, Cone: {"angle": 0.6}, Torus: {"radius": 1.1, "tube": 0.4}}[kind]
    x = np.random.default_rng(2).uniform(-1, 1, (20, 3))
    solid, hole = kind(**data).nearest(x), kind(**data, inside=True).nearest(x)
    np.testing.assert_array_equal(hole[0], -solid[0])
    np.testing.assert_array_equal(hole[1], -solid[1])


def test_known_distances():
    up = {"point": (0, 0, 1), "axis": (0, 0, 3)}
    assert Cylinder(**up, radius=2).nearest([[0, 0, 5.0]])[0] == -2
    cone = Cone(**up, angle=np.pi / 6)
    np.testing.assert_allclose(cone.nearest([[0, 0, 3.0], [2.0, 0, 1], [1.0, 0, -1]])[0], [-1, 3**0.5, 5**0.5])
    np.testing.assert_allclose(Torus(**up, radius=2, tube=0.5).nearest([[0, 0, 1.0], [0, -2, 1.2]])[0], [1.5, -0.3])


@pytest.mark.parametrize("inside", [False, True])
def test_a_cone_pushes_along_its_axis_at_its_apex(inside):
    cone = Cone(point=(0.1, 0.2, 0.3), axis=AXIS, angle=1.4, inside=inside)
    distance, normals = cone.nearest([[0.1, 0.2, 0.3], [0.1, 0.2 + 1e-16, 0.3], [1.0, 2.0, 3.0]])
    np.testing.assert_allclose(distance[:2], 0.0, atol=1e-15)
    np.testing.assert_allclose(normals[:2], (1 if inside else -1) * np.tile(cone.axis, (2, 1)), atol=1e-15)


def test_points_about_a_cube_see_its_faces_edges_and_corners():
    x = [[0.5, 0.5, 1.5], [2, 2, 0.5], [2, 2, 2], [0.5, 0.4, 0.9], [0.5, 1.0, 0.5], [1, 1, 1]]
    distance, normals = cube().nearest(x)
    np.testing.assert_allclose(distance, [0.5, 2**0.5, 3**0.5, -0.1, 0, 0], atol=1e-15)
    third = 3**-0.5
    known = [[0, 0, 1], [0.5**0.5, 0.5**0.5, 0], [third] * 3, [0, 0, 1], [0, 1, 0], [third] * 3]
    np.testing.assert_allclose(normals, known, atol=1e-14)


def test_bad_shapes_are_refused():
    with pytest.raises(InputError, match="axis: is zero"):
        Cylinder(point=(0, 0, 0), axis=(0, 0, 0), radius=1)
    with pytest.raises(InputError, match="radius: is 0; expected a number > 0"):
        Cylinder(point=(0, 0, 0), axis=AXIS, radius=0)
    with pytest.raises(InputError, match="angle: is 2; expected"):
        Cone(point=(0, 0, 0), axis=AXIS, angle=2)
    with pytest.raises(InputError, match="tube: is 3; expected no more than the radius, 2"):
        Torus(point=(0, 0, 0), axis=AXIS, radius=2, tube=3)
