# SPDX-License-Identifier: BSD-3-Clause
"""What a joint damps: closed loops under the forces of a mode, as large as asked for, followed as any other load.

The inertia forces of a mode, ``Q M v``, act as a static load after the preload and go from ``Q`` to ``-Q`` and back
(quasi-static modal analysis). With ``q = v M (u - u_0)`` the loop from one end to the other has the secant
``omega^2 = dQ / dq``, and what friction takes from it, D, damps as ``zeta = D / (2 pi omega^2 q^2)``.

References
----------
Festjens, Chevallier, Dion (2013), A numerical tool for the design of assembled structures under dynamic loads, Int. J.
Mech. Sci. 75:170.
Lacayo, Allen (2019), Updating structural models containing nonlinear Iwan joints using quasi-static modal analysis,
Mech. Syst. Signal Process. 118:133.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.checks import whole
from signorini.engine.solve import raise_failure, solve
from signorini.errors import InputError
from signorini.model.conditions import Load
from signorini.model.model import Model
from signorini.model.modes import MOST_CYCLES, ascending
from signorini.model.step import Step
from signorini.settings import SolverSettings
from signorini.solution.damping import DampingLoop, JointDamping
from signorini.solution.history import History
from signorini.solution.modes import NaturalModes
from signorini.solution.results import Instant, StepResult
from signorini.vibration.modes import natural_modes

MODAL_FORCE = "modal force"
"""What the load is called, and the set of the nodes that bear it."""

_POINTS = 32  # of every half of a loop: what a picture shows as a curve
_TURN_TOL = 1e-9  # of a step: rounding of load factors


def joint_damping(
    history: History,
    amplitudes: Sequence[float],
    *,
    mode: int = 1,
    cycles: int = 2,
    settings: SolverSettings | None = None,
) -> JointDamping:
    """Loops of a mode of the stuck joints about the end of a history, one after the other.

    Where the joint slides as a whole before the last of them, those before it are the answer, with the reason.

    Parameters
    ----------
    history : with the preload
    amplitudes : ascending, length: the largest displacement that the forces would cause if the joint stayed stuck
    mode : number from 1
    cycles : at each amplitude, of which the last is the loop: the first ones may shake down
    settings : limits of the methods that solve contact

    Raises
    ------
    InputError
        If the history was not finished, the mode is a rigid motion, or amplitudes do not ascend.
    SolveFailed
        If not even the first loop was followed.
    """
    if history.end is None or not history.solved:
        raise InputError("was not finished; expected a solved preload", where=("history",))
    whole(mode, ("mode",))
    whole(cycles, ("cycles",), most=MOST_CYCLES)
    levels = np.array(ascending(list(amplitudes), ("amplitudes",)))
    if not len(levels):
        raise InputError("are none; expected one length or more", where=("amplitudes",))
    modes = natural_modes(history, mode)
    square = float(modes.squares[-1])
    if square == 0.0:
        raise InputError(f"is {mode}, a rigid motion; expected a mode that strains something", where=("mode",))
    reach = float(np.linalg.norm(modes.shapes[-1], axis=1).max())
    force = square * levels[-1] / reach
    model = _loaded(history.model, modes, force, [_turns(part, cycles) for part in (levels / levels[-1]).tolist()])
    answer = solve(model, start=history.end, settings=settings, raise_on_failure=False)
    finished = [step for step in answer.steps if step.finished]
    if not finished:
        raise_failure(answer)
    start, weights = history.last.displacement, modes.forces[-1]
    loops = tuple(_loop(step, start, weights, force) for step in finished)
    return JointDamping(
        mode=mode,
        frequency=float(modes.frequencies[-1]),
        reach=reach,
        loops=loops,
        history=answer,
        message=answer.message,
    )


def _turns(part: float, cycles: int) -> list[float]:
    """Where a load turns that goes to a part of its largest value, and from there to and fro."""
    return [part, *([-part, part] * cycles)]


def _loaded(model: Model, modes: NaturalModes, force: float, turns: Sequence[list[float]]) -> Model:
    """The model with the forces of the last mode on all its nodes, and a step for each of the turns."""
    given = modes.forces[-1]
    bearing = np.flatnonzero(np.abs(given).any(axis=1))
    if MODAL_FORCE in model.mesh.nodes or any(load.label == MODAL_FORCE for load in model.loads):
        raise InputError(f"there is a load or node set '{MODAL_FORCE}'; expected another name", where=("load",))
    mesh = replace(model.mesh, nodes={**model.mesh.nodes, MODAL_FORCE: bearing})
    load = Load(MODAL_FORCE, nodal_forces=force * given[bearing])
    steps = [
        Step(name=f"loop {number}", scale={MODAL_FORCE: way}, at=len(way) * _POINTS)
        for number, way in enumerate(turns, start=1)
    ]
    return replace(model, mesh=mesh, loads=[*model.loads, load], steps=steps)


def _loop(step: StepResult, start: Array, weights: Array, force: float) -> DampingLoop:
    """The last two segments of a step: the way back and forth between both ends."""
    segments = [one.load_factor for one in step.instants if one.what == "segment"]
    turn = segments[-3] - _TURN_TOL
    fields = {one.load_factor: one.displacement for one in step.instants} | {step.load_factor: step.displacement}
    way = [one for one in step.instants if one.load_factor >= turn and fields[one.load_factor] is not None]
    moved = [u - start for one in way if (u := fields[one.load_factor]) is not None]
    q = np.array([float(np.vdot(weights, by)) for by in moved])
    Q = np.array([force * one.factors[MODAL_FORCE] for one in way])
    return DampingLoop(coordinate=q, force=Q, dissipation=_spent(way[-1]) - _spent(way[0]))


def _spent(instant: Instant) -> float:
    """By friction and plastic flow since the beginning of the step."""
    flow = 0.0 if instant.plastic is None else instant.plastic.dissipation
    return flow + sum(contact.dissipation for contact in instant.contacts)
