# SPDX-License-Identifier: BSD-3-Clause
"""What an increment asks of a solver, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.clock import Clock
from signorini.law.cohesion import Bonds
from signorini.outcome import Outcome
from signorini.plasticity.state import PlasticState
from signorini.solution.discrete_model import DiscreteModel
from signorini.solution.state import LoadPoint, State


@dataclass(frozen=True, kw_only=True, eq=False)
class Increment:
    """What an increment asks of a solver.

    Attributes
    ----------
    system : bodies, supports, pairs and sizes of the data
    f : (z,) forces on the free displacements
    offset : (d, n) relative displacements of the pairs that f does not cause: gaps, supports, slips of the past, length
    state : before the increment
    last : the state an increment as long as this one before, where there is one
    start : what a condensed law starts from: states (a,) in the plane, ``r - h`` (3, a) in space; None: as the state is
    near : what bodies a little different answered, to start from before all else
    floating : whether contact alone holds a body
    imposed : (dofs,) displacements that supports impose
    point : of the load history, at its end
    clock : counts the seconds
    allowed_lack : of the sizes of the data, what an answer may lack that others follow
    """

    system: DiscreteModel
    f: Array
    offset: Array
    state: State
    last: State | None = None
    start: Array | IntArray | None = None
    near: IncrementAnswer | None = None
    floating: bool
    imposed: Array
    point: LoadPoint
    clock: Clock
    allowed_lack: float = 0.0


class Mechanism(NamedTuple):
    """A motion in which bodies flow without end.

    Attributes
    ----------
    free : (z,) velocity of the free displacements
    forces : (d, n) of the pairs meanwhile
    """

    free: Array
    forces: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class IncrementAnswer:
    """What a solver answers.

    Attributes
    ----------
    outcome, message : how it ended, in one word and in words
    forces, moved : (d, n) forces of the pairs; gaps, length, and slip increments of those that the law is asked of
    free : (z,) free displacements
    status : (a,) codes of :mod:`signorini.law.states`, of the pairs that the law is asked of
    trace : the methods tried, in order
    lost : by how much motions of the pairs differ from those of the bodies, length: digits that are lost
    escape : (k,) combination of the floating motions along which bodies leave, where it is known
    plastic : what the points of bodies that yield remember at the end
    mechanisms : velocities of the bodies where plastic flow runs away; every one may bound the load
    pull : (d, n) of the forces, those of bonds beside what the law of contact bears; None where no pair is bonded
    bonds : what bonds remember at the end; None where no pair is bonded
    """

    outcome: Outcome
    message: str
    forces: Array
    moved: Array
    free: Array
    status: IntArray
    trace: tuple[MethodRun, ...]
    lost: float = 0.0
    escape: Array | None = None
    plastic: PlasticState | None = None
    mechanisms: tuple[Mechanism, ...] = ()
    pull: Array | None = None
    bonds: Bonds | None = None

    @property
    def solved(self) -> bool:
        """Whether a solution was found; the certificate is measured by who asked."""
        return self.outcome == Outcome.SOLVED
