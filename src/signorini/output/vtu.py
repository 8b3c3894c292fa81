# SPDX-License-Identifier: BSD-3-Clause
"""Fields for ParaView (``.vtu``): the bodies, and in space the contact surfaces, both on the undeformed mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from signorini.arrays import Array, padded
from signorini.meshio_fixes import complete_meshio
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.fields import BodyFields
from signorini.plasticity.fields import PlasticFields
from signorini.solution.results import ContactResult
from signorini.solution.surface import contact_faces, status_codes

_FACES = {3: "triangle", 4: "quad"}


def write_bodies(fields: BodyFields, path: Path, further: Mapping[str, Array] | None = None) -> None:
    """Write displacements and stresses of the bodies in one state.

    Point arrays: ``displacement`` (3 components, length), ``stress`` (xx, yy, zz, xy, yz, xz, force per area, tension
    positive; axisymmetric: x is the radius, y the axis, zz the hoop stress), ``von_mises`` and ``node`` (number in the
    mesh or deck). Cell array: ``body`` (0, 1, ... in the order of the model). Where bodies yield, points and cells
    (their means) have ``peeq``, the equivalent plastic strain, ``plastic_strain`` (the tensor, components as those of
    the stress) and ``back_stress`` (the sum of all). Where sides wear, points have ``worn_depth`` (length).

    Parameters
    ----------
    fields : of the bodies
    path : of the file
    further : point arrays by name, (n,)
    """
    import meshio

    complete_meshio()
    grid = meshio.Mesh(
        padded(fields.points, 3),
        list(zip(fields.families, fields.cells, strict=True)),
        point_data={
            "displacement": padded(fields.displacement, 3),
            "stress": fields.stress,
            "von_mises": fields.von_mises,
            "node": fields.node,
            **({} if fields.plastic is None else _plastic(fields.plastic)),
            **({} if fields.depth is None else {"worn_depth": fields.depth}),
            **(further or {}),
        },
        cell_data={"body": list(fields.body), **_by_name(fields.in_cells)},
    )
    with atomic_write(path) as aside:
        meshio.write(aside, grid, file_format="vtu")


def _plastic(fields: PlasticFields) -> dict[str, Array]:
    """Arrays of plastic fields by name."""
    return {"peeq": fields.equivalent, "plastic_strain": fields.strain, "back_stress": fields.back}


def _by_name(blocks: Sequence[PlasticFields]) -> dict[str, list[Array]]:
    """Arrays of the cells by name, one a block; none where there is no block."""
    found: dict[str, list[Array]] = {}
    for block in blocks:
        for name, values in _plastic(block).items():
            found.setdefault(name, []).append(values)
    return found


def write_surfaces(model: Model, contacts: Sequence[ContactResult], path: Path) -> None:
    """Write the nonmortar sides of all contacts of a model in space in one state.

    Point arrays: ``pressure``, ``traction`` (friction on the nonmortar body, a vector), ``slip`` (accumulated, a
    vector), ``gap``, ``area``, ``normal``, ``status`` (0 open, 1 stick, 2 slip), ``node``, ``worn_depth`` (where any
    side wears). Cell array: ``contact``
    (0, 1, ... in the order of the model). Faces are those whose corners all carry pairs.

    Parameters
    ----------
    model : in space, with contacts
    contacts : all of them in one state, in the order of the model
    path : of the file
    """
    import meshio

    start = np.cumsum([0, *(len(contact.node) for contact in contacts)])
    blocks, owner = [], []
    for i, contact in enumerate(contacts):
        for faces in contact_faces(model, contact):
            if len(faces):
                blocks.append((_FACES[faces.shape[1]], start[i] + faces))
                owner.append(np.full(len(faces), i))
    arrays = [
        {
            "points": contact.points,
            "pressure": contact.pressure,
            "traction": contact.shear,
            "slip": contact.along_tangents(contact.slip),
            "gap": contact.gap,
            "area": contact.area,
            "normal": contact.normals,
            "status": status_codes(contact),
            "node": model.mesh.labels[contact.node],
        }
        for contact in contacts
    ]
    for each, contact in zip(arrays, contacts, strict=True):
        if any(other.wear is not None for other in contacts):
            each["worn_depth"] = np.zeros(len(contact.node)) if contact.wear is None else contact.wear.depth
    data = {name: np.concatenate([each[name] for each in arrays]) for name in arrays[0]}
    grid = meshio.Mesh(data.pop("points"), blocks, point_data=data, cell_data={"contact": owner})
    with atomic_write(path) as aside:
        meshio.write(aside, grid, file_format="vtu")
