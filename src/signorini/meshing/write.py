# SPDX-License-Identifier: BSD-3-Clause
"""Meshes to files that keep every name and number."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from signorini.arrays import IntArray, among
from signorini.meshing.read import NAMED, NODE_NUMBER
from signorini.meshio_fixes import complete_meshio
from signorini.model.mesh import Mesh

_FACETS = {
    2: {2: "line", 3: "line3"},
    3: {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"},
}


def write_mesh(mesh: Mesh, path: Path) -> None:
    """Write a mesh as VTU: :func:`signorini.meshing.read.read_mesh` gives the same mesh.

    Names are arrays of 0 and 1 called ``set:NAME``, on cells for bodies and boundaries, on points for node sets; facets
    of boundaries are cells of their own. The arrays ``number`` hold the numbers of nodes and cells.

    Parameters
    ----------
    path : of the file, ``*.vtu``
    """
    import meshio

    complete_meshio()
    named = [(name, facets) for name in mesh.boundaries for facets in mesh.facets(name)]
    kinds = _FACETS[mesh.points.shape[1]]
    blocks = [*mesh.cells.items(), *((kinds[facets.shape[1]], facets) for _, facets in named)]
    sizes = [len(nodes) for _, nodes in blocks]
    ends, total, count = np.cumsum(sizes)[:-1], sum(sizes), mesh.number_of_cells
    members = {name: [cells] for name, cells in mesh.bodies.items()}
    for (name, _), cells in zip(named, np.split(np.arange(total), ends)[len(mesh.cells) :], strict=True):
        members.setdefault(name, []).append(cells)
    data = {NAMED + name: np.split(among(cells, total).astype(np.int8), ends) for name, cells in members.items()}
    point_data: dict[str, IntArray] = {}
    point_data |= {NAMED + name: among([own], len(mesh.points)).astype(np.int8) for name, own in mesh.nodes.items()}
    if mesh.node_numbers is not None:
        point_data[NODE_NUMBER] = mesh.node_numbers
    if mesh.cell_numbers is not None:
        numbers = np.concatenate([mesh.cell_numbers, np.zeros(total - count, np.int64)])
        data[NODE_NUMBER] = np.split(numbers, ends)
    points = np.column_stack([mesh.points, np.zeros((len(mesh.points), 3 - mesh.points.shape[1]))])
    meshio.write(path, meshio.Mesh(points, blocks, point_data=point_data, cell_data=data), file_format="vtu")
