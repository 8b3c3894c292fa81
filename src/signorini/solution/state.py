# SPDX-License-Identifier: BSD-3-Clause
"""The state of all bodies at one instant of the load history."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from signorini.arrays import Array, IntArray, elsewhere, operand
from signorini.interface.interface import Interface
from signorini.law.closure import Borne
from signorini.law.cohesion import Bonds
from signorini.law.states import OPEN
from signorini.plasticity.measure import heat_work
from signorini.plasticity.state import PlasticState
from signorini.short import Short
from signorini.solution.discrete_model import DiscreteModel
from signorini.solution.wear_state import WearState


@elsewhere("reaction", "offset")
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LoadPoint(Short):
    """A point of the load history: everything that is imposed. Between two of them all of it changes linearly.

    Attributes
    ----------
    factors : load factors by name
    gap : (n,) initial gaps, with the interferences of the moment
    given : (d, n) forces of pairs whose contact is switched off, on their way to zero; 0 elsewhere
    reaction : (dofs,) forces of supports that let go, on their way to zero; empty where none ever did
    offset : (dofs,) displacements beyond what supports prescribe, of those that hold again; empty where none ever did
    pull : (d, n) forces with which bonds hold beside what the law of contact bears; None where no pair is bonded
    """

    factors: Mapping[str, float]
    gap: Array
    given: Array
    reaction: Array = field(default_factory=lambda: np.zeros(0))
    offset: Array = field(default_factory=lambda: np.zeros(0))
    pull: Array | None = None

    @property
    def left(self) -> tuple[Any, Any]:
        """(dofs,) Reaction and offset to be computed with, on ranks where they are there; empty where none ever was."""
        return operand(self, "reaction"), operand(self, "offset")

    def changed(self, **data: Any) -> LoadPoint:
        """With other data; arrays that ranks have stay there."""
        reaction, offset = self.left
        return replace(self, **{"reaction": reaction, "offset": offset} | data)

    def towards(self, end: LoadPoint, t: float) -> LoadPoint:
        """The point at the part t of the way to another."""
        if t == 1.0:
            return end
        (reaction, offset), (last, beyond) = self.left, end.left
        pull = None if self.pull is None or end.pull is None else (1.0 - t) * self.pull + t * end.pull
        factors = {name: (1.0 - t) * self.factors.get(name, 0.0) + t * value for name, value in end.factors.items()}
        return LoadPoint(
            factors=MappingProxyType(factors),
            gap=(1.0 - t) * self.gap + t * end.gap,
            given=(1.0 - t) * self.given + t * end.given,
            reaction=(1.0 - t) * reaction + t * last,
            offset=(1.0 - t) * offset + t * beyond,
            pull=pull,
        )


@elsewhere("displacement", "external")
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class State(Short):
    """Displacements, forces and what friction remembers.

    Attributes
    ----------
    point : of the load history
    displacement : (dofs,) length
    external : (dofs,) loads, reactions of supports and forces inside rigid boundaries, rigid bodies and equations
    forces : (d, n) of the pairs on the nonmortar body: normal (pressing > 0), then tangential
    gap : (n,) of the contact law, 0 where closed
    tangential : (d - 1, n) tangential displacement of the contact law, length: where the next slip increment starts
    increment : (d - 1, n) slip increment of the last increment
    slip : (d - 1, n) accumulated while closed
    status : (n,) codes of :mod:`signorini.law.states`
    work : of loads, moving supports and interferences since the beginning
    dissipation : (n,) frictional dissipation since the beginning
    released : energy set free at once since the beginning: in jumps, by changes of the law, by contacts switched off
    plastic : what the points of the bodies remember of plastic flow; None where no body yields
    wear : what the sides have lost by wear; None where none wears
    borne : what closures remember that do not spring back along their lines; None where none does so
    bonds : what bonds remember; None where no pair is bonded
    """

    point: LoadPoint
    displacement: Array
    external: Array
    forces: Array
    gap: Array
    tangential: Array
    increment: Array
    slip: Array
    status: IntArray
    work: float
    dissipation: Array
    released: float
    plastic: PlasticState | None = None
    wear: WearState | None = None
    borne: Borne | None = None
    bonds: Bonds | None = None

    def at_hand(self) -> State:
        """This state with what ranks keep of it here, where they do not compute with it: a history goes on from it."""
        return self.changed()

    @property
    def nodal(self) -> tuple[Any, Any]:
        """(dofs,) Displacement and external forces to be computed with, on ranks where they are there."""
        return operand(self, "displacement"), operand(self, "external")

    def changed(self, **data: Any) -> State:
        """With other data; arrays that ranks have stay there."""
        displacement, external = self.nodal
        return replace(self, **{"displacement": displacement, "external": external} | data)

    @property
    def motion(self) -> Array:
        """(d, n) Motions of the pairs in the contact law since the beginning: gaps and tangential displacements."""
        return np.concatenate([self.gap[None], self.tangential])

    @property
    def dissipated(self) -> Array:
        """(n,) By the friction of the pairs, and by what lies between them, since the beginning."""
        return sum((memory.taken for memory in self._memories), self.dissipation)

    @property
    def closing_work(self) -> float:
        """Energy that bonds and closures which do not spring back have taken, since the beginning."""
        return sum(float(memory.taken.sum()) for memory in self._memories)

    @property
    def _memories(self) -> tuple[Borne | Bonds, ...]:
        return tuple(memory for memory in (self.borne, self.bonds) if memory is not None)

    @property
    def plastic_work(self) -> float:
        """Since the beginning; 0 where no body yields."""
        return 0.0 if self.plastic is None else self.plastic.dissipation


def initial_state(factors: Mapping[str, float], zeros: Array, interface: Interface) -> State:
    """Nothing has moved, and overlaps have not pressed yet.

    Parameters
    ----------
    factors : load factors by name
    zeros : (dofs,) zeros, see `Constraints.zeros`
    interface : the n pairs
    """
    n, d, gap = len(interface), interface.directions, interface.gap
    still = np.zeros((d - 1, n))
    return State(
        point=LoadPoint(factors=MappingProxyType(dict(factors)), gap=gap, given=np.zeros((d, n))),
        displacement=zeros,
        external=zeros,
        forces=np.zeros((d, n)),
        gap=gap,
        tangential=still,
        increment=still,
        slip=still,
        status=np.zeros(n, np.int64),
        work=0.0,
        dissipation=np.zeros(n),
        released=0.0,
        bonds=None if interface.cohesion is None else interface.cohesion.unharmed,
    )


def next_state(
    system: DiscreteModel,
    state: State,
    *,
    point: LoadPoint,
    loads: Array,
    displacement: Array,
    forces: Array,
    moved: Array,
    status: IntArray,
    plastic: PlasticState | None = None,
) -> State:
    """The state after an increment, with the work and the dissipation in between.

    Parameters
    ----------
    system : the problem as posed
    state : before the increment
    point : of the load history, at the end of the increment
    loads, displacement : (dofs,) nodal forces and displacements there
    forces, moved : (d, n) forces of the pairs; gaps and slip increments
    status : (n,) codes of the pairs
    plastic : of the points, where plastic flow has changed it

    Notes
    -----
    Work is trapezoidal in time, that of interferences included; dissipation is that of the forces at the end.
    """
    interface, (last, pressed) = system.interface, state.nodal
    plastic = state.plastic if plastic is None else plastic
    inner = system.K @ displacement - system.pushed(forces)
    if plastic is not None:
        inner -= plastic.forces
    # the loads where a displacement is free on its own, whatever equilibrium takes where it is held, tied or linked
    external = np.where(system.constraints.alone, loads, inner)
    increment, parted = moved[1:], status == OPEN
    work = 0.5 * (pressed + external) @ (displacement - last)
    work -= 0.5 * (state.forces + forces)[0] @ (point.gap - state.point.gap)
    bodies = system.yielding
    if bodies is not None and bodies.heat_works and state.plastic is not None and plastic is not None:
        heat = bodies.heat(state.point.factors), bodies.heat(point.factors)
        work += heat_work(bodies, (state.plastic, heat[0]), (plastic, heat[1]))
    spent = (forces[1:] * increment).sum(axis=0)
    taken = 0.5 * np.vdot(state.point.given + point.given, interface.motion(displacement - last))
    return State(
        point=point,
        displacement=displacement,
        external=external,
        forces=forces,
        gap=moved[0],
        tangential=state.tangential + increment,
        increment=increment,
        slip=state.slip + np.where(parted, 0.0, increment),
        status=status,
        work=state.work + float(work),
        dissipation=state.dissipation + np.where(parted, 0.0, np.maximum(-spent, 0.0)),
        released=state.released - float(taken),
        plastic=plastic,
        wear=state.wear,
        borne=interface.borne_after(state.borne, forces),
        bonds=interface.bonds_after(state.bonds, moved[0]),
    )


def wear_of(state: State) -> WearState:
    """What the sides have lost in a state of a model that wears."""
    assert state.wear is not None
    return state.wear
