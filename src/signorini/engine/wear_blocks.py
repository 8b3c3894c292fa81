# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of cycles, implicit in what a cycle rubs: the last of N cycles, on the sides as they are worn at its end.

With x(d) what a cycle rubs on sides worn by d, a block of N cycles ends at ``d = d_0 + N k x(d)``: backward Euler, of
first order in N. Explicit blocks ``d = d_0 + N k x(d_0)`` oscillate as soon as N k times the distance slid is more
than twice what the bodies give under a pressure that alternates from node to node; implicit ones never do.

The equation is solved by a few cycles, from what the last cycle before lets expect. Each gives a Newton step
(`engine.wear_correction`), and of the steps so far Anderson's method makes the next sides. Where friction lets parts of
the contact stick, a pair at their edge that begins to wear slips the more for it: from a length of blocks on the
equation has no answer near by, and errors stop falling. Such a block is given up at once, and fewer cycles are tried.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Protocol

import numpy as np

from signorini.arrays import Array
from signorini.engine.rubbing import worn
from signorini.engine.wear_paths import FollowedCycle, PathCycle
from signorini.interface.worn_sides import WornSides
from signorini.linalg.anderson import anderson
from signorini.solution.wear_state import WearState

TOLERANCE_OF_DEPTH = 1e-2
"""Of ``block = "auto"``, where the step gives none: of the largest depth that a block wears."""

_SETTLED = 1e-5  # of what the most worn pair loses in a block: how well the equation of a block is solved
_SETTLED_SHARE = 0.1  # of the tolerance of automatic blocks: the same, and what is left wears with the next block
_CYCLES = 20  # tried for one block: two to seven are usual
_FALL = 0.5  # of an error, in every cycle since the second: blocks whose errors fall more slowly are given up
_LOOKS_BACK = 5  # cycles that the next one is made of
_RESOLVED = 1e-8  # of changes of the errors: below it they are rounding
_MOST_GROWTH = 3.0  # times as many cycles as the block before
_SAFETY = 0.8  # of the number of cycles whose error would be the tolerance
_LEAST_BLOCK = 3  # cycles: fewer cost more in a block than one by one
_MOST_COST = 1.1  # cycles followed over cycles gone, from which on automatic blocks wait
_MOST_LOST = 0.5  # of the cycles gone: so many may be lost on blocks of a given length that are not found
_FREE = 10  # cycles that may be lost before that counts
_UNSTABLE = 1.0  # of what a cycle wears: where the next one differs by more, single cycles are implicit too


class BlockPaths(Protocol):
    """Cycles on the condensed interface, as blocks of them ask for.

    Attributes
    ----------
    followed : number of cycles that were followed so far
    """

    followed: int

    @property
    def sides(self) -> WornSides:
        """Sides that wear."""

    @property
    def rate(self) -> Array:
        """Depth over each number of what a cycle rubs."""

    def cycle(self, before: PathCycle, number: int, /) -> FollowedCycle | None:
        """A cycle, by its number; None where no path leads through it."""

    def worn(self, at: PathCycle, wear: WearState, /) -> PathCycle | None:
        """Sides that lose material, to a state of wear; None where no path leads there."""

    def rubs(self, cycle: FollowedCycle, /) -> Array:
        """What a cycle rubs: the unknown of a block."""

    def volume(self, rubs: Array, /) -> Array:
        """(m,) What that takes from the corners of the sides."""

    def expired(self, behind: int, /) -> bool:
        """Whether the last cycle failed for pairs that were found before so many cycles were behind."""


