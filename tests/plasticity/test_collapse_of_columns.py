# SPDX-License-Identifier: BSD-3-Clause
"""A column without hardening carries its yield stress: beyond it that load is named, whatever solves contact."""

from dataclasses import replace

import pytest

import signorini as sg
from signorini.engine.tangent_bodies import TangentBodies
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
