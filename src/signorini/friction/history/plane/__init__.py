# SPDX-License-Identifier: BSD-3-Clause
"""Load histories followed exactly, event by event."""

from signorini.friction.history.plane.follow import PathSettings, follow
from signorini.friction.history.plane.landing import Landing, land
from signorini.friction.history.segment import Breakpoint, Event, Jump, Segment
from signorini.friction.history.state import PathState, initial_state

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
