# SPDX-License-Identifier: BSD-3-Clause
"""Straight parts of a step: from one kink of its loads, or time asked for, to the next."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from signorini.model.stage import Stage
from signorini.solution.state import LoadPoint

_SAME = 1e-9  # parts of a step closer than this are one


@dataclass(frozen=True, kw_only=True)
class Span:
    """A straight part of step ``number``, between two parts of it.

    Attributes
    ----------
    number : of the step, from 1
    low, high : parts of the step, 0 .. 1
    ends : what is at its end: "segment" of the loads, a time "asked" for, an "event" or a "jump"
    cycle : number of the cycle that ends here, 0 where none does
    asked : whether its end, not that of the step, was asked for
    """

    number: int
    low: float
    high: float
    ends: Literal["segment", "asked", "event", "jump"]
    cycle: int = 0
    asked: bool = False

    def part(self, t: float) -> float:
        """Of the step, at the part t of this span."""
        return self.high if t == 1.0 else self.low + t * (self.high - self.low)

    def factor(self, t: float) -> float:
        """Load factor at the part t of this span."""
        return self.number - 1 + self.part(t)


def spans(stage: Stage, start: LoadPoint, end: LoadPoint) -> Iterator[tuple[Span, LoadPoint]]:
    """The straight parts of a step, each with the point at its end.

    Parameters
    ----------
    start, end : points at the ends of the step; everything but factors changes linearly from one to the other
    """
    count, step = len(stage.ends), stage.step
    kinks = [(j / count, "segment") for j in range(1, count + 1)]
    asked = step.at if isinstance(step.at, tuple) else ()
    between = tuple(part for part in asked if min(abs(part - kink) for kink, _ in kinks) > _SAME)
    low = 0.0
    for high, what in sorted([*kinks, *((part, "asked") for part in between)]):
        j = min(int(np.ceil(high * count - _SAME)), count) - 1
        first = stage.ends[j - 1] if j else start.factors
        t = high * count - j if what == "asked" else 1.0
        way = start.towards(end, high)
        factors = {name: (1.0 - t) * first.get(name, 0.0) + t * value for name, value in stage.ends[j].items()}
        point = replace(way, factors=stage.ends[j] if t == 1.0 else factors)
        finished = what == "segment" and (j + 1) % step.segments == 0
        cycle = (j + 1) // step.segments if finished else 0
        yield (
            Span(
                number=stage.number,
                low=low,
                high=high,
                ends="asked" if what == "asked" else "segment",
                cycle=cycle,
                asked=high < 1.0 and any(abs(part - high) <= _SAME for part in asked),
            ),
            point,
        )
        low = high
