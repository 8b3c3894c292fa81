# SPDX-License-Identifier: BSD-3-Clause
"""Which bodies may turn by any angle: those that contact alone holds, a hub of theirs, or a hinge at a node."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from signorini.arrays import Array, BoolArray, IntArray, among, extent
from signorini.fem.body_frames import BodyFrame, BodyFrames, triad
from signorini.fem.links import linked_nodes, rigid_nodes
from signorini.fem.obstacles import arm
from signorini.fem.places import nodes_at, place_dofs
from signorini.fem.rigid import ConnectedBody, connected_bodies
from signorini.fem.space import Space
from signorini.model.model import Model

_DIGITS = 9  # of the size of a body: distances that are equal but for rounding choose the first node
_ON_ONE_LINE = 1e-6  # of the size of a body: distance below which corners count as on one line


def turning_bodies(space: Space, model: Model, parts: tuple[ConnectedBody, ...] | None = None) -> BodyFrames:
    """The frames of all bodies with sides of contacts that slide far, where nothing fixed keeps them from turning.

    Supports, foundations, equations and contacts between sides that stay opposite each other keep bodies from it:
    what they hold is held in directions of space. Bodies that are joined by them, or by a rigid body, turn as one.

    Parameters
    ----------
    space, model : of the bodies
    parts : connected pieces, where they are known
    """
    if model.axisymmetric:
        return BodyFrames(dimension=space.dimension)
    parts = connected_bodies(space, model) if parts is None else parts
    joined = _joined(space, model, parts)
    held = _held(space, model)
    slides = _sliding_nodes(model, joined)
    frames = []
    for group in np.unique(joined[joined >= 0]):
        places = np.flatnonzero(joined == group)
        if slides[places].any():
            label = " and ".join(part.label for part in parts if part.kind == "body" and joined[part.nodes[0]] == group)
            hubs = tuple(j for j in range(len(model.rigid_bodies)) if joined[_hub_place(space, model, j)] == group)
            frame = _frame(space, model, _Group(label=label, places=places, hubs=hubs), held)
            frames += [] if frame is None else [frame]
    return BodyFrames(frames=tuple(frames), dimension=space.dimension)


def in_frames(space: Space, model: Model, displacement: Array) -> tuple[Array, Array | None]:
    """Displacements less those of frames, in their axes, and the rotations of the nodes; None where no body turns.

    Parameters
    ----------
    space, model : of the bodies
    displacement : (nodes, d) in space, of bodies that have turned, too
    """
    carriers = len(model.obstacles) + len(model.rigid_bodies)
    frames = turning_bodies(replace(space, obstacles=carriers, linked=linked_nodes(model)), model)
    if not frames:
        return displacement, None
    points, local = space.mesh.points, displacement.copy()
    turns = np.broadcast_to(np.eye(space.dimension), (len(points), space.dimension, space.dimension)).copy()
    for frame in frames.frames:
        nodes, first = frame.places[frame.places < len(points)], frame.corners[0]
        turn = frame.turn_at(points + displacement)
        lever = points[nodes] - points[first]
        local[nodes] = (lever + displacement[nodes] - displacement[first]) @ turn - lever
        turns[nodes] = turn
    return local, turns


@dataclass(frozen=True, kw_only=True, eq=False)
class _Group:
    """Parts that turn as one.

    Attributes
    ----------
    label : of the parts
    places : (k,) their nodes, and the first of the two nodes of their rigid bodies
    hubs : numbers of those
    """

    label: str
    places: IntArray
    hubs: tuple[int, ...]


def _hub_place(space: Space, model: Model, j: int) -> int:
    """The first of the two nodes of rigid body j."""
    return int(space.obstacle_dofs(len(model.obstacles) + j)[0]) // space.dimension


def _joined(space: Space, model: Model, parts: tuple[ConnectedBody, ...]) -> IntArray:
    """(places,) Number of the parts that are joined of every node, -1 of what is no part of the mesh."""
    part_of = np.full(space.number_of_dofs // space.dimension, -1)
    meshed = [part for part in parts if part.kind == ConnectedBody.kind]
    for i, part in enumerate(meshed):
        part_of[part.nodes] = i
    together: list[IntArray] = []
    for contact in model.contacts:
        sides = contact.meshed_sides(model.mesh)
        if not contact.slides and len(sides) == 2:
            together.append(np.concatenate([model.mesh.nodes_of(side) for side in sides]))
    for j in range(len(model.rigid_bodies)):
        nodes = rigid_nodes(space, model, j)
        part_of[_hub_place(space, model, j)] = part_of[nodes].max()
        together.append(nodes)
    edges = [np.unique(part_of[nodes][part_of[nodes] >= 0]) for nodes in together]
    one = np.concatenate([np.empty(0, np.int64), *(np.repeat(own[:1], len(own)) for own in edges)])
    two = np.concatenate([np.empty(0, np.int64), *edges])
    graph = sp.csr_array((np.ones(len(one)), (one, two)), shape=(len(meshed), len(meshed)))
    _, group = connected_components(graph, directed=False)
    return np.where(part_of >= 0, group[part_of], -1)


def _held(space: Space, model: Model) -> BoolArray:
    """(dofs,) What is held in directions of space, or moves in a way that only they can say."""
    dofs: list[IntArray] = [np.empty(0, np.int64)]
    for i, support in enumerate(model.supports):
        rows = place_dofs(space, model, support.on, ("support", i, "on"))
        dofs += [rows[:, axis] for axis, part in enumerate(support.u) if part is not None]
    for i, load in enumerate(model.loads):
        if load.spread == "displacement":
            dofs.append(space.dofs(nodes_at(space, load.on, ("load", i, "on"))).ravel())
    dofs += [space.dofs(model.mesh.nodes_of(foundation.on)).ravel() for foundation in model.foundations]
    names = [body.name for body in model.rigid_bodies]
    for i, equation in enumerate(model.equations):
        if not all(on in names for on, _, _ in equation.terms):
            places = [on for on, _, _ in equation.terms]
            dofs += [place_dofs(space, model, on, ("equation", i, "terms", k)).ravel() for k, on in enumerate(places)]
    for contact in model.contacts:
        if not contact.slides and len(contact.meshed_sides(model.mesh)) == 1:
            dofs.append(space.dofs(model.mesh.nodes_of(contact.nonmortar)).ravel())
    return among(dofs, space.number_of_dofs)


def _sliding_nodes(model: Model, joined: IntArray) -> BoolArray:
    """(places,) Nodes of the sides of contacts that slide far."""
    sides = [side for contact in model.contacts if contact.slides for side in contact.meshed_sides(model.mesh)]
    return among([model.mesh.nodes_of(side) for side in sides], len(joined))


def _frame(space: Space, model: Model, group: _Group, held: BoolArray) -> BodyFrame | None:
    """The frame of a group; None where something fixed keeps it from turning."""
    d, count = space.dimension, len(space.mesh.points)
    hub = group.hubs[0] if group.hubs else -1
    own = _hub_place(space, model, hub) if group.hubs else -1
    places = group.places[group.places != own]
    nodes = places[places < count]
    there = held.reshape(-1, d)[places]
    pins = places[there.all(axis=1)] if hub < 0 else places[:0]
    if there.any(axis=1).sum() > len(pins) or len(pins) > 1 or (pins >= count).any():
        return None
    points = space.mesh.points
    among_nodes = nodes if hub < 0 else rigid_nodes(space, model, hub)
    corners = _corners(points, among_nodes, pins)
    if corners is None and hub >= 0:
        corners = _corners(points, nodes, pins)
    if corners is None:
        return None
    axes = triad(points[corners])
    if hub < 0:
        about = corners[:1] if len(pins) else corners[:2]
        point, reading, turning = points[about].mean(axis=0), _read_off(space, corners, about), np.empty(0, np.int64)
    else:
        point = np.array(model.rigid_bodies[hub].point)
        dofs = place_dofs(space, model, model.rigid_bodies[hub].name, ("rigid_body", hub, "on"))[0]
        size = np.where(np.arange(len(dofs)) < d, 1.0, 1.0 / arm(model))  # dofs of rotations are lengths
        reading = sp.csr_array((size, (np.arange(len(dofs)), dofs)), shape=(len(dofs), space.number_of_dofs))
        turning = dofs[d:]
    where = np.concatenate([points, np.zeros((len(held) // d - count, d))])
    for j in group.hubs:
        where[_hub_place(space, model, j)] = model.rigid_bodies[j].point
    return BodyFrame(
        label=group.label,
        places=places,
        lever=where[places] - point,
        reading=reading,
        turning=turning,
        corners=corners,
        triad=axes,
    )


def _corners(points: Array, nodes: IntArray, first: IntArray) -> IntArray | None:
    """(d,) Nodes far from each other, in space not on one line; None where there are none.

    Parameters
    ----------
    points : (nodes, d) of the mesh
    nodes : (k,) to choose from
    first : the first of them, where it is known
    """
    at = points[nodes]
    size = float(np.linalg.norm(extent(at))) or 1.0
    chosen = [int(np.flatnonzero(nodes == first[0])[0]) if len(first) else _farthest(at - at.mean(axis=0), size)]
    chosen.append(_farthest(at - at[chosen[0]], size))
    along = at[chosen[1]] - at[chosen[0]]
    if not np.linalg.norm(along) > _ON_ONE_LINE * size:
        return None
    if points.shape[1] == 3:
        along = along / np.linalg.norm(along)
        beside = at - at[chosen[0]]
        beside = beside - (beside @ along)[:, None] * along
        chosen.append(_farthest(beside, size))
        if not np.linalg.norm(beside[chosen[2]]) > _ON_ONE_LINE * size:
            return None
    return np.asarray(nodes[chosen])


def _farthest(levers: Array, size: float) -> int:
    """The first of the longest of levers (k, d), for rounding is not to choose."""
    return int(np.argmax(np.round(np.linalg.norm(levers, axis=1) / size, _DIGITS)))


def _read_off(space: Space, corners: IntArray, about: IntArray) -> sp.csr_array:
    """(d + 1 or d + 3, dofs) Mean displacement of some corners, and the rotation of the directions between all.

    What is left of the corners is along the first direction, and in the plane of all three: what strains alone do.

    Parameters
    ----------
    space : of the mesh
    corners : (d,) nodes
    about : the first one or two of them
    """
    d, at = space.dimension, space.mesh.points[corners]
    axes, dofs = triad(at), space.dofs(corners)
    length = float(np.linalg.norm(at[1] - at[0]))
    read = np.zeros((d + (1 if d == 2 else 3), d, d))  # rows, corners, directions
    read[:d, : len(about)] = np.eye(d)[:, None] / len(about)
    between = np.zeros((d - 1, d, d, d))
    for corner in range(1, d):  # u of a corner less that of the first, along every axis of the triad
        between[corner - 1, :, corner], between[corner - 1, :, 0] = axes, -axes
    second = between[0] / length
    if d == 2:
        read[2] = second[1]
    else:
        forth, aside = (at[2] - at[0]) @ axes[0], (at[2] - at[0]) @ axes[1]
        turns = np.stack([(between[1, 2] - forth * second[2]) / aside, -second[2], second[1]])
        read[3:] = np.einsum("ai,acj->icj", axes, turns)
    rows = sp.coo_array(read.reshape(len(read), -1))
    return sp.csr_array((rows.data, (rows.row, dofs.ravel()[rows.col])), shape=(len(read), space.number_of_dofs))
