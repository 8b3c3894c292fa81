# SPDX-License-Identifier: BSD-3-Clause
"""Follow a straight segment of the load history in space in increments that end where something happens.

Between two events (a pair opens, closes, starts to slip, or its friction reaches the end of an edge of its section)
motions and forces are linear in the load where sections are polygons: an increment that ends at every event is exact.
On smooth sections friction turns while a pair slips; there increments are short enough for a small turn of it.

A short increment shows the rates behind an event; extended in a straight line they tell the next event; the increment
up to there is solved for afresh and certified.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.attempt import Spent
from signorini.friction.history.follower import ZERO_WIDTH, PathFollower, PathSettings
from signorini.friction.history.rates import NoRates, Rates
from signorini.friction.history.segment import Breakpoint, Jump, Segment
from signorini.friction.history.space.bearing import OVERLOADED, Bearing, sliding
from signorini.friction.history.space.find_rates import acting_pairs, departures, find_rates
from signorini.friction.history.space.lengths import PROBE, SHORT, aimed, early, pressed_for, shortened, turned_length
from signorini.friction.history.space.missed_jumps import first_missed_jump
from signorini.friction.history.space.standstill import standstill
from signorini.friction.history.space.straight import (
    END_ROUNDING,
    SolvedIncrement,
    extrapolated_length,
    friction_turns,
    grips,
    held_until,
    settled,
)
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import Pull, pulled_away
from signorini.friction.solve import solve_contact
from signorini.law.result import ContactAnswer
from signorini.outcome import Outcome

LEAST_STEP = 1e-12
"""Part of the segment below which an increment counts as none."""

TRIES = 60
"""Most increments tried to find where one ends."""

_FIRST = 2.0**-6  # part of the segment that is tried first
_LEAST_PROBE = 2.0**-10  # part of the segment that shows the rates behind an event
_EVENT_TOL = 1e-12  # part of an increment by which it may miss an event,
_LATE_EVENT_TOL = 1e-3  # and after some tries
_LOOSER = 2.0  # times at every further try: by how much longer an increment must become to be worth it
_REFUSED = 0.25  # part of an increment, beyond which none was found: not looked into, the next one begins nearer to it
_LONGER_TURN = 4.0  # times what friction may turn elsewhere: where one longer increment is gone again event by event
_FOLD_REACH = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # times the last increment: where to look for the other side of a fold
_FOLD, _TURNED = 1e-9, 0.3  # part of the way in which it is looked for, and what friction may turn in it
_PATIENCE = 4  # tries
_EVENT_TRIES = 12  # in which an event is met to rounding, if it can be
_LOST = 1e-7  # part of the segment: where not even that has a solution nothing goes on gradually
_EVENT_WIDTH = 1e-6  # of the data: width of zero at an event that smooth sections make uncertain
_QUICK_STEPS = 12  # of Newton's method, in an increment that may be shorter


class SpaceFollower(PathFollower):
    """A straight way of the load in space, gone increment by increment."""

    def __init__(self, problem: ContactProblem, start: PathState, b_end: Array, settings: PathSettings) -> None:
        super().__init__(problem, start, b_end, settings)
        self.width = ZERO_WIDTH * (problem.scale or 1.0)
        self._quick = replace(
            settings.solver, searched_steps=_QUICK_STEPS, swept_rounds=1, proximal_rounds=0, springs=()
        )
        self.last, self.tried = _FIRST / PROBE, 0
        # up to where every event ends an increment; whether that failed; up to where no energy is missing
        self.careful, self.trusting, self.balanced = 0.0, False, 0.0
        self.smooth = bool((problem.law.rubs & (problem.section.sides == 0)).any())
        self.refused: ContactAnswer | None = None
        self.limited = False  # whether the load has a limit where motions run away
        self._barrier = np.inf  # part of the segment where the last increment was refused
        self._searched = False  # long, once in vain: shorter increments are near where they begin, or there are none
        self._rate: Array | None = None  # (3, n) of r - h in the last increment that was found, per part of the segment
        self._overloaded = False  # whether the pairs that are near hold the bodies no more
        self.bearing = Bearing(problem, self.b_end, settings.behind, settings.known)
        self.spent = self.bearing.spent
        # the load as rates see it; what smooth sections know of an event is less sharp
        self.rate_problem = replace(problem, b=frozen(self.b_end - start.b))
        self.near, self._astray = (_EVENT_WIDTH * (problem.scale or 1.0), 0.5) if self.smooth else (self.width, 1e-6)

    def _piece(self) -> NoRates | None:
        """One increment, found as it comes or by the rates; why there is none, or None."""
        if self.factor >= self.reach and not self._crosses():
            self._overloaded = True
            self._to_the_brink()
            return NoRates(proof=OVERLOADED, proved=True)
        stop = standstill(self.pieces, self.problem.scale or 1.0)
        if stop is not None and (stop.proved or self.settings.shortest):  # events may be as many as they like
            self.limited = stop.proved
            return stop
        words = self._advance(patience=_PATIENCE)
        if not words:
            return None
        if self._leaves:
            return NoRates(proof=words, proved=True)
        found = self.rates_at(self.now)
        tried = self.tried
        if isinstance(found, Rates) and self._along(found):
            return None
        followed = self.tried - tried
        if isinstance(found, NoRates) and found.proved:
            return replace(found, proof=f"{words}; {found.proof}")
        words = self._advance(patience=TRIES)  # also where increments do not go along the rates, one of several
        if words and self.careful > self.factor:
            self.careful, self.trusting = 0.0, True
            return self._piece()
        rest = f"; {found.proof}" if isinstance(found, NoRates) else f", though there are rates; {followed} tried along"
        return NoRates(proof=f"{words}{rest}", proved=False) if words else None

    def rates_at(self, state: PathState) -> Rates | NoRates:
        """Rates along the way behind a state, wherever that is; why there are none."""
        return find_rates(self.rate_problem, state, self.near)

    def goes_back(self) -> bool:
        """Whether an increment has passed over something: back to its beginning, to go through it event by event."""
        # close to a limit of the load all increments miss energy
        if self.limited or not self.settings.shortest:
            return False
        k = first_missed_jump(self.problem, self.start, self.pieces, self.balanced, self.width)
        if k is None:
            return False
        self.careful = self.balanced = self.pieces[k].factor
        self.trusting, self.refused, self._overloaded, self._rate = False, None, False, None
        self._barrier = np.inf
        self.pieces = self.pieces[:k]
        self.now, self.factor = self.pieces[-1].state or self.start, self.pieces[-1].factor
        self.last = self.careful - self.factor
        self.events = [event for event in self.events if event.factor < self.factor]
        return True

    @property
    def reach(self) -> float:
        """Part of the way that increments do not go beyond, see `Bearing`."""
        return self.bearing.reach(self.now, self.factor)

    def _crosses(self) -> bool:
        """Whether equilibrium goes on gradually beyond the reach: other pairs close as the bodies deform."""
        gradually = self._near_by(self._trial(self.bearing.beyond - self.factor, 0.0)) is not None
        if gradually:
            self.bearing.cross()
        return gradually

    def _to_the_brink(self) -> None:
        """The last increment, to the very load that can be held, where equilibrium at it is near by."""
        trial = self._near_by(self._trial(self.bearing.limit - self.factor, 0.0))
        if trial is not None and trial.until >= 1.0 - _LATE_EVENT_TOL:
            self._enter(trial, settled(self.problem, self.now, trial, trial.after.state), 1)

    def _near_by(self, trial: SolvedIncrement | ContactAnswer) -> SolvedIncrement | None:
        """An increment that moves no pair farther than the loads of the whole history deform the bodies."""
        if isinstance(trial, ContactAnswer) or np.abs(trial.after.h - self.now.h).max() > (self.problem.scale or 1.0):
            return None
        return trial

    @property
    def _leaves(self) -> bool:
        """Whether an increment was refused with the proof that loads pull bodies away."""
        return self.refused is not None and self.refused.outcome == "no_equilibrium"

    def _along(self, rates: Rates) -> bool:
        """One increment in the direction of rates, up to the next event; whether there is one."""
        now, tried = self.now, self.tried
        short = 0.5 * pressed_for(self.problem, now.r, rates.r, self.reach - self.factor)
        piece = replace(now, h=now.h + short * rates.h, r=now.r + short * rates.r, state=rates.state)
        step = min(short * extrapolated_length(self.problem, now, piece, self.width), self.reach - self.factor)
        for _ in range(TRIES):
            if step < LEAST_STEP:
                return False
            h, r = step * rates.h, now.r + step * rates.r
            # the law of the whole piece is that in its middle
            trial = self._trial(step, step, self._counted(0.5 * (now.r + r - h)))
            if isinstance(trial, ContactAnswer):
                step /= 16.0
                continue
            off = np.abs(trial.after.h - now.h - h).max() + np.abs(trial.after.r - r).max()
            if off > self._astray * step * (np.abs(rates.h).max() + np.abs(rates.r).max()) + self.width:
                step /= 2.0
            elif trial.turn > self._turn:
                step *= SHORT * self._turn / trial.turn
            else:
                after = settled(self.problem, self.now, trial, rates.state)
                self._enter(replace(trial, told=False), after, self.tried - tried)
                return True
        return False

    def departs(self) -> bool:
        """One increment in rates in which acting pairs are in a next state, not in those that led here."""
        for found in departures(self.rate_problem, self.now, self.near):
            if isinstance(found, Spent):
                self.spent.append(found)
            elif self._along(found):
                return True
        return False

    def stuck(self) -> bool:
        """Whether it is known beforehand that no rates lead on."""
        found = self.rates_at(self.now)
        return isinstance(found, NoRates) and found.proved

    def crosses(self, before: PathState) -> bool:
        """One increment across a fold of the curve of equilibria that led here from ``before``; whether there is one.

        On a smooth section friction turns until the load that goes back can go no farther: on with the same slip.
        """
        now = self.now
        h, r = now.h - before.h, now.r - before.r
        for times in _FOLD_REACH:
            trial = self._trial(_FOLD, _FOLD, self._counted(now.r + times * (r - h)))
            if isinstance(trial, ContactAnswer) or trial.turn > _TURNED:
                continue
            moved = trial.after.h - now.h
            if (moved * h).sum() > 0.5 * (h * h).sum():
                self._enter(trial, settled(self.problem, self.now, trial, trial.after.state), 1)
                return True
        return False

    def _advance(self, *, patience: int) -> str:
        """One increment; why there is none, or nothing. Given up where so many were tried, and pairs act in all."""
        self.refused = None
        shortest, left = self._shortest, self.reach - self.factor
        step = min(max(PROBE * self.last, _LEAST_PROBE, shortest), left)
        best: SolvedIncrement | None = None
        inner: SolvedIncrement | None = None
        beyond: SolvedIncrement | None = None
        search: tuple[SolvedIncrement, ...] = ()  # that told lengths one after the other, see `Breakpoint`
        tried, told, words, longest, barrier = self.tried, True, "", left, self._barrier - self.factor
        self._barrier = np.inf
        if _LOST < barrier <= step:  # where the last one was refused is not tried again before it is near
            step, longest, told = 0.5 * barrier, barrier, False
        for number in range(TRIES):
            late = self._missed(number, _EVENT_TRIES)
            trial = self._trial(step, shortest, self._guess(step))
            if isinstance(trial, ContactAnswer):
                words, longest, barrier = trial.message, step, step
                self._barrier = self.factor + step
                if not self._leaves:
                    self.refused = trial
                if step <= _LOST or (best is not None and step <= best.step * (1.0 + _REFUSED)):
                    break
                step = step / 16.0 if best is None else 0.5 * (best.step + step)
            elif trial.until >= 1.0 - min(late, _LATE_EVENT_TOL) and trial.turn <= self._turn:
                inner = inner or trial
                step, best = self._aim(trial, best, inner.after.state), replace(trial, search=search, told=told)
                if step >= longest and longest < left:
                    if longest == barrier and longest <= trial.step * (1.0 + _REFUSED):
                        break
                    step = 0.5 * (trial.step + longest)
                turns = step == turned_length(trial, self._turn)
                if min(step, left) <= trial.step * (1.0 + (self._missed(number, _PATIENCE) if turns else late)):
                    break
                step = min(step, left)
            elif trial.step <= shortest and (
                self.trusting or not grips(self.problem, self.now, trial, _LATE_EVENT_TOL)
            ):
                best = inner = trial
                break
            else:
                if trial.step <= shortest:  # event by event
                    self.careful, shortest = self.factor + trial.step, 0.0
                words, longest = f"pairs {np.flatnonzero(trial.each <= trial.until).tolist()} act", step
                if best is None and number >= patience:
                    break
                step, beyond = shortened(trial, self._turn, shortest, best, beyond), trial
                if best is not None and step <= best.step * (1.0 + late):
                    break
            if step < LEAST_STEP:
                break
            if isinstance(trial, SolvedIncrement) and step == turned_length(trial, self._turn):
                search = (*search, trial)
            else:
                search, told = (), step in (shortest, left)
        if best is None or inner is None:
            return f"{self._nothing} ({self.tried - tried} tried, at most {TRIES}: {words})"
        exact = best.until >= 1.0 - END_ROUNDING
        after = settled(self.problem, self.now, best, inner.after.state if exact else best.after.state)
        self._enter(best, after, self.tried - tried)
        return ""

    @property
    def _nothing(self) -> str:
        """Words for that nothing was found here."""
        return f"at factor {self.factor:.12g}: no increment, however short, goes on gradually"

    def _missed(self, number: int, tries: int) -> float:
        """Part of an increment by which it may end beside what ends it, after so many tries of those that are sharp."""
        rough = self.smooth and number >= tries
        return _LATE_EVENT_TOL * _LOOSER ** (number - tries) if rough else _EVENT_TOL

    def _guess(self, step: float) -> Array | None:
        """(3, n) r - h at the end of an increment that goes on as the last one did; None before the first."""
        known = self._rate is not None and self.now.r.any()
        return self._counted(self.now.r) + step * self._rate if known and self._rate is not None else None

    def _aim(self, trial: SolvedIncrement, last: SolvedIncrement | None, state: IntArray) -> float:
        """The length to try after an increment, and a last one, inside which pairs are in these states: `aimed`."""

        def event(one: SolvedIncrement) -> float:
            return one.step * extrapolated_length(self.problem, self.now, replace(one.after, state=state), self.width)

        return aimed(trial, last, event, self._turn, self._shortest)

    @property
    def _turn(self) -> float:
        """What friction may turn here: more of it where increments are short to find what happens, not to be sharp."""
        return self.settings.turn * (_LONGER_TURN if self.factor < self.careful and self.settings.shortest else 1.0)

    @property
    def _shortest(self) -> float:
        """What an increment need not undercut here: little at the beginning, where contact grows and friction turns."""
        whole = 0.0 if self.factor < self.careful else self.settings.shortest
        return min(early(whole, self.factor), self.reach - self.factor)

    def _counted(self, y: Array) -> Array:
        """(3, n) r - h of an increment from here, of an r - h whose gaps change by h."""
        return np.concatenate([y[:1] - self.now.h[:1], y[1:]])

    def _trial(self, step: float, shortest: float, ahead: Array | None = None) -> SolvedIncrement | ContactAnswer:
        """The increment of a part of the segment, sought from its beginning or ahead; or why it has none."""
        now, problem = self.now, self.problem
        factor = self.factor + step
        if factor >= 1.0 - LEAST_STEP:
            factor, step = 1.0, 1.0 - self.factor
        b = self.b_end if factor == 1.0 else (1.0 - factor) * self.start.b + factor * self.b_end
        origin = now.h.copy()
        origin[0] = 0.0
        increment = replace(problem, b=frozen(problem.misfit(origin, np.zeros_like(origin), b)))
        self.tried += 1
        if ahead is None and now.r.any():
            ahead = self._counted(now.r)
        long = step <= shortest and not self._searched
        result = solve_contact(increment, ahead, settings=self.settings.solver if long else self._quick)
        if not result.solved:
            self._searched |= long
            return result
        h, r = result.h, result.r
        self._rate = (r - now.r - (h + origin - now.h)) / step
        until = held_until(increment, now, h, r, self.width)
        least = float(until.min(initial=1.0))
        return SolvedIncrement(
            step=step,
            after=replace(now, b=b, h=h + origin, r=r, state=result.state),
            result=result,
            until=least,
            each=until,
            turn=float(np.abs(friction_turns(increment, now, r, h[1:], self.width)).max(initial=0.0)),
        )

    def _enter(self, trial: SolvedIncrement, after: PathState, tried: int) -> None:
        """Go on from the end of an increment; what is in another state than before changed at its beginning."""
        self.happens(self.now.state, replace(self.now, state=after.state))
        passes = trial.step <= self._shortest
        tries = ((self.factor + one.step, one.after) for one in trial.search)
        search = tuple(Breakpoint(factor=factor, h=state.h, r=state.r, state=state) for factor, state in tries)
        self.factor = 1.0 if self.factor + trial.step >= 1.0 - LEAST_STEP else self.factor + trial.step
        self.now, self.last = after, trial.step
        end = Breakpoint(factor=self.factor, h=after.h, r=after.r, state=after, tried=tried, passes=passes)
        self.pieces.append(replace(end, search=search, told=trial.told or not self.smooth))
        self.residual = max(self.residual, trial.result.residual)

    def ended(self, lost: NoRates) -> Segment:
        """The segment up to a jump, or to where nothing was found."""
        if not lost.proved:
            return self.segment(Outcome.NOT_FOUND, None, lost.proof)
        r = self.now.r
        pressed = r[0] > self.width
        spent = pressed & (self.problem.law.reserve(r) <= self.near)
        leaves, refused = self._leaves, self.refused
        acting = np.flatnonzero(spent) if leaves else acting_pairs(self.rate_problem, self.now, self.near)
        if self._overloaded:
            return self.segment(Outcome.JUMP, self.bearing.jump(self.now, self.factor, pressed, lost.proof), lost.proof)
        slide = sliding(self.problem, self.pieces[-2:], pressed) if self.limited else None
        pull = pulled_away(replace(self.problem, b=frozen(self.b_end))) if leaves else None
        share = pull.share if isinstance(pull, Pull) else 0.0
        jump = Jump(
            factor=self.factor,
            pairs=tuple(int(k) for k in (acting if len(acting) else np.flatnonzero(spent))),
            proof=refused.message if refused is not None and leaves else lost.proof,
            margin=share if leaves else lost.margin,
            gross_sliding=bool(leaves and pressed.any() and spent[pressed].all()) or slide is not None,
            escape=slide,
        )
        return self.segment(Outcome.JUMP, jump, lost.proof)

    @property
    def effort(self) -> tuple[int, int, int]:
        """Increments tried; nothing dense is kept between them."""
        return self.tried, 0, 0
