# SPDX-License-Identifier: BSD-3-Clause
"""Contacts that the sides of a cyclic sector cut: pairs are those of the whole, their motions those of the sector."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.errors import InputError
from signorini.fem.cyclic import contacts_across
from signorini.fem.neighbours import Neighbourhood, neighbourhood
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface, make_interface
from signorini.interface.side_values import side_values
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle
from signorini.model.varying import NodeValues, Varying

_SAME_OBSTACLE_TOL = 1e-9  # of the size of the mesh, or component of a unit vector


def sector_interface(space: Space, model: Model, constraints: Constraints) -> Interface:
    """Pair the surfaces of all contacts of a sector, as those of the whole that it repeats to.

    Nodes of the second side of a sector are those of the first, turned: pairs of the first side stand for both. They
    are made on the sector with a copy on either side, where ``u = R u_source``.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    constraints : what supports hold: planes of symmetry

    Raises
    ------
    InputError
        As :func:`signorini.interface.interface.make_interface`; if a contact that a side cuts slides far, wears, or is
        with an obstacle that is not the same in every sector.
    """
    across = contacts_across(space, model)
    if not across:
        return make_interface(space, model, constraints)
    near, kept = _with_neighbours(space, model, constraints, across)
    return replace(kept, B=sp.csr_array(kept.B @ near.shares))


def wave_motions(
    space: Space, model: Model, constraints: Constraints, angle: float
) -> tuple[sp.csr_array, sp.csr_array]:
    """Real and imaginary part of the motions of pairs, (rows, dofs) each, where every sector is a phase ahead.

    Parameters
    ----------
    space, model, constraints : as of :func:`sector_interface`, whose pairs they are
    angle : from one sector to the next
    """
    across = contacts_across(space, model)
    if not across:
        B = make_interface(space, model, constraints).B
        return B, sp.csr_array(B.shape)
    near, kept = _with_neighbours(space, model, constraints, across)
    phase = angle * near.ahead
    real, imaginary = (kept.B @ sp.diags_array(part) @ near.shares for part in (np.cos(phase), np.sin(phase)))
    return sp.csr_array(real), sp.csr_array(imaginary)


def _with_neighbours(
    space: Space, model: Model, constraints: Constraints, across: Sequence[int]
) -> tuple[Neighbourhood, Interface]:
    """The sector with its neighbours, and its pairs, whose motions are those of all their displacements."""
    near = neighbourhood(space, model, constraints)
    for i in across:
        _refuse_other_obstacle(space, model, near, i)
    contacts = [_repeated(space, near, contact, i) for i, contact in enumerate(model.contacts)]
    found = make_interface(near.space, replace(near.model, contacts=contacts), near.constraints)
    own = np.append(near.original, -1)[np.minimum(found.node, len(near.original))] == found.node
    return near, replace(found.among(own), moments=found.moments[found.rows(own)])


def _repeated(space: Space, near: Neighbourhood, contact: Contact, i: int) -> Contact:
    """The contact with what varies over its sides in every sector as in this one."""

    def everywhere(given: Varying | str, key: str) -> Varying | str:
        if isinstance(given, float | int | str):
            return given
        return NodeValues(side_values(space, contact, given, ("contact", i, key))[near.source])

    parts: dict[str, Any] = {key: everywhere(getattr(contact, key), key) for key in ("gap", "interference")}
    return replace(contact, **parts)


def _refuse_other_obstacle(space: Space, model: Model, near: Neighbourhood, i: int) -> None:
    """Obstacles of one sector are those of all only where their turned image is themselves."""
    contact = model.contacts[i]
    shapes = {obstacle.name: obstacle.shape for obstacle in model.obstacles}
    shape = contact.mortar if isinstance(contact.mortar, Obstacle) else shapes.get(contact.mortar)
    if shape is None:
        return
    nodes = space.mesh.nodes_of(contact.nonmortar)
    second = nodes[near.original[nodes] != nodes]
    points, size = space.mesh.points, float(np.ptp(space.mesh.points, axis=0).max())
    (here, along), (there, turned) = (shape.nearest(points[own]) for own in (near.original[second], second))
    off = np.abs(there - here) > _SAME_OBSTACLE_TOL * size
    off |= np.abs(turned - along @ near.turn.T).max(axis=1) > _SAME_OBSTACLE_TOL
    if off.any():
        one, other = space.mesh.labels[[near.original[second][off][0], second[off][0]]]
        raise InputError(
            f"is reached where the sector is cut, at nodes {one} and {other}, and is not the same in every sector; "
            "expected a surface of revolution about its axis, or a sector cut elsewhere",
            where=("contact", i, "mortar"),
        )
