# SPDX-License-Identifier: BSD-3-Clause
"""Where moving rigid obstacles and rigid bodies are, and what acts on them."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ObstacleMotion(Short):
    """Where a moving rigid obstacle, or a rigid body, is at one load.

    Attributes
    ----------
    displacement : (d,) of the point about which it rotates, length
    rotation : radians, counterclockwise; in space (3,)
    """

    displacement: Array
    rotation: float | Array


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ObstacleResult(ObstacleMotion):
    """A moving rigid obstacle, or a rigid body, at the end of a step.

    Attributes
    ----------
    force : (d,) on it, given or needed to drive it
    moment : the same about the point about which it rotates, counterclockwise; in space (3,)
    """

    force: Array
    moment: float | Array
