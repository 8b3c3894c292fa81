# SPDX-License-Identifier: BSD-3-Clause
"""Increments of bodies that yield: contact is solved exactly on the bodies linearised about the last answer.

With ``K u = f + B^T r + f_p(u)`` and the tangent ``K_T = K - S`` every round solves the problem of contact

    K_T u = f + B^T r + x,      x = f_p(u_k) - S u_k,

on the bodies as they are now. The elastic bodies come first, whose factor is there. A round whose factor is kept is a
fixed-point iteration on x, accelerated by Anderson's method; a new tangent makes it Newton's.

References
----------
Hager, Wohlmuth (2009), Nonlinear complementarity functions for plasticity problems with frictional contact, Comput.
Methods Appl. Mech. Eng. 198:3411. Walker, Ni (2011), Anderson acceleration for fixed-point iterations, SIAM J. Numer.
Anal. 49:1715.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.attempt import MethodRun
from signorini.condense.condensed import Condensed
from signorini.engine.increment import Increment, IncrementAnswer, Mechanism
from signorini.engine.plastic_rounds import Rounds
from signorini.engine.plastic_search import LineSearch
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.engine.tangent_bodies import TangentBodies
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.linalg.protocol import NotPositiveDefinite
from signorini.outcome import Outcome
from signorini.plasticity.bodies import PlasticResponse
from signorini.plasticity.measure import plastic_work, stored_by_back_stresses
from signorini.plasticity.state import PlasticState
from signorini.solution.scale import Scale

_BALANCED = 1e-9  # of the size of forces: a tenth of what the certificate allows
_FITTING = 3e-9  # of the length of the data: by which pairs and bodies may part; beyond it the tangent is too soft
_LACK_IN_ROUNDS = (
    1e-3  # of what the round before lacks: so much contact may lack in a round, the next one makes it anew
)
_MAX_ROUNDS = 200  # of one increment: Newton takes 4 to 16, kept factors some 40
_LEFT_PARTS = (0.0, 1e-6, 1e-4, 1e-2)  # of the elastic law, left in place where a tangent is singular without it
_STIFFER_PARTS = (1e-4, 0.1)  # of the elastic law, left in place where contact finds no answer on a softer tangent
_SEARCH_FROM = 0.5  # of the residual before: a step that leaves more is looked at
_KEPT_TANGENTS = 3  # that are kept for more rounds: near the limit load they lead astray, and Newton's method does not
_SUBSTITUTION = 40.0  # operations that take as long as to move an entry of the factor through memory in one round
_FLOWING = 30.0  # of the first, elastic step: longer ones, again and again, are bodies that flow away
_MAX_LEAP = 10.0  # of how far bodies have moved: a longer step is cut, a soft tangent knows no better
_MAX_LENGTHS = 1e7  # of the length of the data: beyond that arithmetic spoils the mechanism


@dataclass(frozen=True, kw_only=True, eq=False)
class _Tangent:
    """Bodies as they are solved in a round.

    Attributes
    ----------
    solver : of contact on them
    K : (dofs, dofs) their stiffness
    S : (dofs, dofs) what yielding takes off the elastic stiffness; None: nothing
    left : part of the elastic law that yielding leaves in place
    """

    solver: ContactSolver
    K: sp.csr_array
    S: sp.csr_array | None = None
    left: float = 1.0


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticSolver:
    """Contact of bodies of which some yield, through the one door of `ContactSolver`.

    Attributes
    ----------
    elastic : the same bodies before anything yields
    tangents : makes bodies that have yielded
    interface, scale, absent : of the moment
    ways : (k, m) combinations of the floating motions that occur, where some bodies rest; None: all of them
    """

    elastic: ContactSolver
    tangents: TangentBodies
    interface: Interface
    scale: Scale
    absent: BoolArray
    ways: Array | None = None

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.elastic.name

    @property
    def active(self) -> BoolArray:
        """(n,) Pairs that the law is asked of."""
        return self.elastic.active

    @property
    def held(self) -> BoolArray:
        """(n,) Pairs that supports hold on both sides."""
        return self.elastic.held

    @property
    def paths(self) -> CondensedSolver | None:
        """What follows paths along which nothing yields."""
        return self.elastic.paths

    @property
    def condensed(self) -> Condensed | None:
        """The interface as the bodies feel it before any of them yields."""
        return self.elastic.condensed

    def under(self, interface: Interface, scale: Scale, absent: BoolArray) -> PlasticSolver:
        """Bodies under another law, see `ContactSolver.under`.

        Parameters
        ----------
        interface, scale : friction, gaps and sizes of the data of the moment
        absent : (n,) pairs that are switched off
        """
        elastic = self.elastic.under(interface, scale, absent)
        return replace(self, elastic=elastic, interface=interface, scale=scale, absent=absent)

    def paired(self, elastic: CondensedSolver, interface: Interface) -> PlasticSolver:
        """Bodies with other pairs, of sides that have slid.

        Parameters
        ----------
        elastic : the same bodies with these pairs before anything yields
        interface : with as many pairs, in the same order
        """
        paired = self.elastic.paired(elastic, interface)
        return replace(self, elastic=paired, tangents=self.tangents.paired(interface), interface=interface)

    def moving(self, ways: Array, interface: Interface, scale: Scale) -> PlasticSolver:
        """Bodies of which some rest, see `ContactSolver.moving`.

        Parameters
        ----------
        ways : (k, m) the combinations of floating motions that occur
        interface, scale : as of `under`
        """
        elastic = self.elastic.moving(ways, interface, scale)
        return replace(self, elastic=elastic, interface=interface, scale=scale, ways=ways)

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment by backward Euler, contact and flow rule at its end."""
        rounds, system, bodies = Rounds(), increment.system, self.tangents.yielding
        T, state = system.constraints.transform, increment.state
        old = bodies.untouched() if state.plastic is None else state.plastic
        heat = bodies.heat(increment.point.factors)
        scale = 1.0 / np.sqrt(np.maximum(self.tangents.diagonal, np.finfo(np.float64).tiny))
        tangent = _Tangent(solver=self.elastic, K=system.K)
        model, x = bodies.at_rest(state.displacement, old, heat), system.constraints.on_free(old.forces)
        reached: tuple[IncrementAnswer, PlasticResponse] | None = None
        while True:
            answer, tangent, x = self._contact(increment, tangent, x, rounds, model, reached)
            if not answer.solved:  # on bodies that flow away contact may be lost before they have gone far
                return replace(answer, mechanisms=rounds.mechanisms)
            with increment.clock.phase("plasticity"):
                after = bodies.respond(T @ answer.free + increment.imposed, old, heat)
                linear = after
                left = self._left(increment, answer, after)
                lack, step = self._lack(left), 1.0
                if reached is not None:
                    way = LineSearch(bodies=bodies, increment=increment, old=old, heat=heat, one=reached[0], two=answer)
                    most = _MAX_LEAP * max(rounds.lengths[0], float(np.abs(reached[0].free).max(initial=0.0)))
                    if way.length > most:
                        step, answer, after = way.cut(most / way.length)
                    elif not rounds.inputs and lack > max(_BALANCED, _SEARCH_FROM * rounds.last):
                        step, answer, after = way.shortened(reached[1], after)
                    left = left if step == 1.0 else self._left(increment, answer, after)
                    lack = lack if step == 1.0 else self._lack(left)
                before = state.displacement[system.constraints.leaders] if reached is None else reached[0].free
            kept = rounds.last
            rounds.add(lack, left, step, Mechanism(answer.free - before, answer.forces))
            asked = _LACK_IN_ROUNDS * kept <= _BALANCED or len(rounds.steps) == 1  # of contact for all its digits
            parted = answer.lost > _FITTING * self.scale.length
            softest = tangent.S is not None and not rounds.least
            far = float(np.abs(answer.free).max(initial=0.0))
            balanced = step == 1.0 and lack <= _BALANCED and rounds.near(far, _BALANCED)
            if balanced and (not parted or (asked and not softest)):
                return self._settled(increment, old, answer, after, rounds)
            lost = not np.isfinite(lack) or far > _MAX_LENGTHS * self.scale.length
            if rounds.ran_away(_FLOWING) or lost or len(rounds.steps) >= _MAX_ROUNDS:
                words = f"plastic flow did not settle in {len(rounds.steps)} rounds ({lack:.1e} of the forces left)"
                return replace(answer, outcome=Outcome.NOT_FOUND, message=words, mechanisms=rounds.mechanisms)
            reached = answer, after
            stiffer = balanced and asked
            if stiffer:
                rounds.least = _STIFFER_PARTS[0]
            if stiffer or step < 1.0 or self._pays(tangent, rounds):
                del tangent  # one factor less while the next is made
                with increment.clock.phase("plasticity"):
                    model = after = bodies.with_dual(after, old, heat, model=model, reached=linear)
                tangent, reached = self._softened(after, increment, rounds), (answer, after)
                x = self._right(after, tangent, answer, system.constraints)
                rounds.inputs, rounds.outputs = [], []
            else:
                x = rounds.accelerated(x, self._right(after, tangent, answer, system.constraints), scale)

    def _settled(
        self,
        increment: Increment,
        old: PlasticState,
        answer: IncrementAnswer,
        after: PlasticResponse,
        rounds: Rounds,
    ) -> IncrementAnswer:
        """The last answer with what points of yielding bodies remember, and the work that they have taken."""
        bodies, state = self.tangents.yielding, increment.state
        u = increment.system.constraints.transform @ answer.free + increment.imposed
        heat = bodies.heat(state.point.factors), bodies.heat(increment.point.factors)
        work = plastic_work(bodies, (state.displacement, old), (u, after.state), heat)
        run = MethodRun(method="plastic flow", iterations=len(rounds.steps), end="balanced")
        stored = stored_by_back_stresses(bodies, after.state)
        new = replace(after.state, dissipation=old.dissipation + work, stored=stored)
        return replace(answer, plastic=new, trace=(*answer.trace, run))

    def _right(
        self, after: PlasticResponse, tangent: _Tangent, answer: IncrementAnswer, constraints: Constraints
    ) -> Array:
        """x = f_p - S u, (z,), at an answer."""
        forces = after.state.forces
        if tangent.S is not None:
            forces = forces - tangent.S @ (constraints.transform @ answer.free)
        return constraints.on_free(forces)

    def _left(self, increment: Increment, answer: IncrementAnswer, after: PlasticResponse) -> Array:
        """(z,) What equilibrium lacks at an answer, force."""
        system, T = increment.system, increment.system.constraints.transform
        forces = after.state.forces + system.interface.on_bodies(answer.forces) - system.K @ (T @ answer.free)
        return increment.f + system.constraints.on_free(forces)

    def _lack(self, left: Array) -> float:
        """What equilibrium lacks, (z,), of the size of the forces."""
        return float(np.abs(left).max(initial=0.0)) / self.scale.force

    def _pays(self, tangent: _Tangent, rounds: Rounds) -> bool:
        """Whether a new tangent is worth its factorisation."""
        if rounds.gained():
            return False
        if rounds.factorisations >= _KEPT_TANGENTS:
            return True
        share = self.tangents.substitution_share(tangent.solver, _SUBSTITUTION)
        return share is None or not rounds.gains(share)

    def _softened(
        self, at: PlasticResponse, increment: Increment, rounds: Rounds, left: tuple[float, ...] = _LEFT_PARTS
    ) -> _Tangent:
        """Bodies linearised about a response, as soft as they are or as contact bears it."""
        for part in left:
            if part < rounds.least:
                continue
            try:
                return self._made(at, part, increment, rounds)
            except (NotPositiveDefinite, np.linalg.LinAlgError):
                continue
        return _Tangent(solver=self.elastic, K=increment.system.K)

    def _made(self, at: PlasticResponse, left: float, increment: Increment, rounds: Rounds) -> _Tangent:
        """Bodies linearised about a response, factorised."""
        rounds.factorisations += 1
        with increment.clock.phase("assembly"):
            S, K, reduced = self.tangents.softened(at, left)
        solver = self.tangents.solver(reduced, increment.clock).under(self.interface, self.scale, self.absent)
        if self.ways is not None and solver.paths is not None:
            solver = solver.paths.moving(self.ways, self.interface, self.scale)
        return _Tangent(solver=solver, K=K, S=S, left=left)

    def _contact(
        self,
        increment: Increment,
        tangent: _Tangent,
        x: Array,
        rounds: Rounds,
        model: PlasticResponse,
        reached: tuple[IncrementAnswer, PlasticResponse] | None,
    ) -> tuple[IncrementAnswer, _Tangent, Array]:
        """Contact on the bodies of a round; on stiffer ones where that finds no answer, at last on the elastic ones."""
        if reached is None:
            return self._on(increment, tangent, x, None), tangent, x
        increment = replace(increment, allowed_lack=_LACK_IN_ROUNDS * rounds.last)
        answer = self._on(increment, tangent, x, reached[0])
        if answer.solved or tangent.S is None or rounds.flow_away(_FLOWING):
            return answer, tangent, x
        rounds.least = _STIFFER_PARTS[0]
        for part in (*(part for part in _STIFFER_PARTS if part > tangent.left), 1.0):
            other = self._softened(model, increment, rounds, (part,) if part < 1.0 else ())
            y = self._right(reached[1], other, reached[0], increment.system.constraints)
            answer = self._on(increment, other, y, None)
            if answer.solved:
                return answer, other, y
        return answer, tangent, x

    def _on(self, increment: Increment, tangent: _Tangent, x: Array, near: IncrementAnswer | None) -> IncrementAnswer:
        system = replace(increment.system, K=tangent.K)
        return tangent.solver.solve(replace(increment, system=system, f=increment.f + x, near=near))
