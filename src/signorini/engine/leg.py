# SPDX-License-Identifier: BSD-3-Clause
"""A step as it was followed: what every way of stepping gives back."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.solution.certificate import Certificate
from signorini.solution.state import State
from signorini.trace import Attempt


@dataclass(frozen=True, kw_only=True, eq=False)
class Leg:
    """From one end of a step to the other.

    Attributes
    ----------
    path : "single" (one increment) or "increments"
    before, after : states at the ends
    certificates : of every state that was certified on the way
    trace : for every increment the methods tried
    """

    path: str
    before: State
    after: State
    certificates: tuple[Certificate, ...]
    trace: tuple[tuple[Attempt, ...], ...]
