# SPDX-License-Identifier: BSD-3-Clause
"""Cyclic symmetry: what one side of a sector does, the other does turned."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.places import nodes_at
from signorini.fem.space import Space
from signorini.model.links import CyclicSymmetry
from signorini.model.model import Model

_MATCH_TOL = (
    1e-5  # of the size of the mesh: how far a node, turned, may be from the one that it is; decks have six digits
)


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
    turn, first, second = cyclic_sides(space, model, j)
    own, other = space.dofs(second), space.dofs(first)
    columns = np.concatenate([own[:, :, None], np.repeat(other[:, None, :], own.shape[1], axis=1)], axis=2)
    values = np.concatenate([np.ones((*own.shape, 1)), np.broadcast_to(-turn, (*own.shape, len(turn)))], axis=2)
    on_axis = (second == first)[:, None] & (np.abs(turn - np.eye(len(turn))).max(axis=1) == 0.0)
    return columns[~on_axis], values[~on_axis]


def cyclic_sides(space: Space, model: Model, j: int) -> tuple[Array, IntArray, IntArray]:
    """R, (d, d), nodes of the first side of a sector, (k,), and those of the second one that R takes them to.

    Parameters
    ----------
    space, model : with the sides
    j : number of the symmetry

    Raises
    ------
    InputError
        If a node of a side has no partner on the other.
    """
    symmetry, where = model.cyclic_symmetries[j], ("cyclic_symmetry", j)
    first, second = (nodes_at(space, name, where) for name in (symmetry.first, symmetry.second))
    turn, partner = _matched(space, symmetry, first, second, where)
    return turn, first, second[partner]


def contacts_across(space: Space, model: Model) -> list[int]:
    """Numbers of the contacts that a side of a sector cuts: some of what their nodes there bear is in the next one.

    Which side of a contact is the coarser one, and nonmortar for that, is known later: either may reach a side then.

    Parameters
    ----------
    space, model : of the contacts

    Raises
    ------
    InputError
        If one slides far or wears.
    """
    ends = [name for symmetry in model.cyclic_symmetries for name in (symmetry.first, symmetry.second)]
    sides = [space.mesh.nodes_of(name) for name in ends]
    found = []
    for i, contact in enumerate(model.contacts):
        both = contact.side == "coarser" and isinstance(contact.mortar, str)
        names = [contact.nonmortar, *([str(contact.mortar)] if both else [])]
        if not any(np.intersect1d(space.mesh.nodes_of(name), side).size for name in names for side in sides):
            continue
        for key, given in (("sliding", contact.slides), ("wear", contact.wear is not None)):
            if given:
                words = "goes with contacts that no side of a cyclic sector cuts; expected a sector cut elsewhere"
                raise InputError(words, where=("contact", i, key))
        found.append(i)
    return found


def _matched(
    space: Space, symmetry: CyclicSymmetry, first: IntArray, second: IntArray, where: Where
) -> tuple[Array, IntArray]:
    """R, (d, d), and which node of the second side every node of the first is turned to."""
    points, d, size = space.mesh.points, space.dimension, float(space.mesh.extent.max())
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
