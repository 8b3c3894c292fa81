# SPDX-License-Identifier: BSD-3-Clause
"""Results in ``.frd`` files as ccx2paraview converts them for ParaView: every field of every step comes back.

    python -m benchmarks.paraview DECK...

Needs ``ccx2paraview`` with VTK on the path (``pip install ccx2paraview[vtk]``). Every deck is solved and its ``.frd``
converted to ``.vtu``, one step at a time, for ccx2paraview 3.2 writes a step while it fills in the next. Points and the
fields U, RF, S and CONTACT are compared with the solution: the largest difference, as a part of the largest number.
"""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

import signorini as sg
from benchmarks import command
from signorini.arrays import padded
from signorini.deck import load_deck
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.output.ccx_contact import slave_values
from signorini.output.fields import Fields
from signorini.output.frd import write_frd
from signorini.solution.results import StepResult

Values = NDArray[np.float64]


def expected(model: sg.Model, step: StepResult) -> dict[str, Values]:
    """What the fields of a step should hold, (nodes, k); stresses in the means of the bodies at a node."""
    contact = np.zeros((len(model.mesh.points), 6))
    for data, result in zip(model.contacts, step.contacts, strict=True):
        contact[result.node] = slave_values(data, result)
    parts = list(body_stresses(make_space(model.mesh, kind=model.kind), model, step.displacement, step.factors))
    stress, count = np.zeros((len(model.mesh.points), 6)), np.zeros((len(model.mesh.points), 1))
    for part in parts:
        stress[part.nodes] += part.stress
        count[part.nodes] += 1.0
    fields = {"U": padded(step.displacement, 3), "RF": padded(step.external, 3), "S": stress / np.maximum(count, 1.0)}
    return fields | {"CONTACT": contact}


def apart(found: Values, wanted: Values) -> float:
    size = float(np.abs(wanted).max())
    return float(np.abs(found - wanted).max()) / size if size else float(np.abs(found).max())


def check(deck: Path, folder: Path) -> str:
    """What comes back of a deck, in words."""
    solution = sg.solve(load_deck(deck, small_strain=True).model)
    mesh, steps = solution.model.mesh, solution.steps
    used = np.unique(np.concatenate([cells.ravel() for cells in mesh.cells.values()]))
    worst: dict[str, float] = {}
    for step in steps:
        write_frd(replace(solution, steps=(step,)), Fields(solution.model), folder / "result.frd")
        subprocess.run(["ccx2paraview", "result.frd", "vtu"], cwd=folder, capture_output=True, check=True, timeout=120)
        converted = meshio.read(folder / "result.vtu")
        found = {name: np.asarray(values) for name, values in converted.point_data.items()}
        wanted = expected(solution.model, step)
        pairs = [("points", converted.points, padded(mesh.points, 3)[used])]
        pairs += [(name, found[name], values[used]) for name, values in wanted.items() if name in found]
        for name, mine, theirs in pairs:
            worst[name] = max(worst.get(name, 0.0), apart(mine, theirs))
    lost = {"U", "RF", "S", "S_Mises", "CONTACT"} - set(found)
    cells = sum(len(block.data) for block in converted.cells)
    words = ", ".join(f"{name} within {value:.0e}" for name, value in worst.items())
    return (
        f"{deck.stem:16s} {len(steps)} steps, {cells} of {mesh.number_of_cells} cells, {words}; lost: {lost or 'none'}"
    )


if __name__ == "__main__":
    command.deck_by_deck(__doc__, check)
