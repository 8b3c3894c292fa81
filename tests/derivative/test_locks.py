# SPDX-License-Identifier: BSD-3-Clause
"""Bolts that lock between steps, against central differences of the whole program; what else of supports is refused."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import signorini as sg
from signorini.derivative.functionals import value
from tests.engine.test_bolts import flange

BOLT = {"hold": ["left.cut"]}


def tightened(**way):
    """Two bolts through a plate, each locked when the next is tightened; then the plate is pulled to and fro."""
    model = flange("left", "right")
    first, second, last = (replace(step, **way) for step in model.steps)
    pull = sg.Load("plate.left", traction=(0.3, 0.02), name="pull")
    none = {"pull": 0.0}
    steps = [
        replace(first, scale={**first.scale, **none}),
        replace(second, scale={**second.scale, **none}),
        replace(last, scale={"pull": 1.0}),
        sg.Step(scale={"pull": -0.7}, **way),
    ]
    (bed, *ties) = model.contacts
    return replace(model, loads=[pull], contacts=[replace(bed, name="bed", interference=0.0), *ties], steps=steps)


def spread(facets):
    """A cut block that its bolt draws apart between a fixed top and a rigid plane, and that is then pushed sideways."""
    block = sg.box(x=np.linspace(0, 1, 2), y=np.linspace(0, 1.2, 2), z=[0.0, 0.5, 1.0])
    x, y, z = block.points.T
    gap = 0.002 + 0.01 * x + 0.006 * y + 0.004 * x * y
    block = replace(block, points=np.column_stack([x, y, z + gap * np.maximum(1.0 - 2.0 * z, 0.0)]))
    way = {"path": "exact"} if facets else {"increments": 2}
    return sg.Model(
        sg.cut(block, "cut", body="block", point=(0.0, 0.0, 0.5), normal=(0.0, 0.0, 1.0)),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0, 0.0))],
        foundations=[sg.Foundation("bottom", normal_stiffness=20.0)],
        loads=[sg.Load("right", traction=(9.0, 4.0, 0.0), name="pull")],
        contacts=[
            sg.Contact("bottom", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)), friction=0.3, facets=facets, name="bed")
        ],
        bolts=[sg.Bolt("cut", force=-40.0, name="left.cut")],
        steps=[
            sg.Step(scale={"left.cut": 1.0, "pull": 0.1}, **way),
            sg.Step(**BOLT, scale={"pull": 1.0}, **way),
            sg.Step(scale={"pull": 0.3}, **way),
        ],
    )


def ring(**way):
    """A ring that is cut through, drawn apart by its bolt onto a plane and then pushed outward."""
    block = sg.rectangle(nx=4, ny=4, width=1.0, origin=(2.0, 0.0))
    x, y = block.points.T
    gap = 0.002 + 0.01 * (x - 2.0) + 0.006 * (x - 2.0) ** 2
    block = replace(block, points=np.column_stack([x, y + gap * np.maximum(1.0 - 2.0 * y, 0.0)]))
    return sg.Model(
        sg.cut(block, "cut", body="block", point=(2.0, 0.5), normal=(0.0, 1.0)),
        kind="axisymmetric",
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0))],
        foundations=[sg.Foundation("bottom", normal_stiffness=20.0)],
        loads=[sg.Load("right", traction=(9.0, 4.0), name="pull")],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.3, name="bed")],
        bolts=[sg.Bolt("cut", force=-300.0, name="left.cut")],
        steps=[
            sg.Step(scale={"left.cut": 1.0, "pull": 0.1}, **way),
            sg.Step(**BOLT, scale={"pull": 1.0}, **way),
            sg.Step(scale={"pull": 0.3}, **way),
        ],
    )


def with_material(model, q, **step):
    bodies = list(model.bodies)
    ((key, size),) = step.items()
    material = bodies[-1].material
    bodies[-1] = replace(bodies[-1], material=replace(material, **{key: getattr(material, key) + size * q}))
    return replace(model, bodies=bodies)


def with_contact(model, **changed):
    return replace(model, contacts=[replace(model.contacts[0], **changed), *model.contacts[1:]])


def with_bolt(model, factor):
    first, *others = model.bolts
    return replace(model, bolts=[replace(first, force=factor * first.force), *others])


def with_pull(model, factor):
    (load,) = model.loads
    return replace(model, loads=[replace(load, traction=tuple(factor * part for part in load.traction))])


CHANGES = {
    "friction.bed": (1e-5, lambda m, q: with_contact(m, friction=0.3 + 1e-5 * q)),
    "load.left.cut": (1e-5, lambda m, q: with_bolt(m, 1.0 + 1e-5 * q)),
    "load.pull": (1e-5, lambda m, q: with_pull(m, 1.0 + 1e-5 * q)),
    "E": (1e-2, lambda m, q: with_material(m, q, E=1e-2)),
    "nu": (1e-5, lambda m, q: with_material(m, q, nu=1e-5)),
}
MODELS = {
    "plane": lambda: tightened(path="exact"),
    "increments": lambda: tightened(increments=2),
    "polygon": lambda: spread(8),
    "ring": lambda: ring(path="exact"),
    "ring in increments": lambda: ring(increments=2),
    "cone": lambda: spread(0),
}


def outputs_of(model):
    d = model.dimension
    node = int(model.mesh.nodes["left.cut" if "left.cut" in model.mesh.nodes else "cut"][0])
    shortening = sg.displacement(node, along=(1.0,) + (0.0,) * (d - 1))
    along = (0.0, 1.0) if model.axisymmetric else (1.0, 0.3, 0.2)[:d]
    found = [sg.pressure("bed").peak, sg.force("bed", along=along), sg.dissipation()]
    return [*found, sg.dissipation().after(2.0), shortening, sg.stress(model.bodies[0].name, 0, "yy")]


@pytest.mark.parametrize("name", ["cone", *(pytest.param(name, marks=pytest.mark.slow) for name in (*MODELS,)[:-1])])
def test_what_is_given_changes_what_locked_bolts_are(name):
    model = MODELS[name]()
    solution, outputs = sg.solve(model, tape=True), outputs_of(model)
    derivatives = [solution.derivative(output) for output in outputs]
    for given, (step, change) in CHANGES.items():
        parameter = given if "." in given else f"{given}.{model.bodies[-1].name}"
        low, high = (sg.solve(change(model, q), tape=True)._taped.view for q in (-1.0, 1.0))
        tangent = solution.tangent(**dict([parameter.split(".", 1)]))
        for output, derivative in zip(outputs, derivatives, strict=True):
            found, wanted = derivative.by(parameter), (value(output, high) - value(output, low)) / (2.0 * step)
            scale = derivative.value / {"E": 1000.0, "nu": 0.3}.get(given, 1.0)
            assert found == pytest.approx(wanted, rel=1e-6, abs=1e-6 * abs(scale)), (parameter, output)
            if not isinstance(output, type(outputs[-2]) | type(outputs[-1])):
                assert tangent.of(output) == pytest.approx(found, rel=1e-8, abs=1e-10 * abs(scale))


def test_gaps_and_shapes_change_what_locked_bolts_are():
    model, size = tightened(path="exact"), 1e-4
    solution, output = sg.solve(model, tape=True), sg.force("bed", along=(1.0, 0.3))
    derivative = solution.derivative(output)
    with pytest.raises(sg.InputError, match=r"touches without a force .* derivatives node by node have two sides"):
        assert derivative.gap["bed"].any()
    apart = sg.solve(ring(path="exact"), tape=True).derivative(sg.pressure("bed").peak)
    assert apart.gap["bed"].sum() == pytest.approx(-apart.interference["bed"], rel=1e-10)
    motion = np.zeros_like(model.mesh.points)
    plate = model.mesh.points[:, 1] == 0.5
    motion[plate] = np.column_stack([0.2 * np.sin(model.mesh.points[plate, 0]), np.ones(int(plate.sum()))])
    ends = []
    for way in (-size, size):
        mesh = replace(model.mesh, points=model.mesh.points + way * motion)
        ends.append(value(output, sg.solve(replace(model, mesh=mesh), tape=True)._taped.view))
    assert derivative.shape(motion) == pytest.approx((ends[1] - ends[0]) / (2.0 * size), rel=1e-6)
    with pytest.raises(sg.InputError, match="equations or supports that vary hold nodes"):
        _ = derivative.nodes


def test_how_far_a_derivative_holds_is_seen_through_locks():
    """Just inside of the interval the sequence of events is that of the history, just beyond it is another."""
    model = tightened(path="exact")
    found = sg.solve(model, tape=True).derivative(sg.dissipation()).holds("load.left.cut")

    def happens(q):
        steps = sg.solve(with_bolt(model, 1.0 + q)).steps
        return [[(event.contact, event.nodes, event.what) for event in step.events] for step in steps]

    events = [happens(q) for q in (0.0, 0.9 * found.high, 1.1 * found.high)]
    assert events[0] == events[1] != events[2]


def test_a_history_that_is_cut_has_the_derivatives_of_the_whole():
    model, output = tightened(path="exact"), sg.force("bed", along=(1.0, 0.3))
    first, second, *others = model.steps
    begun = sg.solve(replace(model, steps=[first]), tape=True)
    wanted = sg.solve(model, tape=True).derivative(output)
    found = sg.solve(replace(model, steps=[second, *others]), start=begun, tape=True).derivative(output)
    for name in ("friction.bed", "load.left.cut", "load.right.cut", "load.pull", "E.bed"):
        assert found.by(name) == pytest.approx(wanted.by(name), rel=1e-9), name


def test_a_function_of_the_preload_has_its_gradient():
    f = sg.prepare(tightened(path="exact")).function(["load.left.cut", "friction.bed"], [sg.pressure("bed").peak])
    at, step = np.array([1.1, 0.28]), 1e-6
    wanted = [(f.values(at + part) - f.values(at - part)) / (2.0 * step) for part in step * np.eye(2)]
    assert_allclose(f.jacobian(at), np.column_stack(wanted), rtol=1e-6)


REFUSED = {
    "bolts that let go": (
        sg.Step(release=["left.cut"]),
        "step 3: .* but for bolts that lock$",
    ),
    "bolts that go back": (sg.Step(restore=["left.cut"]), "derivatives do not know locked bolts that a step restores"),
    "supports": (sg.Step(release=["bed.bottom"]), "supports but for bolts that lock"),
    "contacts": (sg.Step(inactive=["bed"]), "step 3: derivatives do not know contacts that change from step to step"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_other_changes_are_refused_by_name(name):
    model, (step, words) = tightened(path="exact"), REFUSED[name]
    if name == "supports":  # one of two that hold the bed
        model = replace(model, supports=[*model.supports, sg.Support("bed.left", u=(0.0, None))])
        step = replace(step, release=[model.supports[-1].label])
    solution = sg.solve(replace(model, steps=[*model.steps[:2], step]), tape=True)
    with pytest.raises(sg.InputError, match=words):
        solution.derivative(sg.pressure("bed").peak)


def test_an_accuracy_of_an_output_does_not_pass_over_locks():
    with pytest.raises(sg.InputError, match="does not know bolts that lock"):
        sg.solve(tightened(path="exact"), accuracy=sg.Accuracy(of=sg.force("bed", along=(0.0, 1.0)), error=0.2))
