# SPDX-License-Identifier: BSD-3-Clause
"""Contact across what lies between the sides and closes by a law with kinks: the line of every pair is found.

On given lines of its closure a pair is one of an interface with a compliance, which every solver knows. So increments
are solved on lines, those that the pressures found lie on are taken next, until they are the same. Where the law gets
stiffer as it closes all pressures grow from one round to the next; where it has both, pairs may go back and forth: then
they go no farther than one line a round, and at last one pair at a time, which ends for bodies without friction.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.engine.law_solver import CompliantSolver, LawSolver
from signorini.errors import told
from signorini.law.closure import PairClosure
from signorini.outcome import Outcome

_ROUNDS = 200
"""Lines of the pairs that an increment tries at most: four to eight are usual, whatever the number of pairs."""

_KINK_WIDTH = 1e-12  # of the largest pressure: how far beyond the end of its line a pair counts as on it

_NOT_SETTLED = told(
    "no certified equilibrium, and no proof that there is none: pairs go back and forth between lines of their closure",
    remedy="smaller increments, or points of the closure without kinks to and fro",
    evidence=f"{_ROUNDS} rounds",
)


class Lines(NamedTuple):
    """The lines that pairs are on.

    Attributes
    ----------
    closure : of the n pairs
    line : (n,) numbers of their lines
    """

    closure: PairClosure
    line: IntArray

    @staticmethod
    def at(closure: PairClosure, pressure: Array) -> Lines:
        """The lines at pressures (n,); where two meet the one of higher pressures."""
        return Lines(closure, closure.line(pressure))

    def beyond(self, pressure: Array) -> tuple[BoolArray, BoolArray]:
        """(n,) each: pairs whose pressures are below their lines, and above them."""
        low, high = self.closure.ends(self.line)
        width = _KINK_WIDTH * float(np.abs(pressure).max(initial=0.0))
        return (pressure < low - width) & (self.line > 0), pressure > high + width

    def next(self, pressure: Array, care: int) -> Lines:
        """Of pairs whose pressures are not on their lines; with care 1 the one beside, and with more of one pair."""
        below, above = self.beyond(pressure)
        off = below | above
        if care == 0:
            found = self.closure.line(np.maximum(pressure, 0.0))
            return self._replace(line=np.where(off, found, self.line))
        if care > 1:
            first = np.arange(len(off)) == off.argmax()
            below, above = below & first, above & first
        return self._replace(line=self.closure.beside(self.line, below, above))


@dataclass(frozen=True, kw_only=True, eq=False)
class ClosureSolver(LawSolver):
    """Increments of contact whose pairs close by a law, through the one door of `ContactSolver`.

    Attributes
    ----------
    bodies : the same with an interface of one compliance a pair
    """

    def on(self, lines: Lines, area: Array) -> CompliantSolver:
        """Bodies with pairs on given lines; ``area`` (n,) forces per pressure."""
        compliance, rest = lines.closure.of_lines(lines.line)
        return self.bodies.closing(compliance / area, rest)

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment on lines that its pressures lie on."""
        interface, near = increment.system.interface, increment.near
        assert interface.closure is not None
        closure, area = interface.closure.after(increment.state.borne), interface.area
        before = (increment.state if near is None else near).forces[0] / area
        lines, seen, care = Lines.at(closure, np.maximum(before, 0.0)), set[bytes](), 0
        tried: list[MethodRun] = []
        for rounds in range(1, _ROUNDS + 1):
            seen.add(lines.line.tobytes())
            answer = self.on(lines, area).solve(increment)
            if not answer.solved:
                return replace(_unproved(answer), trace=(*tried, *answer.trace))
            pressure = answer.forces[0] / area
            if not any(off.any() for off in lines.beyond(pressure)):
                found = MethodRun(method="closure", iterations=rounds, end="pairs are on their lines")
                return replace(answer, trace=(*tried, found, *answer.trace))
            tried += answer.trace
            lines, increment = lines.next(pressure, care), replace(increment, near=answer)
            if lines.line.tobytes() in seen:
                care, seen = care + 1, set()
        return replace(answer, outcome=Outcome.NOT_FOUND, message=_NOT_SETTLED, trace=tuple(tried))


def _unproved(answer: IncrementAnswer) -> IncrementAnswer:
    """An answer without a solution: what is proved on some lines is known of all if it is a rigid motion alone."""
    if answer.escape is not None or answer.outcome != Outcome.NO_EQUILIBRIUM:
        return answer
    words = "no certified equilibrium, and no proof that there is none: on lines of the closure that were tried"
    return replace(answer, outcome=Outcome.NOT_FOUND, message=f"{words}, {answer.message}")
