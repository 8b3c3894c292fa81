# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives by the place of every node: their sum along a motion is what the bodies moved along it say."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.fem.displacement_products import Products
from signorini.fem.node_work import add_node_work
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.gallery.cylinder import zhu_cylinder
from signorini.model.outputs import WeightedSum
from tests.derivative.rig import STEPS, ball_rig, rig
from tests.derivative.test_derivative import outputs


def curved(kind="plane strain", **law):
    """The rig with a curved block: facets of a flat side stand for themselves until they bend."""
    model = rig(kind, **law)
    x, y = model.mesh.points.T
    middle = 3.0 if kind == "axisymmetric" else 0.0
    block = np.arange(len(x)) >= model.mesh.nodes_of("block.bottom").min()
    lower = np.where(block, 0.03 * (x - middle + 0.05) ** 2 * y, 0.0)
    return replace(model, mesh=replace(model.mesh, points=np.column_stack([x, y - lower])))


def check(solution, output, tolerance=1e-8):
    """Along a motion of all nodes: plane, axisymmetric or in space."""
    derivative = solution.derivative(output)
    motion = np.random.default_rng(3).standard_normal(solution.model.mesh.points.shape)
    along = float(np.vdot(derivative.nodes, motion))
    assert derivative.nodes.shape == motion.shape
    assert along == pytest.approx(derivative.shape(motion), rel=tolerance, abs=tolerance * abs(derivative.value))
    return derivative


FAMILIES = {
    "quad": ("plane strain", lambda: sg.rectangle(nx=2, ny=2, width=2.0, origin=(1.0, 0.0))),
    "around": ("axisymmetric", lambda: sg.rectangle(nx=2, ny=1, width=2.0, origin=(1.0, 0.0))),
    "twist": ("axisymmetric twist", lambda: sg.rectangle(nx=2, ny=1, width=2.0, origin=(1.0, 0.0))),
    "hexahedron": ("", lambda: sg.box(x=[0.0, 1.0], y=[0.0, 1.0], z=[0.0, 0.5, 1.0])),
}


@pytest.mark.parametrize("formulation", ["standard", "incompatible", "mean dilatation"])
@pytest.mark.parametrize("family", FAMILIES)
def test_the_work_of_stresses_by_the_place_of_every_node(family, formulation):
    kind, make = FAMILIES[family]
    mesh, random = make(), np.random.default_rng(1)
    body = sg.Body(next(iter(mesh.bodies)), sg.Elastic(E=900.0, nu=0.3), formulation=formulation)
    model = sg.Model(mesh, bodies=[body], **({"kind": kind} if kind else {}))
    space = make_space(mesh, kind=model.kind)
    space = space.at(mesh.points + 0.03 * random.standard_normal(mesh.points.shape), np.zeros(0))
    w, u = random.standard_normal((2, space.number_of_dofs, 3))
    found, motion = np.zeros_like(mesh.points), random.standard_normal(mesh.points.shape)
    add_node_work(found, space, model, Products.of(w, u))
    high, low = (
        np.vdot(w, stiffness(space.at(space.mesh.points + step * motion, np.zeros(0)), model) @ u)
        for step in (1e-6, -1e-6)
    )
    assert float(np.vdot(found, motion)) == pytest.approx((high - low) / 2e-6, rel=1e-8)


