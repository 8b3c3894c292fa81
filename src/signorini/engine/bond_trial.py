# SPDX-License-Identifier: BSD-3-Clause
"""What bonds do in an increment, as far as rounds of it tell."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.engine.bond_tensions import Tensions
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.errors import told
from signorini.law.cohesion import Bonds, PairCohesion
from signorini.law.states import OPEN, SLIP, STICK
from signorini.outcome import Outcome

RESERVE = 2.0
"""Times the strength: with what a bond holds beside the law, so that no pair of its is on the verge of opening."""

MOST_RESERVE = 1e8
"""Times the strength, where loads of an increment are beyond that: farther digits of the bond are lost."""

_MORE_RESERVE = 8.0  # times as much as before
_WIDTH = 1e-11  # of the strength, or of the opening: how far off its line a bond may be
_SAME_BREAK = 1e-6  # part of the increment: bonds that break so close together break at once

NO_BOND = 0
"""Code of what a bond does: nothing, as where there is none, or where what it would bear is pressed."""

HOLDS = 1
"""Code of a bond that holds."""

BACK = 2
"""Code of a bond on its way back, or up again, on the line of its damage."""

OPENS = 3
"""Code of a bond that opens farther than ever."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Trial:
    """What bonds do in a round of an increment.

    Attributes
    ----------
    does : (n,) codes of the module
    tension : (n,) of bonds that open, force
    reserve : times the strength, see the module's numbers
    gone, loose : (n,) bonds that have let go at once, and that have reached their strength: along the sides they let go
    """

    does: IntArray
    tension: Array
    reserve: float
    gone: BoolArray
    loose: BoolArray

    @property
    def with_more(self) -> Trial:
        """With more reserve."""
        return replace(self, reserve=_MORE_RESERVE * self.reserve)


@dataclass(frozen=True, kw_only=True, eq=False)
class Seen:
    """What a round has found.

    Attributes
    ----------
    force : (n,) normal force of bond and contact together
    law : (n,) of it what the law of contact bears
    gap : (n,) opening of bonds that are open, 0 of others
    beyond : (n,) part of the increment that is behind when a bond reaches its strength, infinite where it does not
    sheared_off : (n,) bonds that soften, and bear no more along the sides
    """

    force: Array
    law: Array
    gap: Array
    beyond: Array
    sheared_off: BoolArray


