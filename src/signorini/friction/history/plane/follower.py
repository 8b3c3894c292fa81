# SPDX-License-Identifier: BSD-3-Clause
"""Follow a straight segment of the load history exactly, from event to event: no step size.

While no pair changes its state, motions and forces are linear in the load and slip rates are constant. So a piece ends
where a gap, a normal force or the friction to spare of a sticking pair vanishes, or where a slipping pair comes to a
kink of its bound. There the rates change, and every pair
on its friction limit may change with them: from slip to stick only then.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.errors import InputError
from signorini.friction.certificate import certify
from signorini.friction.history.follower import ZERO_WIDTH, PathFollower, PathSettings
from signorini.friction.history.plane.driven_pivots import drive
from signorini.friction.history.plane.find_rates import find_rates
from signorini.friction.history.plane.jump import explain
from signorini.friction.history.plane.rate_law import CORNER, INSIDE, RateLaw, weight
from signorini.friction.history.plane.responses import Responses
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.history.rates import MARGIN, RATE_TOL, NoRates, Rates, widths_of_zero
from signorini.friction.history.segment import Breakpoint, Segment
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.bound import SIGN, plain
from signorini.law.states import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED
from signorini.outcome import Outcome

_SAME_EVENT = 1e-12  # part of the segment: events closer than that act together
_STANDSTILL = 50  # events at one load, after which the path is given up

LET_GO = "a pair of infinite friction holds back a tangential force until it loses its pressure, and lets go at once"
"""A jump that the law itself makes."""


class PlaneFollower(PathFollower):
    """A straight way of the load in the plane, gone from event to event.

    Every end of a piece is certified as an increment that starts at the end before, and solved for afresh where its
    equilibrium lacks more than rounding, so that no error adds up.

    Attributes
    ----------
    load : (2n,) rate of b
    responses : of the interface
    """

    def __init__(self, problem: ContactProblem, start: PathState, b_end: Array, settings: PathSettings) -> None:
        super().__init__(problem, start, b_end, settings)
        self.problem = replace(problem, b=frozen(self.b_end - start.b))
        self.load = self.problem.b
        self.responses = Responses(self.problem)
        self.bound = self.problem.pieces
        self.unbounded = problem.unbounded & ~self.problem.locked[0]
        self.forced = np.where(self.unbounded, STICK, self.problem.law.closed)
        self.width = widths_of_zero(problem, ZERO_WIDTH * (problem.scale or 1.0))
        self.now = self._entered(start)
        self.rates: Rates | None = None
        self.still = 0

    def _entered(self, start: PathState) -> PathState:
        """The first state; pairs that supports drag turn their friction at once where the load turns."""
        turned = (start.state != OPEN) & (self.forced != UNDECIDED) & (plain(start.state) != self.forced)
        state = self._on_branch(np.where(turned, self.forced, start.state), start.r[0])
        slides = turned & (state > STICK)
        bound = self.bound.at(start.r[0])
        friction = np.where(slides, SIGN[state] * bound, start.r[1])
        most = np.where(self.unbounded, np.inf, bound)
        beyond = np.flatnonzero((np.abs(friction) - most) / weight(self.problem.mu) > 1e2 * self.width)
        if len(beyond):
            raise InputError(
                f"pair {beyond[0]} carries more friction than it can; where friction was lowered, expected a start "
                "that one increment at the same load has brought into the law",
                where=("start",),
            )
        return replace(start, state=state, r=np.array([start.r[0], friction]))

    def _on_branch(self, state: IntArray, p: Array) -> IntArray:
        """The states with the branch that each pair slips on; at a kink the one given stays."""
        here = self.bound.coded(state, p)
        given = np.abs(self.bound.start(state) + self.bound.slope(state) * p)
        meant = np.abs(given - self.bound.at(p)) <= self.width * weight(self.problem.mu)
        return np.where((state > STICK) & meant, state, here)

    def _piece(self) -> NoRates | None:
        """The rates from here on, up to the next event or the end; why there are none, or None."""
        return self._turn() or self._advance()

    def rates_at(self, state: PathState) -> Rates | NoRates:
        """Rates along the way behind a state, wherever that is; why there are none."""
        self.now, self.rates, self.acting = self._entered(state), None, np.zeros(0, dtype=np.int64)
        return self._found(self._law())

    def departs(self) -> bool:
        """One piece in which acting pairs are in a next state, not in those that led here; whether there is one."""
        law, acts = self._law(), self._acts
        held = replace(law, kind=np.where(acts, INSIDE, law.kind), kink=law.kink & ~acts)
        for state in self._next_states(law):
            found = find_rates(self.responses, held, self.load, state, [state])
            if isinstance(found, Rates) and law.violation(found) <= RATE_TOL:
                self._enter(found)
                return self._advance() is None
        return False

    @property
    def _acts(self) -> BoolArray:
        acts = np.zeros(self.problem.pairs, dtype=np.bool_)
        acts[self.acting] = True
        return acts

    def _next_states(self, law: RateLaw) -> Iterator[IntArray]:
        """The states that acting pairs may enter: slip for stick, open for closed, and any closed one for open.

        At a kink of the bound also slip on its other branch.
        """
        state, acts = self.now.state, self._acts
        spent = acts & (law.kind > CORNER) & (state == STICK)
        leaves = acts & (law.kind == CORNER) & (state != OPEN)
        meets = acts & (law.kind == CORNER) & (state == OPEN)
        turns = acts & law.kink & (state > STICK)
        moved = np.where(spent, law.kind, np.where(leaves, OPEN, np.where(turns, law.across(state), state)))
        for closed in (STICK, SLIP_PLUS, SLIP_MINUS) if meets.any() else (STICK,):
            forced = np.where(law.forced == UNDECIDED, closed, law.forced)
            yield np.where(meets, forced, moved).astype(np.int64)

    def _turn(self) -> NoRates | None:
        """Find the rates from here on; what changes its state is an event."""
        law = self._law()
        driven = None if self.rates is None else drive(self.responses, law, self.load, self.rates, self.acting)
        if isinstance(driven, Rates):
            self._enter(driven)
            return None
        found = self._found(law)
        if isinstance(found, NoRates):
            return found if driven is None else replace(found, proof=f"{driven}; {found.proof}")
        self._enter(found)
        return None

    def _found(self, law: RateLaw) -> Rates | NoRates:
        """Rates from here on that obey a law."""
        return find_rates(self.responses, law, self.load, self.now.state, self._guesses(law))

    def _law(self) -> RateLaw:
        """The law of the rates here."""
        now = self.now
        closing = self.acting[now.state[self.acting] == OPEN]
        return RateLaw.at(
            bound=self.bound,
            forced=self.forced,
            state=now.state,
            h=now.h,
            r=now.r,
            width=self.width,
            closing=closing,
        )

    def _enter(self, rates: Rates) -> None:
        """Go on with these rates; what changes its state at the present load is an event."""
        self.rates, state = rates, rates.state
        now, old = self.now, self.now.state
        if np.array_equal(state, old):
            return
        sticking = (state == STICK) & (old != STICK)
        self.now = replace(now, state=state, anchor=np.where(sticking, now.h[1:], now.anchor))
        self.happens(old, self.now, free=self.forced == UNDECIDED)

    def _guesses(self, law: RateLaw) -> list[IntArray]:
        """The acting pairs in their natural next state, the others as before; and every pair at a corner sticking."""
        hold = np.where(law.forced == UNDECIDED, STICK, law.forced)
        natural, stuck = next(self._next_states(law)), np.where(law.kind == CORNER, hold, self.now.state)
        return [stuck, natural] if (self.now.state == OPEN).all() else [natural, stuck]

    def _advance(self) -> NoRates | None:
        """Go on to the next event or the end, and certify it."""
        assert self.rates is not None
        times = self._times(self.rates)
        step, room = float(times.min(initial=np.inf)), 1.0 - self.factor
        last = step >= room - 1e-13
        factor = 1.0 if last else self.factor + step
        self.acting = np.flatnonzero(times <= step + _SAME_EVENT)
        self.still = self.still + 1 if factor - self.factor < 1e-13 else 0
        if self.still > _STANDSTILL:
            return NoRates(proof=f"{self.still} events follow each other at one load", proved=False)
        try:
            after, residual = self._reached(factor, self.rates)
        except SingularState:
            return NoRates(proof="the state that has rates is singular", proved=False)
        lost = self._let_go(after)
        if residual > self.settings.solver.tolerance and not len(lost):
            return NoRates(proof=f"the next state fails its certificate, residual {residual:.1e}", proved=False)
        self.now, self.factor = after, factor
        self.pieces.append(
            Breakpoint(factor=factor, h=after.h, r=after.r, state=after, rates=self.rates, acting=self.acting)
        )
        if len(lost):
            self.acting = lost
            held = float(np.abs(after.r[1, lost]).max()) / (self.problem.scale or 1.0)
            return NoRates(proof=f"{LET_GO}: {held:.2g} of the data", proved=held > MARGIN, margin=held)
        self.residual = max(self.residual, residual)
        return None

    def _let_go(self, after: PathState) -> IntArray:
        """Acting pairs of infinite friction that lose their pressure while they hold back a tangential force."""
        k = self.acting
        holds = self.unbounded[k] & (after.state[k] == STICK)
        if not holds.any():
            return k[holds]
        p, friction = after.r[:, k]
        return k[holds & (p <= self.width[k]) & (np.abs(friction) > self.width[k])]

    def _times(self, rates: Rates) -> Array:
        """(n,) Part of the segment until a gap, a normal force or the friction to spare of a pair vanishes.

        Or until a slipping pair comes to a kink of its bound.
        """
        n, state, bound = self.problem.pairs, rates.state, self.bound
        gap, (p, q), (normal, tangential) = self.now.h[0], self.now.r, rates.r
        stick, opened = (state == STICK) & (self.forced == UNDECIDED), state == OPEN
        every = np.ones(n, dtype=np.bool_)
        vanishing = [(every, np.where(opened, gap, p), np.where(opened, rates.h[0], normal))]
        for mu, start, begins in zip(bound.slopes, bound.starts, bound.kinks[:-1], strict=True):
            has, unit, most, grows = stick & np.isfinite(begins), weight(mu), start + mu * p, mu * normal
            vanishing += [(has, (most - sign * q) / unit, (grows - sign * tangential) / unit) for sign in (1.0, -1.0)]
        branch = np.where(state > STICK, (state - SLIP_PLUS) // 2, -1)
        for j in range(1, bound.branches):
            vanishing.append((branch == j, p - bound.kinks[j], normal))
            vanishing.append(((branch == j - 1) & np.isfinite(bound.kinks[j]), bound.kinks[j] - p, -normal))
        which, value, rate = (np.array(rows) for rows in zip(*vanishing, strict=True))
        falls = which & (rate < np.where(value <= self.width, -1e-10 * rates.size, 0.0))
        times = np.divide(np.maximum(value, 0.0), -rate, out=np.full(value.shape, np.inf), where=falls)
        return np.asarray(times.min(axis=0))

    def _reached(self, factor: float, rates: Rates) -> tuple[PathState, float]:
        """The state at a load, solved for afresh where it lacks more than rounding, and its certificate."""
        b, step = self.b_end if factor == 1.0 else self.start.b + factor * self.load, factor - self.factor
        h, r = self.now.h + step * rates.h, self.now.r + step * rates.r
        after = self._lawful(b, h, r)
        residual = self._certificate(after)
        size = max(np.abs(part).max(initial=0.0) for part in (b, h, r))
        if residual * (self.problem.scale or 1.0) > self.responses.rounding * size:
            after = self._lawful(b, *self._afresh(b))
            residual = self._certificate(after)
        return after, residual

    def _afresh(self, b: Array) -> tuple[Array, Array]:
        """(2, n) Motions and forces under a load in the present states, whatever has led there."""
        now, state, none = self.now, self.now.state, np.zeros(self.problem.pairs)
        held = np.array([none, np.where(state == STICK, now.anchor[0], now.h[1])])
        given = np.array([none, self.bound.start(state)])
        free = self.responses.free(b) + self.responses.imposed(held, given)
        h, r = self.responses.respond(state, free)
        return self.responses.balanced(state, b, h + held, r + given)

    def _lawful(self, b: Array, h: Array, r: Array) -> PathState:
        """The state with motions and forces of its law to the last digit, the slip and the dissipation of the piece."""
        now, state = self.now, self.now.state
        opened, slips = state == OPEN, state > STICK
        p = np.where(opened, 0.0, np.maximum(r[0], 0.0))
        bound = self.bound.at(p)
        most = np.where(self.unbounded, np.inf, bound)
        friction = np.where(slips, SIGN[state] * bound, np.where(opened, 0.0, np.clip(r[1], -most, most)))
        gap, tangential = np.where(opened, np.maximum(h[0], 0.0), 0.0), np.where(state == STICK, now.anchor[0], h[1])
        forces = np.array([p, friction])
        moved = np.where(slips & now.bears(forces, self.problem.scale), tangential - now.h[1], 0.0)
        return PathState(
            b=b,
            h=np.array([gap, tangential]),
            r=forces,
            state=state,
            anchor=now.anchor,
            slip=now.slip + moved,
            dissipation=now.dissipation - 0.5 * (friction + now.r[1]) * moved,
        )

    def _certificate(self, after: PathState) -> float:
        """Of the piece as one increment: equilibrium, no tension, the friction cone, slip against friction."""
        origin = self.now.h.copy()
        origin[0] = 0.0
        return certify(self.problem, after.r - (after.h - origin), b=after.b, origin=origin)

    def ended(self, failure: NoRates) -> Segment:
        """The segment up to a jump, or to where nothing was found."""
        if not failure.proved:
            message = f"at factor {self.factor:.12g}: {failure.proof}"
            return self.segment(Outcome.NOT_FOUND, None, message)
        jump = explain(self.problem, self.now, self.b_end, self.factor, self.acting, failure, self.width)
        return self.segment(Outcome.JUMP, jump, f"no gradual continuation at factor {self.factor:.12g}: {jump.proof}")

    @property
    def effort(self) -> tuple[int, int, int]:
        """States tried, dense factorisations and their updates, so far."""
        done = self.responses
        return done.pivots, done.inverse.factorisations, done.inverse.updates
