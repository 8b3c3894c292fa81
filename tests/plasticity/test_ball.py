# SPDX-License-Identifier: BSD-3-Clause
"""A ball pressed far beyond first yield, in space, in one increment: certified, for the price of a few factors."""

import re
import time
from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.clock import Clock
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.engine.tangent_bodies import TangentBodies
from signorini.gallery.half_spaces import SOFT, ball, hertz


def pressed(beyond, *, n=2, friction=0.3, hardening=0.0, block=None, cells="quad", step=None):
    """A quarter of a ball on a plane or a block; ``beyond``: Hertz's peak pressure over the yield stress."""
    model = ball(n=n, block=block, cells=cells)
    peak = hertz(1 if block is None else 2).peak_pressure
    soft = replace(SOFT, plastic=sg.Plastic(peak / beyond, hardening=hardening * SOFT.E))
    return replace(
        model,
        bodies=[sg.Body(body.name, soft) for body in model.bodies],
        contacts=[replace(contact, friction=friction) for contact in model.contacts],
        steps=[step or sg.Step(increments=1)],
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "given",
    [
        {"cells": "quad"},
        {"cells": "quad", "n": 1, "block": 1},
        {"cells": "quad8", "hardening": 0.01},
        {"cells": "tetra10", "n": 1},
        {"cells": "quad", "n": 1, "block": 1, "friction": 0.0},
    ],
    ids=["on a plane", "on a block", "hexahedron20", "tetra10", "without friction"],
)
def test_four_times_beyond_the_yield_stress(given, monkeypatch):
    """Anderson's method on kept factors: one tangent at most instead of a dozen, never more rounds than some forty."""
    made = []
    original = TangentBodies.solver

    def counting(self, *arguments):
        made.append(1)
        return original(self, *arguments)

    monkeypatch.setattr(TangentBodies, "solver", counting)
    step = sg.solve(pressed(4.0, **given)).steps[0]
    assert step.certificate.passed
    rounds = [run.iterations for runs in step.trace for run in runs if run.method == "plastic flow"]
    assert max(rounds) <= 45
    assert len(made) <= 1


def test_factors_are_made_by_operations_and_not_by_the_clock():
    """A clock that runs wild changes neither the rounds nor the tangents; a new one is dearer the more it takes."""
    model, rng = pressed(4.0, n=1, block=1), np.random.default_rng(0)
    found = []
    for timer in (time.perf_counter, lambda: float(rng.exponential(1e3))):
        prepared = prepare(model, clock=Clock(timer=timer))
        steps = solve_prepared(prepared).steps
        found.append(([[run.iterations for run in runs] for runs in steps[0].trace], prepared.clock.seconds.keys()))
    assert found[0] == found[1]
    tangents, elastic = prepared.solver.tangents, prepared.solver.elastic
    plan = elastic.paths.condensed.factorisation.plan
    share = tangents.substitution_share(elastic, 40.0)
    assert share == pytest.approx(40.0 * plan.nnz_factor / (40.0 * plan.nnz_factor + plan.flops))
    assert tangents.substitution_share(elastic, 4.0) < share


def test_first_yield_is_found_where_contact_grows():
    """Pressures grow with the cube root of the load, so that no straight line between increments leads there."""
    solution = sg.solve(pressed(2.5, n=1))
    step = solution.steps[0]
    assert step.certificate.plastic.excess < 1e-8  # of the elastic part too
    (found,) = (re.search(r"at ([\d.]+)%: first yield", note) for note in step.notes if "first yield" in note)
    factor = float(found[1]) / 100.0
    for part, yields in ((factor * (1.0 - 1e-4), False), (factor * (1.0 + 1e-4), True)):
        notes = sg.solve(pressed(2.5, n=1, step=sg.Step(scale={"press": part}, increments=1))).steps[0].notes
        assert any("first yield" in note for note in notes) == yields
