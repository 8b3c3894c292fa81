# SPDX-License-Identifier: BSD-3-Clause
"""What goes along a straight way of the load, in the plane or in space: where it stands, and what has happened."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import Spent
from signorini.errors import InputError
from signorini.friction.history.rates import NoRates, Rates
from signorini.friction.history.segment import Breakpoint, Event, Jump, Segment, What
from signorini.friction.history.state import PathState
from signorini.friction.overload import Overload
from signorini.friction.problem import ContactProblem
from signorini.law.bound import plain
from signorini.law.states import OPEN, STICK
from signorini.outcome import Outcome
from signorini.settings import SolverSettings

ZERO_WIDTH = 1e-10
"""Of zero for a gap, a force or the friction to spare, relative to the data; events are alike from 1e-12 to 1e-7."""

_EVENTS_PER_PAIR = 100  # of a straight way in the plane, at most, where pairs are many; a few are usual


@dataclass(frozen=True, kw_only=True)
class PathSettings:
    """How a way is gone; all dimensionless.

    Attributes
    ----------
    shortest : in space, part of the segment that an increment need not undercut whatever happens in it, less of it at
        the beginning; 0: every event ends one
    turn : in space, largest angle by which friction on a smooth section turns in an increment longer than that
    solver : limits of the methods: the tolerance of certificates, and the number of increments, in the plane of events
    behind : in space, of a longer straight way that the segment ends, in lengths of the segment, see `Bearing`
    known : in space, where contact loses its hold as the beginning of that way knows it, part of the segment
    """

    shortest: float = 0.0
    turn: float = 0.05
    solver: SolverSettings = field(default_factory=SolverSettings)
    behind: float = 0.0
    known: Overload | None = None


class PathFollower(ABC):
    """A straight way of the load from a state, gone piece by piece.

    Parameters
    ----------
    problem : the problem; its own b is not used
    start : where the history stands
    b_end : (d n,) load at the end of the way
    settings : how it is gone

    Attributes
    ----------
    now, factor : the state reached, and the part of the way behind
    events, pieces, residual : as of `Segment`, so far
    acting : pairs whose event it is
    spent : searches on the way that ended at their budgets

    Raises
    ------
    InputError
        Where loads are not as many finite numbers as the pairs have rows.
    """

    def __init__(self, problem: ContactProblem, start: PathState, b_end: Array, settings: PathSettings) -> None:
        self.problem, self.start, self.settings = problem, start, settings
        self.b_end = np.array(b_end, dtype=np.float64)
        for name, b in (("start", start.b), ("b_end", self.b_end)):
            if b.shape != problem.b.shape:
                raise InputError(f"is of shape {b.shape}; expected {problem.b.shape}", where=(name,))
            if not np.isfinite(b).all():
                raise InputError("has entries that are not finite", where=(name,))
        self.now, self.factor, self.residual = start, 0.0, 0.0
        self.events: list[Event] = []
        self.pieces = [Breakpoint(factor=0.0, h=start.h, r=start.r, state=start)]
        self.acting: IntArray = np.zeros(0, dtype=np.int64)
        self.spent: list[Spent] = []
        most = self.settings.solver.path_increments
        self._most = most if problem.directions == 3 else max(most, _EVENTS_PER_PAIR * problem.pairs)
        self._gone = 0  # pieces, those included that are gone again

    def go_on(self) -> NoRates | None:
        """One piece up to the next event or the end, certified; why there is none, or None."""
        if self._gone >= self._most:
            words = f"all {self._most} increments that may be followed are behind"
            return NoRates(proof=words, proved=False)
        self._gone += 1
        return self._piece()

    @abstractmethod
    def _piece(self) -> NoRates | None:
        """One piece, see `go_on`."""

    def goes_back(self) -> bool:
        """Whether a piece has passed over something: back to its beginning, to go through it event by event."""
        return False

    @abstractmethod
    def ended(self, lost: NoRates) -> Segment:
        """The segment up to a jump, or to where nothing was found."""

    @abstractmethod
    def departs(self) -> bool:
        """One piece in which acting pairs are in a next state, not in those that led here; whether there is one."""

    @abstractmethod
    def rates_at(self, state: PathState) -> Rates | NoRates:
        """Rates along the way behind a state, wherever that is; why there are none."""

    def crosses(self, before: PathState) -> bool:  # noqa: ARG002
        """One piece across a fold of the curve of equilibria that led here from ``before``; whether there is one."""
        return False

    def stuck(self) -> bool:
        """Whether it is known beforehand that no rates lead on."""
        return False

    def happens(self, before: IntArray, state: PathState, *, free: BoolArray | None = None) -> None:
        """Note which pairs change here.

        Parameters
        ----------
        before : (n,) their codes before
        state : the state with the codes that hold from here on
        free : (n,) pairs that decide themselves whether they slip; all where not given
        """
        now = state.state
        turned = plain(now) != plain(before)
        slips, slipped = now > STICK, before > STICK
        kinds: dict[What, BoolArray] = {
            "opens": (before != OPEN) & (now == OPEN),
            "closes": (before == OPEN) & (now != OPEN),
            "sticks": slipped & (now == STICK),
            "slips": (before != OPEN) & slips & turned & (True if free is None else free),
            "kinks": slipped & slips & (now != before) & ~turned,
        }
        for what, which in kinds.items():
            if which.any():
                pairs = tuple(np.flatnonzero(which).tolist())
                self.events.append(Event(factor=self.factor, pairs=pairs, what=what, state=state))

    @property
    @abstractmethod
    def effort(self) -> tuple[int, int, int]:
        """States or increments tried, dense factorisations and their updates, so far."""

    def segment(self, outcome: Outcome, jump: Jump | None, message: str) -> Segment:
        """All that is known now, with the outcome, the jump where there is one, and a message in words."""
        pivots, factorisations, updates = self.effort
        return Segment(
            end=self.now,
            events=tuple(self.events),
            pieces=tuple(self.pieces),
            outcome=outcome,
            jump=jump,
            pivots=pivots,
            factorisations=factorisations,
            updates=updates,
            residual=self.residual,
            message=message,
            spent=tuple(dict.fromkeys(self.spent)),
            shortest=self.settings.shortest,
        )
