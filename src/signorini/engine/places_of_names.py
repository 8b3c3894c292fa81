# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of bodies by the names of contacts, boundaries, node sets and bodies, with the normals that lead inward."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, one_of
from signorini.fem.boundary import boundary
from signorini.fem.space import Space
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class NamedPlaces:
    """Nodes of bodies.

    Attributes
    ----------
    nodes : (p, 2) body and node of the mesh
    inward : (p, d) unit normals into the body; NaN where a name is no boundary
    """

    nodes: IntArray
    inward: Array


def named_places(space: Space, model: Model, names: Sequence[str]) -> NamedPlaces:
    """Nodes of contacts (both of their sides), boundaries, node sets and bodies, each once.

    Parameters
    ----------
    space, model : of the bodies
    names : all contacts if there is none

    Raises
    ------
    InputError
        For an unknown name, or if nothing is named and there is no contact.
    """
    if not names and not model.contacts:
        raise InputError("there is no contact; expected a boundary, a node set or a body", where=("where",))
    found = [part for name in names or [c.label for c in model.contacts] for part in _of_name(space, model, name)]
    nodes, inward = np.concatenate([part[0] for part in found]), np.concatenate([part[1] for part in found])
    first = np.sort(np.unique(nodes, axis=0, return_index=True)[1])
    return NamedPlaces(nodes=nodes[first], inward=inward[first])


def _of_name(space: Space, model: Model, name: str) -> Iterator[tuple[IntArray, Array]]:
    """Bodies and nodes (p, 2), and the inward normals (p, d), of what has a name."""
    mesh, owner = model.mesh, model.body_of_cells()
    for contact in model.contacts:
        if contact.label == name:
            sides = [side for side in (contact.nonmortar, contact.mortar) if isinstance(side, str)]
            for side in sides:
                if side in mesh.boundaries and not mesh.bounds_nothing(side):
                    yield from _of_boundary(space, owner, side)
            return
    if name in mesh.boundaries and not mesh.bounds_nothing(name):
        yield from _of_boundary(space, owner, name)
        return
    bodies = [body.name for body in model.bodies]
    if name not in bodies and name not in mesh.nodes:
        known = [*(contact.label for contact in model.contacts), *mesh.boundaries, *mesh.nodes, *bodies]
        raise InputError(one_of(name, known, "contact, boundary, node set or body"), where=("where",))
    asked = np.zeros(len(mesh.points), bool)
    asked[slice(None) if name in bodies else mesh.nodes_of(name)] = True
    for i, body in enumerate(bodies):
        if name not in bodies or name == body:
            own = np.zeros(len(mesh.points), bool)
            for block in space.blocks:
                own[block.cells[owner[block.first : block.first + len(block.cells)] == i]] = True
            nodes = np.flatnonzero(own & asked)
            yield np.column_stack([np.full(len(nodes), i), nodes]), np.full((len(nodes), space.dimension), np.nan)


def _of_boundary(space: Space, owner: IntArray, name: str) -> Iterator[tuple[IntArray, Array]]:
    """Bodies and nodes of a boundary, and the inward normals there."""
    side = boundary(space, name, ("where",))
    for block in side.blocks:
        pairs = np.column_stack([np.repeat(owner[block.cells], block.facets.shape[1]), block.facets.ravel()])
        pairs = np.unique(pairs, axis=0)
        yield pairs, -side.nodal_normals[np.searchsorted(side.nodes, pairs[:, 1])]
