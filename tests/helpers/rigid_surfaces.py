# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of triangles that tests share."""

import numpy as np

from signorini.model.triangulated import Surface


def sphere(times, radius=1.0, centre=(0.0, 0.0, 0.0)):
    """An octahedron whose triangles are cut in four again and again, their corners moved to the sphere."""
    axes = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    t = axes[np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])]
    for _ in range(times):
        middles = t + np.roll(t, -1, axis=1)
        middles /= np.linalg.norm(middles, axis=2, keepdims=True)
        (a, b, c), (ab, bc, ca) = t.transpose(1, 0, 2), middles.transpose(1, 0, 2)
        t = np.concatenate([np.stack(x, axis=1) for x in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    points = (radius * t.reshape(-1, 3) + np.array(centre)).round(12)
    return Surface(points, np.arange(len(points)).reshape(-1, 3))
