# SPDX-License-Identifier: BSD-3-Clause
"""Where nothing was found in space: the load, if there is one, beyond which floating bodies have no equilibrium."""

from __future__ import annotations

from dataclasses import replace

from signorini.arrays import frozen
from signorini.attempt import Spent
from signorini.engine.increments import leaving
from signorini.engine.path_states import right_hand_side
from signorini.engine.step_parts import StepPart, reached
from signorini.errors import SolveFailed, told
from signorini.friction.overload import overload
from signorini.outcome import Outcome

_WORDS = "forces in the friction cones of all pairs cannot balance more load, however they are shared"


def known(stop: SolveFailed, part: StepPart) -> SolveFailed:
    """What stopped a part, as the proof that its end has no equilibrium where nothing was found and there is one.

    Methods end without a solution where increments step beyond what contact can hold, and where the path is lost
    before; the load from which on there is none is a fact of the loads and the friction alone (see `overload`).

    Parameters
    ----------
    part : to which it came; what was followed of it is in ``stop.reached``
    """
    prepared, paths, interval = part.prepared, part.prepared.solver.paths, part.interval
    if stop.status != Outcome.NOT_FOUND or paths is None or paths.law.directions == 2:
        return stop
    followed = reached(stop)
    state = part.before if followed is None else followed.after
    low = interval.low if followed is None else followed.snapshots[-1].fraction
    held = paths.law.by_pair(state.forces[paths.condensed.active_rows] / paths.condensed.root)
    problem = replace(paths.law, b=frozen(right_hand_side(prepared, state.point)))
    found = overload(problem, held, right_hand_side(prepared, part.end))
    if found is None:
        return stop
    if isinstance(found, Spent):
        return stop.saying(str(found))
    words, motion = leaving(prepared, found.motion)
    limit = low + found.factor * (interval.high - low)
    where = f"{part.where}: no equilibrium beyond {100.0 * limit:.6g}%, up to {100.0 * low:.6g}% it was followed"
    proof = SolveFailed(
        told(
            f"{where}: {words}: {_WORDS}",
            remedy="hold the bodies against it, or change loads or friction",
            evidence=stop.sentence,
        ),
        status=Outcome.NO_EQUILIBRIUM,
        motion=motion,
    )
    proof.reached = stop.reached
    return proof
