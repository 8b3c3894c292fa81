# SPDX-License-Identifier: BSD-3-Clause
"""Displacements at any moment of a history, and the bodies before any load."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, frozen
from signorini.engine.examine import examine
from signorini.engine.recovery import Recovery
from signorini.errors import InputError
from signorini.linalg.threads import one_thread
from signorini.solution.history import History
from signorini.solution.results import OPEN, Instant, StepResult

_RANK_TOL = 1e-9  # of the largest: motions that pairs see less of are not known
_FIT_TOL = 1e-6  # of the largest displacement: how far gaps and slips may be from those of the bodies


def at_rest(history: History) -> Instant:
    """The bodies of a history before any load: nothing presses, gaps are those of the mesh."""
    model, first = history.model, history.steps[0].instants[0]
    interface = examine(replace(model, fatigue=())).interface
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
    )


@one_thread()
def displacement_at(recovery: Recovery, history: History, number: int, instant: Instant) -> Array:
    """Displacements (nodes, d) of the bodies at a moment, from the forces of the contacts.

    Rigid motions that nothing but contact holds are those that gaps and slips say, from a state whose displacements
    were kept to this one.

    Parameters
    ----------
    recovery : of the model
    history, number : with the step of the moment, which counts from 1
    instant : its contacts

    Raises
    ------
    InputError
        If displacements do not follow from what was kept.
    """
    step = history.steps[number - 1]
    found = next(iter([*recovery.displacements(step, [instant])]))
    if not recovery.loose.shape[1]:
        return frozen(found)
    for state, kept in _references(history, number, instant):
        rigid = _rigid_motion(recovery, history, step, (state, instant))
        if rigid is not None:
            there = next(iter([*recovery.displacements(step, [state])]))
            return frozen(kept + found - there + recovery.examined.space.at_nodes(rigid))
    words = f"how '{step.name}' moves bodies on the way that contact alone holds does not follow from gaps and slips"
    raise InputError(f'{words}; expected at = "events" in it, which keeps displacements', where=("load",))


def _references(history: History, number: int, instant: Instant) -> Iterator[tuple[Instant, Array]]:
    """Instants whose displacements were kept, those that are next to a moment first."""
    step = history.steps[number - 1]
    known = [shot for shot in step.instants[:-1] if shot.displacement is not None]
    states = [(shot, shot.displacement) for shot in known] + [(step.instants[-1], step.displacement)]
    if number > 1:
        states.append((history.steps[number - 2].instants[-1], history.steps[number - 2].displacement))
    elif history.begin is not None:
        states.append((history.begin, history.begin.displacement))
    for state, kept in sorted(states, key=lambda pair: abs(pair[0].load_factor - instant.load_factor)):
        if kept is not None:
            yield state, kept


def _rigid_motion(
    recovery: Recovery, history: History, step: StepResult, ends: tuple[Instant, Instant]
) -> Array | None:
    """(dofs,) Rigid motion from one state to another besides what `Recovery` finds; None where it is not all known."""
    interface, d = recovery.examined.interface, recovery.examined.interface.directions
    one, two = ends
    strained = recovery.solved([two]) - recovery.solved([one])
    rises = np.full((d, len(interface)), np.nan)
    low, high = sorted(shot.load_factor for shot in ends)
    between = [shot for shot in step.instants if low <= shot.load_factor <= high]
    for i, law in enumerate(history.model.contacts):
        own, first, last = interface.contact == i, one.contacts[i], two.contacts[i]
        if law.label not in {name for part in history.model.steps for name in part.interference} and first.wear is None:
            rises[0, own] = last.gap - first.gap
        held = np.all([shot.contacts[i].closed for shot in (*between, one, two)], axis=0)
        slid = (last.slip - first.slip).reshape(len(held), -1).T
        slid = slid - interface.tangential_compliance[own] * (last.traction - first.traction).reshape(len(held), -1).T
        rises[1:, own] = np.where(held, slid, np.nan)
    rows = np.isfinite(rises.ravel())
    B = interface.B[rows]
    seen, wanted = B @ recovery.loose, rises.ravel()[rows] - (B @ strained)[:, 0]
    sizes = np.linalg.svd(seen, compute_uv=False)
    if len(sizes) < seen.shape[1] or sizes[-1] <= _RANK_TOL * sizes[0]:
        return None
    motion = np.linalg.lstsq(seen, wanted)[0]
    size = max(float(np.abs(step.displacement).max(initial=0.0)), float(np.abs(rises.ravel()[rows]).max()))
    if np.abs(seen @ motion - wanted).max() > _FIT_TOL * size:
        return None
    return np.asarray(recovery.loose @ motion)
