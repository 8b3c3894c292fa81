# SPDX-License-Identifier: BSD-3-Clause
"""Mortar weights: known rows, exact integrals, linear fields, partial cover, rotated and shifted sides."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import signorini as sg
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.interface.mortar import mortar_coupling
from signorini.meshing.plane import rectangle
from signorini.model.mesh import Mesh, join

knots = st.lists(st.floats(0.02, 0.98), min_size=0, max_size=6).map(
    lambda inner: np.unique(np.round([0.0, *inner, 1.0], 3))
)


def two_sides(upper, lower, angle=0.0):
    mesh = join({"upper": rectangle(x=upper, y=[0.0, 1.0]), "lower": rectangle(x=lower, y=[-1.0, 0.0])})
    c, s = np.cos(angle), np.sin(angle)
    return Mesh(
        points=mesh.points @ np.array([[c, s], [-s, c]]),
        cells=mesh.cells,
        bodies=mesh.bodies,
        boundaries=mesh.boundaries,
    )


def coupled(mesh, measure=lambda x, *_: np.ones(x.shape[:-1])):
    space = make_space(mesh)
    first, second = (boundary(space, name, ()) for name in ("upper.bottom", "lower.top"))
    return first, second, mortar_coupling(first, second, measure=measure)


def opposite(coupling, mesh, side):
    """P, its columns in the order in which the mortar nodes follow each other along the surface."""
    order = side.nodes[np.argsort(side.nodal_normals[0] @ [[0, 1], [-1, 0]] @ mesh.points[side.nodes].T)]
    return -coupling.relative.toarray()[:, order]


def hat_integrals(x, low, high):
    """``int N_l`` over [low, high] of the hats on the knots x."""
    cut = np.unique(np.clip([low, *x, high], low, high))
    middle, length = 0.5 * (cut[1:] + cut[:-1]), np.diff(cut)
    return np.array([length @ np.interp(middle, x, row, left=0, right=0) for row in np.eye(len(x))])


def test_known_rows():
    mesh = two_sides([0, 0.25, 0.5, 0.75, 1], [0, 0.17, 0.5, 0.62, 0.9, 1])
    _, side, coupling = coupled(mesh)
    P = -coupling.relative.toarray()[:, side.nodes[np.argsort(mesh.points[side.nodes, 0])]]
    np.testing.assert_allclose(P[0], [0.8976, 0.155152, -0.052752, 0, 0, 0], atol=5e-7)
    np.testing.assert_allclose(P[1], [-0.1088, 0.922424, 0.186376, 0, 0, 0], atol=5e-7)
    np.testing.assert_allclose(P[2, 2:5], [0.8648, 0.193143, -0.057943], atol=5e-7)
    np.testing.assert_allclose(coupling.area @ P, [0.085, 0.25, 0.225, 0.2, 0.19, 0.05], atol=1e-15)


@settings(max_examples=60, deadline=None)
@given(upper=knots, lower=knots, angle=st.floats(-3.1, 3.1), shift=st.floats(-0.6, 0.6))
def test_weights_are_exact_on_any_two_meshes(upper, lower, angle, shift):
    mesh = two_sides(upper + shift, lower, angle)
    own, other, coupling = coupled(mesh)
    along = mesh.points @ [np.cos(angle), np.sin(angle)]
    low, high = max(0.0, shift), min(1.0, 1.0 + shift)
    # of both sides the weights sum to one, and linear fields are the same from either side
    # (rounding grows where little of a facet is covered)
    rounding = 1e-13 / coupling.area.min()
    np.testing.assert_allclose(coupling.relative.sum(axis=1), 0.0, atol=rounding)
    np.testing.assert_allclose(coupling.relative @ mesh.points, 0.0, atol=rounding)
    # uniform pressure arrives on both sides as int N over what is covered
    for side, sign in ((own, 1.0), (other, -1.0)):
        order = side.nodes[np.argsort(along[side.nodes])]
        arrives = sign * (coupling.area @ coupling.relative)[order]
        np.testing.assert_allclose(arrives, hat_integrals(np.sort(along[side.nodes]), low, high), atol=1e-10)
    assert coupling.area.min() > 0.0


def test_a_measure_weighs_both_sides_alike():
    """On circles through the points: ``int N 2 pi r`` of the hats on both sides, exactly."""
    x = np.array([0.0, 0.4, 0.7, 1.0])
    mesh = two_sides([0, 0.3, 1.0], x)
    _, other, coupling = coupled(mesh, lambda p, *_: 2 * np.pi * p[..., 0])
    order = other.nodes[np.argsort(mesh.points[other.nodes, 0])]
    h = np.diff(x)
    exact = np.zeros(4)
    exact[:-1] += h * (2 * x[:-1] + x[1:]) / 6
    exact[1:] += h * (x[:-1] + 2 * x[1:]) / 6
    np.testing.assert_allclose(-(coupling.area @ coupling.relative)[order], 2 * np.pi * exact, rtol=1e-13)


def test_a_gap_changes_nothing_but_the_gap():
    """Seen across a gap of constant width the weights are those of closed surfaces."""
    near, far = (
        join({"upper": rectangle(x=[0, 0.3, 0.8, 1], y=[g, 1]), "lower": rectangle(x=[0, 0.5, 1], y=[-1, 0])})
        for g in (0.0, 0.2)
    )
    (*_, one), (*_, two) = coupled(near), coupled(far)
    np.testing.assert_allclose(one.relative.toarray(), two.relative.toarray(), atol=1e-14)
    np.testing.assert_allclose(two.relative @ far.points, [[0, 0.2]] * 4, atol=1e-14)


def test_of_layers_behind_each_other_the_nearest_counts():
    """A plate between two others, one named side through both of its neighbours' tops."""
    lower = join({"near": rectangle(x=[0, 0.4, 1], y=[-0.2, 0]), "far": rectangle(x=[0, 0.7, 1], y=[-0.5, -0.3])})
    tops = np.vstack([lower.boundaries["near.top"], lower.boundaries["far.top"]])
    lower = Mesh(points=lower.points, cells=lower.cells, bodies={"l": np.arange(4)}, boundaries={"top": tops})
    mesh = join({"upper": rectangle(x=[0, 0.5, 1], y=[0.1, 1]), "lower": lower})
    _, _, coupling = coupled(mesh)
    np.testing.assert_allclose(coupling.relative @ mesh.points, [[0, 0.1]] * 3, atol=1e-14)