Correct = Callable[[FollowedCycle, Array, int], Array]
"""What every one of N cycles rubs, of a cycle, what it was worn by since the first of them, and N: a Newton step."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleBlock:
    """A block of cycles that was solved.

    Attributes
    ----------
    count : of cycles
    cycle : the last of them, sides worn as at its end
    done : at its end, with what all of them have done
    """

    count: int
    cycle: FollowedCycle
    done: PathCycle


class CycleBlocks:
    """The blocks of a step, one after the other.

    Attributes
    ----------
    paths : the cycles, as they are followed at the moment
    most : cycles of a block; None where that is found by the tolerance
    tolerance : of automatic blocks: error of a block over what it wears
    blocks, singles : numbers of blocks, and of cycles that had to go by themselves
    longest : cycles of a block
    """

    def __init__(
        self, paths: BlockPaths, correct: Correct, block: int | Literal["auto"], tolerance: float | None
    ) -> None:
        self.go_on(paths, correct)
        self.tolerance = tolerance or TOLERANCE_OF_DEPTH
        self.most = None if block == "auto" else block
        self.blocks, self.singles, self.longest = 0, 0, 0
        self._known: FollowedCycle | None = None
        self._since = np.zeros(0)  # what the sides are worn by since that cycle began
        self._count, self._least = 1, _LEAST_BLOCK
        self._lost = 0

    def go_on(self, paths: BlockPaths, correct: Correct) -> None:
        """From here on with cycles that are followed otherwise, and their Newton step."""
        self.paths, self.correct = paths, correct

    def next(self, at: PathCycle, behind: int, room: int) -> CycleBlock | None:
        """The next block; None where its first cycle is to go by itself.

        Parameters
        ----------
        at : where the step stands
        behind : cycles so far
        room : cycles to the next that is kept
        """
        found = self._given(at, behind, room) if self.most else self._automatic(at, behind, room)
        if found is not None:
            self.blocks, self.longest = self.blocks + 1, max(self.longest, found.count)
            self._known, self._since = found.cycle, np.zeros(len(self.paths.rate))
        return found

    def single(self, cycle: FollowedCycle | None) -> None:
        """A cycle that went by itself; None where it was followed with all that is known of the bodies."""
        if cycle is not None and self._known is not None and self.most is None:
            change = self._change(cycle)
            self._count, self._least = self._wanted(1, change), 1 if change > _UNSTABLE else _LEAST_BLOCK
        self._known = cycle
        if cycle is not None:
            self._since = self.paths.rubs(cycle)
        self.singles += 1

    @property
    def note(self) -> str:
        """What a reader should know of them."""
        words = f"sides wore in {self.blocks} blocks of up to {self.longest} cycles and in {self.singles} single ones"
        return f"{words}, for which {self.paths.followed} cycles were followed"

    def _given(self, at: PathCycle, behind: int, room: int) -> CycleBlock | None:
        """A block of the length asked for, shorter where none is found; the first cycle is one of its own."""
        assert self.most is not None
        if self._lost > _FREE + _MOST_LOST * behind:
            return None
        asked = count = min(self._count, room)
        found = self._solved(at, behind, count, _SETTLED)
        while found is None and count > 1:
            if self.paths.expired(behind):
                return None
            count //= 2
            found = self._solved(at, behind, count, _SETTLED)
        failed = found is None or count < asked
        self._count = 2 * count if failed else self.most if behind == 0 else min(self.most, 2 * self._count)
        return found

    def _automatic(self, at: PathCycle, behind: int, room: int) -> CycleBlock | None:
        """A block within the tolerance, where it pays."""
        count = min(self._count, room)
        if self._known is None or self.paths.followed > _FREE + _MOST_COST * behind:
            return None
        while count >= self._least:
            found = self._solved(at, behind, count, _SETTLED_SHARE * self.tolerance)
            if found is None:
                if self.paths.expired(behind):
                    return None
                count = self._count = count // 2
                continue
            change = self._change(found.cycle)
            self._count = self._wanted(count, change)
            if 0.5 * change <= self.tolerance or count == 1:
                return found
            count = min(self._count, count // 2)
        return None

    def _change(self, cycle: FollowedCycle) -> float:
        """How much else a cycle wears than the one known before it, of the most that a pair wears."""
        assert self._known is not None
        now, then = (self.paths.rate * self.paths.rubs(each) for each in (cycle, self._known))
        return float(np.abs(now - then).max() / max(now.max(), np.finfo(float).tiny))

    def _wanted(self, count: int, change: float) -> int:
        """Cycles of a block whose error, half of what its last cycle wears else than the one before it, is allowed."""
        growth = min(_MOST_GROWTH, _SAFETY * self.tolerance / max(0.5 * change, 1e-12))
        return max(1, int(count * growth))

    def _solved(self, at: PathCycle, behind: int, count: int, settled: float) -> CycleBlock | None:
        known, before = self._known, self.paths.followed
        guess = np.zeros(len(self.paths.rate)) if known is None else self.correct(known, -self._since, count)
        found = implicit_block(self.paths, self.correct, (at, behind), count, guess, settled)
        if found is None:
            self._lost += self.paths.followed - before
        return found


def implicit_block(
    paths: BlockPaths, correct: Correct, begin: tuple[PathCycle, int], count: int, guess: Array, settled: float
) -> CycleBlock | None:
    """A block of cycles; None where it is not found.

    Parameters
    ----------
    paths, correct : the cycles, and their Newton step
    begin : where the step stands before the block, and how many cycles are behind
    count : of cycles
    guess : what a cycle rubs
    settled : error of the equation of the block, over what the most worn place loses in it
    """
    (at, behind), rubs, best = begin, guess, np.inf
    inputs, outputs = list[Array](), list[Array]()
    for tries in range(_CYCLES):
        loose = at.wear.loose + count * paths.volume(rubs)
        moved = paths.worn(at, worn(paths.sides, replace(at.wear, loose=loose), cycles=count))
        cycle = None if moved is None else paths.cycle(moved, behind + count)
        if cycle is None:
            return None
        grown = paths.rate * paths.rubs(cycle)
        error, most = float(np.abs(grown - paths.rate * rubs).max()), grown.max(initial=0.0)
        if error <= settled * most:
            return CycleBlock(count=count, cycle=cycle, done=_repeated(paths, cycle, rubs, count))
        best = min(best, error / max(most, np.finfo(float).tiny))
        if best > _FALL ** (tries - 1):
            return None
        inputs, outputs = [*inputs, rubs], [*outputs, correct(cycle, count * rubs, count)]
        inputs, outputs = inputs[-_LOOKS_BACK - 1 :], outputs[-_LOOKS_BACK - 1 :]
        rubs = np.maximum(anderson(inputs, outputs, paths.rate, rcond=_RESOLVED), 0.0)
    return None


def _repeated(paths: BlockPaths, cycle: FollowedCycle, rubs: Array, count: int) -> PathCycle:
    """The end of a block whose last cycle stands for all of them; ``rubs`` is what each has worn."""
    done, rubbing, others = cycle.after.repeated(cycle.before, count - 1), cycle.rubbing, count - 1
    wear = replace(
        done.wear,
        distance=done.wear.distance + others * rubbing.distance,
        loose=done.wear.loose + others * rubbing.volume - count * paths.volume(rubs),
    )
    return replace(done, wear=wear)
