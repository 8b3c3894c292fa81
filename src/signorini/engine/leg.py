# SPDX-License-Identifier: BSD-3-Clause
"""A part of a step as it was followed: what every way of stepping gives back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Literal

import numpy as np

from signorini.attempt import MethodRun
from signorini.errors import Interrupted, SolveFailed
from signorini.solution.certificate import Certificate
from signorini.solution.results import PairEvent
from signorini.solution.state import State

What = Literal["start", "event", "increment", "asked", "segment", "jump", "landing", "change", "approach"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """A state on the way.

    Attributes
    ----------
    load_factor : step k goes from k - 1 to k
    what : happens there
    state : its displacement and external forces hold only where it is ``whole``, its work where it is ``worked``; gaps
        of pairs that the law is not asked of are NaN where it is neither
    whole : whether the displacement of the bodies is there
    kept : whether it is one of the results
    worked : whether it was recovered
    """

    load_factor: float
    what: What
    state: State
    whole: bool = True
    kept: bool = False
    worked: bool = True

    def light(self) -> Snapshot:
        """Without the displacement of the bodies: a history may have thousands of snapshots."""
        none = np.zeros(0)
        point = replace(self.state.point, reaction=none, offset=none)
        return replace(self, state=replace(self.state, point=point, displacement=none, external=none), whole=False)


@dataclass(frozen=True, kw_only=True, eq=False)
class Leg:
    """From one state to another.

    Attributes
    ----------
    path : "single" (one increment), "increments" or "exact"
    before, after : states at the ends
    certificates : of every state that was certified on the way
    trace : for every increment the methods tried; on an exact path one entry for all of it; empty where nothing had to
        be solved
    snapshots : on the way, in order, the end last
    events : of an exact path
    notes : what a reader should know of the way
    """

    path: str
    before: State
    after: State
    certificates: tuple[Certificate, ...]
    trace: tuple[tuple[MethodRun, ...], ...]
    snapshots: tuple[Snapshot, ...]
    events: tuple[PairEvent, ...] = ()
    notes: tuple[str, ...] = ()


def lightened(leg: Leg, *, every: bool, end: bool, heated: bool) -> Leg:
    """A leg that keeps the displacement of the bodies only where it was asked for, and where it ends.

    Parameters
    ----------
    every : asked for wherever it is known
    end : asked for at the end
    heated : displacements that were not asked for are needed for the work of temperatures
    """
    shots = []
    for i, shot in enumerate(leg.snapshots, start=1):
        kept = shot.whole and (every or shot.what == "asked" or (end and i == len(leg.snapshots)))
        shots.append(replace(shot, kept=True) if kept else shot if heated else shot.light())
    return replace(leg, snapshots=tuple(shots))


def joined(legs: Sequence[Leg]) -> Leg:
    """Several legs, one after the other, as one; the way is that of those on which loads change or the law does."""
    paths = [leg.path for leg in legs if leg.trace] or [leg.path for leg in legs]
    exact = "exact" in paths and {*paths} <= {"exact", "single"}
    return Leg(
        path="exact" if exact else "increments" if len(paths) > 1 else paths[0],
        before=legs[0].before,
        after=legs[-1].after,
        certificates=tuple(chain.from_iterable(leg.certificates for leg in legs)),
        trace=tuple(chain.from_iterable(leg.trace for leg in legs)),
        snapshots=tuple(chain.from_iterable(leg.snapshots for leg in legs)),
        events=tuple(chain.from_iterable(leg.events for leg in legs)),
        notes=tuple(dict.fromkeys(chain.from_iterable(leg.notes for leg in legs))),
    )


def keep(stop: SolveFailed | KeyboardInterrupt, legs: Sequence[Leg]) -> SolveFailed | KeyboardInterrupt:
    """What stopped a step, with what was followed before: legs, and what it already carries."""
    last = reached(stop)
    every = [*legs, *([] if last is None else [last])]
    if not every:
        return stop
    if isinstance(stop, KeyboardInterrupt):
        return Interrupted(reached=joined(every))
    stop.reached = joined(every)
    return stop


def reached(stop: SolveFailed | KeyboardInterrupt) -> Leg | None:
    """The part of a step that was followed before it was stopped; None where that is nothing."""
    found = stop.reached if isinstance(stop, (SolveFailed, Interrupted)) else None
    return found if isinstance(found, Leg) else None
