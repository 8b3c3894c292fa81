# SPDX-License-Identifier: BSD-3-Clause
"""Spheres in space: their mesh, and Hertz's pressure where they hardly feel their size."""

import numpy as np
import pytest

from signorini.gallery.spheres import hemisphere
from signorini.verify import solids


@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_half_a_sphere(cells):
    """Where it is cut, where it touches, and that every node of its skin is on the sphere."""
    mesh = hemisphere(radius=5.0, seat=1.0, n=3, cells=cells)
    points = mesh.points
    distance = np.linalg.norm(points - [0.0, 0.0, 5.0], axis=1)
    assert distance.max() <= 5.0 * (1 + 1e-12)
    assert points[mesh.nodes_of("top")][:, 2] == pytest.approx(5.0, abs=1e-12)
    seat = mesh.nodes_of("seat")
    assert distance[seat] == pytest.approx(5.0, rel=1e-12)
    assert np.hypot(*points[seat].T[:2]).max() == pytest.approx(5.0 * np.sin(0.2), rel=1e-9)
    assert points[mesh.nodes_of("start")][:, 1] == pytest.approx(0.0, abs=1e-12)
    assert points[mesh.nodes_of("end")][:, 0] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_spheres():
    for check in solids.spheres():
        assert check.passed, f"{check.case}, {check.quantity}: {check.computed} instead of {check.reference}"
