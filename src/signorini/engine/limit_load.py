# SPDX-License-Identifier: BSD-3-Clause
"""The load, if there is one, beyond which contact cannot hold floating bodies, whatever solves it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.attempt import Spent
from signorini.engine.increments import applied, moving_away
from signorini.engine.prepare import Prepared
from signorini.engine.solver import compression
from signorini.engine.step_parts import StepPart, reached
from signorini.errors import SolveFailed, told
from signorini.friction.history.space.bearing import NEAR_GAP, OVERLOADED
from signorini.friction.overload import along_contact, unheld
from signorini.friction.pull_away import GAIN
from signorini.law.bound import ADHESION_SLOPE, STICKING_FRICTION
from signorini.law.section import FrictionSection
from signorini.outcome import Outcome
from signorini.solution.state import LoadPoint, State

_WORDS = "forces in the friction cones of all pairs cannot balance more load, however they are shared"

HOLD = "hold the bodies that slide, press them more, or prescribe their motion in place of the load"
"""What to do about gross sliding."""

_FELT = 1e-9  # of the largest motion: less of a floating motion is not felt by the pairs


@dataclass(frozen=True, kw_only=True, eq=False)
class LimitLoad:
    """Where contact loses its hold.

    Attributes
    ----------
    factor : part of the way, to the last digit
    share : of the load at the end of the way what no force takes, at least
    motion : (k,) combination of the floating motions that proves it
    slide : (k,) as far as it slides on the pairs that carry load; None where bodies tip or lift
    """

    factor: float
    share: float
    motion: Array
    slide: Array | None


def limit_load(prepared: Prepared, state: State, end: LoadPoint, *, near: bool) -> LimitLoad | Spent | None:
    """Where on the straight way from a state to a load contact can hold floating bodies no more; None where it does.

    Equilibrium of floating bodies asks of the forces of the pairs ``P' r + w = 0``, with P what the pairs see of the
    floating motions and w the work of the loads along them; see `friction.overload`.

    Parameters
    ----------
    prepared : the model under the law of the moment
    state, end : the beginning of the way, in equilibrium, and the load at its end
    near : whether only pairs that touch, or nearly do, may carry load
    """
    interface = prepared.interface
    acts = prepared.solver.active & ~prepared.absent & ~interface.tied
    slope = interface.friction.steepest[acts]
    bounded = (slope >= ADHESION_SLOPE) & ~interface.friction.sticks[acts]  # by a limit alone: no cone is known
    if not prepared.floating.shape[1] or bounded.any() or not state.forces.any():
        return None
    constraints, rigid, floating = prepared.constraints, prepared.rigid, prepared.floating
    P = np.asarray(interface.felt(rigid) @ floating)[interface.rows(acts)]
    R, triangle = np.linalg.qr(P)
    if np.abs(np.diag(triangle)).min() <= _FELT * np.abs(triangle).max():
        return None

    def work(point: LoadPoint) -> Array:
        loads = applied(prepared, point)[0] + prepared.pushed(point.given)
        return np.asarray(np.linalg.solve(triangle.T, floating.T @ constraints.resultants(rigid, loads)))

    load = work(state.point)
    growth = work(end) - load
    if np.abs(growth).max() <= GAIN * max(np.abs(load).max(), np.abs(growth).max()):
        return None
    may = np.ones(int(acts.sum()), dtype=np.bool_)
    if near:
        may = state.gap[acts] <= NEAR_GAP * compression(interface, prepared.scale, prepared.solver.active)
    sections = np.minimum(slope, STICKING_FRICTION) * interface.anisotropy[acts].T
    cones = FrictionSection(axes=sections, sides=interface.facets[acts])
    held = (state.forces - state.point.given)[:, acts]
    found = unheld(R, cones, held, load, growth, near=may)
    if found is None or isinstance(found, Spent):
        return found
    pressed = held[0] > GAIN * prepared.scale.force
    along = along_contact(R, found.motion, pressed) if pressed.any() else None

    def combined(motion: Array) -> Array:
        return np.asarray(np.linalg.solve(triangle, R.T @ motion))

    slide = None if along is None else combined(along)
    return LimitLoad(factor=found.factor, share=found.share, motion=combined(found.motion), slide=slide)


def known(stop: SolveFailed, part: StepPart) -> SolveFailed:
    """What stopped a part, as the proof that its end has no equilibrium where nothing was found and there is one.

    Methods end without a solution where increments step beyond what contact can hold, and where the path is lost
    before; the load from which on there is none is a fact of the loads and the friction alone (see `limit_load`).

    Parameters
    ----------
    part : to which it came; what was followed of it is in ``stop.reached``
    """
    prepared, interval = part.prepared, part.interval
    if stop.status != Outcome.NOT_FOUND:
        return stop
    followed = reached(stop)
    state = part.before if followed is None else followed.after
    low = interval.low if followed is None else followed.snapshots[-1].fraction
    found = limit_load(prepared, state, part.end, near=False)
    if found is None:
        return stop
    if isinstance(found, Spent):
        return stop.saying(str(found))
    words, motion = moving_away(prepared, prepared.floating @ found.motion)
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


def slide(part: StepPart, state: State, low: float, high: float) -> SolveFailed | None:
    """The loss of hold between the fractions low and high of a part as a jump; None where none is known.

    Parameters
    ----------
    part : the part
    state : at low, in equilibrium
    low, high : 0 .. 1
    """
    prepared = part.prepared
    found = limit_load(prepared, state, part.before.point.towards(part.end, high), near=True)
    if found is None or isinstance(found, Spent):
        return None
    what = "a jump" if found.slide is None else "gross sliding"
    words, motion = moving_away(prepared, prepared.floating @ (found.motion if found.slide is None else found.slide))
    where = f"{part.where} at {part.interval.fraction(low + found.factor * (high - low)):.6%}"
    sentence = f"{where}: {what}: {words}: no equilibrium continues the history gradually"
    proof = f"{OVERLOADED}: none of them takes {found.share:.2g} of the load at the end, or more"
    return SolveFailed(told(sentence, remedy=HOLD, evidence=proof), status=Outcome.JUMP, motion=motion)
