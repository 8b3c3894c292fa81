# SPDX-License-Identifier: BSD-3-Clause
"""From the places that a user names to nodes."""

from __future__ import annotations

import numpy as np

from signorini.arrays import IntArray
from signorini.errors import InputError, Where
from signorini.fem.space import Space
from signorini.model.conditions import Place

# of the size of the mesh: how far a node may be from the point that a user gives
_NEAR = 1e-6


def nodes_at(space: Space, on: Place, where: Where) -> IntArray:
    """Nodes of a boundary, a node set, or the one node at a point, sorted.

    Raises
    ------
    InputError
        If there is no node at the point (the nearest is named), or a node belongs to no cell.
    """
    if isinstance(on, str):
        nodes = space.mesh.nodes_of(on)
        loose = np.setdiff1d(nodes, space.used_nodes)
        if len(loose):
            raise InputError(f"'{on}' holds node {space.mesh.labels[loose[0]]}, which belongs to no cell", where=where)
        return nodes
    points = space.mesh.points[space.used_nodes]
    distance = np.linalg.norm(points - np.asarray(on), axis=1)
    nearest = int(np.argmin(distance))
    if distance[nearest] > _NEAR * np.ptp(points, axis=0).max():
        at = tuple(float(x) for x in points[nearest])
        node = space.mesh.labels[space.used_nodes[nearest]]
        raise InputError(f"no node at {on}; the nearest is node {node} at {at}", where=where)
    return space.used_nodes[[nearest]]
