# SPDX-License-Identifier: BSD-3-Clause
"""What of one side may be opposite what of the other, their number linear in that of both."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from signorini.arrays import Array, IntArray


def near(points: Array, centres: Array, radius: Array | float, search: float) -> tuple[IntArray, IntArray]:
    """Pairs of points and centres of what is around them that may be opposite each other along some normal.

    Along the normal the other side can be twice as far as the closest centre, which is 60 degrees aside.

    Parameters
    ----------
    points : (p, d) nodes, or centres of facets
    centres : (m, d) of the facets of the other side
    radius : (p,) or a number: how far from its centre a facet may reach, both sides together, length
    search : how far apart they can be along the normal, length

    Returns
    -------
    i, j : (k,) sorted by i, then by j

    Examples
    --------
    >>> i, j = near(np.array([[0.0, 0.0], [5.0, 0.0]]), np.array([[0.0, 1.0], [5.0, 3.0]]), 0.5, 2.0)
    >>> i.tolist(), j.tolist()
    ([0], [0])
    """
    tree = KDTree(centres)
    closest, _ = tree.query(points)
    reach = radius + np.minimum(2.0 * closest, search)
    lists = tree.query_ball_point(points, reach * (1.0 + 1e-9), return_sorted=True)
    count = np.array([len(found) for found in lists], int)
    return np.repeat(np.arange(len(count)), count), np.concatenate([np.asarray(found, int) for found in lists])
