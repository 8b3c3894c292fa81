# SPDX-License-Identifier: BSD-3-Clause
"""Shape functions of the edges of plane elements."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array


def line_shapes(count: int, at: Array) -> tuple[Array, Array]:
    """Values and derivatives of the shape functions of an edge: its two ends, then its middle.

    ``N = (1 - s)/2, (1 + s)/2``; with a middle ``N = s (s - 1)/2, s (s + 1)/2, 1 - s^2``.

    Parameters
    ----------
    count : nodes of the edge, 2 or 3
    at : (q,) coordinates s on the edge, -1 at the first node and 1 at the second

    Returns
    -------
    values, derivatives : (q, count) each, the derivatives with respect to s

    Examples
    --------
    >>> line_shapes(3, np.array([-1.0, 0.0]))[0]
    array([[ 1., -0.,  0.],
           [-0.,  0.,  1.]])
    """
    s = np.asarray(at, float)
    if count == 2:
        values, slopes = [0.5 * (1.0 - s), 0.5 * (1.0 + s)], [np.full_like(s, -0.5), np.full_like(s, 0.5)]
    else:
        values, slopes = [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s**2], [s - 0.5, s + 0.5, -2.0 * s]
    return np.stack(values, axis=1), np.stack(slopes, axis=1)
