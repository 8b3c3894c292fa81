# SPDX-License-Identifier: BSD-3-Clause
"""What a history leaves for its derivatives where that is asked for: its straight parts as they were followed."""

from __future__ import annotations

from dataclasses import dataclass, field

from signorini.engine.prepare import Prepared
from signorini.friction.history import PathState, Segment
from signorini.solution.state import LoadPoint, State


@dataclass(frozen=True, kw_only=True, eq=False)
class Leg:
    """A straight part of a history as it was followed: to events, or in equal increments.

    Attributes
    ----------
    prepared : the model, as it was in this part
    where : name of the step
    before, after : states at the ends
    end : the point of the load history at its end
    low, high : load factors at the ends
    start : state of the path at the beginning, in the scaled units of the law; None in equal increments
    segment : the pieces of the path, in space increments that end at events; None in equal increments
    states : at the ends of equal increments; empty on a path
    carried : whether loads carry bodies rigidly until they touch, at no load
    """

    prepared: Prepared
    where: str
    before: State
    after: State
    end: LoadPoint
    low: float
    high: float
    start: PathState | None = None
    segment: Segment | None = None
    states: tuple[State, ...] = ()
    carried: bool = False

    @classmethod
    def at_once(
        cls, prepared: Prepared, where: str, before: State, after: State, load_factor: float, *, carried: bool = False
    ) -> Leg:
        """What pairs do at the same loads, under another law or as bodies are carried until they touch.

        Parameters
        ----------
        prepared, where : the model under the law of the step, and its name
        before, after : states
        load_factor : at which that is
        carried : see `Leg`
        """
        end = before.point
        return cls(
            prepared=prepared,
            where=where,
            before=before,
            after=after,
            end=end,
            low=load_factor,
            high=load_factor,
            states=(after,),
            carried=carried,
        )


@dataclass(kw_only=True, eq=False)
class Tape:
    """All legs of a history in order, with those of the history that it goes on from.

    Attributes
    ----------
    legs : so far
    whole : whether the history begins at rest, or goes on from one that has a tape
    end : the state that the last leg leads to; None before the first
    lost : the first step with something that was followed on no leg; empty where there is none
    changed : whether that is a change of supports or contacts
    """

    legs: list[Leg] = field(default_factory=list)
    whole: bool = True
    end: State | None = None
    lost: str = ""
    changed: bool = False

    def change(self, before: State, after: State, where: str, *, locks: bool) -> None:
        """Go on from a state under other supports or contacts, which is followed where bolts lock.

        Parameters
        ----------
        before, after : the state under those before and after
        where : name of the step, for what is lost
        locks : whether nothing changes but that bolts lock
        """
        if locks:
            self.end = after if self.end is before else self.end
        elif not self.lost:
            self.lost, self.changed = where, True

    def take(self, legs: tuple[Leg, ...], after: State, where: str) -> None:
        """Take what was followed up to a state.

        Parameters
        ----------
        legs : straight parts, none where it was followed otherwise
        after : state that they lead to
        where : name of the step, for what is lost
        """
        for leg in legs:
            self.lost = self.lost or (where if leg.before is not self.end else "")
            self.end = leg.after
        self.lost = self.lost or (where if after is not self.end else "")
        self.legs.extend(legs)
        self.end = after
