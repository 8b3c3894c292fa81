# SPDX-License-Identifier: BSD-3-Clause
"""Cyclic symmetry: what one side of a sector does, the other does turned."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.space import Space
from signorini.model.links import CyclicSymmetry
from signorini.model.model import Model

_MATCH_TOL = 1e-6  # of the size of the mesh: how far a node, turned, may be from the one that it is


def cyclic_rows(space: Space, model: Model, j: int) -> tuple[IntArray, Array]:
    """``u(R x) - R u(x) = 0`` at every node of the first side: dofs and coefficients, (rows, 1 + d) each.

    Nodes of the axis are on both sides: they stay on it.

    Parameters
    ----------
    space, model : with the sides
    j : number of the symmetry

    Raises
    ------
    InputError
        If a node of a side has no partner on the other.
    """
    symmetry = model.cyclic_symmetries[j]
    where: Where = ("cyclic_symmetry", j)
    first, second = (space.mesh.nodes_of(name) for name in (symmetry.first, symmetry.second))
    turn, partner = _matched(space, symmetry, first, second, where)
    own, other = space.dofs(second[partner]), space.dofs(first)
    columns = np.concatenate([own[:, :, None], np.repeat(other[:, None, :], own.shape[1], axis=1)], axis=2)
    values = np.concatenate([np.ones((*own.shape, 1)), np.broadcast_to(-turn, (*own.shape, len(turn)))], axis=2)
    on_axis = (second[partner] == first)[:, None] & (np.abs(turn - np.eye(len(turn))).max(axis=1) == 0.0)
    return columns[~on_axis], values[~on_axis]


def refuse_contact_across(space: Space, model: Model) -> None:
    """Refuse contacts whose nonmortar nodes are on a side of a sector: half of what they bear is on the other.

    Which side of a contact is the coarser one, and nonmortar for that, is known later: neither may reach a side then.

    Parameters
    ----------
    space, model : of the contacts

    Raises
    ------
    InputError
        With the contact and a node.
    """
    for symmetry in model.cyclic_symmetries:
        sides = np.union1d(space.mesh.nodes_of(symmetry.first), space.mesh.nodes_of(symmetry.second))
        for i, contact in enumerate(model.contacts):
            names = {"nonmortar": contact.nonmortar}
            if contact.side == "coarser" and isinstance(contact.mortar, str):
                names["mortar"] = contact.mortar
            for key, name in names.items():
                both = np.intersect1d(space.mesh.nodes_of(name), sides)
                if len(both):
                    raise InputError(
                        f"reaches '{symmetry.first}' or '{symmetry.second}' at node {space.mesh.labels[both[0]]}, "
                        "where a cyclic sector ends; expected a sector cut where nothing touches, or supports of "
                        "symmetry",
                        where=("contact", i, key),
                    )


def _matched(
    space: Space, symmetry: CyclicSymmetry, first: IntArray, second: IntArray, where: Where
) -> tuple[Array, IntArray]:
    """R, (d, d), and which node of the second side every node of the first is turned to."""
    points, d = space.mesh.points, space.dimension
    size = float(np.ptp(points, axis=0).max())
    centre = np.array(symmetry.point or (0.0,) * d)
    if len(first) != len(second):
        raise InputError(
            f"'{symmetry.first}' has {len(first)} nodes and '{symmetry.second}' {len(second)}; expected sides whose "
            "nodes rotate onto each other",
            where=where,
        )
    tree, best = cKDTree(points[second]), np.inf
    for way in (1.0, -1.0):
        turn = _rotation(way * 2.0 * np.pi / symmetry.sectors, np.array(symmetry.axis))[:d, :d]
        distance, partner = tree.query((points[first] - centre) @ turn.T + centre)
        if distance.max() <= _MATCH_TOL * size and len(np.unique(partner)) == len(partner):
            return turn, np.asarray(partner)
        if distance.max() < best:
            best, worst = float(distance.max()), int(first[np.argmax(distance)])
    raise InputError(
        f"node {space.mesh.labels[worst]} of '{symmetry.first}', turned by 1/{symmetry.sectors} of a full turn, is "
        f"{best:.4g} away from the next node of '{symmetry.second}'; expected sides whose nodes rotate onto each other",
        where=where,
    )


def _rotation(angle: float, axis: Array) -> Array:
    """By an angle about an axis, (3, 3); what is 0 or 1 but for rounding is so."""
    found = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()
    whole = np.round(found)
    return np.asarray(np.where(np.abs(found - whole) < 1e-15, whole, found))
