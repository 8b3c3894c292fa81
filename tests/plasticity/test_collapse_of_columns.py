# SPDX-License-Identifier: BSD-3-Clause
"""A column without hardening carries its yield stress: beyond it that load is named, whatever solves contact."""

import re
from dataclasses import replace

import pytest

import signorini as sg
from signorini.engine.tangent_bodies import TangentBodies
from signorini.settings import SolverSettings
from tests.helpers.columns import ELASTIC, Y, column

PERFECT = replace(ELASTIC, plastic=sg.Plastic(Y))


def overloaded(kind, factor):
    """The column under its limit load times a factor."""
    loads = [sg.Load("up.top", pressure=factor * Y, name="press")]
    return column(kind, upper=PERFECT, lower=PERFECT, loads=loads, cells=(1, 2))


@pytest.mark.parametrize("kind", ["axisymmetric", "3d"])
@pytest.mark.parametrize(
    ("factor", "backend"), [(1.02, "auto"), (2.0, "auto"), pytest.param(1.02, "iterative", marks=pytest.mark.slow)]
)
def test_the_limit_load_is_found_in_a_dozen_tangents(kind, backend, factor, monkeypatch):
    """Contact finds no answer on the singular tangent: what is left of the elastic law lets bodies flow far at once."""
    made = []
    original = TangentBodies.solver

    def counting(self, *given):
        made.append(1)
        return original(self, *given)

    monkeypatch.setattr(TangentBodies, "solver", counting)
    with pytest.raises(
        sg.SolveFailed, match=rf"flow plastically at {100.0 / factor:.4f}% of the step at most"
    ) as found:
        sg.solve(overloaded(kind, factor), backend=backend)
    assert found.value.status == "no_equilibrium"
    assert len(made) <= 20


@pytest.mark.parametrize("backend", ["auto", "iterative"])
@pytest.mark.parametrize("kind", ["axisymmetric", "3d"])
def test_just_below_it_the_column_holds(kind, backend):
    solution = sg.solve(overloaded(kind, 0.999), backend=backend)
    assert solution.steps[0].certificate.passed


def test_contact_that_is_lost_while_bodies_flow_away_leaves_the_bound():
    """Multipliers do not settle on bodies that hardly resist any more; the motions so far name the load."""
    loads = [sg.Load("up.top", pressure=3.0 * Y, name="press")]
    model = column("3d", upper=PERFECT, lower=ELASTIC, loads=loads, cells=(1, 2), friction="tied")
    few = SolverSettings(multiplier_rounds=12)
    named = [
        sg.solve(model, backend=backend, settings=settings, raise_on_failure=False)
        for backend, settings in (("iterative", few), ("auto", None))
    ]
    assert {found.status for found in named} == {"no_equilibrium"}
    assert named[0].message == named[1].message


@pytest.mark.parametrize("backend", ["auto", "iterative"])
def test_a_body_that_does_not_yield_does_not_strain_in_a_mechanism(backend):
    """A little of its strain takes any stress: a bound that leaves that out was below what is carried."""

    def pressed(part):
        loads = [
            sg.Load("up.top", pressure=1.5 * part * Y, name="press"),
            sg.Load("up.top", traction=(0.3 * part * Y, 0.0), name="drag"),
        ]
        model = column("plane strain", upper=PERFECT, lower=ELASTIC, loads=loads, cells=(1, 2), friction="tied")
        return sg.solve(model, backend=backend, raise_on_failure=False)

    beyond = pressed(1.0)
    assert beyond.status == "no_equilibrium"
    named = float(re.search(r"flow plastically at ([\d.]+)%", beyond.message)[1]) / 100.0
    assert pressed(0.9995 * named).last.certificate.passed