@pytest.mark.parametrize(
    ("kind", "cells"),
    [
        *(("plane stress", cells) for cells in ("triangle", "quad8")),
        *((f"axisymmetric{twist}", cells) for cells in ("quad", "triangle6") for twist in ("", " twist")),
        *(("3d", cells) for cells in ("tetra", "hexahedron20")),
    ],
)
def test_the_work_of_many_displacements_is_the_sum_of_their_works(kind, cells):
    """Few go through slopes, many through products of all dofs of a cell; both bodies have more cells than lanes."""
    if kind == "3d":
        one, beside = (
            sg.box(x=np.linspace(low, low + 1.0, 6), y=[0, 1, 2], z=[0, 1, 2], cells=cells) for low in (0, 3)
        )
    else:
        one, beside = (sg.rectangle(nx=9, ny=8, origin=(low, 0.0), cells=cells) for low in (1.0, 3.0))
    mesh, random = sg.join({"one": one, "beside": beside}), np.random.default_rng(1)
    soft = sg.Orthotropic(E1=90.0, E2=40.0, E3=50.0, nu12=0.3, nu13=0.2, nu23=0.1, G12=20.0, G13=25.0, G23=15.0)
    bodies = [sg.Body("one", sg.Elastic(E=900.0, nu=0.3)), sg.Body("beside", soft)]
    model = sg.Model(mesh, bodies=bodies, kind=kind)
    space = make_space(mesh, kind=kind)
    count = space.blocks[0].cells.shape[1] + 1
    w, u = random.standard_normal((2, space.number_of_dofs, count))
    many, each = np.zeros_like(mesh.points), np.zeros_like(mesh.points)
    add_node_work(many, space, model, Products.of(w, u))
    for k in range(count):
        add_node_work(each, space, model, Products.of(w[:, k, None], u[:, k, None]))
    assert each == pytest.approx(many, rel=0, abs=1e-12 * np.abs(many).max())


@pytest.mark.slow
def test_nodes_add_up_to_a_shape_for_every_output():
    """Of a sum of all kinds, each of about one."""
    solution = sg.solve(curved(), tape=True)
    every = outputs(solution.model).values()
    parts = tuple((1.0 / solution.derivative(output).value, output) for output in every)
    check(solution, WeightedSum(parts=parts))


def test_a_shape_of_two_increments_takes_the_displacements_that_they_found():
    """Beside what nodes have, which substitutes combinations of them back; also where an output pulls on bodies."""
    press, pull = (replace(step, path="increments", increments=1) for step in STEPS[:2])
    solution = sg.solve(curved(steps=[press, pull]), tape=True)
    assert [point.displacement is None for point in solution._taped.view.points] == [False, False]
    names = "peak", "dissipation", "displacement", "stress"
    parts = tuple(
        (1.0 / solution.derivative(output).value, output) for output in map(outputs(solution.model).get, names)
    )
    check(solution, WeightedSum(parts=parts))


@pytest.mark.slow
def test_discs_have_them_and_radii_on_the_axis_stay():
    ring = curved("axisymmetric", steps=STEPS[:2])
    x, y = ring.mesh.points.T
    disc = replace(ring, mesh=replace(ring.mesh, points=np.column_stack([x - x.min(), y])))
    derivative = sg.solve(disc, tape=True).derivative(sg.halfwidth("joint"))
    on_axis = disc.mesh.points[:, 0] == 0.0
    motion = np.random.default_rng(3).standard_normal(disc.mesh.points.shape)
    motion[on_axis, 0] = 0.0
    assert float(np.vdot(derivative.nodes, motion)) == pytest.approx(derivative.shape(motion), rel=1e-7)
    assert not derivative.nodes[on_axis, 0].any()
    assert derivative.nodes[on_axis, 1].any()


@pytest.mark.slow
def test_loads_foundations_and_limits_of_the_friction_follow_their_nodes():
    model = curved(adhesion=0.1, shear_limit=5.0)
    loads = [
        sg.Load("pad.left", force=(6.0, 0.0), name="pull"),
        sg.Load("block.right", pressure=lambda x: 2.0 + x[:, 1], name="side"),
        sg.Load("block", temperature=lambda x: 20.0 + 3.0 * x[:, 0], name="heat"),
        sg.Load("block", body_force=(0.3, -1.0), name="weight"),
    ]
    springs = [sg.Foundation("block.left", normal_stiffness=30.0, tangential_stiffness=7.0)]
    steps = [
        sg.Step(name="press", scale={"down": 1.0, "side": 0.5, "heat": 0.5, "weight": 0.5}, increments=2),
        sg.Step(name="pull", scale={"pull": 0.3}, increments=1),
    ]
    solution = sg.solve(replace(model, loads=loads, foundations=springs, steps=steps), tape=True)
    check(solution, sg.pressure("joint").peak, 1e-7)


