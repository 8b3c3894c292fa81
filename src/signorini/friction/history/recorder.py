# SPDX-License-Identifier: BSD-3-Clause
"""What every way of following a segment keeps while it goes: where it stands, and what has happened."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.errors import InputError
from signorini.friction.history.segment import Breakpoint, Event, Jump, Segment, What
from signorini.friction.history.state import PathState
from signorini.outcome import Outcome


class PathRecorder:
    """A straight way of the load from a state, gone piece by piece, in the plane or in space.

    Attributes
    ----------
    now, factor : the state reached, and the part of the way behind
    events, pieces, residual : as of `Segment`, so far
    """

    def __init__(self, start: PathState) -> None:
        self.now, self.factor, self.residual = start, 0.0, 0.0
        self.events: list[Event] = []
        self.pieces = [Breakpoint(factor=0.0, h=start.h, r=start.r)]

    def happens(self, kinds: Mapping[What, BoolArray], state: PathState) -> None:
        """Pairs, (n,) of every kind of event, change here; the state with the codes that hold from here on."""
        for what, which in kinds.items():
            pairs = tuple(np.flatnonzero(which).tolist())
            if pairs:
                self.events.append(Event(factor=self.factor, pairs=pairs, what=what, state=state))

    @property
    def effort(self) -> tuple[int, int, int]:
        """States tried, dense factorisations and their updates, so far."""
        raise NotImplementedError

    def segment(self, outcome: Outcome, jump: Jump | None, message: str) -> Segment:
        """All that is known now, with the outcome, the jump where there is one, and a message in words."""
        pivots, factorisations, updates = self.effort
        return Segment(
            end=self.now,
            events=tuple(self.events),
            pieces=tuple(self.pieces),
            outcome=outcome,
            jump=jump,
            pivots=pivots,
            factorisations=factorisations,
            updates=updates,
            residual=self.residual,
            message=message,
        )


def check_loads(rows: int, **loads: Array) -> None:
    """Refuse loads that are not ``rows`` finite numbers, by name.

    >>> check_loads(2, start=np.zeros(2), b_end=np.zeros(3))
    Traceback (most recent call last):
    signorini.errors.InputError: b_end: is of shape (3,); expected (2,)
    """
    for name, b in loads.items():
        if b.shape != (rows,):
            raise InputError(f"is of shape {b.shape}; expected {(rows,)}", where=(name,))
        if not np.isfinite(b).all():
            raise InputError("has entries that are not finite", where=(name,))
