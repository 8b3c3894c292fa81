# SPDX-License-Identifier: BSD-3-Clause
"""Contact surfaces in space for ParaView: what ``contact.vtu`` holds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.solution.results import ContactResult
from signorini.solution.surface import contact_faces, status_codes

_KINDS = {3: "triangle", 4: "quad"}


def write_surfaces(model: Model, results: Sequence[ContactResult], path: Path) -> None:
    """Write the nonmortar sides of all contacts in one state, on the undeformed mesh.

    Point arrays: ``pressure``, ``traction`` (friction on the nonmortar body, a vector), ``slip`` (accumulated, a
    vector), ``gap``, ``area``, ``normal``, ``status`` (0 open, 1 stick, 2 slip) and ``node``. Cell array: ``contact``
    (0, 1, ... in the order of the model). Faces are those whose corners all carry pairs.
    """
    import meshio

    start = np.cumsum([0, *(len(result.node) for result in results)])
    blocks, owner = [], []
    for i, result in enumerate(results):
        for faces in contact_faces(model, result):
            if len(faces):
                blocks.append((_KINDS[faces.shape[1]], start[i] + faces))
                owner.append(np.full(len(faces), i))

    def joined(values: list[Any]) -> Any:
        return np.concatenate(values)

    grid = meshio.Mesh(
        joined([result.points for result in results]),
        blocks,
        point_data={
            "pressure": joined([result.pressure for result in results]),
            "traction": joined([result.shear for result in results]),
            "slip": joined([np.einsum("nk,nki->ni", result.slip, result.tangents) for result in results]),
            "gap": joined([result.gap for result in results]),
            "area": joined([result.area for result in results]),
            "normal": joined([result.normals for result in results]),
            "status": joined([status_codes(result) for result in results]),
            "node": model.mesh.labels[joined([result.node for result in results])],
        },
        cell_data={"contact": owner},
    )
    with atomic_write(path) as aside:
        meshio.write(aside, grid, file_format="vtu")