def on_a_curve(height, counts, cells="quad", gap=0.0):
    """Two blocks that meet on y = height(x), with a gap of a given width along y."""
    meshes = {}
    for name, n, low, off in (("upper", counts[0], 0.0, gap), ("lower", counts[1], -1.0, 0.0)):
        mesh = rectangle(nx=n, ny=1, origin=(0.0, low), cells=cells)
        x, y = mesh.points.T
        meshes[name] = replace(mesh, points=np.column_stack([x, y + height(x) * (1.0 - np.abs(y)) + off]))
    return join(meshes)


def pushes(coupling):
    """Forces of a unit pressure on all nodes, (n, 2)."""
    return np.column_stack([force.sum(axis=0) for force in coupling.forces])


def nodal_pushes(side):
    """``- int N n`` of all nodes of a side, n outward."""
    return -side.nodal(block.outward for block in side.blocks)


@pytest.mark.parametrize("counts", [(4, 4), (3, 7), (7, 4)])
@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_uniform_pressure_presses_every_curve_as_it_is(cells, counts):
    """On the nonmortar side always; on the mortar side its resultant, and all of it where both are one curve."""
    mesh = on_a_curve(lambda x: 0.4 * x**2, counts, cells)
    own, other, coupling = coupled(mesh)
    pushed = pushes(coupling)
    if cells == "quad8" or counts == (4, 4):
        np.testing.assert_allclose(pushed[own.nodes], nodal_pushes(own), atol=1e-12)
        np.testing.assert_allclose(pushed[other.nodes], nodal_pushes(other), atol=1e-12)
        gap = sum(force @ x for force, x in zip(coupling.forces, mesh.points.T, strict=True))
        np.testing.assert_allclose(gap, 0.0, atol=1e-13)
    np.testing.assert_allclose(pushed.sum(axis=0), 0.0, atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(coupling.normals, axis=1), 1.0)


@pytest.mark.parametrize("counts", [(4, 4), (3, 7), (7, 4)])
def test_on_linear_facets_the_forces_of_a_pair_are_in_balance(counts):
    """Across a gap too: neither their sum nor their moment is left, whatever the normals do from facet to facet."""
    mesh = on_a_curve(lambda x: 0.3 * np.sin(3 * x), counts, gap=0.1)
    _, _, coupling = coupled(mesh)
    fx, fy = coupling.forces
    x, y = mesh.points.T
    np.testing.assert_allclose([fx.sum(axis=1), fy.sum(axis=1)], 0.0, atol=1e-15)
    np.testing.assert_allclose(fy @ x - fx @ y, 0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("lower", "said"),
    [
        ({"y": [-5.0, -4.0]}, "the nearest nodes are 4 apart"),
        ({"y": [-5.0, -4.0], "x": [30, 31]}, "looked for up to 0.5 along the normals"),
        ({"y": [-5.0, -4.0]}, "their outward normals 180 degrees"),
    ],
)
def test_sides_too_far_apart_are_refused(lower, said):
    mesh = join({"upper": rectangle(x=[0, 0.5, 1], y=[0, 1]), "lower": rectangle(**{"x": [0, 1], **lower})})
    with pytest.raises(InputError, match=said):
        coupled(mesh)


@pytest.mark.parametrize("cells", ["quad", "quad8"])
@pytest.mark.parametrize("n", [2, 3])
def test_a_tie_of_bodies_that_are_drawn_over_each_other_holds_what_lies_in_one_place(n, cells):
    """Bodies side by side in depth, tied along one edge of both: a plate of both thicknesses, pulled evenly."""
    plates = {
        "lower": sg.rectangle(x=[0.0, 0.5, 1.0], y=[0.0, 0.4, 1.0], cells=cells),
        "other": sg.rectangle(width=1.0, height=1.0, nx=n, ny=2, cells=cells),
    }
    model = sg.Model(
        sg.join(plates),
        kind="plane stress",
        bodies=[sg.Body(name, sg.Elastic(E=100.0, nu=0.0)) for name in plates],
        supports=[sg.Support("other.top", u=(None, 0.0)), sg.Support("other.left", u=(0.0, None))]
        + [sg.Support("lower.left", u=(0.0, None))],
        loads=[sg.Load("lower.top", traction=(0.0, 2.0))],
        contacts=[sg.Contact("lower.bottom", "other.bottom", friction="tied")],
    )
    step = sg.solve(model).steps[-1]
    # the other plate is pressed by as much as the lower one is pulled: its lower edge goes up, the upper one doubly
    top = model.mesh.nodes_of("lower.top")
    np.testing.assert_allclose(step.displacement[top, 1], 2.0 * 2.0 / 100.0, rtol=1e-10)
    if cells == "quad":
        loose = replace(model, contacts=[sg.Contact("lower.bottom", "other.bottom", friction=0.3)])
        with pytest.raises(InputError, match=r"do not face each other"):
            sg.solve(loose)