def test_a_side_on_an_obstacle_has_them():
    derivative = check(sg.solve(zhu_cylinder(), tape=True), sg.force("foundation", along=(1, 0)))
    # all lengths by one factor are the force by its inverse, but for that factor of the answer
    larger = float(np.vdot(derivative.nodes, zhu_cylinder().mesh.points))
    assert larger == pytest.approx(derivative.value - derivative.load["cut"], rel=1e-7)
    sides = np.zeros(len(derivative.nodes), dtype=bool)
    sides[np.unique(np.concatenate([np.ravel(part) for part in zhu_cylinder().mesh.boundaries.values()]))] = True
    assert np.abs(derivative.nodes[sides]).max() > 10.0 * np.abs(derivative.nodes[~sides]).max()


@pytest.mark.slow
def test_space_has_them():
    """Both sides curved, on four cells each that do not match."""
    rigged = ball_rig(increments=1)
    block = sg.box(x=np.linspace(-0.1, 1.1, 3), y=np.linspace(-0.2, 1.1, 3), z=[0.0, 1.0])
    x, y, z = block.points.T
    domed = np.column_stack([x, y, z - 0.05 * z * ((x - 0.4) ** 2 + (y - 0.55) ** 2)])
    pad = sg.box(x=np.linspace(0, 1, 3), y=np.linspace(0, 1, 3), z=[1.0, 2.0])
    pad = replace(pad, points=rigged.mesh.points[: len(pad.points)])
    model = replace(rigged, mesh=sg.join({"pad": pad, "block": replace(block, points=domed)}))
    check(sg.solve(model, tape=True), sg.pressure("joint").peak, 1e-7)


def test_what_friction_takes_without_friction_is_moved_by_no_node():
    model = rig(friction=0.0, steps=[sg.Step(scale={"down": 1.0, "pull": 0.0, "heat": 0.0}, increments=1)])
    model = replace(model, supports=[replace(model.supports[0], u=(0.0, -0.02)), model.supports[1]])
    assert not sg.solve(model, tape=True).derivative(sg.dissipation()).nodes.any()


@pytest.mark.slow
def test_a_flat_facet_opposite_a_domed_side_has_them():
    """Both axes in its plane are followed by its normal alike; which of them tangents go by is not moved by nodes."""
    pad, block = ball_rig(increments=1), sg.box(x=[-0.1, 1.1], y=[-0.2, 1.1], z=[0.0, 1.0])
    x, y, z = block.points.T
    domed = replace(block, points=np.column_stack([x, y, z - 0.05 * z * ((x - 0.4) ** 2 + (y - 0.55) ** 2)]))
    upper = sg.box(x=np.linspace(0, 1, 3), y=np.linspace(0, 1, 3), z=[1.0, 2.0])
    upper = replace(upper, points=pad.mesh.points[: len(upper.points)])
    model = replace(
        pad,
        mesh=sg.join({"pad": upper, "block": domed}),
        supports=[replace(pad.supports[0], u=(0.0, 0.0, -0.06)), pad.supports[1]],
        contacts=[replace(pad.contacts[0], nonmortar="block.top", mortar="pad.bottom")],
    )
    solution, motion = sg.solve(model, tape=True), np.random.default_rng(3).standard_normal(model.mesh.points.shape)
    output, step = sg.force("joint", along=(1.0, 0.0, 0.3)), 1e-6
    high, low = (
        sg.solve(replace(model, mesh=replace(model.mesh, points=model.mesh.points + q * motion)))
        .derivative(output)
        .value
        for q in (step, -step)
    )
    derivative = solution.derivative(output)
    wanted = (high - low) / (2.0 * step)
    assert derivative.shape(motion) == pytest.approx(wanted, rel=1e-6)
    assert float(np.vdot(derivative.nodes, motion)) == pytest.approx(wanted, rel=1e-6)


def test_what_is_held_by_its_place_is_refused():
    model = rig()
    down = sg.Support("pad.top", u=(None, lambda x: -0.02 - 0.001 * x[:, 0]), name="down")
    derivative = sg.solve(replace(model, supports=[down, model.supports[1]]), tape=True).derivative(sg.dissipation())
    with pytest.raises(sg.InputError, match="supports that vary hold nodes by where they are"):
        assert derivative.nodes.any()
