# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that move with what is worn: bodies are assembled and condensed again, gaps lose what the mesh has taken.

The places of the nodes follow from the mesh as it was given and the depth that it has taken, so that states hold no
other mesh. Displacements of the nodes stay; the equilibrium of the bodies that are left is found at the loads of the
moment, and the elastic energy that they no longer have counts as released.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.engine.condensation import whole_stiffness
from signorini.engine.energy import stored_energy
from signorini.engine.examine import Examined, floating_motions
from signorini.engine.handing_over import supported
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared, condensed_model
from signorini.engine.step_parts import FollowedPart
from signorini.engine.stride_pairs import where_bodies_are
from signorini.errors import InputError, SolveFailed
from signorini.fem.body_frames import BodyFrames
from signorini.fem.loads import nodal_loads
from signorini.fem.rigid import connected_bodies
from signorini.fem.rigid_motions import RigidMotions, resistance
from signorini.fem.space import make_space
from signorini.fem.supports import Constraints, make_constraints
from signorini.fem.worn_mesh import WornSide, cell_heights, worn_places
from signorini.interface.interface import Interface, make_interface
from signorini.interface.worn_sides import WornSides, worn_sides
from signorini.model.model import Model
from signorini.model.stage import stages
from signorini.outcome import Outcome
from signorini.solution.state import LoadPoint, State, wear_of

_GEOMETRY = ("B", "gap", "area", "normals", "tangents", "moments", "sides")


def deepest_wear(prepared: Prepared) -> Array | None:
    """(m,) Depth from which on the mesh moves at every corner, infinite where it stays; None where all of it stays.

    Raises
    ------
    InputError
        If bodies may turn, whose frames are read off a mesh that stays.
    """
    sides, contacts = prepared.wearing, prepared.model.contacts
    moving = [i for i, contact in enumerate(contacts) if contact.wear is not None and contact.wear.move_mesh]
    if sides is None or not moving:
        return None
    if prepared.turns:
        words = "is given, but bodies may turn by any angle; expected a mesh that stays, or supports against turning"
        raise InputError(words, where=("contact", moving[0], "wear", "move_mesh"))
    found = np.full(len(sides), np.inf)
    for name, own in _groups(prepared, sides):
        wear = contacts[int(sides.contact[own[0]])].wear
        if wear is not None and wear.move_mesh:
            found[own] = wear.move_mesh * cell_heights(prepared.space, name, sides.node[own])
    return found


def _groups(prepared: Prepared, sides: WornSides) -> Iterator[tuple[str, IntArray]]:
    """Boundaries that wear, and the numbers of their corners."""
    for i, pairing in enumerate(prepared.interface.sides):
        for mortar, name in ((False, pairing.nonmortar), (True, pairing.mortar)):
            own = np.flatnonzero((sides.contact == i) & (sides.mortar == mortar))
            if len(own):
                yield name, own


def on_worn_mesh(now: Prepared, taken: Array) -> Prepared:
    """The model, under the law of the moment, on a mesh that has taken depths (m,); it is condensed again.

    Raises
    ------
    InputError
        If cells turn over, or other nodes make pairs.
    """
    given, sides = now.meshed or now, now.wearing
    assert sides is not None
    worn = [WornSide(name, sides.node[own], taken[own]) for name, own in _groups(given, sides)]
    with now.clock.phase("assembly"):
        places = worn_places(given.space, given.model, worn)
        model = replace(given.model, mesh=replace(given.model.mesh, points=places))
        examined = _examined(now, model)
        K = whole_stiffness(examined)
    made = condensed_model(examined, K, now.candidates, now.backend, now.settings, now.clock)
    made = replace(
        made,
        solver=made.solver.under(made.interface, made.scale, now.absent),
        absent=now.absent,
        released=now.released,
        multiplied=now.multiplied,
        wearing=worn_sides(examined.space, model, made.interface),
        meshed=given,
    )
    return made if now.kept is None else made.keeping()


def _examined(now: Prepared, model: Model) -> Examined:
    """All that a mesh decides, under the supports and the law of the moment."""
    carriers = len(model.obstacles) + len(model.rigid_bodies)
    space = make_space(model.mesh, kind=model.kind, obstacles=carriers, linked=now.space.linked)
    constraints = _times(make_constraints(space, model, without=now.released), now)
    always = make_constraints(space, model, without=list(stages(model))[-1].loosened)
    found = make_interface(space, model, always)
    if not np.array_equal(found.node, now.interface.node):
        words = "pairs other nodes on the mesh that has moved with what is worn; expected sides that stay the same"
        raise InputError(words, where=("contact", 0))
    interface = with_geometry(now.interface, found)
    parts = connected_bodies(space, model)
    rigid = RigidMotions(space, parts)
    resisted = resistance(rigid, constraints)
    return Examined(
        model=model,
        space=space,
        constraints=constraints,
        always=always,
        interface=interface,
        loads={name: now.multiplied.get(name, 1.0) * forces for name, forces in nodal_loads(space, model).items()},
        parts=parts,
        rigid=rigid,
        resisted=resisted,
        floating=floating_motions(rigid, resisted, interface),
        frames=BodyFrames(dimension=space.dimension),
        loading=now.loading,
        scale=now.scale,
    )


