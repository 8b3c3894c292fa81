# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives through the events of paths in space: exact on polygons, in increments that end at events on cones."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import signorini as sg
from benchmarks import random_cones
from signorini.derivative.functionals import value
from signorini.model.outputs import Displacement, Stress
from tests.derivative.rig import ball_rig, tilted_rig, twisted_rig
from tests.derivative.test_derivative import with_body, with_contact, with_load

NODE = 4  # sticks at last, after it has slipped
PARAMETERS = {
    "friction.joint": (lambda model, q: with_contact(model, friction=model.contacts[0].friction + q), 1e-6),
    "interference.joint": (lambda model, q: with_contact(model, interference=q), 1e-8),
    "load.pull": (lambda model, q: with_load(model, 0, 1.0 + q), 1e-6),
    "E.block": (lambda model, q: with_body(model, 0, E=1000.0 + q), 1e-3),
    "nu.block": (lambda model, q: with_body(model, 0, nu=0.3 + q), 1e-6),
}
OUTPUTS = [
    sg.pressure("joint").peak,
    sg.traction("joint")[NODE, 0],
    sg.motion("joint")[NODE, 1],
    sg.moment("joint", about=(0.5, 0.6, 0.0), axis=2),
    sg.dissipation(),
    sg.displacement(7, along=(1.0, 0.5, 0.0)),
]


def change_and_differences(model, parameter, outputs):
    change, step = PARAMETERS[parameter]
    views = [sg.solve(change(model, q), tape=True)._taped.view for q in (-step, 0.0, step)]
    below, here, above = ([value(output, view) for output in outputs] for view in views)
    return [((b - a) / step, (c - b) / step) for a, b, c in zip(below, here, above, strict=True)]


@pytest.fixture(scope="module")
def solved():
    model = tilted_rig()
    return model, sg.solve(model, tape=True)


def check(model, solution, outputs, parameter):
    """Every output's derivative by a parameter is that of the whole program, and forwards the same."""
    wanted = change_and_differences(model, parameter, outputs)
    for output, (below, above) in zip(outputs, wanted, strict=True):
        derivative = solution.derivative(output)
        size = abs(derivative.value) / (1000.0 if parameter.startswith("E") else 1.0)
        assert derivative.by(parameter) == pytest.approx(0.5 * (below + above), rel=1e-6, abs=1e-6 * size), output
        if not isinstance(output, Displacement | Stress):
            kind, name = parameter.split(".")
            assert solution.tangent(**{kind: name}).of(output) == pytest.approx(derivative.by(parameter), rel=1e-9)


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_the_derivative_is_that_of_the_whole_program(solved, parameter):
    model, solution = solved
    points = solution._taped.view.points
    corners = [(tangent.closed & (tangent.left == 0)).any() for tangent in (point.states.tangent for point in points)]
    assert any(corners)
    assert {1, 2} <= set(points[-1].states.tangent.left)  # on edges, sticking
    check(model, solution, OUTPUTS, parameter)


@pytest.mark.parametrize(
    ("rig", "parameter"),
    [(ball_rig, "friction.joint"), *((partial(tilted_rig, facets=0), parameter) for parameter in PARAMETERS)],
)
def test_increments_that_end_at_events_on_cones(rig, parameter):
    """Those in which nothing happens keep their length, or have one that friction's turn in others told before."""
    model = rig()
    model = replace(model, steps=[replace(step, increments=None) for step in model.steps])
    solution = sg.solve(model, tape=True)
    points = solution._taped.view.points
    assert any(point.at_event for point in points)
    assert any(point.quiet is not None and (rig is ball_rig or point.quiet.trials) for point in points)
    outputs = [sg.pressure("joint").peak, sg.force("joint", along=(1.0, 0.2, 0.3)), sg.dissipation()]
    check(model, solution, outputs, parameter)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [8, 29])
def test_where_a_pair_begins_to_slip_between_increments_is_found_to_rounding(seed):
    """The length of the increment up to there is that of the event: behind it friction turns, and lengths matter."""
    assert max(random_cones.differences(seed).values()) < 1e-6


@pytest.mark.slow
def test_a_length_that_hangs_on_an_event_beyond_the_increment_is_refused():
    with pytest.raises(sg.InputError, match=r"up to load factor 2\.42.* met which were tried: it is not followed"):
        random_cones.taped(random_cones.random_model(43))


@pytest.mark.parametrize("parameter", ["friction.joint", "load.pull"])
def test_bodies_that_twist(parameter):
    model = twisted_rig()
    solution = sg.solve(model, tape=True)
    assert any(point.at_event for point in solution._taped.view.points)
    node, top = int(solution.contact("joint").node[1]), int(model.mesh.nodes_of("shaft.top")[0])
    outputs = [
        sg.pressure("joint").peak,
        sg.traction("joint")[node, 1],
        sg.dissipation(),
        sg.displacement(top, along=(0.0, 0.2, 1.0)),
        sg.stress("shaft", top, "xx"),
    ]
    check(model, solution, outputs, parameter)


