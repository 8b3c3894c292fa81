# SPDX-License-Identifier: BSD-3-Clause
"""The contact interface of a model: one list of pairs for all contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.fem.obstacles import carried
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.coupling import along
from signorini.interface.frames import tangents
from signorini.interface.pairing import Sides, make_pairs
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class Interface:
    """Pairs that may touch: ``u_c = B u`` is the relative displacement, the gap is ``g + B_n u``.

    A pair is a nonmortar node and what lies opposite: a node, a weighted mean of nodes, or a rigid obstacle.

    The normal n points from the mortar side into the nonmortar body, the tangent is ``t = (n_y, -n_x)``; in space there
    are two, ``t1 x t2 = n``. Forces of the interface on the bodies are ``B^T r``, r the normal (pressing > 0) and
    tangential forces on the nonmortar body.

    Attributes
    ----------
    B : (d n, dofs) sparse; n normal rows, then n rows of every tangent
    gap : (n,) initial gaps g, length, negative where the bodies overlap
    area : (n,) tributary area, see :class:`signorini.interface.coupling.Coupling`
    normals : (n, d) unit vectors
    tangents : (n, d - 1, d) unit vectors
    node : (n,) nodes on the nonmortar side
    contact : (n,) index of the contact that a pair belongs to
    friction : (n,) Coulomb's coefficient, infinite where it sticks
    normal_compliance, tangential_compliance : (n,) length per pressure
    tied : (n,) whether the pair neither slips nor opens
    sides : how every contact was paired
    """

    B: sp.csr_array
    gap: Array
    area: Array
    normals: Array
    tangents: Array
    node: IntArray
    contact: IntArray
    friction: Array
    normal_compliance: Array
    tangential_compliance: Array
    tied: BoolArray
    sides: tuple[Sides, ...]

    def __len__(self) -> int:
        return len(self.gap)

    @property
    def directions(self) -> int:
        """Rows of B a pair, d."""
        return int(self.normals.shape[1])

    def rows(self, pairs: BoolArray) -> BoolArray:
        """(d n,) the rows of B that belong to some pairs (n,)."""
        return np.tile(pairs, self.directions)

    @property
    def compliance(self) -> Array:
        """(d n,) of every row of B, length per pressure."""
        return np.concatenate([self.normal_compliance, np.tile(self.tangential_compliance, self.directions - 1)])

    @property
    def areas(self) -> Array:
        """(d n,) of every row of B."""
        return np.tile(self.area, self.directions)

    def across(self, tangential: Array) -> Array:
        """(n,) length of tangential vectors that are given row by row, ((d - 1) n,)."""
        length: Array = np.linalg.norm(tangential.reshape(self.directions - 1, len(self)), axis=0)
        return length


def make_interface(space: Space, model: Model, constraints: Constraints) -> Interface:
    """Pair the surfaces of all contacts.

    Raises
    ------
    InputError
        If surfaces do not face each other or their obstacle, or cannot be paired as asked, with the contact's index.
    """
    parts = [make_pairs(space, model, constraints, i) for i in range(len(model.contacts))]
    index = np.repeat(np.arange(len(parts)), [len(part.gap) for part in parts]).astype(int)
    normals = _joined([part.coupling.normals for part in parts], (0, space.dimension))
    area = _joined([part.coupling.area for part in parts], (0,))
    node: IntArray = np.concatenate([np.empty(0, int), *(part.coupling.nodes for part in parts)])
    mirrored: BoolArray = np.concatenate([np.empty((0, space.dimension), bool), *(part.mirrored for part in parts)])
    axes, still = tangents(normals, mirrored)

    def data(key: str) -> Array:
        return np.array([getattr(contact, key) for contact in model.contacts], float)[index]

    per_area = sp.diags_array(1.0 / area)
    none = sp.csr_array((0, len(space.mesh.points)))
    closing, sliding = (
        tuple(per_area @ sp.vstack([none, *(part[i] for part in of)]) for i in range(space.dimension))
        for of in ([part.coupling.forces for part in parts], [part.sliding for part in parts])
    )
    carrier = np.repeat([part.obstacle for part in parts], np.bincount(index, minlength=len(parts))).astype(int)
    rows = [_with_obstacles(space, model, carrier, closing)]
    for k in range(space.dimension - 1):
        turned = _turned(sliding, normals, axes[:, k])
        rows.append(sp.diags_array(np.where(still[:, k], 0.0, 1.0)) @ _with_obstacles(space, model, carrier, turned))
    return Interface(
        B=sp.csr_array(sp.vstack(rows)),
        gap=_joined([part.gap for part in parts], (0,)),
        area=area,
        normals=normals,
        tangents=axes,
        node=node,
        contact=index,
        friction=friction_of(space, model, node, index),
        normal_compliance=data("normal_compliance"),
        tangential_compliance=data("tangential_compliance"),
        tied=data("tied").astype(bool),
        sides=tuple(part.sides for part in parts),
    )


def _joined(parts: Sequence[Array], none: tuple[int, ...]) -> Array:
    return np.concatenate(parts) if parts else np.empty(none)


def friction_of(space: Space, model: Model, node: IntArray, contact: IntArray) -> Array:
    """Coulomb's coefficient of every pair, (n,).

    Parameters
    ----------
    node, contact : (n,) nonmortar nodes of the pairs, and the contacts that they belong to

    Raises
    ------
    InputError
        If a function that gives the friction gives something else, with the contact's index.
    """
    friction = np.zeros(len(node))
    for i, data in enumerate(model.contacts):
        own = contact == i
        try:
            friction[own] = data.coefficients(space.mesh.points[node[own]])
        except InputError as error:
            raise error.inside("contact", i) from error
    return friction


def _turned(closing: tuple[sp.csr_array, ...], normals: Array, axes: Array) -> tuple[sp.csr_array, ...]:
    """Rows of the sliding along one axis t of every pair: what turns n into t, ``t n^T - n t^T``, turns them too.

    In the plane that is the exact turn by a right angle: where the weights of the gap follow the normals along a curved
    side, those of the sliding follow its tangents, and a uniform friction passes as exactly as a uniform pressure.
    """
    onto, aside = along(closing, normals), along(closing, axes)
    return tuple(
        sp.csr_array(sp.diags_array(axes[:, i]) @ onto - sp.diags_array(normals[:, i]) @ aside)
        for i in range(axes.shape[1])
    )


def _with_obstacles(space: Space, model: Model, carrier: IntArray, weights: tuple[sp.csr_array, ...]) -> sp.csr_array:
    """Rows ``sum_ji weights_kji u_ji`` in terms of all unknowns: moving obstacles take the nonmortar side with them."""
    entries = [sp.coo_array(part) for part in weights]
    rows = np.concatenate([part.row for part in entries])
    columns = np.concatenate([space.dofs(part.col.astype(np.int64))[:, i] for i, part in enumerate(entries)])
    values = np.concatenate([part.data for part in entries])
    bodies = sp.csr_array((values, (rows, columns)), shape=(len(carrier), space.mesh.points.size))
    bodies.eliminate_zeros()
    width = 2 * space.dimension
    moved = np.zeros((len(carrier), width * len(model.obstacles)))
    for j in range(len(model.obstacles)):
        own = np.flatnonzero(carrier == j)
        seen = np.unique(np.concatenate([part[own].indices for part in weights]))
        motions = carried(model, j, space.mesh.points[seen])
        of_pairs = sum(part[own][:, seen] @ motions[:, i] for i, part in enumerate(weights))
        moved[own, width * j : width * (j + 1)] = -of_pairs
    return sp.csr_array(sp.hstack([bodies, sp.csr_array(moved)]))
