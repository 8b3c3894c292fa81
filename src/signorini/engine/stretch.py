# SPDX-License-Identifier: BSD-3-Clause
"""What does not change while a straight part of a step is followed, in whatever way."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from signorini.arrays import BoolArray
from signorini.engine.prepare import Prepared
from signorini.engine.span import Span
from signorini.solution.state import LoadPoint, State


@dataclass(frozen=True, kw_only=True, eq=False)
class Stretch:
    """A straight part of a step, to be followed from a state to a point of the load history.

    Attributes
    ----------
    prepared : the model, as it is in this step
    where : name of the step, for messages
    span : the part of the history that this is
    before : the state that it begins in
    end : the point at its end
    whole : whether the displacement of the bodies is recovered at every event, not at the end alone
    awake : the model in which bodies may move that rest in this stretch; None where none does
    waiting : (n,) pairs of those bodies; empty where there is none
    """

    prepared: Prepared
    where: str
    span: Span
    before: State
    end: LoadPoint
    whole: bool = False
    awake: Prepared | None = None
    waiting: BoolArray = field(default_factory=lambda: np.zeros(0, np.bool_))

    def cut(self, factor: float, ends: Literal["event", "jump"]) -> Stretch:
        """Up to an event or a jump at a part of it, 0 .. 1, from where on it is followed anew."""
        end = self.before.point.towards(self.end, factor)
        return replace(self, end=end, span=replace(self.span, high=self.span.part(factor), ends=ends))

    @property
    def woken(self) -> Stretch:
        """The same with all bodies free to move."""
        if self.awake is None:
            return self
        return replace(self, prepared=self.awake, awake=None, waiting=np.zeros(0, np.bool_))

    def rest(self, cut: Stretch, state: State) -> Stretch:
        """What is left behind a part that was cut off, from a state at its end."""
        return replace(self, before=state, span=replace(self.span, low=cut.span.high))