def test_a_shape_of_bodies_that_twist_in_one_increment():
    """Of so few points cells tell what moving their nodes changes: the shear across radii, too."""
    model = twisted_rig()
    model = replace(model, steps=[sg.Step(scale={"pull": 1.0}, increments=1)])
    output, motion = sg.pressure("joint").peak, model.mesh.points * np.array([0.02, 0.03])
    moved = [replace(model.mesh, points=model.mesh.points + part * motion) for part in (-1e-5, 1e-5)]
    low, high = (sg.solve(replace(model, mesh=mesh), tape=True).derivative(output).value for mesh in moved)
    found = sg.solve(model, tape=True).derivative(output).shape(motion)
    assert found == pytest.approx((high - low) / 2e-5, rel=1e-7)


def test_dissipation_is_that_of_the_solution(solved):
    _, solution = solved
    wanted = sum(step.dissipation for step in solution.steps)
    assert solution.derivative(sg.dissipation()).value == pytest.approx(wanted, rel=1e-12)


def test_a_derivative_says_how_far_it_holds():
    """On polygons: beyond its ends there are other events, or others in another order."""
    model = tilted_rig()
    holds = sg.solve(model, tape=True).derivative(OUTPUTS[0]).holds("friction.joint")
    assert holds.low < 0.0 < holds.high

    def states(friction):
        points = sg.solve(with_contact(model, friction=friction), tape=True)._taped.view.points
        return [(point.states.tangent.left.tolist(), point.acting.tolist()) for point in points]

    for end, words in zip((holds.low, holds.high), holds.ends, strict=True):
        assert states(0.2 + 0.9 * end) == states(0.2)
        assert states(0.2 + 1.1 * end) != states(0.2), words


@pytest.fixture(scope="module")
def closing():
    """The same pressed until a pair closes, and not farther."""
    event = sg.solve(tilted_rig()).steps[0].events[-1]
    assert event.what == "closes"
    scale = {"down": event.load_factor, "pull": 0.4 * event.load_factor, "across": 0.0}
    model = tilted_rig(steps=[sg.Step(scale=scale, path="exact")])
    return model, sg.solve(model, tape=True), int(event.nodes[0])


@pytest.mark.parametrize("parameter", ["load.pull", "E.block"])
def test_a_pair_that_closes_at_the_end_has_two_sides(closing, parameter):
    model, solution, node = closing
    outputs = [sg.pressure("joint")[node], sg.traction("joint")[node, 0], sg.dissipation()]
    wanted = change_and_differences(model, parameter, outputs)
    for output, sides in zip(outputs, wanted, strict=True):
        size = max(map(abs, sides))
        assert solution.derivative(output).sides(parameter) == pytest.approx(sides, abs=1e-5 * size)
        with pytest.raises(sg.InputError, match=rf"node {node + 1} of 'joint' closes .* two sides"):
            solution.derivative(output).by(parameter)


def pressed_on_cones(scale, pull):
    return tilted_rig(facets=0, steps=[sg.Step(scale={"down": scale, "pull": pull * scale, "across": 0.0})])


@pytest.fixture(scope="module", params=[(2, 0.1655, 0.4, False), (6, 0.4064, 0.3, True)], ids=["ends", "passes"])
def closing_on_a_cone(request):
    """Pressed on smooth cones until a pair closes, in an increment that its event ends, or that passes over it."""
    node, scale, pull, passes = request.param

    def apart(scale):
        solution = sg.solve(pressed_on_cones(scale, pull), tape=True)
        point = solution._taped.view.points[-1]
        pair = list(solution._taped.view.interface.node[point.system.active]).index(node)
        return solution, point, point.h[0, pair] - point.r[0, pair]

    low, (*_, before) = 0.999 * scale, apart(0.999 * scale)
    for _ in range(6):
        solution, point, here = apart(scale)
        if abs(here) < 1e-14:
            break
        low, scale, before = scale, scale - here * (scale - low) / (here - before), here
    assert point.passes == passes
    return pressed_on_cones(scale, pull), solution, node


@pytest.mark.parametrize("parameter", ["load.pull", "E.block"])
def test_a_pair_that_closes_on_its_cone_at_the_end_has_two_sides(closing_on_a_cone, parameter):
    """Others slip by then, and where it closes it slips from there on, in the direction of the rates."""
    model, solution, node = closing_on_a_cone
    outputs = [sg.pressure("joint")[node], sg.traction("joint")[node, 0], sg.traction("joint")[node, 1]]
    outputs += [sg.pressure("joint").peak, sg.dissipation()]
    wanted = change_and_differences(model, parameter, outputs)
    for output, sides in zip(outputs, wanted, strict=True):
        size = max(map(abs, sides))
        assert solution.derivative(output).sides(parameter) == pytest.approx(sides, abs=1e-5 * size)
