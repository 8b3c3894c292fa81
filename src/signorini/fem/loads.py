# SPDX-License-Identifier: BSD-3-Clause
"""Nodal forces of loads."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from signorini.arrays import Array, IntArray, distinct, padded, stored
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.jacobian import cell_determinants
from signorini.fem.measure import facet_areas, measure, measure_of_cells
from signorini.fem.obstacles import arm, obstacle_loads
from signorini.fem.places import nodes_at, place_dofs
from signorini.fem.space import ON_AXIS, Block, Space
from signorini.fem.thermal import thermal_forces
from signorini.fem.varying import on_facets
from signorini.model.conditions import BODY_LOADS, Load
from signorini.model.model import Model
from signorini.model.varying import Varying

_AT_ONCE = 1 << 16  # cells whose nodes are looked at together: what they take does not grow with the mesh


def nodal_loads(space: Space, model: Model) -> dict[str, Array]:
    """Consistent nodal forces of every load, and of loaded obstacles, at factor 1, by name, each (dofs,)."""
    nodal = {load.label: load_forces(space, model, load, ("load", i)) for i, load in enumerate(model.loads)}
    return nodal | obstacle_loads(space, model) if model.obstacles else nodal


def load_forces(space: Space, model: Model, load: Load, where: Where) -> Array:
    """(dofs,) Consistent nodal forces of a load at factor 1.

    Parameters
    ----------
    space, model : of the bodies
    load : one of the model, or one like it
    where : what errors call it
    """
    forces = np.zeros(space.number_of_dofs)
    if load.force is not None and any(load.on == body.name for body in model.rigid_bodies):
        dofs = place_dofs(space, model, load.on, (*where, "on"))[0]
        size = np.where(np.arange(len(dofs)) < space.dimension, 1.0, arm(model))  # dofs of rotations are lengths
        forces[dofs] = _given(load.force) / size
    else:
        forces[: space.dofs_of_nodes] = _on_mesh(space, model, load, where)
    return forces


def _on_mesh(space: Space, model: Model, load: Load, where: Where) -> Array:
    if load.temperature is not None:
        return thermal_forces(space, model, load)
    if load.kind in BODY_LOADS:
        return _body_forces(space, model, load)
    forces = np.zeros((space.mesh.number_of_nodes, space.components))
    nodes, given = forces_at(space, model, load, where)
    forces[nodes] = given
    return forces.ravel()


def forces_at(space: Space, model: Model, load: Load, where: Where) -> tuple[IntArray, Array]:
    """Nodes (k,) of a boundary or set of nodes that a load is on, each once, and its forces (k, c) there at factor 1.

    Parameters
    ----------
    space, model : of the bodies
    load : neither a temperature nor one on all of a body
    where : what errors call it
    """
    if load.torque is not None:
        return _torque(space, model, load, where)
    if load.nodal_forces is not None or (load.force is not None and load.on not in space.mesh.boundaries):
        nodes = nodes_at(space, load.on, (*where, "on"), completed=load.force is not None)
        forces = np.zeros((len(nodes), space.components))
        forces[:] = _given(load.force) / len(nodes) if load.force is not None else load.nodal_forces
        _check_axis(model, nodes, forces, where)
        return nodes, forces
    side = boundary(space, str(load.on), (*where, "on"))
    if load.pressure is not None:
        pressures = on_facets(load.pressure, space, side, (*where, "pressure"))
        parts = [
            -p[..., None] * measure(model, block.at, block.cells)[..., None] * block.outward
            for p, block in zip(pressures, side.blocks, strict=True)
        ]
    elif load.bearing is not None:
        parts = _bearing(model, load, side, (*where, "bearing"))
    else:
        areas = [facet_areas(model, block)[..., None] for block in side.blocks]
        if load.force is not None:
            tractions = [_given(load.force) / sum(float(area.sum()) for area in areas)] * len(areas)
        else:
            tractions = _tractions(space, load, side, (*where, "traction"))
        parts = [area * traction for area, traction in zip(areas, tractions, strict=True)]
    nodal = side.nodal(parts)
    return side.nodes, padded(nodal, space.components)


def _torque(space: Space, model: Model, load: Load, where: Where) -> tuple[IntArray, Array]:
    """Forces along the hoop that grow with the radius: tractions on a boundary, forces on the nodes of a set."""
    if load.on in space.mesh.boundaries:
        side = boundary(space, str(load.on), (*where, "on"))
        arms = [facet_areas(model, block) * block.at[..., 0] for block in side.blocks]
        nodes, shares = side.nodes, side.nodal(arms)
        lever = sum(float((arm * block.at[..., 0]).sum()) for arm, block in zip(arms, side.blocks, strict=True))
    else:
        nodes = nodes_at(space, load.on, (*where, "on"))
        shares = space.mesh.points[nodes, 0]
        lever = float(shares @ shares)
    if not lever > 0.0:
        raise InputError("acts on the axis; expected a place with a radius", where=(*where, "torque"))
    assert load.torque is not None
    forces = np.zeros((len(nodes), space.components))
    forces[:, 2] = load.torque / lever * shares
    return nodes, forces


def _tractions(space: Space, load: Load, side: Boundary, where: Where) -> list[Array]:
    """At the quadrature points of every block of facets, (m, q, d)."""
    if callable(load.traction):
        given = load.traction
        columns: list[Varying] = [partial(_column, given, i, space.components) for i in range(space.components)]
    else:
        assert load.traction is not None
        columns = list(load.traction)
    found = [on_facets(column, space, side, where) for column in columns]
    return [np.stack(block, axis=-1) for block in zip(*found, strict=True)]


def _column(given: Callable[[Array], Array], i: int, components: int, points: Array) -> Array:
    """A component of a function that gives one vector a point."""
    found = np.asarray(given(points), float)
    if found.shape != (len(points), components):
        raise InputError(
            f"is a function that gives shape {found.shape} for points {points.shape}; expected one vector a point"
        )
    column: Array = found[:, i]
    return column


def _bearing(model: Model, load: Load, side: Boundary, where: Where) -> list[Array]:
    """Forces at the quadrature points, (m, q, d), of a pressure ``p c``, c the cosine into the body where it is > 0.

    The total along the force is as given; what it presses across cancels where the side is symmetric about the force.
    """
    assert load.bearing is not None
    size = float(np.linalg.norm(load.bearing))
    way = np.array(load.bearing) / size
    cosines = [np.maximum(-(block.outward @ way), 0.0) / block.weights for block in side.blocks]
    inward = [
        -c[..., None] * measure(model, block.at, block.cells)[..., None] * block.outward
        for c, block in zip(cosines, side.blocks, strict=True)
    ]
    total = sum(float((part @ way).sum()) for part in inward)
    if total <= 0.0:
        raise InputError(
            f"is {load.bearing}, which pulls on '{load.on}' everywhere; expected a force into the body", where=where
        )
    return [part * (size / total) for part in inward]


def _check_axis(model: Model, nodes: IntArray, forces: Array, where: Where) -> None:
    """A radial force at one node of the axis is not symmetric."""
    if not model.axisymmetric:
        return
    radii = model.mesh.points[:, 0]
    wrong = np.flatnonzero((radii[nodes] <= ON_AXIS * radii.max()) & (forces[:, ::2] != 0.0).any(axis=1))
    if len(wrong):
        kind = "radial" if forces[wrong[0], 0] else "hoop"
        raise InputError(f"has a {kind} component at node {nodes[wrong[0]] + 1}, which is on the axis", where=where)


def _given(force: tuple[float | None, ...]) -> Array:
    return np.array([part or 0.0 for part in force])


def _body_forces(space: Space, model: Model, load: Load) -> Array:
    """``int N_k b dx`` over a body."""
    index = next(i for i, body in enumerate(model.bodies) if body.name == load.on)
    owner = model.body_of_cells()
    forces = np.zeros((len(space.mesh.points), space.components))
    for block, volumes in zip(space.blocks, space.volumes, strict=True):
        here = np.flatnonzero(owner[block.first : block.first + len(block.cells)] == index)
        at = np.einsum("qk,mki->mqi", block.values, space.mesh.points[block.cells[here]])
        weights = (volumes[here] * measure(model, at, block.first + here))[..., None]
        density = _density(load, model.bodies[index].material.density, at, model.axisymmetric)
        shares = np.einsum("qk,mqi->mki", block.values, weights * density)
        np.add.at(forces[:, : shares.shape[2]], block.cells[here], shares)
    return forces.ravel()


def nodal_volumes(space: Space, model: Model) -> Iterator[tuple[IntArray, Array]]:
    """``int N_k dx`` over some cells at a time: their nodes (k,), and of each, < 0 in some quadratic ones.

    Parameters
    ----------
    space, model : of the bodies
    """
    for block in space.blocks:
        cells = stored(block, "cells")
        for first in range(0, cells.shape[0], _AT_ONCE):
            rows = np.arange(first, min(first + _AT_ONCE, cells.shape[0]))
            corners = cells[rows]
            nodes = distinct(corners)
            own, points = np.searchsorted(nodes, corners), space.mesh.places_of(nodes)
            weights = np.abs(cell_determinants(points, own, block.gradients)) * block.weights
            at = partial(_quadrature_points, block, points[own])
            weights = weights * measure_of_cells(model, at, block.first + rows)
            yield nodes, np.bincount(own.ravel(), (weights @ block.values).ravel()).astype(np.float64, copy=False)


def _density(load: Load, mass: float, at: Array, axisymmetric: bool) -> Array:
    """Force per volume at points (m, q, d)."""
    if load.centrifugal is not None:
        arm = at - np.array(load.centre or (0.0,) * at.shape[-1])
        along = np.array(load.axis) if load.axis is not None else np.eye(3)[2]
        if arm.shape[-1] == 2:
            along = np.array([0.0, 1.0 if axisymmetric else 0.0])
        along = along / max(float(np.linalg.norm(along)), 1.0e-300)
        outward: Array = arm - (arm @ along)[..., None] * along
        return mass * load.centrifugal**2 * outward
    constant = np.array(load.body_force) if load.body_force is not None else mass * np.array(load.gravity)
    return np.broadcast_to(constant, (*at.shape[:-1], len(constant)))


def _quadrature_points(block: Block, corners: Array) -> Array:
    """Of cells of a block, (m, q, d), whose corners are at (m, k, d)."""
    at: Array = block.values @ corners
    return at
