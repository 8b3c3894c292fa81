# SPDX-License-Identifier: BSD-3-Clause
"""What rounds of an increment of bodies that yield leave: residuals, steps, when a factor or a flow is given up."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from signorini.arrays import Array
from signorini.engine.increment import Mechanism
from signorini.linalg.anderson import anderson

_KEPT_GAIN = 0.03  # of the residual before: a full step that leaves less has a tangent that will do once more
_KEPT_FROM = 1e-6  # of the size of forces: below it that pays, above it costs rounds
_ANDERSON_DEPTH = 10  # rounds that Anderson's method looks back on: with 6 a tenth more of them, with 15 as many
_TANGENT_DECADES = 0.7  # that a new tangent gains; a kept one is worth it as long as it gains its share of the price
_PATIENCE = 3  # rounds in which a kept tangent has to gain that, together: single ones rise and fall
_SHORTER = 0.5  # of the first step on it: a tangent whose steps are shorter than that may be waited for
_LOST = 10.0  # times the first residual on it: beyond that it is not
_STEADY = 0.5  # of the step before: steps of bodies that flow away do not fall below it
_FLOWING_STEPS = 4  # in a row: so many of these are flow that runs away
_DRIVEN_STEPS = 2  # in a row: on so many of these loads do more work than is taken, a single one may have turned
_MECHANISMS = 8  # of the longest steps: each bounds the load, and the last need not bound it best
_MECHANISM_ROUNDS = 12  # rounds: after so many the mechanism is known to four digits
_STEP_LEFT = 1e-9  # of the displacements: soft bodies in balance may be farther than that from where they end
_NEARER_ROUNDS = 2  # more in balance, until they are not


@dataclass(kw_only=True, eq=False)
class Rounds:
    """What the rounds of an increment have left.

    Attributes
    ----------
    residuals, steps : of every round: what equilibrium lacks, and the part of the step that was taken
    lengths : of every step, the largest displacement
    powers : what equilibrium lacks, on every step: work that loads do there beyond what bodies and pairs take
    inputs, outputs : of the rounds on the factor at hand: x and what it became
    factorisations : of tangents
    mechanisms : the last step and the longest ones: where flow runs away one of them is nearest to the mechanism
    least : part of the elastic law that is left in place from the start, once contact found nothing on a softer tangent
    """

    residuals: list[float] = field(default_factory=list)
    steps: list[float] = field(default_factory=list)
    lengths: list[float] = field(default_factory=list)
    powers: list[float] = field(default_factory=list)
    inputs: list[Array] = field(default_factory=list)
    outputs: list[Array] = field(default_factory=list)
    factorisations: int = 0
    mechanisms: tuple[Mechanism, ...] = ()
    least: float = 0.0

    @property
    def last(self) -> float:
        """Residual of the last round."""
        return self.residuals[-1] if self.residuals else np.inf

    def flow_away(self, beyond: float) -> bool:
        """Whether steps stay longer than so many times the first, and loads do more work on them than is taken."""
        if len(self.lengths) <= _FLOWING_STEPS:
            return False
        recent = self.lengths[-_FLOWING_STEPS - 1 :]
        steady = all(two > _STEADY * one for one, two in pairwise(recent))
        return steady and min(recent) > beyond * self.lengths[0] and min(self.powers[-_DRIVEN_STEPS:]) > 0.0

    def ran_away(self, beyond: float) -> bool:
        """Whether they have done so for so many rounds that the last step is the mechanism.

        A little above the limit steps are long before they are, and not all flows in their direction.
        """
        return len(self.lengths) >= _MECHANISM_ROUNDS and self.flow_away(beyond)

    def add(self, residual: float, left: Array, step: float, motion: Mechanism) -> None:
        """A round.

        Parameters
        ----------
        residual, left : what equilibrium lacks, of the size of the forces and (z,)
        step, motion : the part of the step that was taken, and the step
        """
        length = float(np.abs(motion.free).max(initial=0.0))
        self.powers.append(float(left @ motion.free))
        if np.isfinite(residual):
            others = sorted(self.mechanisms, key=lambda one: float(np.abs(one.free).max(initial=0.0)), reverse=True)
            self.mechanisms = (motion, *others[:_MECHANISMS])
        self.residuals.append(residual)
        self.steps.append(step)
        self.lengths.append(length)

    def near(self, length: float, balance: float) -> bool:
        """Whether a round more would hardly change displacements of that length, or enough had residuals in balance."""
        if sum(residual <= balance for residual in self.residuals) > _NEARER_ROUNDS or len(self.residuals) < 2:
            return True
        return self.lengths[-1] * self.residuals[-1] <= _STEP_LEFT * length * self.residuals[-2]

    def gains(self, share: float) -> bool:
        """Whether the factor at hand still gains that share of a new tangent's decades a round, or soon will again.

        Residuals on it rise and fall; while steps shorten, those of a few rounds count together.
        """
        here, steps = (each[-len(self.inputs) - 1 :] for each in (self.residuals, self.lengths))
        within = _PATIENCE if steps[-1] < _SHORTER * steps[0] else 1
        if len(here) <= within:
            return here[-1] <= _LOST * here[0]
        before, now = min(here[:-within]), min(here[-within:])
        return now <= 10.0 ** (-_TANGENT_DECADES * share * within) * before

    def gained(self) -> bool:
        """Whether the last full step gained so much that its tangent will do once more."""
        if len(self.residuals) < 2 or self.steps[-1] < 1.0:
            return False
        return self.residuals[-1] < min(_KEPT_GAIN * self.residuals[-2], _KEPT_FROM)

    def accelerated(self, x: Array, became: Array, scale: Array) -> Array:
        """The next x by Anderson's method.

        Parameters
        ----------
        x, became : (z,) of the last round, and what it became
        scale : (z,) what residuals are measured over
        """
        self.inputs, self.outputs = (
            [*self.inputs, x][-_ANDERSON_DEPTH - 1 :],
            [*self.outputs, became][-_ANDERSON_DEPTH - 1 :],
        )
        return anderson(self.inputs, self.outputs, scale)
