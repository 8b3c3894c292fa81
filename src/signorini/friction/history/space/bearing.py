# SPDX-License-Identifier: BSD-3-Clause
"""How much of the load pairs that nearly touch can hold on floating bodies, before increments are sought.

Rigid equilibrium needs forces in the friction cones that balance the loads, however they are shared; where it ends a
linear programme of a few rows tells (see `overload`). An equilibrium found beyond has moved a body as a whole until it
met something else, which no history does gradually.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.attempt import Spent
from signorini.friction.history.segment import Breakpoint, Jump
from signorini.friction.history.state import PathState
from signorini.friction.overload import Overload, along_contact, overload
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import GAIN

OVERLOADED = (
    "forces in the friction cones of the pairs that touch, or nearly do, cannot balance more load, however they are "
    "shared"
)

NEAR_GAP = 0.1
"""Of the motions that the loads cause: a gap that bodies close by deforming a little more."""

_SHORT_OF_LIMIT = 1e-3  # of the load that can be held: so near to it slip grows without bound, and nothing is gained
_SPENT_FRICTION = 0.05  # of the friction of all pairs: what is left of it where bodies slide rather than tip


class Bearing:
    """Where on a way of the load floating bodies lose their hold; asked again only as other pairs come near.

    Parameters
    ----------
    problem : its b is not used
    b_end : (3 n,) load at the end of the way
    behind : of a longer straight way that this one ends, in lengths of this one: what is near a limit, is near it alike
        wherever on that way the look begins
    known : where pairs that were near at the beginning of that way hold no more, part of this one; so the load named is
        one number, wherever the look begins

    Attributes
    ----------
    spent : searches that ended at their budgets, of which nothing is known
    """

    def __init__(
        self, problem: ContactProblem, b_end: Array, behind: float = 0.0, known: Overload | None = None
    ) -> None:
        self.problem, self.b_end, self.behind = problem, b_end, behind
        self._near: BoolArray = np.zeros(0, dtype=np.bool_)
        self._found: Overload | None = None  # with the pairs that are near
        self._least = known  # with those of any state since equilibrium was seen to go on beyond one
        self._crossed = 0.0
        self.spent: list[Spent] = []

    def reach(self, now: PathState, factor: float) -> float:
        """Part of the way just before the pairs that are near can hold the bodies no more, 1 while nothing presses."""
        problem = self.problem
        if not problem.floating or not now.r.any():
            return 1.0
        near = _near(problem, now)
        if not self._known(near):
            found = overload(replace(problem, b=now.b), now.r, self.b_end, near=near)
            self._near = near
            known = self._told(found)
            self._found = known and replace(known, factor=_along(factor, known.factor))
        ahead = self._found
        if ahead is not None and ahead.factor > self._crossed:
            self._least = ahead if self._least is None else min(self._least, ahead, key=lambda one: one.factor)
        return 1.0 if self._least is None else (1.0 - _SHORT_OF_LIMIT) * self.limit - _SHORT_OF_LIMIT * self.behind

    def _told(self, found: Overload | Spent | None) -> Overload | None:
        """What is known; that a search ended at its budget is kept."""
        if isinstance(found, Spent):
            self.spent.append(found)
            return None
        return found

    def _known(self, near: BoolArray) -> bool:
        """Whether these pairs are known to hold as much; more of them hold no less."""
        if len(near) != len(self._near):
            return False
        holds = self._found is None and bool((near >= self._near).all())
        return holds or bool((near == self._near).all())

    @property
    def least(self) -> Overload | None:
        """Where bodies lose their hold, as far as it is known; None where they do not."""
        return self._least

    @property
    def limit(self) -> float:
        """Part of the way up to which, to the last digit, the pairs that are near can hold the bodies."""
        return 1.0 if self._least is None else self._least.factor

    @property
    def beyond(self) -> float:
        """Part of the way a little beyond that."""
        return min(1.0, (1.0 + _SHORT_OF_LIMIT) * self.limit + _SHORT_OF_LIMIT * self.behind)

    def cross(self) -> None:
        """Take note that equilibrium goes on gradually beyond the reach."""
        self._crossed, self._least = self.beyond, None

    def jump(self, now: PathState, factor: float, pressed: BoolArray, proof: str) -> Jump:
        """The loss of hold as a jump: at which load, along which motion, and from where on no pair whatever can hold.

        Parameters
        ----------
        now, factor : a state within reach of it
        pressed : (n,) pairs that carry load
        proof : that equilibrium is lost, in words
        """
        assert self._least is not None
        problem, over = replace(self.problem, b=now.b), self._least
        every = self._told(overload(problem, now.r, self.b_end))
        sure = every is not None and every.share > GAIN
        who, share = ("nothing", every.share) if every is not None and sure else ("none of them", over.share)
        return Jump(
            factor=over.factor,
            pairs=tuple(np.flatnonzero(pressed).tolist()),
            proof=f"{proof}: {who} takes {share:.2g} of the load at the end, or more" if share > GAIN else proof,
            margin=share if share > GAIN else 0.0,
            gross_sliding=bool(pressed.any()) and _spent(problem, now.r, pressed),
            escape=_sliding(problem, over.motion, pressed),
            hopeless=_along(factor, every.proved) if every is not None and sure else None,
        )


def bears(problem: ContactProblem, now: PathState, b_end: Array) -> bool:
    """Whether pairs that touch, or nearly do, can hold floating bodies all the way: none of them slides as a whole.

    Parameters
    ----------
    problem : its b is not used
    now : the state at the beginning of the way
    b_end : (3 n,) load at its end
    """
    if problem.bounded.any():
        return False
    return overload(replace(problem, b=now.b), now.r, b_end, near=_near(problem, now)) is None


def _near(problem: ContactProblem, now: PathState) -> BoolArray:
    """(n,) Pairs that touch in a state, or nearly do."""
    return np.asarray(now.h[0] <= NEAR_GAP * (problem.scale or 1.0))


def _along(behind: float, part: float) -> float:
    """Part of the whole way, of a part of what is left of it."""
    return behind + part * (1.0 - behind)


def sliding(problem: ContactProblem, ends: Sequence[Breakpoint], pressed: BoolArray) -> Array | None:
    """The rigid motion (3, n) of an increment in which a floating body slides on pressed pairs (n,) that hold no more.

    Parameters
    ----------
    problem : the problem
    ends : of the increment
    pressed : (n,) pairs that press
    """
    one, two = ends
    if not problem.floating or not pressed.any() or not _spent(problem, two.r, pressed):
        return None
    R = problem.image.R
    return _sliding(problem, R @ (R.T @ (two.h - one.h).ravel()), pressed)


def _sliding(problem: ContactProblem, motion: Array, pressed: BoolArray) -> Array:
    """A rigid motion (3 n,) as far as it slides on pressed pairs (n,), as a whole where it does not."""
    along = along_contact(problem.image.R, motion, pressed)
    return motion if along is None else along


def _spent(problem: ContactProblem, r: Array, pressed: BoolArray) -> bool:
    """Whether next to nothing is left of the friction of pressed pairs, all of them together."""
    most = problem.bound.at(np.maximum(r[0], 0.0))
    return bool(problem.law.reserve(r)[pressed].sum() <= _SPENT_FRICTION * most[pressed].sum())
