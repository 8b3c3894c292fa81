# SPDX-License-Identifier: BSD-3-Clause
"""Displacements at any moment of a history, and the bodies before any load."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from signorini.arrays import Array, frozen
from signorini.blas_threads import one_thread
from signorini.engine.examine import Examined, examine
from signorini.engine.reactions import rigid_dofs, rigid_motions, rigid_names
from signorini.engine.recovery import Recovery
from signorini.errors import InputError
from signorini.solution.history import History
from signorini.solution.nodal_forces import NodalForces
from signorini.solution.obstacle_result import ObstacleMotion
from signorini.solution.results import OPEN, Instant, StepResult

_RANK_TOL = 1e-9  # of the largest: motions that pairs see less of are not known
_FIT_TOL = 1e-6  # of the largest displacement: how far gaps and slips may be from those of the bodies


def at_rest(history: History) -> Instant:
    """The bodies of a history before any load: nothing presses, gaps are those of the mesh."""
    model, first = history.model, history.steps[0].instants[0]
    examined = examine(replace(model, fatigue=()))
    interface, space = examined.interface, examined.space
    contacts = []
    for i, contact in enumerate(first.contacts):
        still = 0.0 * contact.traction
        gap = interface.gap[interface.contact == i]
        contacts.append(
            replace(
                contact,
                gap=frozen(gap),
                pressure=frozen(np.zeros(len(gap))),
                traction=frozen(still),
                slip=frozen(still),
                status=np.full(len(gap), OPEN),
                damage=None if contact.damage is None else frozen(0.0 * contact.damage),
            )
        )
    return Instant(
        load_factor=0.0,
        what="start",
        contacts=tuple(contacts),
        work=0.0,
        displacement=frozen(np.zeros_like(history.steps[0].displacement)),
        factors={},
        motions=rigid_motions(model, space, np.zeros(space.number_of_dofs)),
    )


def whole_instant(recovery: Recovery, history: History, number: int, instant: Instant) -> Instant:
    """A moment with the displacements that `dofs_on_the_way` finds, and the forces that follow from them.

    Parameters
    ----------
    recovery : of the model
    history, number : with the step of the moment, which counts from 1
    instant : the contacts at the moment
    """
    (u,) = dofs_on_the_way(recovery, history, number, [instant])
    space, constraints = recovery.examined.space, recovery.examined.constraints
    reaction = recovery.held(instant, u) + constraints.foundation_forces(u)
    forces = NodalForces.of(space, reaction, recovery.pressed(instant))
    motions = rigid_motions(history.model, space, u)
    return replace(instant, displacement=frozen(space.at_nodes(u)), nodal_forces=forces, motions=motions)


@one_thread()
def dofs_on_the_way(recovery: Recovery, history: History, number: int, instants: Sequence[Instant]) -> list[Array]:
    """Displacements (dofs,) at moments of a step, from the forces of the contacts.

    Rigid motions that nothing but contact holds are those that gaps and slips say, from a state whose displacements
    were kept to the moment.

    Parameters
    ----------
    recovery : of the model
    history, number : with the step of the moments, which counts from 1
    instants : the contacts at the moments

    Raises
    ------
    InputError
        If displacements do not follow from what was kept.
    """
    step, solved = history.steps[number - 1], cache(lambda state: recovery.solved([state])[:, 0])
    strained = recovery.dofs(step, instants)
    if not recovery.loose.shape[1]:
        return [*strained]
    return [
        _settled(recovery, history, number, (instant, found), solved)
        for instant, found in zip(instants, [*strained], strict=True)
    ]


def _settled(
    recovery: Recovery,
    history: History,
    number: int,
    moment: tuple[Instant, Array],
    solved: Callable[[Instant], Array],
) -> Array:
    """Displacements (dofs,) with the rigid motions of bodies that contact alone holds.

    Parameters
    ----------
    recovery, history, number : as of `dofs_on_the_way`
    moment : its contacts, and displacements (dofs,) but for rigid motions
    solved : the latter at instants
    """
    step, (instant, found) = history.steps[number - 1], moment
    for state, kept in _references(recovery, history, number, instant):
        strained = found - solved(state)
        rigid = _rigid_motion(recovery, history, step, (state, instant), strained)
        if rigid is not None:
            return np.asarray(kept + strained + rigid)
    words = f"how '{step.name}' moves bodies on the way that contact alone holds does not follow from gaps and slips"
    raise InputError(f'{words}; expected at = "events" in it, which keeps displacements', where=("load",))


def _references(recovery: Recovery, history: History, number: int, instant: Instant) -> Iterator[tuple[Instant, Array]]:
    """Instants with displacements (dofs,) that were kept, those that are next to a moment first."""
    step = history.steps[number - 1]
    known: list[tuple[Instant, Instant | StepResult]] = [(shot, shot) for shot in step.instants[:-1]]
    known.append((step.instants[-1], step))
    if number > 1:
        before = history.steps[number - 2]
        known.append((before.instants[-1], before))
    elif history.begin is not None:
        known.append((history.begin, history.begin))
    rigid = bool(recovery.examined.model.obstacles or recovery.examined.model.rigid_bodies)
    for state, end in sorted(known, key=lambda each: abs(each[0].load_factor - instant.load_factor)):
        if end.displacement is not None and (end.motions is not None or not rigid):
            yield state, whole_dofs(recovery.examined, end.displacement, end.motions or {})


def whole_dofs(examined: Examined, displacement: Array, motions: Mapping[str, ObstacleMotion]) -> Array:
    """(dofs,) Displacements of the bodies, with those of obstacles and rigid bodies.

    Parameters
    ----------
    examined : the model
    displacement : (nodes, d) of the bodies
    motions : of obstacles and rigid bodies by name
    """
    space, model = examined.space, examined.model
    found = np.full(space.number_of_dofs, np.nan)
    found[: displacement.size] = displacement.ravel()
    for j, name in enumerate(rigid_names(model)):
        dofs, size = rigid_dofs(model, space, j)
        motion = motions[name]
        found[dofs] = np.concatenate([motion.displacement, np.atleast_1d(motion.rotation)]) * size
    return found


def _rigid_motion(
    recovery: Recovery, history: History, step: StepResult, ends: tuple[Instant, Instant], strained: Array
) -> Array | None:
    """(dofs,) Rigid motion from one state to another besides what the bodies strain; None where it is not all known.

    Parameters
    ----------
    recovery, history, step : of the states
    ends : the states
    strained : (dofs,) by what displacements but for rigid motions differ
    """
    interface, d = recovery.examined.interface, recovery.examined.interface.directions
    one, two = ends
    rises = np.full((d, len(interface)), np.nan)
    low, high = sorted(shot.load_factor for shot in ends)
    between = [shot for shot in step.instants if low <= shot.load_factor <= high]
    overlapping = {name for part in history.model.steps for name in part.interference}
    for i, law in enumerate(history.model.contacts):
        own, first, last = interface.contact == i, one.contacts[i], two.contacts[i]
        if law.label not in overlapping and first.wear is None:
            rises[0, own] = last.gap - first.gap
        held = np.all([shot.contacts[i].closed for shot in (*between, one, two)], axis=0)
        slid = (last.slip - first.slip).reshape(len(held), -1).T
        slid = slid - interface.tangential_compliance[own] * (last.traction - first.traction).reshape(len(held), -1).T
        rises[1:, own] = np.where(held, slid, np.nan)
    rows = np.isfinite(rises.ravel())
    B, risen = interface.B[rows], rises.ravel()[rows]
    seen, wanted = B @ recovery.loose, risen - B @ strained
    sizes = np.linalg.svd(seen, compute_uv=False)
    if len(sizes) < seen.shape[1] or sizes[-1] <= _RANK_TOL * sizes[0]:
        return None
    motion = np.linalg.lstsq(seen, wanted)[0]
    size = max(float(np.abs(step.displacement).max(initial=0.0)), float(np.abs(risen).max()))
    if np.abs(seen @ motion - wanted).max() > _FIT_TOL * size:
        return None
    return np.asarray(recovery.loose @ motion)
