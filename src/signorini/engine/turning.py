# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that turn: loads as they see them, and what small strains about their frames do not bear out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import ceil

import numpy as np

from signorini.arrays import Array, among
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.errors import SolveFailed
from signorini.fem.body_frames import mean_turn
from signorini.fem.jacobian import jacobians
from signorini.fem.rigid import ConnectedBody
from signorini.outcome import Outcome
from signorini.solution.state import LoadPoint, State

_HELD_TURN = 0.05  # radians: what a body without a frame may turn by; it strains it by half the square, 1.25e-3
_SAID_TURN = 0.005  # radians: from which on a note says so; strains of 1.25e-5
_STRAINED = 0.05  # strain beyond which small ones are visibly wrong
_TWISTED = 0.05  # radians by which a part of a body turns against its frame: strains are wrong by half the square
_FOLLOWING = ("pressure", "centrifugal", "temperature")  # kinds of loads that turn along; others keep their direction


def with_turned_loads(prepared: Prepared, displacement: Array) -> Prepared:
    """The model with its loads as bodies see them that have moved.

    Parameters
    ----------
    prepared : with loads as on bodies that have not
    displacement : (dofs,) as frames see it; empty where none has turned
    """
    frames = prepared.frames
    if not prepared.turns or not len(displacement):
        return prepared
    there = with_loads_in_space(prepared, displacement).loads
    return replace(prepared, loads={name: frames.felt(forces, displacement) for name, forces in there.items()})


def with_loads_in_space(prepared: Prepared, displacement: Array) -> Prepared:
    """The model with its loads as they are in space where bodies have moved: some kinds turn along.

    Parameters
    ----------
    prepared, displacement : as of `with_turned_loads`
    """
    frames, following = prepared.frames, {load.label for load in prepared.model.loads if load.kind in _FOLLOWING}
    if not prepared.turns or not len(displacement):
        return prepared
    loads = {
        name: frames.in_space(forces, displacement) if name in following else forces
        for name, forces in prepared.loads.items()
    }
    return replace(prepared, loads=loads)


def forces_in_space(prepared: Prepared, state: State, displacement: Array) -> tuple[Array, Array]:
    """Forces of loads, and of supports, on bodies in space, (dofs,) each.

    Parameters
    ----------
    prepared : the model
    state : in which they act
    displacement : (dofs,) that the loads have turned with, as of `with_turned_loads`
    """
    turned, _ = applied(with_turned_loads(prepared, displacement), state.point)
    loads, _ = applied(with_loads_in_space(prepared, displacement), state.point)
    held = prepared.constraints.support_forces(state.external - turned)
    return loads, prepared.frames.about_axes(held, state.displacement)


def first_share(prepared: Prepared, begin: LoadPoint, end: LoadPoint, limit: float) -> float:
    """The part of the way between two points of the load history in which supports move no node farther than a limit.

    It is 1 where no body turns: the motion of others is linear, and how far they slide is seen when they have.

    Parameters
    ----------
    prepared : the model
    begin, end : the points
    limit : length
    """
    if not prepared.turns:
        return 1.0
    imposed = applied(prepared, end)[1] - applied(prepared, begin)[1]
    return 1.0 / max(1, ceil(prepared.space.farthest(imposed) / limit))


def refuse_turned(prepared: Prepared, state: State, where: str) -> None:
    """A body that something fixed keeps from having a frame does not turn far.

    Parameters
    ----------
    prepared : the model
    state : to be looked at
    where : for messages

    Raises
    ------
    SolveFailed
        If one has turned too far: its name, by how much, and what that strains it by.
    """
    for part, angle in _without_frames(prepared, state):
        if angle > _HELD_TURN:
            raise SolveFailed(
                f"{where}: {part.label} has turned by {angle:.3g} rad, and what holds it (supports, foundations, "
                "equations, contacts that stay) does so in directions of space, which strains it by "
                f"{0.5 * angle**2:.1e}; up to {_HELD_TURN} rad are taken for small, expected a hub (a rigid body with "
                "a point and a rotation) that holds and turns it, or contact alone",
                status=Outcome.NOT_FOUND,
            )


def turning_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """What small strains about frames, and small rotations of bodies without one, do not bear out."""
    if prepared.model.axisymmetric:
        return
    for part, angle in _without_frames(prepared, state):
        if angle > _SAID_TURN:
            yield (
                f"{part.label} turns by {angle:.2g} rad where fixed directions hold it: that alone strains it by "
                f"{0.5 * angle**2:.1e}"
            )
    for i, (strain, twist) in enumerate(_largest_strains(prepared, state)):
        name = prepared.model.bodies[i].name
        if strain > _STRAINED:
            yield f"body '{name}' strains by up to {strain:.1%}: strains are taken for small, which holds to about 5%"
        if twist > _TWISTED:
            yield (
                f"a part of body '{name}' turns by {twist:.2g} rad against the rest of it: strains are taken for "
                f"small, and are off by {0.5 * twist**2:.1e} there"
            )


def _without_frames(prepared: Prepared, state: State) -> Iterator[tuple[ConnectedBody, float]]:
    """Connected pieces of the mesh without a frame, and by how much each has turned, radians."""
    carried = among([frame.places for frame in prepared.frames.frames], len(prepared.space.places))
    at_nodes = prepared.space.at_nodes(state.displacement)
    for part in prepared.parts:
        if part.kind == ConnectedBody.kind and not carried[part.nodes[0]]:
            yield part, float(np.linalg.norm(mean_turn(prepared.space.mesh.points[part.nodes], at_nodes[part.nodes])))


def _largest_strains(prepared: Prepared, state: State) -> list[tuple[float, float]]:
    """Of every body the largest strain, and the largest angle by which a point turns against its frame, radians."""
    space, owner = prepared.space, prepared.model.body_of_cells()
    local = space.at_nodes(prepared.frames.elastic(state.displacement))
    found = [(0.0, 0.0)] * len(prepared.model.bodies)
    for block in space.blocks:
        inner = jacobians(space.mesh.points[block.cells], block.gradients)
        slopes = jacobians(local[block.cells], block.gradients) @ np.linalg.inv(inner)
        turned = 0.5 * (slopes - slopes.swapaxes(-1, -2))
        strain = np.abs(slopes - turned).max(axis=(1, 2, 3))
        twist = np.linalg.norm(turned, axis=(2, 3)).max(axis=1) / np.sqrt(2.0)
        here = owner[block.first : block.first + len(block.cells)]
        for i in np.unique(here):
            most = found[i], (float(strain[here == i].max()), float(twist[here == i].max()))
            found[i] = max(most[0][0], most[1][0]), max(most[0][1], most[1][1])
    return found
