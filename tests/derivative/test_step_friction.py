# SPDX-License-Identifier: BSD-3-Clause
"""Coefficients of friction that steps give are parameters by the name of contact and step, each where it holds."""

from dataclasses import replace

import pytest

import signorini as sg
from signorini.derivative.functionals import value
from tests.derivative.rig import STEPS, rig, tilted_rig

GIVEN = {"joint": 0.3, "joint@turn": 0.4, "joint@step 3": 0.28}
STEP = 1e-6


def in_the_plane(own, second, third):
    press, pull, back = STEPS
    steps = [press, replace(pull, name="turn", friction={"joint": second}), replace(back, name="")]
    steps[2] = replace(steps[2], scale={"pull": -0.5}, friction={"joint": third})
    return rig(friction=own, steps=steps)


def in_space(own, second, third):
    pulled = {"down": 1.0, "pull": 0.4}
    steps = [
        sg.Step(name="press", scale=pulled, path="exact"),
        sg.Step(name="turn", scale={"pull": 0.1, "across": 0.5}, friction={"joint": second}, path="exact"),
        sg.Step(scale={"across": 0.8}, friction={"joint": third}, path="exact"),
    ]
    return tilted_rig(friction=own, steps=steps)


@pytest.mark.parametrize("made", [in_the_plane, in_space])
def test_every_coefficient_has_its_derivative(made):
    solution = sg.solve(made(*GIVEN.values()), tape=True)
    outputs = [sg.pressure("joint").peak, sg.force("joint", along=(1.0, 0.2, 0.3)[: 2 + (made is in_space)])]
    outputs += [sg.dissipation(), sg.dissipation().after(2.0)]
    derivatives = [solution.derivative(output) for output in outputs]
    assert set(derivatives[0].friction) == set(GIVEN)
    assert derivatives[3].friction["joint@step 3"] == 0.0
    for k, name in enumerate(GIVEN):
        changed = [made(*(given + q * (i == k) for i, given in enumerate(GIVEN.values()))) for q in (-STEP, STEP)]
        low, high = (sg.solve(model, tape=True)._taped.view for model in changed)
        tangent = solution.tangent(friction=name)
        for output, derivative in zip(outputs, derivatives, strict=True):
            wanted = (value(output, high) - value(output, low)) / (2.0 * STEP)
            assert derivative.friction[name] == pytest.approx(wanted, rel=1e-6, abs=1e-6 * abs(derivative.value)), name
            if output.load_factor is None:
                assert tangent.of(output) == pytest.approx(derivative.friction[name], rel=1e-9, abs=1e-12)


def test_what_holds_and_what_functions_refuse():
    model = in_the_plane(*GIVEN.values())
    holds = sg.solve(model, tape=True).derivative(sg.dissipation()).holds("friction.joint@turn")
    assert holds.low < 0.0 < holds.high
    with pytest.raises(sg.InputError, match=r"'friction\.joint@turn' is no input that can change"):
        sg.prepare(model).function(["friction.joint@turn"], [sg.dissipation()])