def _times(constraints: Constraints, now: Prepared) -> Constraints:
    """With what supports prescribe as it was changed."""
    prescribed = {name: now.multiplied.get(name, 1.0) * u for name, u in constraints.prescribed.items()}
    return constraints.prescribing(prescribed)


def with_geometry(law: Interface, geometry: Interface) -> Interface:
    """Pairs with the law of one interface that are where those of another are."""
    return replace(law, **{name: getattr(geometry, name) for name in _GEOMETRY})


def between_moved(old: Prepared, new: Prepared, start: State, end: LoadPoint, taken: Array) -> tuple[State, LoadPoint]:
    """The ends of a step, between sides that are worn as they were at its start, as a mesh sees them that has moved.

    Parameters
    ----------
    old, new : the model before and behind
    start, end : state and point at the ends
    taken : (m,) by the mesh behind
    """
    wear = wear_of(start)
    shift = _moved_gap(old, new, wear.depth, (wear.taken, taken))
    point = replace(start.point, gap=start.point.gap + shift)
    start = replace(start, point=point, wear=replace(wear, taken=taken))
    return start, replace(end, gap=end.gap + shift)


def _moved_gap(old: Prepared, new: Prepared, depth: Array, taken: tuple[Array, Array]) -> Array:
    """(n,) What gaps between sides of a worn depth (m,) change by as the mesh takes some of it, length.

    Parameters
    ----------
    old, new : the model before and behind
    depth : (m,) worn
    taken : (m,) by the mesh before and behind
    """
    assert old.wearing is not None
    assert new.wearing is not None
    change = new.interface.gap - old.interface.gap
    worn = new.wearing.gap @ (depth - taken[1]) - old.wearing.gap @ (depth - taken[0])
    return np.where(np.isfinite(change), change, 0.0) + worn


def giving_way(now: Prepared, state: State, where: str) -> tuple[Prepared, State, LoadPoint]:
    """The model on a mesh that takes all that sides have lost where it moves; a state on it, and the point at the end.

    What equilibrium misses on it is a load that goes to zero from that state to the point, and gaps go from what they
    are to those of the mesh, which differ by squares of angles.

    Parameters
    ----------
    now : the model before
    state : with its bodies
    where : name of the step, for messages

    Raises
    ------
    SolveFailed
        If the mesh cannot follow.
    """
    deepest, wear = deepest_wear(now), wear_of(state)
    assert deepest is not None
    taken = np.where(np.isfinite(deepest), wear.depth, wear.taken)
    try:
        new = on_worn_mesh(now, taken)
    except InputError as error:
        words = f"{where}: the mesh cannot move with what is worn: {error}"
        raise SolveFailed(words, status=Outcome.NOT_FOUND) from error
    gap = state.point.gap + _moved_gap(now, new, wear.depth, (wear.taken, taken))
    end = replace(supported(state.point, len(state.displacement)), gap=gap)
    loads = applied(new, end)[0]
    state = replace(
        state,
        external=state.external + loads - applied(now, state.point)[0],
        wear=replace(wear, taken=taken, moves=wear.moves + 1),
    )
    if new.model.slides:  # strides find what equilibrium misses with the pairs of the moment
        return new, replace(state, point=replace(state.point, gap=gap)), replace(state.point, gap=gap)
    inner = new.K @ state.displacement - new.interface.on_bodies(state.forces)
    fading = inner - state.external
    moved = new.interface.motion(state.displacement) + new.interface.give(state.forces)
    begin = replace(
        state,
        point=replace(end, gap=state.gap - moved[0], reaction=end.reaction + fading),
        external=state.external + fading,
        tangential=moved[1:],
    )
    return new, begin, end


def given_way(old: tuple[Prepared, State], new: Prepared, point: LoadPoint, followed: FollowedPart) -> FollowedPart:
    """The mesh has moved: the work of the loads, and the elastic energy that is gone with what is worn.

    Parameters
    ----------
    old : the model and the state before
    new : the model on the mesh that has moved
    point : of the loads at the end
    followed : at constant loads, from one equilibrium to the other
    """
    (now, before), after = old, followed.after
    work = float(applied(new, point)[0] @ (after.displacement - before.displacement))
    gone = stored_energy(where_bodies_are(now, before), before) - stored_energy(where_bodies_are(new, after), after)
    spent = float((after.dissipation - before.dissipation).sum())
    after = replace(
        after,
        point=replace(after.point, reaction=point.reaction, offset=point.offset),
        work=before.work + work,
        released=before.released + gone + work - spent,
    )
    shot = replace(followed.snapshots[-1], what="mesh", state=after)
    return replace(followed, before=before, after=after, snapshots=(shot,), prepared=new, events=(), until=None)
