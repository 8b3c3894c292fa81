# SPDX-License-Identifier: BSD-3-Clause
"""Follow a step in equal increments, each one Coulomb problem on the condensed interface, certified."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart, at_nodes, keep, leg_of
from signorini.errors import SolveFailed, told
from signorini.fem.rigid import describe_motion
from signorini.law.states import OPEN, STICK
from signorini.linalg import NotPositiveDefinite
from signorini.outcome import Outcome
from signorini.plasticity.state import PlasticState
from signorini.solution.certificate import TOLERANCE, Certificate, certify
from signorini.solution.state import LoadPoint, State, next_state

_LOST_DIGITS = 1e-10  # of how far bodies move: by how much motions of pairs may differ from those of the bodies
_POLISHING_ROUNDS = 3  # without progress from what is right but for rounding: one round is the rule
_SAID_FROM = 1e-3  # of a rigid motion: what words leave out of it
_BENT = 10.0  # times as far as loads bend bodies: what an answer may move them by for its rounding to be theirs
_UNLOADED = 1e-12  # of the size of forces: a normal force that rounding leaves where nothing presses
_CANCELLED = 1e-14  # of the largest displacement that supports impose: less between two sides is rounding


def follow_increments(part: StepPart, number: int) -> FollowedPart:
    """Follow a straight part of a step in equal increments.

    Where bodies are not condensed every increment starts from where the last one leads if it is repeated.

    Parameters
    ----------
    number : of increments

    Raises
    ------
    SolveFailed
        If an increment has no certified solution; it carries the increments before.
    """
    prepared, interval, state = part.prepared, part.interval, part.before
    path = "single" if number == 1 else "increments"
    certificates: list[Certificate] = []
    trace: list[tuple[MethodRun, ...]] = []
    snapshots: list[Snapshot] = []

    def so_far() -> FollowedPart:
        return FollowedPart(
            path=path,
            before=part.before,
            after=state,
            certificates=tuple(certificates),
            trace=tuple(trace),
            snapshots=tuple(snapshots),
            legs=(leg_of(part, state, states=tuple(shot.state for shot in snapshots)),),
        )

    last: State | None = None
    for k in range(1, number + 1):
        words = f"{part.where} at {interval.fraction(k / number):.0%}"
        point = part.before.point.towards(part.end, k / number)
        prepared.clock.increment(words)
        try:
            new, certificate, tried = advance(prepared, state, point, words, last=last)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, [so_far()] if snapshots else []) from None
        last, state = state, new
        certificates.append(certificate)
        trace.append(tried)
        what = interval.ends if k == number else "increment"
        fraction = interval.fraction(k / number)
        snapshots.append(Snapshot(number=interval.number, fraction=fraction, what=what, state=state))
    return so_far()


def advance(
    prepared: Prepared,
    state: State,
    point: LoadPoint,
    where: str,
    *,
    start: Array | IntArray | None = None,
    last: State | None = None,
) -> tuple[State, Certificate, tuple[MethodRun, ...]]:
    """One increment: the state at the next point of the load history, its certificate and the methods tried.

    Parameters
    ----------
    prepared : the model under the law of the moment
    state, point : before, and at the end
    where : for messages
    start : what the law's solver starts from, see `Increment`; as the state is where not given
    last : the state an increment as long as this one before, where there is one: bodies that are not condensed are
        sought as far ahead again

    Raises
    ------
    SolveFailed
        If there is no certified solution.
    """
    increment = _asked(prepared, state, point, where, start=start, last=last)
    answer = prepared.solver.solve(increment)
    if not answer.solved:
        raise _failure(prepared, answer, where)
    new = _recovered(prepared, increment, answer, point)
    sizes = (new.nodal[0], increment.imposed, state.nodal[0], point.gap)
    farthest = max(float(np.abs(size).max(initial=0.0)) for size in sizes)
    origin = None if len(prepared.flowed) else state.plastic
    certificate = measured(prepared, new, state.tangential, origin)
    if certificate.passed and answer.lost <= _LOST_DIGITS * farthest:
        return new, certificate, answer.trace
    if prepared.has_multipliers:
        polished = _polished(prepared, increment, answer, min(prepared.scale.length, farthest))
        new = new if polished is None else _recovered(prepared, increment, polished, point)
    return new, certified(prepared, new, state.tangential, where, origin), answer.trace


def glimpse(prepared: Prepared, state: State, point: LoadPoint, where: str) -> Array | None:
    """(dofs,) Where one increment would bring the bodies, which nothing certifies; None where that is not found.

    Parameters
    ----------
    prepared, state, point, where : as of `advance`
    """
    try:
        increment = _asked(prepared, state, point, where)
    except SolveFailed:
        return None
    answer = prepared.solver.solve(increment)
    return prepared.constraints.displaced(answer.free) + increment.imposed if answer.solved else None


def _asked(
    prepared: Prepared,
    state: State,
    point: LoadPoint,
    where: str,
    *,
    start: Array | IntArray | None = None,
    last: State | None = None,
) -> Increment:
    """What an increment asks of a solver, see `advance`."""
    _, imposed = applied(prepared, point)
    offset = np.concatenate([point.gap[None], -state.tangential]) + moved_by_supports(prepared, imposed)
    refuse_overlap(prepared, offset[0], where)
    return Increment(
        system=prepared,
        f=free_load(prepared, point),
        offset=offset,
        imposed=imposed,
        point=point,
        state=state,
        last=last,
        start=start,
        floating=bool(prepared.floating.shape[1]),
        clock=prepared.clock,
    )


def _recovered(prepared: Prepared, increment: Increment, answer: IncrementAnswer, point: LoadPoint) -> State:
    """The state at the end of an increment."""
    constraints, interface, n = prepared.constraints, prepared.interface, len(prepared.interface)
    active, (loads, imposed) = prepared.solver.active, applied(prepared, point)
    with prepared.clock.phase("recovery"):
        displacement = constraints.displaced(answer.free) + imposed
        moved = np.where(active, answer.moved, increment.offset + interface.motion(displacement - imposed))
        status = np.full(n, OPEN)
        status[active] = answer.status
        status[interface.tied] = STICK
        pull = 0.0 if answer.pull is None else answer.pull
        forces, status = settled(prepared, answer.forces - pull, status)
        new = next_state(
            prepared,
            increment.state,
            point=point,
            loads=loads,
            displacement=displacement,
            forces=forces + (point.given + pull),
            moved=moved,
            status=status,
            plastic=answer.plastic,
        )
        return new if answer.bonds is None else new.changed(bonds=answer.bonds)


def _polished(
    prepared: Prepared, increment: Increment, answer: IncrementAnswer, length: float
) -> IncrementAnswer | None:
    """An answer with the digits that the condensed interface has lost; None where that does not settle.

    Lost are those by which pairs and bodies move apart, and those that a certificate misses.

    Rounding of forces moves slender bodies by many roundings of their displacements. Equilibrium between both has
    digits to spare, so the motions of the pairs are made right and it takes what that changes.

    Parameters
    ----------
    answer : of the condensed interface, from which multipliers start
    length : to whose digits motions are wanted
    """
    try:
        better = prepared.multipliers(_POLISHING_ROUNDS).solve_near(increment, answer.free, answer.forces, length)
    except (NotPositiveDefinite, SolveFailed):
        return None
    return replace(better, trace=answer.trace) if better.solved else None


def settled(prepared: Prepared, forces: Array, status: IntArray) -> tuple[Array, IntArray]:
    """Forces and states of the pairs, of which those that nothing but rounding presses are open.

    Parameters
    ----------
    prepared : the model
    forces, status : (d, n) forces and (n,) codes as they were found
    """
    interface = prepared.interface
    idle = ~interface.tied & (status != OPEN) & (forces[0] <= _UNLOADED * prepared.scale.force)
    return np.where(idle, 0.0, forces), np.where(idle, OPEN, status)


def applied(prepared: Prepared, point: LoadPoint) -> tuple[Array, Array]:
    """Nodal forces of the loads and imposed displacements at a point of the history, each (dofs,).

    Supports that let go are loads, what others hold beyond what they prescribe is imposed, and where bodies rest.
    """
    zero, placed = prepared.constraints.zeros, prepared.constraints.placed
    loads = sum((point.factors[name] * placed(f) for name, f in prepared.loads.items()), zero)
    imposed = sum((point.factors[name] * placed(u) for name, u in prepared.constraints.prescribed.items()), zero)
    if len(prepared.resting):
        imposed = imposed + prepared.resting
    reaction, offset = point.left
    return (loads + placed(reaction), imposed + placed(offset)) if len(reaction) else (loads, imposed)


def moved_by_supports(prepared: Prepared, imposed: Array) -> Array:
    """(d, n) Motions of the pairs that supports impose; where they cancel, no rounding drags a pair."""
    interface = prepared.interface
    moved = interface.motion(imposed)
    largest = float(np.abs(imposed).max(initial=0.0))
    if largest > 0.0:
        moved[np.abs(moved) <= _CANCELLED * largest * abs(interface.B).sum(axis=1).reshape(moved.shape)] = 0.0
    return moved


def free_load(prepared: Prepared, point: LoadPoint) -> Array:
    """(z,) Forces on the free displacements: loads, what supports impose, contacts that are being switched off."""
    loads, imposed = applied(prepared, point)
    if point.given.any():
        loads = loads + prepared.pushed(point.given)
    if point.pull is not None:
        loads = loads + prepared.pushed(point.pull)
    if len(prepared.flowed):
        loads = loads + prepared.flowed
    if imposed.any():
        loads = loads - prepared.K @ imposed
    return prepared.constraints.on_free(loads)


def is_straight(prepared: Prepared, followed: FollowedPart) -> bool:
    """Whether the law of contact holds all along the increments of a part, so that more of them change nothing.

    Between two states in which it holds it does so everywhere if it does in the middle: gaps and forces are linear
    there and never negative, their product vanishes in between only where one of them does throughout; sections of
    the friction cone are convex, and a force on the limit at the end and in the middle of the same slip is there
    from the beginning on because the bound is concave in the normal force.

    Parameters
    ----------
    followed : as it was followed; nothing is known of one whose displacements on the way were not recovered
    """
    if not all(shot.whole for shot in followed.snapshots):
        return False
    ways = pairwise([followed.before, *(shot.state for shot in followed.snapshots)])
    return all(measured(prepared, _half_way(one, two), one.tangential).passed for one, two in ways)


def _half_way(one: State, two: State) -> State:
    """What is half-way between two states, as far as certificates look at it."""
    displacement, external = (0.5 * (a + b) for a, b in zip(one.nodal, two.nodal, strict=True))
    return replace(
        two,
        point=one.point.towards(two.point, 0.5),
        displacement=displacement,
        external=external,
        forces=0.5 * (one.forces + two.forces),
        borne=None if two.borne is None else two.borne.half_way(one.borne),
        bonds=one.bonds,
    )


def measured(
    prepared: Prepared, state: State, before: Array | None = None, origin: PlasticState | None = None
) -> Certificate:
    """The certificate of a state, whatever it says.

    Parameters
    ----------
    prepared : the model under the law of the moment
    state : to be measured
    before : (d - 1, n) tangential displacement at which its slip increment began; its own where not given
    origin : what the points of bodies that yield remembered there; None: the flow rule is not asked
    """
    paths = prepared.solver.paths
    return certify(
        prepared,
        state,
        loads=applied(prepared, state.point)[0],
        before=state.tangential if before is None else before,
        yielding=None if paths is None else paths.condensed.on_springs,
        origin=origin,
    )


def certified(
    prepared: Prepared, state: State, before: Array, where: str, origin: PlasticState | None = None
) -> Certificate:
    """Measure a state; what does not pass is no solution.

    Parameters
    ----------
    prepared, state, before, origin : as of `measured`
    where : for messages

    Raises
    ------
    SolveFailed
        If the state does not pass.
    """
    certificate = measured(prepared, state, before, origin)
    if certificate.passed:
        return certificate
    words = f"{where}: the solver's answer did not pass the certificate"
    remedy = "look for extreme ratios of moduli, sizes or compliances, which are the usual cause"
    if certificate.rounding > TOLERANCE and np.abs(state.displacement).max() <= _BENT * prepared.scale.length:
        words = (
            f"{where}: bodies are too slender for double precision: rounding of their displacements alone takes "
            f"{certificate.rounding:.1e} of the loads from equilibrium"
        )
        remedy = "bodies shorter for their height, cells that are less flat, or moduli less far apart"
    verge = np.flatnonzero(prepared.interface.friction.sticks & ~prepared.absent & (state.status > STICK))
    if len(verge):
        pair = int(verge[0])
        contact = prepared.model.contacts[prepared.interface.contact[pair]]
        number = prepared.model.mesh.labels[prepared.interface.node[pair]]
        words = (
            f"{where}: no equilibrium was found: node {number} of contact '{contact.label}', which never slips, can "
            "neither stick nor open: it holds back a tangential force that nothing presses"
        )
        remedy = f"finite friction of '{contact.label}', or a 'shear_limit'"
    raise SolveFailed(told(words, remedy=remedy, evidence=str(certificate)), status=Outcome.NOT_FOUND)


def refuse_overlap(prepared: Prepared, gap: Array, where: str) -> None:
    """Supports that hold both sides of a pair decide its gap; no force can mend an overlap there.

    Parameters
    ----------
    prepared : the model
    gap : (n,) that supports leave, length
    where : for messages
    """
    held = np.nonzero(prepared.solver.held & ~prepared.absent & (gap < -1e-12 * prepared.scale.length))[0]
    if len(held):
        pair = held[np.argmin(gap[held])]
        contact = prepared.model.contacts[prepared.interface.contact[pair]]
        number = prepared.model.mesh.labels[prepared.interface.node[pair]]
        raise SolveFailed(
            f"{where}: contact '{contact.label}': supports press node {number} "
            f"{-gap[pair]:.4g} into the other side and leave it no way out",
            status=Outcome.NO_EQUILIBRIUM,
        )


def _failure(prepared: Prepared, answer: IncrementAnswer, where: str) -> SolveFailed:
    """The reason, and the bodies that leave by name, with their motion."""
    if answer.escape is None:
        failure = SolveFailed(f"{where}: {answer.message}", status=answer.outcome)
        failure.mechanisms = answer.mechanisms if prepared.interface.cohesion is None else ()  # bonds resist too
        return failure
    words, motion = moving_away(prepared, prepared.floating @ answer.escape)
    return SolveFailed(f"{where}: {words}: {answer.message}", status=answer.outcome, motion=motion)


def leaving(prepared: Prepared, escape: Array) -> tuple[str, Array]:
    """The bodies that leave by name, and their motion (nodes, d), largest entry 1, of a motion of the pairs (d a,)."""
    return moving_away(prepared, prepared.floating @ prepared.paths.floating(escape))


def moving_away(prepared: Prepared, rigid: Array) -> tuple[str, Array]:
    """The bodies that move by name, and their motion (nodes, d), largest entry 1; ``rigid`` as of all rigid motions."""
    meshed = np.repeat([part.obstacle < 0 for part in prepared.parts], [part.motions for part in prepared.parts])
    motion = prepared.constraints.carried(prepared.rigid, np.where(meshed, rigid, 0.0))
    said = np.where(np.abs(rigid) < _SAID_FROM * np.abs(rigid).max(initial=0.0), 0.0, rigid)
    return describe_motion(prepared.parts, said), at_nodes(prepared, motion / (np.abs(motion).max(initial=0.0) or 1.0))
