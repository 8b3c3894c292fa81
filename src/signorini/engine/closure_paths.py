# SPDX-License-Identifier: BSD-3-Clause
"""Exact paths of pairs that close by a law with kinks: followed on the lines that they are on, from kink to kink.

Where a pair comes to the end of its line the way is cut, exactly, and goes on with the pair on the next one; whether it
goes on there, back, or both beside other pairs at kinks of theirs, is tried, as pairs with friction try their states.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.engine.closure_solver import ClosureSolver, Lines
from signorini.engine.increments import advance
from signorini.engine.path_states import path_state, right_hand_side
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import StepPart
from signorini.friction.history import Breakpoint, Event, PathSettings, PathState, Segment, follow
from signorini.friction.history.segment import What
from signorini.outcome import Outcome

_TRIALS = 50
"""Lines that pairs at kinks try at one load, at most: one or two are usual."""

_KINK_WIDTH = 1e-12  # of the largest normal force: how far from the end of its line a pair is at a kink
_TRIALS_TOGETHER = 5  # trials in which all pairs that leave their lines at once change them, before they do one by one
_SAME_KINK = 1e-10  # of a piece: pairs that leave their lines so close together act together
_AT_ONCE = 1e-12  # part of the way: a pair that leaves its line within it should not have been on it


@dataclass(frozen=True, kw_only=True, eq=False)
class LinesPath:
    """A part of a step as it was followed on lines of the closures.

    Attributes
    ----------
    part : on the lines, awake where it goes on on others
    lines : of the pairs
    start : its state before, in the scaled units of the law
    segment : DISTURBED where a pair comes to the end of its line
    """

    part: StepPart
    lines: Lines
    start: PathState
    segment: Segment


def follow_on_lines(part: StepPart, stops: PathSettings | None, tell: Callable[[float], None]) -> LinesPath:
    """Follow a part of a step up to its end, or to where a pair comes to the end of its line.

    Parameters
    ----------
    part : with a solver for pairs that close by a law
    stops : as of `CondensedSolver.follow`
    tell : is called with the part that is behind
    """
    lines, turned = _first_lines(part), False
    for trial in range(_TRIALS):
        path, watch = _followed(part, lines, stops, tell)
        segment = path.segment
        if segment.outcome == Outcome.DISTURBED:
            factor, below, above = watch.first(segment)
            if factor > _AT_ONCE:
                return replace(path, segment=watch.cut(segment, factor, below, above))
        else:
            below, above = watch.at_kinks(path.start)
            if len(segment.pieces) > 1 or turned or not (below | above).any():
                return path
            turned = True  # no rates: pairs at kinks may have them on their other lines
        lines = watch.beside(below, above, alone=trial >= _TRIALS_TOGETHER)
    words = f"pairs at kinks of their closures tried {_TRIALS} lines at one load"
    lost = replace(segment, end=path.start, events=(), pieces=segment.pieces[:1], outcome=Outcome.NOT_FOUND, jump=None)
    return replace(path, segment=replace(lost, message=words))


def on_their_lines(path: LinesPath, state: PathState) -> bool:
    """Whether a state of the law on the lines of a path is one of the closures: every pair is on its line.

    Of closures that do not spring back along their lines that is not known: pairs may have been farther on the way.
    """
    return path.lines.closure.springs is None and not _Watch.of(path.part.prepared, path.lines).left(
        Breakpoint(factor=0.0, h=state.h, r=state.r)
    )


def _followed(
    part: StepPart, lines: Lines, stops: PathSettings | None, tell: Callable[[float], None]
) -> tuple[LinesPath, _Watch]:
    """A part as far as pairs stay on lines; the arguments as of `follow_on_lines`."""
    prepared, solver = part.prepared, part.prepared.solver.elastic
    assert isinstance(solver, ClosureSolver)
    posed = replace(prepared, solver=solver.on(lines, prepared.interface.area))
    start, b = path_state(posed, part.before), right_hand_side(posed, part.end)
    watch = _Watch.of(posed, lines)
    settings = stops or PathSettings(solver=prepared.settings)
    segment = follow(posed.paths.law, start, b, settings=settings, tell=tell, leaves=watch.left)
    nobody = np.zeros(len(prepared.interface), np.bool_)
    on_lines = replace(part, prepared=posed, awake=prepared, waiting=nobody)
    return LinesPath(part=on_lines, lines=lines, start=start, segment=segment), watch


def _first_lines(part: StepPart) -> Lines:
    """The lines at the pressures in which a part begins; where overlaps press first, at theirs."""
    prepared, state = part.prepared, part.before
    interface = prepared.interface
    assert interface.closure is not None
    own = prepared.solver.active
    if not state.forces.any() and not state.nodal[0].any() and (state.gap[own] < 0.0).any():
        state = advance(prepared, state, state.point, part.where)[0]
    closure = interface.closure.after(part.before.borne)
    return Lines.at(closure, np.maximum(state.forces[0], 0.0) / interface.area)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Watch:
    """Where pairs on a path leave their lines.

    Attributes
    ----------
    lines : of all pairs
    active : (n,) those of the path
    low, high : (a,) scaled normal forces at which lines of these begin and end; of pairs on the way to the largest
        pressure yet, which spring back otherwise, the low end goes along
    loading : (a,) those pairs
    """

    lines: Lines
    active: BoolArray
    low: Array
    high: Array
    loading: BoolArray

    @staticmethod
    def of(prepared: Prepared, lines: Lines) -> _Watch:
        """On a path of the active pairs."""
        condensed, interface = prepared.paths.condensed, prepared.interface
        active = condensed.active
        per_pressure = interface.area[active] / condensed.root
        low, high = (per_pressure * end[active] for end in lines.closure.ends(lines.line))
        springs, line = lines.closure.springs, lines.line[active]
        on_the_way = np.zeros(len(line), np.bool_) if springs is None else (springs[active] > 0.0) & (line > 0)
        return _Watch(lines=lines, active=active, low=np.where(line > 0, low, -np.inf), high=high, loading=on_the_way)

    def _width(self, p: Array) -> float:
        return _KINK_WIDTH * float(np.abs(p).max(initial=0.0))

    def left(self, piece: Breakpoint) -> bool:
        """Whether any pair is beyond its line at the end of a piece, one after the other."""
        p = piece.r[0]
        width = self._width(p)
        left = bool(((p < self.low - width) | (p > self.high + width)).any())
        if not left:
            self.low[self.loading] = np.maximum(self.low, p)[self.loading]
        return left

    def first(self, segment: Segment) -> tuple[float, BoolArray, BoolArray]:
        """Where pairs leave first in the last piece of a segment, and (a,) each which, below and above."""
        one, two = segment.pieces[-2:]
        p, change = one.r[0], two.r[0] - one.r[0]
        width = self._width(two.r[0])
        below, above = two.r[0] < self.low - width, two.r[0] > self.high + width
        way = np.where(below, self.low, self.high) - p
        times = np.divide(way, change, out=np.full(len(p), np.inf), where=below | above)
        times = np.clip(times, 0.0, None)
        here = times <= times.min() + _SAME_KINK
        factor = one.factor + float(times.min()) * (two.factor - one.factor)
        return factor, below & here, above & here

    def cut(self, segment: Segment, factor: float, below: BoolArray, above: BoolArray) -> Segment:
        """A segment up to where pairs leave their lines, with what happens to them there.

        Parameters
        ----------
        factor, below, above : as of `first`
        """
        until = segment.until(factor)
        before, after = (self._compliance(line) for line in (self.lines, self._next(below, above)))
        events = list(until.events)
        kinds: tuple[tuple[What, BoolArray], ...] = ("stiffens", after < before), ("softens", after > before)
        for what, which in kinds:
            pairs = tuple(np.flatnonzero(which).tolist())
            if pairs:
                events.append(Event(factor=factor, pairs=pairs, what=what, state=until.end))
        return replace(until, events=tuple(events), outcome=Outcome.DISTURBED, message=f"kink at factor {factor:.12g}")

    def at_kinks(self, start: PathState) -> tuple[BoolArray, BoolArray]:
        """(a,) each: pairs that are where their lines begin, and where they end."""
        p = start.r[0]
        width = self._width(p)
        return p <= self.low + width, p >= self.high - width

    def beside(self, below: BoolArray, above: BoolArray, *, alone: bool) -> Lines:
        """The lines below and above those of some active pairs, (a,); ``alone``: of the first of them only."""
        if alone:
            first = np.arange(len(below)) == (below | above).argmax()
            below, above = below & first, above & first
        return self._next(below, above)

    def _next(self, below: BoolArray, above: BoolArray) -> Lines:
        every = np.zeros((2, len(self.active)), np.bool_)
        every[:, self.active] = below, above
        return self.lines._replace(line=self.lines.closure.beside(self.lines.line, *every))

    def _compliance(self, lines: Lines) -> Array:
        return lines.closure.of_lines(lines.line)[0][self.active]
