# SPDX-License-Identifier: BSD-3-Clause
"""An increment in space: how its length is chosen, and what is known of it once it is solved."""

from __future__ import annotations

from dataclasses import dataclass, field

from signorini.arrays import Array
from signorini.friction.history.state import PathState
from signorini.friction.result import ContactAnswer
from signorini.settings import SolverSettings


@dataclass(frozen=True, kw_only=True)
class StopSettings:
    """How increments are chosen; all dimensionless.

    Attributes
    ----------
    shortest : part of the segment that an increment need not undercut whatever happens in it, less of it at the
        beginning; 0: every event ends one
    turn : largest angle by which friction on a smooth section turns in an increment longer than that
    width : of zero for a gap, a force or the friction to spare, relative to the data
    solver : limits of the methods, the number of increments among them
    behind : of a longer straight way that the segment ends, in lengths of the segment, see `Bearing`
    """

    shortest: float = 0.0
    turn: float = 0.05
    width: float = 1e-10
    solver: SolverSettings = field(default_factory=SolverSettings)
    behind: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SolvedIncrement:
    """An increment that was solved.

    Attributes
    ----------
    step : part of the segment
    after : the state at its end
    result : of the solver
    until : part of it up to which the law holds on a straight way
    each : (n,) that part of every pair
    turn : largest angle by which friction turns
    """

    step: float
    after: PathState
    result: ContactAnswer
    until: float
    each: Array
    turn: float
