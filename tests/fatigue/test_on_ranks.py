"""Criteria of fatigue on ranks say what they say in one process, wherever places and the cells around them are."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.distributed import ranks
from signorini.distributed.partition import owners
from signorini.engine.examine import examine
from signorini.engine.fatigue import assess_fatigue
from signorini.fem.stress import space_of
from signorini.gallery.cubes import cubes
from signorini.gallery.sectors import ring_on_shaft
from signorini.solution.fatigue_result import PER_PLACE
from tests.helpers.fake_ranks import RanksInTurn

LIFE = {"strength": 900.0, "strength_exponent": -0.1, "ductility": 0.3, "ductility_exponent": -0.6}


def warm_blocks():
    """Two blocks that stick at first and then slip, one of them warm, in increments."""
    model = cubes(3)
    bodies = [replace(body, material=replace(body.material, expansion=1e-5)) for body in model.bodies]
    heat = sg.Load("upper", temperature=lambda at: 10.0 * at[:, 0], name="heat")
    return replace(model, bodies=bodies, loads=[*model.loads, heat], steps=[sg.Step(increments=3)])


@pytest.mark.parametrize(
    ("made", "asked"),
    [
        (warm_blocks, sg.Fatigue(sg.fatigue.SWT(**LIFE), where=["upper", "contact"])),
        (warm_blocks, sg.Fatigue(sg.fatigue.FatemiSocie(yield_stress=300.0), distance=0.1, average="line")),
        (warm_blocks, sg.Fatigue(sg.fatigue.Ruiz())),
        (lambda: ring_on_shaft(whole=False), sg.Fatigue(sg.fatigue.SWT(), where=["ring", "shaft"], steps="drag")),
        (lambda: ring_on_shaft(whole=False), sg.Fatigue(sg.fatigue.Ruiz(), steps=["press", "drag"])),
    ],
)
def test_ranks_say_what_one_process_says(made, asked, monkeypatch):
    """Displacements that were not kept are found by the first one, as of a history that nobody has looked at."""
    history = sg.solve(made(), backend="multifrontal")
    model, team = history.model, RanksInTurn(5)
    found = assess_fatigue(history, asked, lambda: space_of(model))
    team.owners[model.mesh] = owners(space_of(model), examine(model).interface.B, team.size)
    monkeypatch.setattr(ranks, "several_ranks", lambda: team)
    history = replace(history, backend="petsc")
    there = assess_fatigue(history, asked, lambda: pytest.fail("all cells were looked at"))
    assert (there.moments, there.steps, there.exact) == (found.moments, found.steps, found.exact)
    for name in PER_PLACE:
        one, other = getattr(found, name), getattr(there, name)
        assert one.shape == other.shape
        if one.dtype.kind != "f":
            np.testing.assert_array_equal(one, other)
        elif name in ("parameter", "life", "points"):
            np.testing.assert_allclose(other, one, rtol=1e-9)
    assert there.worst == found.worst
    assert there.count == len(found.node)
