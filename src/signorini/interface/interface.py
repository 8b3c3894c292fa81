# SPDX-License-Identifier: BSD-3-Clause
"""The contact interface of a model: one list of pairs for all contacts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.measure import nodal_areas
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.matching import match_nodes
from signorini.model.contact import Contact, Plane
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class Interface:
    """Pairs of points that may touch: ``u_c = B u`` is the relative displacement, the gap is ``g + B_n u``.

    The normal n points from the mortar side into the nonmortar body, the tangent is ``t = (n_y, -n_x)``. Forces of the
    interface on the bodies are ``B^T r``, r the normal (pressing > 0) and tangential forces on the nonmortar body.

    Attributes
    ----------
    B : (2 n, dofs) sparse; n normal rows, then n tangential rows
    gap : (n,) initial gaps g, length, negative where the bodies overlap
    area : (n,) tributary area, see :func:`signorini.fem.measure.nodal_areas`
    normals, tangents : (n, 2) unit vectors
    node, partner : (n,) nodes on the nonmortar and on the mortar side (-1: rigid obstacle)
    contact : (n,) index of the contact that a pair belongs to
    friction : (n,) Coulomb's coefficient, infinite where it sticks
    normal_compliance, tangential_compliance : (n,) length per pressure
    """

    B: sp.csr_array
    gap: Array
    area: Array
    normals: Array
    tangents: Array
    node: IntArray
    partner: IntArray
    contact: IntArray
    friction: Array
    normal_compliance: Array
    tangential_compliance: Array

    def __len__(self) -> int:
        return len(self.gap)


def make_interface(space: Space, model: Model, constraints: Constraints) -> Interface:
    """Pair the surfaces of all contacts.

    Raises
    ------
    InputError
        If surfaces do not match or do not face each other or their obstacle, with the contact's index.
    """
    parts = [_pairs(space, model, constraints, i, contact) for i, contact in enumerate(model.contacts)]
    node, partner, normals, gap, area, index = (
        np.concatenate([part[k] for part in parts]) if parts else empty
        for k, empty in enumerate(
            (np.empty(0, int), np.empty(0, int), np.empty((0, 2)), np.empty(0), np.empty(0), np.empty(0, int))
        )
    )
    tangents = np.column_stack([normals[:, 1], -normals[:, 0]])

    def data(key: str) -> Array:
        return np.array([getattr(contact, key) for contact in model.contacts], float)[index]

    return Interface(
        B=_relative(space, node, partner, normals, tangents),
        gap=gap,
        area=area,
        normals=normals,
        tangents=tangents,
        node=node,
        partner=partner,
        contact=index,
        friction=data("coefficient"),
        normal_compliance=data("normal_compliance"),
        tangential_compliance=data("tangential_compliance"),
    )


def _pairs(
    space: Space, model: Model, constraints: Constraints, i: int, contact: Contact
) -> tuple[IntArray, IntArray, Array, Array, Array, IntArray]:
    """Nodes, partners, normals, gaps, areas and contact index of one contact."""
    points = space.mesh.points
    side = boundary(space, contact.nonmortar, ("contact", i, "nonmortar"))
    if isinstance(contact.mortar, Plane):
        partner = np.full(len(side.nodes), -1)
        normals = np.tile(contact.mortar.normal, (len(side.nodes), 1))
        if (side.normals @ normals[0] >= 0).all():
            raise InputError(
                f"'{contact.nonmortar}' faces away from the plane; its normal {contact.mortar.normal} must point from "
                "the obstacle towards the body",
                where=("contact", i, "plane"),
            )
        gap = contact.mortar.gap(points[side.nodes])
    else:
        mortar = boundary(space, contact.mortar, ("contact", i, "mortar"))
        partner = match_nodes(points, side, mortar, ("contact", i))
        normals = _along_symmetry(space, constraints, side)
        gap = np.sum((points[side.nodes] - points[partner]) * normals, axis=1)
    if contact.gap != "geometry":
        gap = np.full(len(gap), contact.gap)
    area = nodal_areas(model, side)
    return side.nodes, partner, normals, gap - contact.interference, area, np.full(len(gap), i)


def _along_symmetry(space: Space, constraints: Constraints, side: Boundary) -> Array:
    """Minus the averaged outward normals; in the plane of symmetry where a support keeps a node in one.

    The average at the last node of a half model misses the other half: its component along the supported direction is
    what the mirror image takes away.
    """
    normals = -side.nodal_normals
    held = constraints.free[space.dofs(side.nodes)] < 0
    inside = np.where(held, 0.0, normals)
    size = np.linalg.norm(inside, axis=1)
    mirrored = size > 0.5
    normals[mirrored] = inside[mirrored] / size[mirrored, None]
    return normals


def _relative(space: Space, node: IntArray, partner: IntArray, normals: Array, tangents: Array) -> sp.csr_array:
    """Rows ``e . (u_node - u_partner)`` for e the normals, then the tangents."""
    n, paired = len(node), np.nonzero(partner >= 0)[0]
    rows, columns, values = [], [], []
    for block, axes in enumerate((normals, tangents)):
        for pairs, nodes, sign in ((np.arange(n), node, 1.0), (paired, partner, -1.0)):
            rows.append(np.repeat(block * n + pairs, space.dimension))
            columns.append(space.dofs(nodes[pairs]).ravel())
            values.append(sign * axes[pairs].ravel())
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    relative = sp.csr_array(entries, shape=(2 * n, space.number_of_dofs))
    relative.eliminate_zeros()
    return relative
