# SPDX-License-Identifier: BSD-3-Clause
"""Increments of contact whose pairs are bonded: which bonds hold, which are on the way back, which open, is found.

A bond that holds, or is on its way back, is a pair that is closed under a pull beside the law, the latter with the
compliance of its way in series: monotone, as every solver knows it. One that opens has a negative stiffness, which none
knows: its tension is given, and what its line says at the opening found is given next. Between tensions and openings
of pairs that keep their states all is linear, so few rounds of Anderson's acceleration settle them. What they have seen
tells whether equilibrium is stable (Sylvester's law); where it is not the bond that opens most lets go, and it is seen
whether others hold, as on exact paths.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.engine.bond_company import in_increments
from signorini.engine.bond_tensions import Tensions
from signorini.engine.bond_trial import (
    BACK,
    HOLDS,
    MOST_RESERVE,
    NO_BOND,
    OPENS,
    RESERVE,
    BondIncrement,
    Trial,
    sheared_off,
)
from signorini.engine.closure_solver import ClosureSolver
from signorini.engine.examine import Examined
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.engine.law_solver import CompliantSolver, LawSolver
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.errors import told
from signorini.law.states import OPEN
from signorini.outcome import Outcome

_ROUNDS = 1000
"""States and tensions of bonds that an increment tries at most: a few, and some a bond that opens, are usual."""

_SHARE = 0.01  # of what tensions may lack: what a round may

_NOT_SETTLED = told(
    "no certified equilibrium, and no proof that there is none: bonds go back and forth between holding and opening",
    remedy="smaller increments, a finer mesh, or bonds that take more energy",
    evidence=f"{_ROUNDS} rounds",
)

_LEFT = "bonds let go, and of those that are left and contact"


@dataclass(frozen=True, kw_only=True, eq=False)
class BondSolver(LawSolver):
    """Increments of contact with bonds, through the one door of `ContactSolver`.

    Attributes
    ----------
    bodies : the same, whose pairs are bonded in no way
    labels : (nodes,) numbers of nodes in messages
    normal : (n,) compliance of the interface along its normals, length per force, where it is not its own; and
    rest : (n,) what it has closed without force, length: of closures of other contacts; empty where there are none
    """

    labels: IntArray
    normal: Array = field(default_factory=lambda: np.zeros(0))
    rest: Array = field(default_factory=lambda: np.zeros(0))

    def closing(self, compliance: Array, rest: Array) -> BondSolver:
        """Bodies whose interface closes otherwise along its normals.

        Parameters
        ----------
        compliance, rest : (n,) length per force, and what it has closed without force, length
        """
        return replace(self, normal=compliance, rest=rest)

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment: what bonds do in it, and with what tensions."""
        way = BondIncrement.of(increment, self.active)
        trial, tensions, tried = way.first, Tensions(len(way.asked)), list[MethodRun]()
        near = way.from_state if increment.near is None else increment.near
        for rounds in range(1, _ROUNDS + 1):
            answer, raw = self._on(way, trial, increment, near)
            if not answer.solved and (trial.does == HOLDS).any() and trial.reserve < MOST_RESERVE:
                trial = trial.with_more
                continue
            if not answer.solved:
                return replace(_unproved(answer, trial), trace=(*tried, *answer.trace))
            seen = way.seen(trial, answer, raw)
            sheared = seen.sheared_off
            if sheared.any():
                number = self.labels[increment.system.interface.node[np.flatnonzero(sheared)[0]]]
                trace = (*tried, *answer.trace)
                return replace(answer, outcome=Outcome.NOT_FOUND, message=sheared_off(number), trace=trace)
            following = way.following(trial, seen, tensions)
            if following is None and trial.reserve > RESERVE:
                following = replace(trial, reserve=RESERVE)
            if following is None:
                found = MethodRun(method="bonds", iterations=rounds, end="bonds are on their lines")
                return replace(answer, trace=(*tried, found, *answer.trace), bonds=way.after(trial, answer))
            tried += answer.trace
            trial, near = following, answer
        return replace(answer, outcome=Outcome.NOT_FOUND, message=_NOT_SETTLED, trace=tuple(tried))

    def _on(
        self, way: BondIncrement, trial: Trial, increment: Increment, near: IncrementAnswer
    ) -> tuple[IncrementAnswer, Array]:
        """The increment while bonds do as in a trial, in forces of bonds and law together; and normal ones of the law.

        Parameters
        ----------
        way, trial : what bonds do
        increment : as it was asked
        near : an answer to start from
        """
        system, interface = increment.system, increment.system.interface
        own = interface.compliance[0] if not len(self.normal) else self.normal
        rest = self.rest if len(self.rest) else np.zeros(len(own))
        compliance, pull = own + way.on_line(trial), way.pull(trial)
        posed = replace(interface, friction=interface.friction.bonded(trial.does > NO_BOND, way.sticking(trial)))
        bodies = self.bodies.under(posed, system.scale, np.zeros(len(own), np.bool_))
        offset = increment.offset.copy()
        offset[0] += compliance * pull[0]
        f = increment.f + system.constraints.on_free(interface.on_bodies(pull))
        asked = replace(
            increment,
            system=replace(system, interface=posed),
            f=f,
            offset=offset,
            near=way.posed(trial, near, pull),
            allowed_lack=_SHARE * increment.allowed_lack,
        )
        found = bodies.closing(compliance, rest).solve(asked)
        total = found.forces + pull
        moved, status = found.moved.copy(), found.status.copy()
        slack = (trial.does == BACK) & self.active
        moved[0, slack] = np.maximum(-total[0] * way.on_line(trial), 0.0)[slack]
        status[(trial.does >= BACK)[self.active]] = OPEN
        return replace(found, forces=total, moved=moved, status=status, pull=pull), found.forces[0]


def _unproved(answer: IncrementAnswer, trial: Trial) -> IncrementAnswer:
    """An answer without a solution: nothing is proved of bonds that were taken to hold or to have let go."""
    opened = trial.gone | (trial.does == OPENS)
    if answer.outcome != Outcome.NO_EQUILIBRIUM:
        return answer
    status = Outcome.JUMP if opened.any() else Outcome.NOT_FOUND
    return replace(answer, outcome=status, message=f"{_LEFT}: {answer.message}" if opened.any() else answer.message)


def with_laws(bodies: CondensedSolver | CompliantSolver, examined: Examined) -> ContactSolver:
    """Bodies whose pairs close by a law, or are bonded and not followed on exact paths.

    Parameters
    ----------
    bodies : whose pairs have a compliance each
    examined : the model
    """
    interface, model, found = examined.interface, examined.model, bodies
    exactly = bodies.paths is not None and in_increments(model) is None
    if interface.cohesion is not None and not exactly:
        found = BondSolver(bodies=bodies, labels=model.mesh.labels)
    return found if interface.closure is None else ClosureSolver(bodies=found)
