# SPDX-License-Identifier: BSD-3-Clause
"""What happens at once at the beginning of a step: contacts switched on and off, friction that is lowered."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import BoolArray
from signorini.attempt import MethodRun
from signorini.engine.exact import set_free, stored_energy
from signorini.engine.increments import advance
from signorini.engine.prepare import Prepared
from signorini.friction.law import OPEN
from signorini.solution.certificate import Certificate
from signorini.solution.state import State

_MORE = 1e-9  # of the friction bound: what counts as beyond it


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
    given = np.where(prepared.interface.rows(off), state.forces, 0.0)
    overlap = np.where(on, np.maximum(-state.gap, 0.0), 0.0)
    # compliant interfaces let their energy go with the law
    soft = stored_energy(replace(prepared, absent=absent), state) - stored_energy(prepared, state)
    return replace(
        state,
        point=replace(state.point, gap=state.point.gap + overlap, given=given),
        gap=state.gap + overlap,
        slip=np.where(np.tile(on, prepared.interface.directions - 1), 0.0, state.slip),
        status=np.where(off | on, OPEN, state.status),
        released=state.released + soft,
    )


def relaxed(prepared: Prepared, state: State, where: str) -> tuple[State, Certificate, tuple[MethodRun, ...]] | None:
    """The state after pairs whose friction was lowered below what they carry have slipped, at the same loads.

    That is no gradual motion: the energy set free beyond what friction takes, by the mean of its forces before and
    after, is counted as released. None where nothing slips.
    """
    n, interface = len(prepared.interface), prepared.interface
    tangential, bound = interface.effort(state.forces[n:]), interface.most(state.forces[:n])
    bound[interface.sticks] = np.inf
    size = float(np.abs(state.forces).max(initial=0.0))
    if not (~prepared.absent & (tangential > (1.0 + _MORE) * bound + 1e-12 * size)).any():
        return None
    after, certificate, result = advance(prepared, state, state.point, f"{where}, friction lowered")
    spent = 0.5 * (state.forces + after.forces)[n:] * (after.slip - state.slip)
    taken = np.where(prepared.absent, 0.0, np.maximum(-spent.reshape(-1, n).sum(axis=0), 0.0))
    return set_free(prepared, state, after, taken=taken), certificate, result.trace