@dataclass(frozen=True, kw_only=True, eq=False)
class BondIncrement:
    """An increment as bonds see it.

    Attributes
    ----------
    increment : as it was asked
    cohesion, bonds : of the pairs, and what they remember at its beginning
    asked : (n,) bonds that are looked for
    active : (n,) pairs that the law is asked of
    """

    increment: Increment
    cohesion: PairCohesion
    bonds: Bonds
    asked: BoolArray
    active: BoolArray

    @staticmethod
    def of(increment: Increment, active: BoolArray) -> BondIncrement:
        """An increment of a model whose bonds remember something."""
        cohesion, bonds = increment.system.interface.cohesion, increment.state.bonds
        assert cohesion is not None
        assert bonds is not None
        asked = active & ~increment.system.absent & (cohesion.most > 0.0) & (bonds.damage < 1.0)
        return BondIncrement(increment=increment, cohesion=cohesion, bonds=bonds, asked=asked, active=active)

    @property
    def first(self) -> Trial:
        """Bonds go on as they were: what has begun to open is on its way back, unless it is pressed."""
        state = self.increment.state
        begun = np.where(state.forces[0] > 0.0, NO_BOND, BACK)
        does = np.where(self.asked, np.where(self.bonds.damage > 0.0, begun, HOLDS), NO_BOND)
        none = np.zeros_like(self.asked)
        return Trial(does=does, tension=np.zeros(len(does)), reserve=RESERVE, gone=none, loose=none)

    @property
    def from_state(self) -> IncrementAnswer:
        """The state before as an answer, to start from."""
        state, leaders = self.increment.state, self.increment.system.constraints.leaders
        return IncrementAnswer(
            outcome=Outcome.SOLVED,
            message="",
            forces=state.forces,
            moved=np.concatenate([state.gap[None], np.zeros_like(state.tangential)]),
            free=state.displacement[leaders],
            status=state.status[self.active],
            trace=(),
        )

    @property
    def allowed(self) -> float:
        """What tensions may lack, force."""
        return self.increment.allowed_lack * self.increment.system.scale.force

    @property
    def limit(self) -> Array:
        """(n,) Tension at which bonds open farther than ever, force."""
        return self.cohesion.most * (1.0 - self.bonds.damage)

    def on_line(self, trial: Trial) -> Array:
        """(n,) Compliance of bonds on their way back, length per force; 0 of others."""
        damage, limit = self.bonds.damage, self.limit
        opening = damage * self.cohesion.opening
        back = trial.does == BACK
        return np.divide(opening, limit, out=np.zeros_like(opening), where=back & (limit > 0.0))

    def pull(self, trial: Trial) -> Array:
        """(d, n) Forces with which bonds pull beside the law."""
        pull = np.zeros_like(self.increment.offset)
        closed = (trial.does == HOLDS) | (trial.does == BACK)
        pull[0] = np.where(
            closed, -trial.reserve * self.cohesion.most, np.where(trial.does == OPENS, -trial.tension, 0)
        )
        return pull

    def sticking(self, trial: Trial) -> BoolArray:
        """(n,) Bonds that hold the sides from sliding."""
        return np.asarray((trial.does == HOLDS) & self.cohesion.sticking(self.bonds) & ~trial.loose)

    def posed(self, trial: Trial, near: IncrementAnswer, pull: Array) -> IncrementAnswer:
        """An answer near a round's as the law of that round sees it.

        Parameters
        ----------
        trial : what bonds do in it
        near : with the forces of bonds and law together
        pull : (d, n) of them those of bonds in the round
        """
        forces, moved, status = near.forces - pull, near.moved.copy(), near.status.copy()
        does = trial.does
        forces[0] = np.where(does > NO_BOND, np.maximum(forces[0], 0.0), forces[0])
        forces[:, does == OPENS] = 0.0
        moved[0, (does == HOLDS) | (does == BACK)] = 0.0
        own = does[self.active]
        law = np.where(self.sticking(trial), STICK, SLIP)[self.active]
        status = np.where(own == OPENS, OPEN, np.where((own == HOLDS) | (own == BACK), law, status))
        return replace(near, forces=forces, moved=moved, status=status)

    def seen(self, trial: Trial, answer: IncrementAnswer, law: Array) -> Seen:
        """What a round has found of its bonds.

        Parameters
        ----------
        trial, answer : what bonds did, and the answer
        law : (n,) normal forces of the law
        """
        cohesion, state, limit = self.cohesion, self.increment.state, self.limit
        force, holds = answer.forces[0], trial.does == HOLDS
        over = ((trial.does == BACK) | holds) & (force < -(1.0 + _WIDTH) * limit)
        before = np.maximum(state.forces[0], -limit)
        behind = np.divide(
            -limit - before, force - before, out=np.full_like(force, np.inf), where=over & (before > force)
        )
        along, along_before = (np.linalg.norm(each.forces[1:], axis=0) for each in (answer, state))
        slides = self.sticking(trial) & (along > (1.0 + _WIDTH) * cohesion.along)
        sheared, way = np.zeros_like(along), along - along_before
        np.divide(cohesion.along - along_before, way, out=sheared, where=slides & (way > 0.0))
        sheared = np.where(slides, np.clip(sheared, 0.0, 1.0), np.inf)
        brittle = cohesion.opening == 0.0
        return Seen(
            force=force,
            law=law,
            gap=np.where(trial.does == HOLDS, 0.0, answer.moved[0]),
            beyond=np.where(over, np.clip(behind, 0.0, 1.0), np.where(brittle, sheared, np.inf)),
            sheared_off=np.asarray(slides & ~brittle & ~over),
        )

    def following(self, trial: Trial, seen: Seen, tensions: Tensions) -> Trial | None:
        """What bonds do in the next round; None where all are on their lines.

        Parameters
        ----------
        trial, seen : what they did, and what was found
        tensions : of those that open, as they were found so far
        """
        cohesion, does, damage = self.cohesion, trial.does, self.bonds.damage
        width = _WIDTH * cohesion.most
        lost = ((does == HOLDS) | (does == BACK)) & (seen.law <= 0.0)
        if lost.any() and trial.reserve < MOST_RESERVE:
            return trial.with_more
        brittle, over = cohesion.opening == 0.0, np.isfinite(seen.beyond)
        breaks = over & brittle
        if breaks.any():
            breaks &= seen.beyond <= seen.beyond[breaks].min() + _SAME_BREAK
            return replace(trial, does=np.where(breaks, NO_BOND, does), gone=trial.gone | breaks)
        begins = over & ~brittle
        pressed = (does == BACK) & (seen.force > width)
        slack = self.asked & ~trial.gone & (does == NO_BOND) & (seen.law <= 0.0) & (seen.gap > 0.0)
        changed = np.where(begins, OPENS, np.where(pressed, NO_BOND, np.where(slack, BACK, does)))
        opens, span = changed == OPENS, np.where(cohesion.opening > 0.0, cohesion.opening, 1.0)
        line = np.minimum(cohesion.most * np.clip(1.0 - seen.gap / span, 0.0, 1.0), self.limit)
        if (changed != does).any():
            tensions.forget()
        elif tensions.settled(opens, trial.tension, line, self.limit, self.allowed):
            # no sooner: with their own tension, pressed on, they hold as well as closed ones
            returns = opens & ((seen.law > 0.0) | (seen.gap < damage * cohesion.opening * (1.0 - _WIDTH)))
            if not returns.any():
                return None
            tensions.forget()
            return replace(trial, does=np.where(returns, np.where(damage > 0.0, BACK, HOLDS), does))
        old = opens & ~begins
        found = tensions.following(old, trial.tension, line, cohesion.most / span, self.limit)
        return replace(
            trial,
            does=changed,
            tension=np.where(begins, self.limit, found),
            loose=trial.loose | (begins & cohesion.sticks),
        )

    def after(self, trial: Trial, answer: IncrementAnswer) -> Bonds:
        """What bonds remember behind the increment."""
        gap = np.where(trial.does == HOLDS, 0.0, answer.moved[0])
        return self.cohesion.after(self.bonds, np.where(self.asked, gap, 0.0), trial.gone, trial.loose)


def sheared_off(number: int) -> str:
    """A bond that softens, and whose strength along the sides is reached, in words; ``number`` of its node."""
    return told(
        f"the bond of node {number} bears no more along the sides",
        remedy="bonds that let go at once, or without a shear_strength",
        evidence="bonds that soften are followed for tension alone",
    )
