# SPDX-License-Identifier: BSD-3-Clause
"""A step as it was followed: what every way of stepping gives back."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.solution.certificate import Certificate
from signorini.solution.results import PairEvent
from signorini.solution.state import State
from signorini.trace import Attempt


@dataclass(frozen=True, kw_only=True, eq=False)
class Leg:
    """From one end of a step to the other.

    Attributes
    ----------
    path : "single" (one increment), "increments" or "exact"
    before, after : states at the ends
    certificates : of every state that was certified on the way
    trace : for every increment the methods tried; on an exact path one entry for all of it
    events : of an exact path
    notes : what a reader should know of the way
    """

    path: str
    before: State
    after: State
    certificates: tuple[Certificate, ...]
    trace: tuple[tuple[Attempt, ...], ...]
    events: tuple[PairEvent, ...] = ()
    notes: tuple[str, ...] = ()
