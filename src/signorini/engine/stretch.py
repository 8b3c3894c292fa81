# SPDX-License-Identifier: BSD-3-Clause
"""What does not change while a straight part of a step is followed, in whatever way."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
    """

    prepared: Prepared
    where: str
    span: Span
    before: State
    end: LoadPoint
    whole: bool = False

    def cut(self, factor: float) -> Stretch:
        """Up to a jump at a part of it, 0 .. 1."""
        end = self.before.point.towards(self.end, factor)
        return replace(self, end=end, span=replace(self.span, high=self.span.part(factor), ends="jump"))

    def rest(self, cut: Stretch, state: State) -> Stretch:
        """What is left behind a part that was cut off, from a state at its end."""
        return replace(self, before=state, span=replace(self.span, low=cut.span.high))
