# SPDX-License-Identifier: BSD-3-Clause
"""Energies: stored in bodies, foundations, compliant interfaces and by temperature; set free at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.arrays import Array
from signorini.engine.prepare import Prepared
from signorini.fem.thermal import held_energy
from signorini.plasticity.measure import stored_by_plastic_strain
from signorini.solution.state import State


def thermal_energy(prepared: Prepared) -> Callable[[State], float]:
    """``- u f_T + s G s / 2``: the elastic energy is ``u K u / 2`` and this; thermal forces ``f_T = sum_k s_k f_k``.

    G is the energy of the held bodies; s the factors of the temperatures. As external work counts that of the thermal
    forces, the change of it is also what heating does beyond that.
    """
    names, G = held_energy(prepared.space, prepared.model)

    def heat(state: State) -> float:
        s = np.array([state.point.factors.get(name, 0.0) for name in names])
        constraints, (u, _) = prepared.constraints, state.nodal
        named = (s[k] * constraints.placed(prepared.loads[name]) for k, name in enumerate(names))
        forces = sum(named, constraints.zeros)
        return float(0.5 * s @ G @ s - u @ forces)

    return heat


def set_free(prepared: Prepared, before: State, after: State, *, taken: Array) -> State:
    """The state after something that happened at once at constant loads, with its energy.

    Parameters
    ----------
    prepared : under the law in which it happened
    before, after : states at its ends
    taken : (n,) by friction; what else the bodies lose and plastic flow does not take is set free
    """
    loss = stored_energy(prepared, before) - stored_energy(prepared, after)
    loss -= after.plastic_work - before.plastic_work
    (u, pressing), (now, pressed) = before.nodal, after.nodal
    work = 0.5 * (pressing + pressed) @ (now - u)
    return after.changed(
        dissipation=before.dissipation + taken,
        work=before.work + float(work),
        released=before.released + loss + float(work) - float(taken.sum()),
    )


def stored_energy(prepared: Prepared, state: State) -> float:
    """Elastic, in the bodies, elastic foundations and compliant interfaces; with what closures have taken for good."""
    u, _ = state.nodal
    if prepared.turns:
        u = prepared.frames.elastic(u)  # rigid motions store nothing but their rounding
    strain = float(u @ (prepared.K @ u)) if u.any() else 0.0
    beyond = 0.0
    if prepared.yielding is not None and state.plastic is not None:
        bodies = prepared.yielding
        beyond = stored_by_plastic_strain(bodies, u, state.plastic, bodies.heat(state.point.factors))
    return 0.5 * strain + beyond + interface_energy(prepared, state) + state.closing_work


def missing_energy(prepared: Prepared, before: State, after: State, then: Prepared | None = None) -> float:
    """Of the work between two states, what is neither stored, nor taken by friction and plastic flow, nor set free.

    Parameters
    ----------
    prepared : under the law in between
    before, after : the states
    then : the model behind, where its mesh has moved in between
    """
    work = after.work - before.work
    spent = stored_energy(then or prepared, after) - stored_energy(prepared, before) + after.released - before.released
    spent += float((after.dissipation - before.dissipation).sum()) + after.plastic_work - before.plastic_work
    return abs(work - spent) / (abs(work) or 1.0)


def interface_energy(prepared: Prepared, state: State) -> float:
    """In compliant interfaces, and in bonds that have opened."""
    forces, interface = np.where(prepared.absent, 0.0, state.forces), prepared.interface
    stored = 0.0
    if state.bonds is not None and interface.cohesion is not None:
        stored = 0.5 * float(interface.cohesion.tension(state.bonds, state.gap) @ state.gap)
    if interface.closure is None:
        return stored + 0.5 * float(np.vdot(forces**2, interface.compliance))
    along = 0.5 * float(np.vdot(forces[1:] ** 2, interface.compliance[1:]))
    closure = interface.closure.after(state.borne)
    return stored + along + float(interface.area @ closure.energy(forces[0] / interface.area))
