# SPDX-License-Identifier: BSD-3-Clause
"""What a step changes of contacts: its law, what is switched on and off, friction that is lowered."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.attempt import MethodRun
from signorini.engine.energy import set_free, stored_energy
from signorini.engine.examine import left_out, refuse_free_motions
from signorini.engine.increments import advance
from signorini.engine.overlaps import gap_under
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.interface.interface import pairs_of, under_laws
from signorini.law.states import OPEN
from signorini.model.stage import Stage
from signorini.solution.certificate import Certificate
from signorini.solution.scale import Loading
from signorini.solution.state import State

_BOUND_TOL = 1e-9  # of the friction bound: what counts as beyond it
_UNLOADED_FRICTION = 1e-12  # of the size of forces: what rounding leaves of friction where nothing presses


def switched(prepared: Prepared, state: State, absent: BoolArray) -> State:
    """The state with the contacts of a step switched on and off.

    A pair that is switched off keeps its forces as given ones, which the step takes to zero. One that is switched on
    has no slip behind it; what overlaps there counts as touching, and the step presses it out.

    Parameters
    ----------
    prepared : under the law of the step
    state : at the end of the step before
    absent : (n,) pairs that were switched off in it
    """
    off, on = prepared.absent & ~absent, absent & ~prepared.absent
    if not off.any() and not on.any():
        return state
    given = np.where(off, state.forces, 0.0)
    overlap = np.where(on, np.maximum(-state.gap, 0.0), 0.0)
    # compliant interfaces let their energy go with the law
    soft = stored_energy(replace(prepared, absent=absent), state) - stored_energy(prepared, state)
    return state.changed(
        point=state.point.changed(gap=state.point.gap + overlap, given=given),
        gap=state.gap + overlap,
        slip=np.where(on, 0.0, state.slip),
        status=np.where(off | on, OPEN, state.status),
        released=state.released + soft,
    )


def relaxed(prepared: Prepared, state: State, where: str) -> tuple[State, Certificate, tuple[MethodRun, ...]] | None:
    """The state after pairs whose friction was lowered below what they carry have slipped, at the same loads.

    That is no gradual motion: the energy set free beyond what friction takes, by the mean of its forces before and
    after, is counted as released. None where nothing slips.

    Parameters
    ----------
    prepared : under the law of the step
    state : at the end of the step before
    where : name of the step, for messages
    """
    interface = prepared.interface
    tangential, bound = interface.effort(state.forces[1:]), interface.most(state.forces[0])
    bound[interface.friction.sticks] = np.inf
    if not (
        ~prepared.absent & (tangential > (1.0 + _BOUND_TOL) * bound + _UNLOADED_FRICTION * prepared.scale.force)
    ).any():
        return None
    after, certificate, tried = advance(prepared, state, state.point, f"{where}, friction lowered")
    spent = 0.5 * (state.forces + after.forces)[1:] * (after.slip - state.slip)
    taken = np.where(prepared.absent, 0.0, np.maximum(-spent.sum(axis=0), 0.0))
    return set_free(prepared, state, after, taken=taken), certificate, tried


def staged(prepared: Prepared, stage: Stage, loading: Loading) -> Prepared:
    """The prepared model under the law of a step; nothing sparse is factorised again.

    Parameters
    ----------
    prepared : with every contact switched on and the friction that the contacts themselves have
    stage : the step
    loading : the most that was imposed up to the end of the step: what its certificates refer to

    Raises
    ------
    InputError
        If the contacts that are left do not hold a body: it is named, with its motion.
    """
    labels = [contact.label for contact in prepared.model.contacts]
    laws: list[Any] = [contact.law for contact in prepared.model.contacts]
    for name, value in stage.friction.items():
        i = labels.index(name)
        laws[i] = replace(laws[i], friction="stick" if value == np.inf else value)
    absent = pairs_of(prepared.model, prepared.interface, stage.inactive)
    interface = under_laws(prepared.interface, prepared.model, laws) if stage.friction else prepared.interface
    if absent.any():
        left = interface.among(~absent)
        try:
            refuse_free_motions(prepared.space, prepared.resisted, left, prepared.parts, prepared.rigid)
        except InputError as error:
            raise left_out(error, stage) from error
    return prepared.under(interface, loading, absent)


def pressed_gap(prepared: Prepared, stage: Stage) -> Array:
    """(n,) Gaps of sides that are not worn, length, under the interferences at the end of a step."""
    gap = prepared.interface.gap.copy()
    for i, contact in enumerate(prepared.model.contacts):
        if contact.label in stage.interference:
            own, overlap = prepared.interface.contact == i, stage.interference[contact.label]
            if isinstance(overlap, float) and isinstance(contact.interference, float):
                gap[own] += contact.interference - overlap
            else:
                gap[own] = gap_under(prepared.space, prepared.model, i, overlap)
    return gap
