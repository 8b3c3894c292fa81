# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces spread out on paper: no area is lost, no face is torn, what points around or along does so on paper."""

import numpy as np
import pytest

from signorini.plot.chart import chart_of


def shell(n, until, *, height=2.0, rows=3, radius=1.5):
    """A piece of a cylinder about z, cut into quadrangles: points, faces, outward normals."""
    closed = until == 2 * np.pi
    angle = np.linspace(0, until, n + 1)[: n if closed else n + 1]
    z = np.linspace(0, height, rows + 1)
    normals = np.repeat(np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]), rows + 1, axis=0)
    points = radius * normals + np.tile([0, 0, 1], (len(angle) * (rows + 1), 1)) * np.tile(z, len(angle))[:, None]
    first = (np.arange(n)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    after = ((np.arange(n)[:, None] + 1) % len(angle) * (rows + 1) + np.arange(rows)).ravel()
    return points, np.column_stack([first, after, after + 1, first + 1]), normals


def turn():
    Q = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    return Q * np.linalg.det(Q)


def areas(places, faces):
    x, y = places[faces].transpose(2, 0, 1)
    return 0.5 * np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))


@pytest.mark.parametrize("until", [2 * np.pi, 1.6 * np.pi])
@pytest.mark.parametrize("turned", [False, True])
def test_a_cylinder_is_unrolled(until, turned):
    points, faces, normals = shell(48, until)
    Q = turn() if turned else np.eye(3)
    points, normals, axis = points @ Q.T + [3, 1, 2], normals @ Q.T, Q[:, 2]
    touching = normals @ Q[:, 1] > 0.9
    chart = chart_of(points, faces, touching)
    np.testing.assert_allclose(areas(chart.at, chart.faces), until * 1.5 / 48 * 2.0 / 3, rtol=1e-9)
    assert np.abs(chart.at[np.isin(chart.node, np.flatnonzero(touching)), 0]).max() < 1.5 * np.pi / 4
    around = np.cross(axis, normals)[chart.node]
    side = np.sign(chart.second[0] @ axis)
    np.testing.assert_allclose(chart.first, side * around, atol=1e-9)
    np.testing.assert_allclose(np.abs(chart.second @ axis), 1.0, atol=1e-9)
    assert turned or chart.labels == ("arc length around", "z")


def test_what_faces_one_way_is_looked_at_along_its_normal():
    points, faces, _ = shell(12, np.pi / 3)
    assert chart_of(points, faces, np.zeros(len(points), bool)).labels[1] == "z"
    x, y = (part.ravel() for part in np.meshgrid([0.0, 1, 2], [0.0, 1, 2], indexing="ij"))
    flat, cells = np.column_stack([x, 0 * x, y]), np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]])
    chart = chart_of(flat, cells, np.zeros(9, bool))
    assert chart.labels == ("x", "z")
    np.testing.assert_array_equal(chart.at, flat[:, [0, 2]])
    oblique = chart_of(flat @ turn().T, cells, np.zeros(9, bool))
    np.testing.assert_allclose(areas(oblique.at, oblique.faces), 1.0, rtol=1e-12)
    assert all(label.startswith("along (") for label in oblique.labels)
