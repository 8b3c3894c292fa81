# SPDX-License-Identifier: BSD-3-Clause
"""Forwards and backwards through the events of a path against complex steps of a replayed one."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.derivative.adjoint_terms import BoundTerm, Weights
from signorini.derivative.block_steps import BlockSteps
from signorini.derivative.forward import forward
from signorini.derivative.recursion import backward
from signorini.derivative.tape_points import tape_points
from signorini.gallery.cylinder import zhu_cylinder
from tests.derivative.replay import replayed, replayed_in_space
from tests.derivative.rig import rig, tilted_rig

STEP = 1e-30  # imaginary: no digit is lost
RAW = np.random.default_rng(7)


class Direction:
    """Compliances, gaps and coefficients that change, each pair by its own number."""

    def __init__(self, system, compliance=0.0, gap=0.0, friction=0.0):
        A, R, n = system.law.image.A, system.law.image.R, system.pairs
        rng = np.random.default_rng(3)
        change = rng.standard_normal(A.shape) * 0.1 * np.abs(A).max()
        project = np.eye(len(A)) - R @ R.T
        self.A = compliance * project @ (change + change.T) @ project
        self.gap = gap * rng.standard_normal(n) * system.law.scale
        self.mu = friction * rng.standard_normal(n)
        self.system = system

    def moved(self, points):
        found = []
        for point in points:
            motion = (self.A @ point.r.ravel()).reshape(point.r.shape)
            motion[0] += self.gap
            found.append((motion / self.system.root, np.zeros(self.system.motions)))
        return found

    def bound(self, system):
        term = BoundTerm.of(system.law.pieces)
        term.slopes[0] = self.mu
        return term

    def replay(self, points, legs):
        """Motions and forces as they change, in the units of the problem, and the parts of the legs."""
        system, R = self.system, self.system.law.image.R
        gap = np.append(self.gap, np.zeros(len(R) - len(self.gap)))
        moved = np.append(gap - R @ (R.T @ gap), np.zeros(R.shape[1]))
        free = system.free
        ends = [(free(leg.start.b) + 1j * STEP * moved, free(leg.segment.end.b) + 1j * STEP * moved) for leg in legs]
        A, mu = system.law.image.A + 1j * STEP * self.A, system.law.mu + 1j * STEP * self.mu
        space = (system.law.section.sides[0],) if system.directions == 3 else ()
        replay = replayed_in_space if space else replayed
        return [(h / system.root, r * system.root, part) for h, r, part in replay(points, A, R, ends, mu, *space)]


@pytest.fixture(scope="module", params=["cylinder", "rig", "space"])
def path(request):
    if request.param == "cylinder":
        steps = [sg.Step(scale={"cut": factor}, path="exact") for factor in (1.0, 0.3, 1.5)]
        model = zhu_cylinder(friction=0.2, steps=steps)
    elif request.param == "space":
        model = tilted_rig()
    else:
        model = rig()
        held = replace(model.supports[0], u=(0.0, -0.02))
        model = replace(model, supports=[held, model.supports[1]])
    tape = sg.solve(model, tape=True).tape
    return tape_points(tape), tape.legs


@pytest.mark.parametrize("parameter", ["compliance", "gap", "friction"])
def test_both_ways_are_those_of_a_complex_step(path, parameter):
    points, legs = path
    system = points[-1].system
    direction = Direction(system, **{parameter: 1.0})
    wanted = direction.replay(points, legs)
    found = forward(points, direction, np.zeros((system.directions - 1, len(system.condensed.active))))
    sizes = [max(np.abs(row[k].imag).max() for row in wanted) / STEP for k in range(2)]
    weights = {}
    for i, (change, (h, r, _)) in enumerate(zip(found, wanted, strict=True)):
        assert change.h[:, system.active] == pytest.approx(h.imag / STEP, abs=1e-12 * sizes[0])
        assert change.r[:, system.active] == pytest.approx(r.imag / STEP, abs=1e-12 * sizes[1])
        assert h.real == pytest.approx(points[i].h / system.root, abs=1e-12)
        if i % 3 == 0 or i == len(points) - 1:
            weights[i] = Weights(h=RAW.standard_normal(change.h.shape), r=RAW.standard_normal(change.r.shape))
    expected = sum(np.vdot(weight.h, found[i].h) + np.vdot(weight.r, found[i].r) for i, weight in weights.items())
    adjoint = backward(points, weights)
    total = sum(np.vdot(term.motion, direction.moved([points[i]])[0][0]) for i, term in adjoint.terms.items())
    total += sum(term.along(direction.bound(where)) for where, term in adjoint.bounds.items())
    assert total == pytest.approx(expected, rel=1e-12)


def test_points_passed_together_are_those_passed_one_by_one(path, monkeypatch):
    """In the plane blocks of points share an inverse; where that is singular, and in space, every point has its own."""
    points, _ = path
    shape, some = (points[-1].system.directions, len(points[-1].system.condensed.active)), range(1, len(points), 2)
    weights = {i: Weights(h=RAW.standard_normal(shape), r=RAW.standard_normal(shape)) for i in some}
    together = backward(points, weights)
    monkeypatch.setattr(BlockSteps, "back", lambda *_: None)
    one_by_one = backward(points, weights)
    assert together.terms.keys() == one_by_one.terms.keys()
    for found, wanted in zip(together.stacks, one_by_one.stacks, strict=True):
        assert found.motion == pytest.approx(wanted.motion, abs=1e-11 * np.abs(wanted.motion).max())
    for system, wanted in one_by_one.bounds.items():
        slopes = together.bounds[system].slopes
        assert slopes == pytest.approx(wanted.slopes, abs=1e-11 * np.abs(wanted.slopes).max())
