# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield in frictional contact: in other units, and seen from elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.model.obstacle import Plane
from tests.helpers.changed_models import mapped, rescaled

LAW = sg.Plastic([(0.0, 1.0), (0.005, 1.2)], hardening=5.0, backstresses=[(40.0, 20.0)])


def dragged(d):
    """A block that is pressed on a rough plane and dragged along it, back a little, and farther, by its whole top."""
    grids = [np.linspace(0.0, 2.0, 5), np.linspace(0.0, 1.5, 3), np.linspace(0.0, 1.0, 3)]
    mesh = sg.rectangle(x=grids[0], y=grids[2]) if d == 2 else sg.box(x=grids[0], y=grids[1], z=grids[2])
    way = (0.015, -0.02) if d == 2 else (0.015, 0.003, -0.02)
    return sg.Model(
        mesh,
        bodies=[sg.Body("block", sg.Elastic(E=200.0, nu=0.3, plastic=LAW))],
        supports=[sg.Support("top", u=way, name="drag")],
        contacts=[sg.Contact("bottom", Plane((0.0,) * d, (*(0.0,) * (d - 1), 1.0)), friction=0.3, name="foot")],
        steps=[sg.Step(scale={"drag": part}, increments=2) for part in (1.0, 0.7, 1.3)],
    )


def turned(d):
    """An orthogonal matrix without a zero."""
    Q = np.linalg.qr(np.random.default_rng(4).normal(size=(d, d)))[0]
    return Q * np.sign(np.linalg.det(Q))


@pytest.mark.parametrize("d", [2, 3])
def test_axes_change_nothing(d):
    model = dragged(d)
    one, two = sg.solve(model), sg.solve(mapped(model, turned(d), np.arange(1.0, d + 1.0)))
    flowed = one.end.state.plastic.equivalent
    assert flowed.max() > 0.01
    np.testing.assert_allclose(two.end.state.plastic.equivalent, flowed, rtol=0, atol=1e-8 * flowed.max())
    moved = one.last.displacement @ turned(d).T
    np.testing.assert_allclose(two.last.displacement, moved, rtol=0, atol=1e-8 * np.abs(moved).max())
    assert two.end.state.plastic.dissipation == pytest.approx(one.end.state.plastic.dissipation, rel=1e-7)


@pytest.mark.parametrize("d", [2, 3])
def test_units_change_nothing(d):
    model, length, modulus = dragged(d), 1e-3, 2.5e7
    other = rescaled(model, length=length, modulus=modulus)
    law = sg.Plastic(
        [(p, modulus * stress) for p, stress in LAW.curve],
        hardening=modulus * LAW.hardening,
        backstresses=[(modulus * C, gamma) for C, gamma in LAW.backstresses],
    )
    (body,) = other.bodies
    other = replace(other, bodies=[replace(body, material=replace(body.material, plastic=law))])
    one, two = sg.solve(model).end.state.plastic, sg.solve(other).end.state.plastic
    np.testing.assert_allclose(two.equivalent, one.equivalent, rtol=0, atol=1e-8 * one.equivalent.max())
    np.testing.assert_allclose(two.back, modulus * one.back, rtol=0, atol=1e-8 * modulus * np.abs(one.back).max())
    assert two.dissipation == pytest.approx(modulus * length**d * one.dissipation, rel=1e-7)
