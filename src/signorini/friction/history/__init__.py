# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb histories: what is followed along a load, in the plane and in space."""

from signorini.friction.history.follow import follow
from signorini.friction.history.follower import PathSettings
from signorini.friction.history.landing import Landing, land
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
