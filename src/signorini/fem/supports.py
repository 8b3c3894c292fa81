# SPDX-License-Identifier: BSD-3-Clause
"""Supports and rigid boundaries: the displacements that remain unknown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.fem.foundation import make_springs
from signorini.fem.obstacles import driven
from signorini.fem.places import nodes_at
from signorini.fem.space import ON_AXIS, Space
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class Constraints:
    """``u = T z + sum_k s_k g_k``: z the free displacements, g_k what support k prescribes at factor 1.

    Attributes
    ----------
    free : (dofs,) index into z, -1 where a support, the axis (or nothing at all) holds the dof; dofs that move together
        share one
    transform : (dofs, z) sparse T, one entry 1 a row
    prescribed : name of moving support or obstacle to (dofs,) displacements at factor 1
    springs : elastic foundations by name, see :func:`signorini.fem.foundation.make_springs`
    owner : (dofs,) index of the support that holds the dof, otherwise -1
    nodes : (z,) a node of each free displacement; those of obstacles follow the nodes of the mesh
    """

    free: IntArray
    transform: sp.csr_array
    prescribed: Mapping[str, Array]
    springs: Mapping[str, sp.csr_array]
    owner: IntArray
    nodes: IntArray

    @property
    def leaders(self) -> IntArray:
        """(z,) The first dof of each free displacement."""
        held = int((self.free < 0).any())
        return np.asarray(np.unique(self.free, return_index=True)[1][held:], dtype=np.int64)

    def foundation_forces(self, displacement: Array) -> Array:
        """Forces of all elastic foundations on the bodies, (dofs,)."""
        return sum((-(S.T @ (S @ displacement)) for S in self.springs.values()), np.zeros(len(self.free)))


def make_constraints(space: Space, model: Model) -> Constraints:
    """Read supports and rigid loaded boundaries.

    Raises
    ------
    InputError
        If two supports prescribe different values at one node, a support moves a node off the axis of an axisymmetric
        body, or a rigid boundary carries a support in its direction.
    """
    d, total = space.dimension, space.number_of_dofs
    axis_dofs = _on_axis(space, model)
    owner = np.full(total, -1)
    values = np.zeros(total)
    prescribed = {support.label: np.zeros(total) for support in model.supports if support.moves}
    for i, support in enumerate(model.supports):
        nodes = nodes_at(space, support.on, ("support", i, "on"))
        for axis, value in enumerate(support.u):
            if value is None:
                continue
            dofs = nodes * d + axis
            if value != 0.0:
                _check_axis(space, np.intersect1d(dofs, axis_dofs), i, value)
            _check_agreement(space, model, owner, values, dofs, i, value)
            new = dofs[owner[dofs] < 0]
            owner[new], values[new] = i, value
            if support.moves:
                prescribed[support.label][new] = value
    held = owner >= 0
    for j, obstacle in enumerate(model.obstacles):
        dofs = space.obstacle_dofs(j)
        held[dofs], path = driven(model, j)
        if path.any():
            prescribed[obstacle.label] = np.zeros(total)
            prescribed[obstacle.label][dofs] = path
    unused = np.setdiff1d(np.arange(len(space.mesh.points)), space.used_nodes)
    held[space.dofs(unused).ravel()] = True
    held[axis_dofs] = True
    leader = np.arange(total)
    for i, load in enumerate(model.loads):
        if load.spread == "displacement" and load.force is not None:
            nodes = nodes_at(space, load.on, ("load", i, "on"))
            for axis, part in enumerate(load.force):
                if part is not None:
                    _tie(space, model, leader, owner, held, nodes * d + axis, i)
    free = np.full(total, -1)
    leaders = np.nonzero(~held & (leader == np.arange(total)))[0]
    free[leaders] = np.arange(len(leaders))
    free = np.where(held, -1, free[leader])
    rows = np.nonzero(free >= 0)[0]
    transform = sp.csr_array((np.ones(len(rows)), (rows, free[rows])), shape=(total, len(leaders)))
    return Constraints(
        free=free,
        transform=transform,
        prescribed=prescribed,
        springs=make_springs(space, model),
        owner=owner,
        nodes=leaders // d,
    )


def _on_axis(space: Space, model: Model) -> IntArray:
    """Radial dofs of nodes on the axis of an axisymmetric body: its points cannot leave the axis."""
    if not model.axisymmetric:
        return np.empty(0, int)
    radii = space.mesh.points[space.used_nodes, 0]
    return space.used_nodes[radii <= ON_AXIS * radii.max()] * space.dimension


def _check_axis(space: Space, dofs: IntArray, i: int, value: float) -> None:
    if len(dofs):
        number = space.mesh.labels[dofs[0] // 2]
        raise InputError(
            f"u_r = {value:g} at node {number}, which is on the axis and stays there; expected 0 or None "
            '(in a deck "free")',
            where=("support", i, "u"),
        )


def _check_agreement(
    space: Space, model: Model, owner: IntArray, values: Array, dofs: IntArray, i: int, value: float
) -> None:
    """Two supports may share a dof if they prescribe the same at every load factor."""
    for dof in dofs[owner[dofs] >= 0]:
        other = model.supports[owner[dof]]
        if value == 0.0 and values[dof] == 0.0:
            continue
        node, axis = divmod(int(dof), space.dimension)
        number = space.mesh.labels[node]
        raise InputError(
            f"'{model.supports[i].label}' prescribes u_{model.axes[axis]} = {value:g} at node {number}, where "
            f"support '{other.label}' prescribes {values[dof]:g}; expected one support to move a node in a direction",
            where=("support", i, "u"),
        )


def _tie(
    space: Space, model: Model, leader: IntArray, owner: IntArray, held: BoolArray, dofs: IntArray, i: int
) -> None:
    """Let the dofs of a rigid loaded boundary follow the first of them."""
    blocked = dofs[held[dofs] | (leader[dofs] != dofs)]
    if len(blocked):
        node, axis = divmod(int(blocked[0]), space.dimension)
        number = space.mesh.labels[node]
        by = "the axis" if held[blocked[0]] else "another load"
        by = f"support '{model.supports[owner[blocked[0]]].label}'" if owner[blocked[0]] >= 0 else by
        raise InputError(
            f"the boundary should move rigidly in {model.axes[axis]}, but {by} holds node {number} in that "
            'direction; expected the component to be free (None, in a deck "free")',
            where=("load", i, "force"),
        )
    leader[dofs] = dofs[0]
