# SPDX-License-Identifier: BSD-3-Clause
"""From the states of a step to its results: resultants, energies, arrays over the contact nodes, notes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.engine.bolts import bolt_results
from signorini.engine.cycles import judge, make_cycles
from signorini.engine.energy import interface_energy, stored_energy, thermal_energy
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.engine.reactions import reactions, rigid_dofs, rigid_motions, rigid_result
from signorini.engine.step_parts import FollowedPart, at_nodes
from signorini.engine.stride_pairs import where_bodies_are
from signorini.engine.turning import forces_in_space
from signorini.engine.validity_notes import step_notes
from signorini.interface.interface import Interface
from signorini.law.states import OPEN, STICK
from signorini.model.stage import Stage
from signorini.solution import results
from signorini.solution.certificate import worst_of
from signorini.solution.contact_wear import ContactWear
from signorini.solution.nodal_forces import NodalForces
from signorini.solution.results import (
    ContactResult,
    Instant,
    PlasticResult,
    StepResult,
    Yielding,
)
from signorini.solution.state import State


def step_result(
    prepared: Prepared, stage: Stage, followed: FollowedPart, cycle_ends: Sequence[float], *, finished: bool = True
) -> StepResult:
    """Results at the end of a step.

    Parameters
    ----------
    prepared : under the law of the step
    stage : the step
    followed : all of it
    cycle_ends : load factors at which its cycles end; one where it does not repeat
    finished : whether it goes to the end of the step
    """
    before, state = followed.before, followed.after
    stored_before = stored_energy(_paired(prepared, before), before)
    instants_of, prepared = prepared, followed.prepared or prepared
    heat = thermal_energy(prepared) if prepared.model.heats else _no_heat
    instants = tuple(_instants(instants_of, followed, cycle_ends, heat))
    cycles = followed.cycles or (make_cycles(followed, cycle_ends) if len(cycle_ends) > 1 else ())
    steadiness, words = judge(cycles, prepared.scale) if cycles else ("", "")
    there = _paired(prepared, state)
    stored, dissipated = stored_energy(there, state), (state.dissipation - before.dissipation).sum()
    spent = stored - stored_before + float(dissipated) + state.released - before.released
    spent += state.plastic_work - before.plastic_work
    layers = interface_energy(there, state)
    loads, held = _outside(prepared, followed)
    model = prepared.model
    bolts = {bolt.label for bolt in model.bolts}
    space, (u, external) = prepared.space, state.nodal
    forces = reactions(model, space, prepared.constraints, u, held)
    springs = -0.5 * float(u @ prepared.constraints.foundation_forces(u))
    return StepResult(
        name=stage.title,
        path=followed.path,
        finished=finished,
        events=followed.events,
        displacement=at_nodes(prepared, _displacement(prepared, state)),
        external=at_nodes(prepared, _external(prepared, state, loads, held)),
        obstacles={
            obstacle.name: rigid_result(model, space, j, u, external) for j, obstacle in enumerate(model.obstacles)
        },
        rigid_bodies={
            body.name: rigid_result(model, space, j, u, loads + held)
            for j, body in enumerate(model.rigid_bodies, start=len(model.obstacles))
        },
        reactions={name: force for name, force in forces.items() if name not in bolts},
        bolts=bolt_results(model, u, state.point.factors, forces) if bolts else {},
        strain_energy=stored - layers - springs - state.closing_work + heat(state),
        interface_energy=layers + springs,
        work=state.work - before.work + heat(state) - heat(before),
        released=state.released - before.released,
        energy_defect=state.work - before.work - spent,
        certificate=worst_of(followed.certificates),
        trace=followed.trace,
        instants=instants,
        cycles=cycles,
        steadiness=steadiness,
        notes=(*step_notes(prepared, followed), *((words,) if words else ())),
        yielding=_yielding(prepared, followed, float(stage.number - 1)),
    )


def _paired(prepared: Prepared, state: State) -> Prepared:
    """The model with the pairs of where its bodies are, if they slide far."""
    return where_bodies_are(prepared, state) if prepared.model.slides else prepared


def _no_heat(_state: State) -> float:
    """Energy of temperatures where there is none."""
    return 0.0


def _outside(prepared: Prepared, followed: FollowedPart) -> tuple[Array, Array]:
    """(dofs,) Forces of loads, and of supports, on the bodies at the end."""
    state = followed.after
    if prepared.turns:
        return forces_in_space(prepared, state, followed.turned_at)
    loads, _ = applied(prepared, state.point)
    return loads, prepared.constraints.support_forces(state.nodal[1] - loads)


def _displacement(prepared: Prepared, state: State) -> Array:
    """(dofs,) Displacement in space, of bodies that turn, too."""
    u: Array = state.nodal[0]
    return prepared.frames.displaced(u) if prepared.turns else u


def _yielding(prepared: Prepared, followed: FollowedPart, begin: float) -> Yielding | None:
    """How far the bodies have yielded at the end of what was followed from a load factor on."""
    bodies, plastic = prepared.yielding, followed.after.plastic
    if bodies is None or plastic is None:
        return None
    flowed, worst, body, at = plastic.equivalent > 0.0, int(plastic.equivalent.argmax()), "", ()
    if flowed[worst]:
        body, at = prepared.model.bodies[int(bodies.body[worst])].name, tuple(bodies.places()[worst].tolist())
    return Yielding(
        largest=float(plastic.equivalent[worst]),
        body=body,
        at=at,
        share=float(bodies.weights[flowed].sum() / bodies.weights.sum()),
        first=_first_yield(followed, begin),
    )


def _first_yield(followed: FollowedPart, begin: float) -> float | None:
    """The load factor up to which no plastic work was done, from the one where all of it began; None where none is."""
    work, factor = followed.before.plastic_work, begin
    for shot in followed.snapshots:
        if shot.state.plastic_work != work:
            return factor
        factor = shot.load_factor
    return None


def _plastic(before: State, state: State, *, whole: bool) -> PlasticResult | None:
    """Plastic flow in one state of a step from another at its beginning, with its points or its energies alone."""
    if state.plastic is None:
        return None
    kept = state.plastic if whole else state.plastic.light()
    return PlasticResult(state=kept, dissipation=state.plastic_work - before.plastic_work)


def _external(prepared: Prepared, state: State, loads: Array, held: Array) -> Array:
    """(dofs,) Loads and reactions; those of a rigid body at its node of no cell, if one is at its point."""
    model, constraints = prepared.model, prepared.constraints
    external: Array = state.nodal[1]
    if not len(constraints.dependent):
        if not prepared.turns:
            return external
        force = np.where(constraints.held, external, prepared.frames.in_space(external, state.displacement))
        return np.where(constraints.alone, loads, force)
    force = np.where(constraints.alone | (constraints.free >= 0), loads, loads + held)
    d, loose = model.dimension, prepared.space.loose_nodes
    for j, body in enumerate(model.rigid_bodies, start=len(model.obstacles)):
        here = loose[(model.mesh.places_of(loose) == np.array(body.point)).all(axis=1)][:1]
        if len(here):
            borne = force[rigid_dofs(model, prepared.space, j)[0][:d]]
            force = force + constraints.spread(prepared.space.dofs(here)[0, :d], borne)
    return force


def contacts_of(prepared: Prepared, before: State, state: State) -> tuple[ContactResult, ...]:
    """The contacts in one state, with slips and dissipation since another.

    Parameters
    ----------
    prepared : the model
    before, state : the other state, and the one
    """
    moved = np.linalg.norm(state.slip - before.slip, axis=0)
    return tuple(
        _contact_result(prepared, _surface(prepared, i), before, state, moved, moved)
        for i in range(len(prepared.model.contacts))
    )


def instant_of(prepared: Prepared, state: State) -> Instant:
    """A state that a history goes on from, with its displacements."""
    return Instant(
        load_factor=0.0,
        what="start",
        contacts=contacts_of(prepared, state, state),
        work=0.0,
        displacement=at_nodes(prepared, _displacement(prepared, state)),
        factors=dict(state.point.factors),
        plastic=_plastic(state, state, whole=True),
        places=frozen(prepared.space.mesh.points) if prepared.meshed is not None else None,
        nodal_forces=_nodal_forces(prepared, state),
        motions=rigid_motions(prepared.model, prepared.space, state.nodal[0]),
    )


def _nodal_forces(prepared: Prepared, state: State) -> NodalForces | None:
    """Forces of supports and contacts at the nodes in a state whose displacements are known."""
    if prepared.turns:
        return None
    space, constraints, (u, external) = prepared.space, prepared.constraints, state.nodal
    loads, _ = applied(prepared, state.point)
    held = constraints.support_forces(external - loads) + constraints.foundation_forces(u)
    return NodalForces.of(space, held, prepared.pushed(state.forces))


def _instants(
    prepared: Prepared, followed: FollowedPart, cycle_ends: Sequence[float], heat: Callable[[State], float]
) -> Iterator[Instant]:
    """The contacts at every snapshot, with what they slid since the beginning of the step and of the cycle."""
    surfaces = [_surface(prepared, i) for i in range(len(prepared.model.contacts))]
    last, sliding = followed.before.slip, np.zeros(len(prepared.interface))
    low, high, cycle, wear = last, last, 0, followed.before.wear
    begun, end = heat(followed.before), followed.snapshots[-1]
    for snapshot in followed.snapshots:
        slip = snapshot.state.slip
        now, shown = prepared, surfaces
        if snapshot.interface is not None or snapshot.prepared is not None:
            now = snapshot.prepared or prepared
            now = now if snapshot.interface is None else replace(now, interface=snapshot.interface)
            shown = [_surface(now, i) for i in range(len(prepared.model.contacts))]
        sliding = sliding + np.linalg.norm(slip - last, axis=0)
        if wear is not snapshot.state.wear and snapshot.state.wear is not None and followed.before.wear is not None:
            wear = snapshot.state.wear  # of cycles that nobody has looked at too
            sliding = wear.distance - followed.before.wear.distance
        low, high, last = np.minimum(low, slip), np.maximum(high, slip), slip
        slid = np.linalg.norm(high - low, axis=0)
        contacts = tuple(
            _contact_result(now, surface, followed.before, snapshot.state, sliding, slid) for surface in shown
        )
        yield Instant(
            load_factor=snapshot.load_factor,
            what=snapshot.what,
            contacts=contacts,
            work=snapshot.state.work - followed.before.work + heat(snapshot.state) - begun
            if snapshot.worked
            else np.nan,
            displacement=at_nodes(prepared, _displacement(prepared, snapshot.state)) if snapshot.kept else None,
            factors=dict(snapshot.state.point.factors),
            plastic=_plastic(
                followed.before,
                followed.after if snapshot is end else snapshot.state,
                whole=snapshot is end or snapshot.kept,
            ),
            places=frozen(now.space.mesh.points)
            if now.meshed is not None and (snapshot is end or snapshot.kept)
            else None,
            nodal_forces=_nodal_forces(now, followed.after if snapshot is end else snapshot.state)
            if snapshot is end or snapshot.kept
            else None,
            motions=rigid_motions(prepared.model, prepared.space, snapshot.state.nodal[0]) if snapshot.kept else None,
        )
        if cycle + 1 < len(cycle_ends) and snapshot.load_factor == cycle_ends[cycle]:
            low, high, cycle = slip, slip, cycle + 1


@dataclass(frozen=True, kw_only=True, eq=False)
class _Surface:
    """What does not change of a contact: its name and number, its pairs, corners that wear, and where they are."""

    name: str
    index: int
    own: IntArray
    corners: IntArray
    fixed: Mapping[str, Any]


def _surface(prepared: Prepared, i: int) -> _Surface:
    interface = prepared.interface
    own = np.flatnonzero(interface.contact == i)
    fixed = {
        "nonmortar": interface.sides[i].nonmortar,
        "mortar": interface.sides[i].mortar,
        "coupling": interface.sides[i].coupling,
        "node": frozen(interface.node[own], np.int64),
        "points": frozen((prepared.meshed or prepared).model.mesh.places_of(interface.node[own])),
        "normals": frozen(interface.normals[own]),
        "tangents": frozen(interface.tangents[own, 0] if interface.directions == 2 else interface.tangents[own]),
        "levers": frozen(interface.moments.reshape(interface.directions, len(interface), -1)[:, own].swapaxes(0, 1)),
        "area": frozen(interface.area[own]),
    }
    sides = prepared.wearing
    corners = np.zeros(0, np.int64) if sides is None else np.flatnonzero(sides.contact == i)
    return _Surface(name=prepared.model.contacts[i].label, index=i, own=own, corners=corners, fixed=fixed)


def _contact_result(
    prepared: Prepared, surface: _Surface, before: State, state: State, sliding: Array, slip_range: Array
) -> ContactResult:
    interface, own = prepared.interface, surface.own
    normal = state.forces[0, own]
    tangential = interface.effort(state.forces[1:])[own]
    code, area = state.status[own], surface.fixed["area"]
    bound = interface.most(state.forces[0])[own]
    # a pair that a support guides carries no friction: it touches without slipping
    sticks = (code == STICK) | (interface.friction.rubs[own] & (tangential < (1.0 - 1e-9) * bound))
    status = np.where(code == OPEN, results.OPEN, np.where(sticks, results.STICK, results.SLIP))
    dissipation = (state.dissipated - before.dissipated)[own]
    rubbed = (state.dissipation - before.dissipation)[own]
    return ContactResult(
        name=surface.name,
        gap=frozen(_distance(interface, state)[own]),
        pressure=frozen(normal / area),
        traction=frozen(_by_pair(state.forces[1:, own] / area)),
        slip=frozen(_by_pair(state.slip[:, own])),
        sliding=frozen(sliding[own]),
        slip_range=frozen(slip_range[own]),
        status=status,
        worn=frozen(rubbed / area),
        dissipation=float(dissipation.sum()),
        wear=_contact_wear(prepared, surface, state),
        damage=None if state.bonds is None else frozen(state.bonds.damage[own]),
        **surface.fixed,
    )


def _distance(interface: Interface, state: State) -> Array:
    """(n,) Gaps of the sides themselves, below 0 where they have closed on what lies between them."""
    if interface.closure is not None:
        return interface.closure.after(state.borne).distance(state.gap, state.forces[0] / interface.area)
    return np.asarray(state.gap - interface.normal_compliance * state.forces[0] / interface.area)


def _contact_wear(prepared: Prepared, surface: _Surface, state: State) -> ContactWear | None:
    """What the sides of a contact have lost."""
    sides, wear, corners, index = prepared.wearing, state.wear, surface.corners, surface.index
    if sides is None or wear is None or prepared.model.contacts[index].wear is None:
        return None
    mortar = sides.mortar[corners]
    seen = [sides.gap[surface.own] @ np.where(sides.mortar == side, wear.depth, 0.0) for side in (False, True)]
    return ContactWear(
        depth=frozen(seen[0]),
        mortar_depth=frozen(seen[1]),
        node=frozen(sides.node[corners], np.int64),
        points=frozen((prepared.meshed or prepared).model.mesh.places_of(sides.node[corners])),
        depths=frozen(wear.depth[corners]),
        on_mortar=mortar,
        volume=(float(wear.volume[corners][~mortar].sum()), float(wear.volume[corners][mortar].sum())),
        distance=frozen(wear.distance[surface.own]),
        cycles=wear.cycles,
        mesh_moves=wear.moves,
    )


def _by_pair(tangential: Array) -> Array:
    """Tangential values, (d - 1, n), pair by pair: (n,) in the plane, (n, 2) in space."""
    return tangential[0] if len(tangential) == 1 else tangential.T
