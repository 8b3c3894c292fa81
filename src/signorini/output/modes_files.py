# SPDX-License-Identifier: BSD-3-Clause
"""Files of natural modes and of what a joint damps: tables, and shapes for ParaView."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from signorini.arrays import padded
from signorini.meshio_fixes import complete_meshio
from signorini.model.model import Model
from signorini.output.atomic_write import write_csv
from signorini.output.vtu import write_grid
from signorini.solution.damping import JointDamping
from signorini.solution.modes import NaturalModes

MODES, SHAPES = "modes.csv", "modes.vtu"
"""Files of natural modes: their numbers, and their shapes."""

DAMPING, LOOPS = "damping.csv", "loops.csv"
"""Files of a mode's damping: a row an amplitude, and all points of the loops."""


def write_modes(modes: Mapping[str, NaturalModes], path: Path) -> None:
    """Write a row a mode and state of the joints; effective masses are those of its motion along x, y and z."""
    axes = "xyz"
    columns = ("joint", "mode", "frequency", "omega_squared", "residual", *(f"effective_mass_{x}" for x in axes))
    rows = []
    for joint, own in modes.items():
        masses = padded(own.effective_masses, 3)
        for k in range(len(own)):
            row = {"joint": joint, "mode": k + 1, "frequency": float(own.frequencies[k])}
            row |= {"omega_squared": float(own.squares[k]), "residual": float(own.residuals[k])}
            rows.append(row | {f"effective_mass_{x}": float(masses[k, i]) for i, x in enumerate(axes)})
    write_csv(columns, rows, path)


def write_shapes(model: Model, modes: Mapping[str, NaturalModes], path: Path) -> None:
    """Write every mode as a point array ``JOINT_MODE``, 3 components, mass-normalised, on the undeformed mesh.

    ``JOINT_MODE_force`` are its inertia forces, ``omega^2 M v``, by which as a static load the largest displacement of
    bodies with that joint is 1; ``JOINT_MODE_imaginary`` is in their place where a wave goes around.

    Parameters
    ----------
    model : the model
    modes : by state of the joints
    path : of the file, ``*.vtu``
    """
    import meshio

    complete_meshio()
    arrays = {}
    for joint, own in modes.items():
        for k, (shape, force) in enumerate(zip(own.shapes, own.forces, strict=True)):
            name, reach = f"{joint}_{k + 1}", float(np.linalg.norm(shape, axis=1).max())
            arrays[name] = padded(shape.real, 3)
            if np.iscomplexobj(shape):
                arrays[f"{name}_imaginary"] = padded(shape.imag, 3)
            else:
                arrays[f"{name}_force"] = padded(own.squares[k] / reach * force, 3)
    grid = meshio.Mesh(
        padded(model.mesh.points, 3),
        list(model.mesh.cells.items()),
        point_data=arrays | {"node": model.mesh.labels},
        cell_data={"body": model.mesh.by_family(model.body_of_cells())},
    )
    write_grid(grid, path)


def write_damping(damping: JointDamping, path: Path) -> None:
    """Write a row an amplitude: secant frequency, damping ratio, dissipation, its exponent up to there, and closure."""
    exponents = np.concatenate([[np.nan], damping.exponents])
    rows = [
        {
            "amplitude": float(damping.amplitudes[k]),
            "modal_amplitude": loop.half_range,
            "modal_force": float(np.ptp(loop.force)) / 2.0,
            "frequency": float(damping.frequencies[k]),
            "damping_ratio": loop.ratio,
            "dissipation": loop.dissipation,
            "exponent": "" if np.isnan(exponents[k]) else float(exponents[k]),
            "closure": loop.closure,
        }
        for k, loop in enumerate(damping.loops)
    ]
    write_csv(list(rows[0]), rows, path)


def write_loops(damping: JointDamping, path: Path) -> None:
    """Write the points of all loops: number of the loop, modal coordinate and modal force."""
    rows = (
        {"loop": number, "modal_coordinate": float(q), "modal_force": float(force)}
        for number, loop in enumerate(damping.loops, start=1)
        for q, force in zip(loop.coordinate, loop.force, strict=True)
    )
    write_csv(("loop", "modal_coordinate", "modal_force"), rows, path)
