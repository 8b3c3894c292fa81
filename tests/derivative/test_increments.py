# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives through increments: on the circular cone in space, in the plane, and without friction."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.derivative.functionals import value
from tests.derivative.rig import ball_rig, rig


def with_contact(model, **changed):
    return replace(model, contacts=[replace(model.contacts[0], **changed)])


def with_modulus(model, E):
    body = model.bodies[0]
    return replace(model, bodies=[replace(body, material=replace(body.material, E=E)), model.bodies[1]])


def checked(model, outputs, change, parameter, step):
    """Every output's derivative by a parameter is that of the whole program, and forwards the same."""
    solution = sg.solve(model, tape=True)
    low, high = (sg.solve(change(q), tape=True)._taped.view for q in (-step, step))
    for output in outputs:
        derivative = solution.derivative(output)
        wanted = (value(output, high) - value(output, low)) / (2.0 * step)
        assert derivative.by(parameter) == pytest.approx(wanted, rel=2e-7, abs=1e-9 * abs(derivative.value)), output
        kind, name = parameter.split(".")
        if not isinstance(output, type(sg.displacement(0, (0, 0)))):
            assert solution.tangent(**{kind: name}).of(output) == pytest.approx(derivative.by(parameter), rel=1e-9)
    return solution


@pytest.mark.parametrize("parameter", ["friction", "interference"])
def test_pairs_that_turn_on_their_cones(parameter):
    model = ball_rig()
    contact = sg.solve(model).contact("joint")
    assert (contact.status == "slip").any()
    node = int(contact.node[np.argmax(np.linalg.norm(contact.slip, axis=1))])
    outputs = [
        sg.pressure("joint").peak,
        sg.traction("joint")[node, 0],
        sg.traction("joint")[node, 1],
        sg.motion("joint")[node, 1],
        sg.force("joint", along=(1.0, 0.2, 0.3)),
        sg.moment("joint", about=(0.5, 0.2, 1.0), axis=1),
        sg.dissipation("joint"),
        sg.displacement(0, along=(1.0, 0.5, 0.0)),
    ]
    given = getattr(model.contacts[0], parameter)
    step = {"friction": 1e-5, "interference": 1e-7}[parameter]
    checked(
        model, outputs, lambda q: with_contact(model, **{parameter: (given or 0.0) + q}), f"{parameter}.joint", step
    )


def test_a_modulus_in_space():
    model = ball_rig(increments=1)
    outputs = [sg.pressure("joint").peak, sg.force("joint", along=(1.0, 0.2, 0.3)), sg.stress("block", 20, "xz")]
    solution = sg.solve(model, tape=True)
    low, high = (sg.solve(with_modulus(model, 2000.0 + q), tape=True)._taped.view for q in (-0.02, 0.02))
    for output in outputs:
        derivative = solution.derivative(output)
        wanted = (value(output, high) - value(output, low)) / 0.04
        assert derivative.E["pad"] == pytest.approx(wanted, rel=2e-7, abs=1e-10 * abs(derivative.value))


@pytest.mark.parametrize("friction", [0.35, 0.0])
def test_increments_in_the_plane(friction):
    steps = [sg.Step(scale={"down": 1.0, "heat": 0.3}, increments=2), sg.Step(scale={"pull": 1.0}, increments=3)]
    model = rig(friction=friction, steps=steps)
    model = replace(model, supports=[replace(model.supports[0], u=(0.0, -0.02)), model.supports[1]])
    node = int(model.mesh.nodes_of("pad.bottom")[1])
    outputs = [sg.pressure("joint").peak, sg.motion("joint")[node], sg.displacement(0, along=(1.0, 0.0))]
    solution = checked(model, outputs, lambda q: with_contact(model, interference=q), "interference.joint", 1e-7)
    holds = solution.derivative(outputs[0]).holds("interference.joint")
    assert holds.low < 0.0 < holds.high
