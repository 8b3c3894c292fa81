# SPDX-License-Identifier: BSD-3-Clause
"""Load histories followed exactly, event by event."""

from signorini.friction.exact.follow import PathSettings, follow
from signorini.friction.exact.landing import Landing, land
from signorini.friction.exact.segment import Breakpoint, Event, Jump, Segment
from signorini.friction.exact.state import PathState, initial_state

__all__ = [
    "Breakpoint",
    "Event",
    "Jump",
    "Landing",
    "PathSettings",
    "PathState",
    "Segment",
    "follow",
    "initial_state",
    "land",
]
