# SPDX-License-Identifier: BSD-3-Clause
"""Follow a step in equal increments, each one Coulomb problem on the condensed interface, certified."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.attempt import MethodRun
from signorini.engine.multipliers import given_way, has_another_way
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart, Snapshot, StepPart, keep
from signorini.errors import SolveFailed, told
from signorini.fem.rigid import describe_motion
from signorini.friction.law import OPEN, STICK
from signorini.friction.problem import CoulombProblem
from signorini.friction.result import CoulombResult
from signorini.friction.solve import solve_coulomb
from signorini.friction.spatial import SpatialProblem, SpatialResult, solve_spatial
from signorini.iterative.bodies import Bodies
from signorini.iterative.solve import Answer, Load, solve_iteratively
from signorini.linalg import NotPositiveDefinite
from signorini.solution.certificate import Certificate, certify
from signorini.solution.state import LoadPoint, State, next_state

_BALANCED = 1e-10  # of the sizes of the data: what equilibrium may lack before it is refined
_REFINEMENTS = 2
_NEAR = 3  # rounds without progress from what is right but for rounding: one round is the rule
_SLIGHT = 1e-3  # of a rigid motion: what words leave out of it
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
        )

    last: State | None = None
    for k in range(1, number + 1):
        words = f"{part.where} at {interval.fraction(k / number):.0%}"
        point = part.before.point.towards(part.end, k / number)
        prepared.clock.increment(words)
        try:
            new, certificate, result = advance(prepared, state, point, words, last=last)
        except (SolveFailed, KeyboardInterrupt) as stop:
            raise keep(stop, [so_far()] if snapshots else []) from None
        last, state = state, new
        certificates.append(certificate)
        trace.append(result.trace)
        what = interval.ends if k == number else "increment"
        snapshots.append(Snapshot(load_factor=interval.factor(k / number), what=what, state=state))
    return so_far()


def advance(
    prepared: Prepared,
    state: State,
    point: LoadPoint,
    where: str,
    *,
    start: Array | IntArray | None = None,
    last: State | None = None,
) -> tuple[State, Certificate, CoulombResult | SpatialResult | Answer]:
    """One increment: from a state to the next point of the load history.

    Parameters
    ----------
    start : what the law's solver starts from, see `_start`; as the state is where not given
    last : the state an increment as long as this one before, where there is one: bodies that are not condensed are
        sought as far ahead again
    """
    constraints, interface = prepared.constraints, prepared.interface
    n, active = len(interface), prepared.bodies.active
    loads, imposed = applied(prepared, point)
    offset = np.concatenate([point.gap, -state.tangential]) + moved_by_supports(prepared, imposed)
    refuse_overlap(prepared, offset[:n], where)
    f = free_load(prepared, point)
    result: CoulombResult | SpatialResult | Answer
    if isinstance(prepared.bodies, Bodies):
        u, r = state.displacement, state.forces
        if last is not None:
            u, r = 2.0 * u - last.displacement, 2.0 * r - last.forces
        free, length = u[constraints.leaders], prepared.scale.length
        result, forces, moved, free = _iterated(prepared, prepared.bodies, f, offset, free, r, length)
    else:
        begin = _start(prepared, state) if start is None else start
        result, forces, moved, free, lost = _balanced(prepared, f, offset, begin)
        if result.solved:
            sizes = (constraints.transform @ free + imposed, imposed, state.displacement, point.gap)
            farthest = max(float(np.abs(size).max(initial=0.0)) for size in sizes)
            if lost > _BALANCED * farthest and has_another_way(prepared):
                better = _polished(prepared, f, offset, free, forces, farthest)
                if better is not None:
                    polished, forces, moved, free = better
                    result = replace(result, state=polished.state)
    if not result.solved:
        raise _failure(prepared, result, where)
    with prepared.clock.phase("recovery"):
        displacement = constraints.transform @ free + imposed
        outside = np.nonzero(~interface.rows(active))[0]
        moved[outside] = (offset + interface.B @ (displacement - imposed))[outside]
        status = np.full(n, OPEN)
        status[active] = result.state
        status[interface.tied] = STICK
        forces, status = settled(prepared, forces, status)
        new = next_state(
            state,
            prepared.K,
            constraints,
            interface,
            point=point,
            loads=loads,
            displacement=displacement,
            forces=forces + point.given,
            moved=moved,
            status=status,
        )
    return new, certified(prepared, new, state.tangential, where), result


def settled(prepared: Prepared, forces: Array, status: IntArray) -> tuple[Array, IntArray]:
    """Forces (d n,) and states (n,) of the pairs, of which those that nothing but rounding presses are open."""
    interface, n = prepared.interface, len(status)
    idle = ~interface.tied & (status != OPEN) & (forces[:n] <= _UNLOADED * prepared.scale.force)
    return np.where(interface.rows(idle), 0.0, forces), np.where(idle, OPEN, status)


def applied(prepared: Prepared, point: LoadPoint) -> tuple[Array, Array]:
    """Nodal forces of the loads and imposed displacements at a point of the history, each (dofs,).

    Supports that let go are loads, what others hold beyond what they prescribe is imposed, and where bodies rest.
    """
    zero = np.zeros(prepared.space.number_of_dofs)
    loads = sum((point.factors[name] * f for name, f in prepared.loads.items()), zero)
    imposed = sum((point.factors[name] * u for name, u in prepared.constraints.prescribed.items()), zero)
    if len(prepared.resting):
        imposed = imposed + prepared.resting
    if len(point.reaction):
        return loads + point.reaction, imposed + point.offset
    return loads, imposed


def moved_by_supports(prepared: Prepared, imposed: Array) -> Array:
    """(d n,) Relative displacements of the pairs that supports impose; where they cancel, no rounding drags a pair."""
    B = prepared.interface.B
    moved: Array = B @ imposed
    largest = float(np.abs(imposed).max(initial=0.0))
    if largest > 0.0:
        moved[np.abs(moved) <= _CANCELLED * largest * abs(B).sum(axis=1)] = 0.0
    return moved


def free_load(prepared: Prepared, point: LoadPoint) -> Array:
    """(z,) Forces on the free displacements: loads, what supports impose, contacts that are being switched off."""
    loads, imposed = applied(prepared, point)
    if point.given.any():
        loads = loads + prepared.interface.B.T @ point.given
    if imposed.any():
        loads = loads - prepared.K @ imposed
    force: Array = prepared.constraints.transform.T @ loads
    return force


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
    return replace(
        two,
        point=one.point.towards(two.point, 0.5),
        displacement=0.5 * (one.displacement + two.displacement),
        external=0.5 * (one.external + two.external),
        forces=0.5 * (one.forces + two.forces),
    )


def measured(prepared: Prepared, state: State, before: Array | None = None) -> Certificate:
    """The certificate of a state, whatever it says.

    Parameters
    ----------
    before : (n,) tangential displacement at which its slip increment began; its own where not given
    """
    bodies = prepared.bodies
    return certify(
        prepared.K,
        applied(prepared, state.point)[0],
        prepared.motions,
        prepared.constraints,
        prepared.interface,
        state,
        state.tangential if before is None else before,
        prepared.scale,
        prepared.absent,
        None if isinstance(bodies, Bodies) else bodies.on_springs,
    )


def certified(prepared: Prepared, state: State, before: Array, where: str) -> Certificate:
    """Measure a state; what does not pass is no solution."""
    certificate = measured(prepared, state, before)
    if certificate.passed:
        return certificate
    words = f"{where}: the solver's answer did not pass the certificate"
    remedy = "look for extreme ratios of moduli, sizes or compliances, which are the usual cause"
    verge = np.flatnonzero(prepared.interface.sticks & ~prepared.absent & (state.status > STICK))
    if len(verge):
        pair = int(verge[0])
        contact = prepared.model.contacts[prepared.interface.contact[pair]]
        number = prepared.model.mesh.labels[prepared.interface.node[pair]]
        words = (
            f"{where}: no equilibrium was found: node {number} of contact '{contact.label}', which never slips, can "
            "neither stick nor open: it holds back a tangential force that nothing presses"
        )
        remedy = f"finite friction of '{contact.label}', or a 'shear_limit'"
    raise SolveFailed(told(words, remedy=remedy, evidence=str(certificate)), status="not_found")


def _balanced(
    prepared: Prepared, f: Array, offset: Array, start: Array | IntArray | None
) -> tuple[CoulombResult | SpatialResult, Array, Array, Array, float]:
    """The contact problem under the load f on the free displacements: result, forces, motions, free displacements.

    And by how much the motions differ in the end from those of the bodies.

    What equilibrium and the motions of the pairs lack in the end, on the problem as posed, is added to the condensed
    problem, and what that changes to the displacements: it was condensed with rounding, which gaps far larger than what
    the loads move (an arc that leaves its foundation) and thin bodies magnify, whose loads alone would bend them far.
    """
    condensed, interface, scale, law = prepared.condensed, prepared.interface, prepared.scale, prepared.law
    rows, T, ties = condensed.active_rows, prepared.constraints.transform, condensed.ties
    forces, moved, free = np.zeros(len(offset)), np.zeros(len(offset)), np.zeros_like(f)
    residual, misfit, b, lost = f, offset[rows], np.zeros(len(rows)), 0.0
    guided = np.concatenate([np.zeros(law.pairs, dtype=np.bool_), law.locked.T.ravel()])
    for _ in range(_REFINEMENTS + 1):
        with prepared.clock.phase("complementarity"):
            reduced = condensed.reduce(residual)
            b = b + condensed.right_hand_side(reduced.load, misfit)
            result = _solve(law, b, start)
        if not result.solved:
            break
        with prepared.clock.phase("recovery"):
            before = moved[rows], forces[rows]
            forces[rows] = condensed.root * np.concatenate([result.normal_force, result.tangential_force.T.ravel()])
            moved[rows] = np.concatenate([result.gap, result.slip.T.ravel()]) / condensed.root
            free = free + condensed.displacement(reduced, moved[rows] - before[0], forces[rows] - before[1], misfit)
            u = T @ free
            forces[ties.rows] = 0.0
            residual = f + T.T @ (interface.B.T @ forces - prepared.K @ u)
            forces[ties.rows] = ties.forces(residual)
            residual += ties.B.T @ forces[ties.rows]
            misfit = (offset + interface.B @ u - moved)[rows] + condensed.compliance * forces[rows]
            misfit[guided] = 0.0
        size = max(np.abs(residual).max(initial=0.0) / scale.force, np.abs(misfit).max(initial=0.0) / scale.length)
        lost = float(np.abs(misfit).max(initial=0.0))
        if size <= _BALANCED:
            break
        start = result.y if isinstance(result, SpatialResult) else result.state
    return result, forces, moved, free, lost


def _polished(
    prepared: Prepared, f: Array, offset: Array, free: Array, forces: Array, farthest: float
) -> tuple[Answer, Array, Array, Array] | None:
    """The same with the digits that the condensed interface has lost; None where that does not settle.

    Rounding of forces moves slender bodies by many roundings of their displacements. Equilibrium between both has
    digits to spare, so the motions of the pairs are made right and it takes what that changes.

    Parameters
    ----------
    free, forces : what was found
    farthest : displacement, gap or imposed motion
    """
    other, length = given_way(prepared, patience=_NEAR), min(prepared.scale.length, farthest)
    assert isinstance(other.bodies, Bodies)
    try:
        better = _iterated(other, other.bodies, f, offset, free, forces, length)
    except (NotPositiveDefinite, SolveFailed):
        return None
    return better if better[0].solved else None


def _iterated(
    prepared: Prepared, bodies: Bodies, f: Array, offset: Array, free: Array, r: Array, length: float
) -> tuple[Answer, Array, Array, Array]:
    """The same on the bodies as they are, from displacements and forces near which it may be, to digits of a length."""
    d, rows = bodies.directions, bodies.rows
    load = Load(
        f=bodies.blocks.spread(f),
        offset=offset[rows].reshape(d, -1),
        bound=prepared.interface.bound(bodies.pairs),
        force=prepared.scale.force,
        length=length,
        floating=bool(prepared.floating.shape[1]),
    )
    start = bodies.blocks.spread(free)
    with prepared.clock.phase("complementarity"):
        result = solve_iteratively(bodies, load, start, r[rows].reshape(d, -1))
    forces, moved = np.zeros(len(offset)), np.zeros(len(offset))
    forces[rows], moved[rows] = result.forces, result.moved
    return result, forces, moved, result.free


def _start(prepared: Prepared, state: State) -> Array | IntArray | None:
    """What the law's solver starts from: the states of the pairs, in space their ``y = r - h``; None at rest."""
    condensed, rows = prepared.condensed, prepared.condensed.active_rows
    if not state.forces.any():
        return None
    if isinstance(prepared.law, CoulombProblem):
        pressing = state.forces[rows] / condensed.root
        return prepared.law.bound.coded(state.status[condensed.active], pressing[: len(rows) // 2])
    still = np.concatenate([state.gap, np.zeros_like(state.tangential)])[rows]
    start: Array = state.forces[rows] / condensed.root - condensed.root * still
    return start


def _solve(
    law: CoulombProblem | SpatialProblem, b: Array, start: Array | IntArray | None
) -> CoulombResult | SpatialResult:
    if isinstance(law, SpatialProblem):
        return solve_spatial(replace(law, b=b), None if start is None else np.asarray(start, dtype=np.float64))
    return solve_coulomb(replace(law, b=b), None if start is None else np.asarray(start, dtype=np.int64))


def refuse_overlap(prepared: Prepared, gap: Array, where: str) -> None:
    """Supports that hold both sides of a pair decide its gap; no force can mend an overlap there."""
    held = np.nonzero(prepared.bodies.held & ~prepared.absent & (gap < -1e-12 * prepared.scale.length))[0]
    if len(held):
        pair = held[np.argmin(gap[held])]
        contact = prepared.model.contacts[prepared.interface.contact[pair]]
        number = prepared.model.mesh.labels[prepared.interface.node[pair]]
        raise SolveFailed(
            f"{where}: contact '{contact.label}': supports press node {number} "
            f"{-gap[pair]:.4g} into the other side and leave it no way out",
            status="no_equilibrium",
        )


def _failure(prepared: Prepared, result: CoulombResult | SpatialResult | Answer, where: str) -> SolveFailed:
    """The reason, and the bodies that leave by name, with their motion."""
    if isinstance(result, Answer) or result.escape is None or not prepared.law.floating:
        return SolveFailed(f"{where}: {result.message}", status=result.outcome)
    words, motion = leaving(prepared, result.escape)
    return SolveFailed(f"{where}: {words}: {result.message}", status=result.outcome, motion=motion)


def leaving(prepared: Prepared, escape: Array) -> tuple[str, Array]:
    """The bodies that leave by name, and their motion (nodes, d), largest entry 1, of a rigid motion of the pairs."""
    coefficients, *_ = np.linalg.lstsq(prepared.law.motions, escape, rcond=None)
    return moving_away(prepared, prepared.floating @ coefficients)


def moving_away(prepared: Prepared, rigid: Array) -> tuple[str, Array]:
    """The same of coefficients of the rigid motions of all parts."""
    motion = (prepared.motions @ rigid).reshape(-1, prepared.model.dimension)
    said = np.where(np.abs(rigid) < _SLIGHT * np.abs(rigid).max(initial=0.0), 0.0, rigid)
    return describe_motion(prepared.parts, said), frozen(motion / (np.abs(motion).max() or 1.0))
