# SPDX-License-Identifier: BSD-3-Clause
"""Two plane or curved sides in space whose faces do not match."""

import numpy as np

from signorini.fem.boundary import Boundary
from signorini.fem.facets import facet_nodes


def rotation(seed):
    """A random proper rotation."""
    Q, R = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q * np.linalg.det(Q)


def grid(x, y, kind, jiggle=0.0, seed=0):
    """Nodes (n, 2) and faces (m, kind) of a rectangle with straight edges, its inner nodes moved at random."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    nx, ny = len(x) - 1, len(y) - 1
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    room = 0.5 * jiggle * min(np.diff(x).min(), np.diff(y).min())
    points[1:-1, 1:-1] += room * np.random.default_rng(seed).uniform(-1, 1, points[1:-1, 1:-1].shape)
    number = np.arange(points[..., 0].size).reshape(nx + 1, ny + 1)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    corners, nodes = quads, points.reshape(-1, 2)
    if kind in (3, 6):
        corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    if kind in (3, 4):
        return nodes, corners
    ends = facet_nodes(3, kind)
    shape = corners.shape[1]
    weights = {6: _linear(ends, 3), 8: _linear(ends, 4), 9: _linear(ends, 4)}[kind]
    everything = np.einsum("ka,mad->mkd", weights, nodes[corners])
    flat, index = np.unique(np.round(everything.reshape(-1, 2), 10), axis=0, return_inverse=True)
    faces = index.reshape(len(corners), kind)
    exact = np.empty_like(flat)
    exact[faces.ravel()] = everything.reshape(-1, 2)
    assert shape == corners.shape[1]
    return exact, faces


def _linear(places, corners):
    x, y = places.T
    if corners == 3:
        return np.column_stack([1 - x - y, x, y])
    return np.column_stack([(1 - x) * (1 - y), (1 + x) * (1 - y), (1 + x) * (1 + y), (1 - x) * (1 + y)]) / 4


def turned(faces):
    """The same faces seen from the other side."""
    order = {3: [0, 2, 1], 4: [0, 3, 2, 1], 6: [0, 2, 1, 5, 4, 3], 8: [0, 3, 2, 1, 7, 6, 5, 4]}
    order[9] = order[8] + [8]
    return faces[:, order[faces.shape[1]]]


def two_sides(upper, lower, *, gap=0.0, turn=None):
    """Nonmortar side looking down on a mortar side looking up: (points, nonmortar, mortar) of (x, y), faces each."""
    (above, faces_1), (below, faces_2) = upper, lower
    points = np.concatenate(
        [np.column_stack([above, np.full(len(above), gap)]), np.column_stack([below, np.zeros(len(below))])]
    )
    if turn is not None:
        points = points @ turn.T
    return points, Boundary.of(points, turned(faces_1)), Boundary.of(points, faces_2 + len(above))
