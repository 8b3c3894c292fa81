# SPDX-License-Identifier: BSD-3-Clause
"""Faces one side of which has no length, or none that its square leaves in the numbers."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("side", [1e-320, 1e-170, 1e-100])
def test_normals_at_the_ends_of_a_side_without_length_are_those_of_the_face(side):
    mesh = sg.box(x=np.array([0.0, 1.0]), y=np.array([0.0, 1.0]), z=np.array([0.0, 1.0]))
    points = mesh.points.copy()
    x, y, z = points.T
    points[(x == 0) & (z == 0) & (y == 1), 1] = side
    found = boundary(make_space(replace(mesh, points=points)), "bottom", ("contact", 0)).nodal_normals
    np.testing.assert_allclose(found, np.tile([0.0, 0.0, -1.0], (4, 1)), atol=1e-15)
