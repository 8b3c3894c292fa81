# SPDX-License-Identifier: BSD-3-Clause
"""From the places that a user names to nodes and their unknowns."""

from __future__ import annotations

import numpy as np

from signorini.arrays import IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import boundary
from signorini.fem.space import ON_AXIS, Space
from signorini.model.conditions import Place
from signorini.model.links import directions
from signorini.model.mesh import CORNERS, NODES_PER_CELL
from signorini.model.model import Model

# of the size of the mesh: how far a node may be from the point that a user gives
_PLACE_TOL = 1e-6


def nodes_at(space: Space, on: Place, where: Where, *, completed: bool = True) -> IntArray:
    """Nodes of a boundary, a node set, or the one node at a point, sorted.

    Parameters
    ----------
    space : of the mesh
    on : boundary, node set, coordinates or number of a node
    where : what errors call the place
    completed : of a boundary that names the corners of its facets only, also the nodes in the middle of them

    Raises
    ------
    InputError
        If there is no node at the point (the nearest is named), or a node belongs to no cell and to no equation.
    """
    if isinstance(on, str):
        nodes = space.mesh.nodes_of(on)
        if completed and on in space.mesh.boundaries and _corners_only(space, on):
            nodes = boundary(space, on, where).nodes
        loose = np.setdiff1d(nodes[~space.used[nodes]], space.loose_nodes)
        if len(loose):
            raise InputError(f"'{on}' holds node {space.mesh.labels[loose[0]]}, which belongs to no cell", where=where)
        return nodes
    points = space.mesh.points[space.used_nodes]
    distance = np.linalg.norm(points - np.asarray(on), axis=1)
    nearest = int(np.argmin(distance))
    if distance[nearest] > _PLACE_TOL * np.ptp(points, axis=0).max():
        at = tuple(float(x) for x in points[nearest])
        node = space.mesh.labels[space.used_nodes[nearest]]
        raise InputError(f"no node at {on}; the nearest is node {node} at {at}", where=where)
    return space.used_nodes[[nearest]]


def place_dofs(space: Space, model: Model, on: Place | int, where: Where) -> IntArray:
    """(k, c) dofs at a place: of a rigid body its one row of displacements and rotations, otherwise of its nodes.

    Parameters
    ----------
    space, model : where the place is
    on : boundary, node set, coordinates, number of a node, or rigid body
    where : what errors call the place
    """
    names = [body.name for body in model.rigid_bodies]
    if isinstance(on, str) and on in names:
        dofs = space.obstacle_dofs(len(model.obstacles) + names.index(on))
        return dofs[None, : len(directions(space.dimension))]
    if isinstance(on, int):
        if on not in space.node_of:
            raise InputError(f"there is no node {on} in the mesh", where=where)
        return space.dofs(np.array([space.node_of[on]]))
    return space.dofs(nodes_at(space, on, where))


def dofs_on_axis(space: Space, model: Model) -> IntArray:
    """Radial and hoop dofs of nodes on the axis of an axisymmetric body: its points cannot leave the axis.

    Parameters
    ----------
    space, model : of the body
    """
    if not model.axisymmetric:
        return np.empty(0, int)
    radii = space.mesh.points[space.used_nodes, 0]
    dofs = space.dofs(space.used_nodes[radii <= ON_AXIS * radii.max()])
    return np.sort(dofs[:, ::2], axis=None)


def _corners_only(space: Space, name: str) -> bool:
    """Whether a boundary of quadratic cells leaves out the middle nodes."""
    most = 2 if space.dimension == 2 else 4
    linear = any(facets.shape[1] <= most for facets in space.mesh.facets(name))
    return linear and any(NODES_PER_CELL[family] > CORNERS[family] for family in space.mesh.cells)
