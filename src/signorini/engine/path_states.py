# SPDX-License-Identifier: BSD-3-Clause
"""States of bodies and pairs, in units of the problem, from and to states of a path, in the scaled units of its law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.energy import stored_energy
from signorini.engine.increments import applied, free_load, moved_by_supports, settled
from signorini.engine.prepare import Prepared
from signorini.friction.history import PathState, initial_state
from signorini.law.bound import plain
from signorini.law.states import OPEN, STICK
from signorini.solution.state import LoadPoint, State, next_state

_SPENT = 1e-9  # of the friction bound: what a slipping pair may lack of it


def offsets(prepared: Prepared, point: LoadPoint) -> Array:
    """(d, n) Motions of all pairs that loads do not cause: gaps, what supports impose and bonds pull, no past slip."""
    _, imposed = applied(prepared, point)
    offset = moved_by_supports(prepared, imposed)
    offset[0] += point.gap
    if point.pull is not None:
        offset += prepared.interface.compliance * point.pull
    return offset


def right_hand_side(prepared: Prepared, point: LoadPoint, slipped: Array | None = None) -> Array:
    """(d a,) b of the law at a point of the load history.

    Parameters
    ----------
    prepared : condensed
    point : of the load history
    slipped : (d - 1, n) tangential displacements that slips are counted from, length; from the beginning if not given
    """
    condensed, offset = prepared.paths.condensed, prepared.paths.rested(offsets(prepared, point))
    if slipped is not None:
        offset[1:] -= slipped
    reduced = condensed.reduce(free_load(prepared, point))
    return condensed.right_hand_side(reduced.load, offset[:, condensed.active])


def path_state(prepared: Prepared, state: State) -> PathState:
    """A state in the scaled units of the law; overlaps of bodies that nothing has moved yet press first."""
    paths, condensed, active = prepared.paths, prepared.paths.condensed, prepared.paths.active
    b, root, law = right_hand_side(prepared, state.point), condensed.root, paths.law
    h, slip = root * state.motion[:, active], root * state.slip[:, active]
    dissipation = state.dissipation[active]
    if not state.forces.any() and not state.nodal[0].any() and (h[0] < 0.0).any():
        pressed = initial_state(law, b, settings=prepared.settings)
        return replace(pressed, slip=slip + pressed.slip, dissipation=dissipation + pressed.dissipation)
    forces = state.forces if state.point.pull is None else state.forces - state.point.pull
    r, status = forces[:, active] / root, state.status[active]
    if prepared.interface.directions == 2:  # friction that has risen since leaves some to spare
        spare = (status > STICK) & (np.abs(r[1]) < (1.0 - _SPENT) * law.bound.at(r[0]))
        status = np.where(spare, STICK, status)
    return PathState(b=b, h=h, r=r, state=status, anchor=h[1:], slip=slip, dissipation=dissipation)


def on_the_way(prepared: Prepared, last: State, point: LoadPoint, now: PathState) -> State:
    """The contacts at an event; the bodies are not looked at.

    Parameters
    ----------
    prepared : condensed
    last : a state before, to whose slips and dissipation those of the path are added
    point : of the load history
    now : the state of the path there
    """
    active, root = prepared.paths.condensed.active, prepared.paths.condensed.root
    forces, moved = np.zeros_like(point.given), np.full(point.given.shape, np.nan)
    forces[:, active], moved[:, active] = root * now.r, now.h / root
    status, slip, dissipation = np.full(len(active), OPEN), last.slip.copy(), last.dissipation.copy()
    status[active], status[prepared.interface.tied] = plain(now.state), STICK
    forces, status = settled(prepared, forces, status)
    slip[:, active] = now.slip / root
    dissipation[active] = now.dissipation
    return last.changed(
        point=point,
        forces=forces + point.given if point.pull is None else forces + point.given + point.pull,
        gap=moved[0],
        tangential=moved[1:],
        slip=slip,
        status=status,
        dissipation=dissipation,
        borne=prepared.interface.borne_after(last.borne, forces),
        bonds=prepared.interface.bonds_after(last.bonds, moved[0]),
    )


def recovered(prepared: Prepared, last: State, point: LoadPoint, now: PathState) -> State:
    """The whole state at an event or at an end; its work is that of the trapezoidal rule.

    Parameters
    ----------
    prepared, point, now : as of `on_the_way`
    last : the last state that was recovered
    """
    condensed, interface, constraints = prepared.paths.condensed, prepared.interface, prepared.constraints
    active = condensed.active
    seen = on_the_way(prepared, last, point, now)
    (loads, imposed), offset = applied(prepared, point), prepared.paths.rested(offsets(prepared, point))
    reduced = condensed.reduce(free_load(prepared, point))
    beside = point.given if point.pull is None else point.given + point.pull
    acting = (seen.forces - beside)[:, active]
    free = condensed.displacement(reduced, seen.motion[:, active], acting, offset[:, active])
    displacement = constraints.displaced(free) + imposed
    moved = np.where(active, seen.motion, offset + interface.motion(displacement - imposed))
    moved[1:] -= last.tangential
    forces, ties = seen.forces.copy(), condensed.ties
    given = loads + prepared.flowed if len(prepared.flowed) else loads
    if ties is not None:
        missing = given + prepared.pushed(forces) - prepared.K @ displacement
        ties.give(forces, ties.forces(constraints.on_free(missing)))
    after = next_state(
        prepared,
        last,
        point=point,
        loads=loads,
        displacement=displacement,
        forces=forces,
        moved=moved,
        status=seen.status,
    )
    return after.changed(slip=seen.slip, dissipation=seen.dissipation)


def balanced(prepared: Prepared, last: State, here: State, lost: float) -> State:
    """A recovered state with its exact work: what is stored, what contact takes on linear pieces, and what is set free.

    With ``K u = f + B^T r`` and ``B u = h - C r - h_0`` the work of the loads and of the interferences h_0 is the
    change of the energy stored less ``int r . dh``. Overlaps that press before anything moves work by themselves.

    Parameters
    ----------
    prepared : condensed
    last, here : the last state with its exact work, and the state
    lost : what contact takes in between, ``-int r . dh``
    """
    stored = stored_energy(prepared, here) - stored_energy(prepared, last)
    return here.changed(work=last.work + stored + lost + here.released - last.released)


def tangential(prepared: Prepared, state: State, h: Array) -> Array:
    """(d - 1, n) Tangential displacements of a state, of active pairs those of a path, length.

    Parameters
    ----------
    prepared : condensed
    state : of all pairs
    h : (d, a) motions of the active pairs, scaled
    """
    condensed, moved = prepared.paths.condensed, state.tangential.copy()
    moved[:, condensed.active] = h[1:] / condensed.root
    return moved
