# SPDX-License-Identifier: BSD-3-Clause
"""Histories in space: increments that end at events, rates where they fail, landings."""

from signorini.friction.history.space.follow import at_rest, follow_stopping
from signorini.friction.history.space.increment import StopSettings
from signorini.friction.history.space.landing import land_spatial

__all__ = ["StopSettings", "at_rest", "follow_stopping", "land_spatial"]
