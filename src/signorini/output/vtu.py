# SPDX-License-Identifier: BSD-3-Clause
"""Fields for ParaView: displacement and stress on the undeformed mesh, every body on its own points."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.fem.space import Space, make_space
from signorini.fem.stress import BodyStress, body_stresses
from signorini.meshio_fixes import complete_meshio
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.solution.history import History
from signorini.solution.results import StepResult


def write_vtu(history: History, path: Path) -> None:
    """Write the last state; see :func:`write_step`.

    Raises
    ------
    InputError
        If nothing was solved.
    """
    write_step(history.model, history.last, path)


def write_step(model: Model, step: StepResult, path: Path) -> None:
    """Write the end of a step as a VTU file; see :func:`write_fields`."""
    space = make_space(model.mesh, axisymmetric=model.axisymmetric)
    write_fields(space, model, step.displacement, step.factors, path)


def write_fields(space: Space, model: Model, displacement: Array, factors: Mapping[str, float], path: Path) -> None:
    """Write displacements and the stresses that follow from them as a VTU file.

    The points of the bodies come one body after the other, in the order of the model, so that stresses of bodies that
    share nodes are not averaged. Point arrays: ``displacement`` (3 components, length), ``stress`` (xx, yy, zz, xy, yz,
    xz, force per area, tension positive; axisymmetric: x is the radius, y the axis, zz the hoop stress),
    ``von_mises`` and ``node`` (number in the mesh or deck). Cell array:
    ``body`` (0, 1, ... in the order of the model).

    Parameters
    ----------
    space : of the model's mesh
    displacement : (n, d) length
    factors : load factors by name, for the temperatures
    """
    import meshio

    complete_meshio()
    stresses = body_stresses(space, model, displacement, factors)
    nodes = np.concatenate([part.nodes for part in stresses])
    stress = np.concatenate([part.stress for part in stresses])
    blocks, body = _cells(model, stresses)
    grid = meshio.Mesh(
        _three(model.mesh.points[nodes]),
        blocks,
        point_data={
            "displacement": _three(displacement[nodes]),
            "stress": stress,
            "von_mises": np.concatenate([part.von_mises for part in stresses]),
            "node": model.mesh.labels[nodes],
        },
        cell_data={"body": body},
    )
    with atomic_write(path) as aside:
        meshio.write(aside, grid, file_format="vtu")


def _cells(model: Model, stresses: list[BodyStress]) -> tuple[list[tuple[str, IntArray]], list[IntArray]]:
    """Cells by body and family on the points of the bodies, and the body of each."""
    owner = model.body_of_cells()
    blocks, body, start = [], [], 0
    for i, part in enumerate(stresses):
        first = 0
        for family, cells in model.mesh.cells.items():
            own = cells[owner[first : first + len(cells)] == i]
            if len(own):
                blocks.append((family, start + np.searchsorted(part.nodes, own)))
                body.append(np.full(len(own), i))
            first += len(cells)
        start += len(part.nodes)
    return blocks, body


def _three(plane: Array) -> Array:
    """Vectors (n, 2) with a third component 0; those of space as they are."""
    return plane if plane.shape[1] == 3 else np.column_stack([plane, np.zeros(len(plane))])
