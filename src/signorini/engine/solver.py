# SPDX-License-Identifier: BSD-3-Clause
"""The one door to what solves increments of contact, and the way through it that is taken where it fits in memory.

`ContactSolver` is the door. `CondensedSolver` condenses the bodies and follows paths from event to event too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol, Self

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import Spent
from signorini.condense.condensed import Condensed
from signorini.engine.increment import Increment, IncrementAnswer
from signorini.fem.internal_forces import internal_forces
from signorini.friction.history import Landing, PathSettings, PathState, Segment, follow, land
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.interface.interface import Interface
from signorini.law.bound import Bound
from signorini.law.result import ContactAnswer
from signorini.outcome import Outcome
from signorini.settings import SolverSettings
from signorini.solution.scale import Scale

_BALANCED = 1e-10  # of the sizes of the data: what equilibrium may lack before it is refined
_REFINEMENTS = 2
_SETTLING = 10  # refinements in all, while rounding that bends slender bodies still changes which pairs touch
_MOST_ALLOWED = 1e-3  # of the data of the law: what answers that others follow may lack at most
_ROUNDED_TOLERANCES = (
    10.0  # of the tolerance of the law: as many times may rounding leave where no method ends below it
)
_LENGTH_PER_GAP = 1e-4  # of the largest gap or displacement: times the law's tolerance, 1e-10, a few roundings of it


class ContactSolver(Protocol):
    """Bodies and their contact pairs, made ready once for every load."""

    @property
    def name(self) -> str:
        """Of the back end, for reports."""

    @property
    def active(self) -> BoolArray:
        """(n,) Pairs that the law of contact is asked of."""

    @property
    def held(self) -> BoolArray:
        """(n,) Pairs that supports hold on both sides."""

    @property
    def paths(self) -> CondensedSolver | None:
        """What follows paths from event to event; None where nothing is condensed, or lines of closures are sought."""

    @property
    def condensed(self) -> Condensed | None:
        """The interface as the bodies feel it; None where nothing is condensed."""

    @property
    def elastic(self) -> ContactSolver:
        """Of the same bodies before any of them yields."""

    def under(self, interface: Interface, scale: Scale, absent: BoolArray) -> Self:
        """Bodies as they are under another law, without pairs that are switched off; nothing is factorised again.

        Parameters
        ----------
        interface : with the friction of the moment
        scale : sizes of the data
        absent : (n,) pairs that are switched off

        Raises
        ------
        LinAlgError
            If the pairs that are left do not hold the bodies.
        """

    def moving(self, ways: Array, interface: Interface, scale: Scale) -> Self:
        """Bodies of whose k rigid motions only some combinations occur: springs hold the others, where it is condensed.

        Parameters
        ----------
        ways : (k, m) the combinations
        interface, scale : as of `under`
        """

    def paired(self, elastic: CondensedSolver, interface: Interface) -> ContactSolver:
        """Bodies with other pairs, of sides that have slid.

        Parameters
        ----------
        elastic : the same bodies with these pairs, before any of them yields
        interface : with as many pairs, in the same order
        """

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedSolver:
    """The law of contact on the condensed interface.

    Attributes
    ----------
    condensed : the interface as the bodies feel it
    law : of the active pairs, without load, in the scaled units of `Condensed`
    settings : limits of the methods
    rest : (n,) what the interface has closed without force, length; None for nothing
    """

    condensed: Condensed
    law: ContactProblem
    settings: SolverSettings
    rest: Array | None = None

    @staticmethod
    def of(condensed: Condensed, interface: Interface, scale: Scale, settings: SolverSettings) -> CondensedSolver:
        """The law of the active pairs, with no load yet.

        Parameters
        ----------
        condensed : the interface as the bodies feel it
        interface : the n pairs and their friction
        scale : sizes of the data
        settings : limits of the methods
        """
        data = _friction(condensed, interface)
        law = ContactProblem(
            image=condensed.image,
            b=np.zeros(condensed.compliance.size),
            scale=_size(condensed, interface, scale),
            **data,
        )
        return CondensedSolver(condensed=condensed, law=law, settings=settings)

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.condensed.name

    @property
    def active(self) -> BoolArray:
        """(n,) Pairs that the law is asked of."""
        return self.condensed.active

    @property
    def held(self) -> BoolArray:
        """(n,) Pairs that supports hold on both sides."""
        return self.condensed.held

    @property
    def paths(self) -> CondensedSolver:
        """Itself."""
        return self

    @property
    def elastic(self) -> CondensedSolver:
        """Itself."""
        return self

    def under(self, interface: Interface, scale: Scale, absent: BoolArray) -> CondensedSolver:
        """Bodies under another law, see `ContactSolver.under`; the law shares what it has computed.

        Parameters
        ----------
        interface, scale : friction, gaps and sizes of the data of the moment
        absent : (n,) pairs that are switched off
        """
        if absent.any():
            return CondensedSolver.of(self.condensed.among(~absent), interface, scale, self.settings)
        size = _size(self.condensed, interface, scale)
        return replace(self, law=replace(self.law, scale=size, **_friction(self.condensed, interface)))

    def moving(self, ways: Array, interface: Interface, scale: Scale) -> CondensedSolver:
        """Bodies of which some rest, see `ContactSolver.moving`.

        Parameters
        ----------
        ways : (k, m) combinations of the rigid motions
        interface, scale : as of `of`
        """
        return CondensedSolver.of(self.condensed.moving(ways), interface, scale, self.settings)

    def solve(self, increment: Increment) -> IncrementAnswer:
        """Solve one increment.

        What equilibrium and the motions of the pairs lack in the end, on the problem as posed, is added to the
        condensed problem, and what that changes to the displacements: it was condensed with rounding, which gaps far
        larger than what the loads move (an arc that leaves its foundation) and thin bodies magnify, whose loads alone
        would bend them far. Their forces are then those of all digits of the displacements.
        """
        condensed, law, system, f = self.condensed, self.law, increment.system, increment.f
        offset, interface, scale = self.rested(increment.offset), system.interface, system.scale
        own, constraints, ties = np.flatnonzero(condensed.active), system.constraints, condensed.ties
        forces, moved, free = np.zeros_like(offset), np.zeros_like(offset), np.zeros_like(f)
        residual, misfit, b, lost = f, offset[:, own], np.zeros(len(law.b)), 0.0
        start = self._start(increment)
        allowed = self._allowed(increment.allowed_lack, scale)
        for step in range(_SETTLING + 1):
            with increment.clock.phase("complementarity"):
                reduced = condensed.reduce(residual)
                b = b + condensed.right_hand_side(reduced.load, misfit)
                result = self._in_law(b, start, allowed)
            if not result.solved:
                break
            with increment.clock.phase("recovery"):
                before = moved[:, own], forces[:, own]
                forces[:, own] = condensed.root * result.r
                moved[:, own] = result.h / condensed.root
                free = free + condensed.displacement(
                    reduced, moved[:, own] - before[0], forces[:, own] - before[1], misfit
                )
                u = constraints.displaced(free)
                if ties is not None:
                    ties.give(forces, 0.0)
                internal = internal_forces(system.K, u) if step else system.K @ u
                residual = f + constraints.on_free(system.pushed(forces) - internal)
                if ties is not None:
                    tied = ties.forces(residual)
                    ties.give(forces, tied)
                    residual = residual + constraints.spread_free(*ties.pushes(tied))
                misfit = (offset + interface.motion(u) - moved)[:, own] + condensed.compliance * forces[:, own]
                misfit[1:][law.locked] = 0.0
            lost = float(np.abs(misfit).max(initial=0.0))
            lack = np.abs(residual).max(initial=0.0) / scale.force if step < _REFINEMENTS else 0.0
            if max(lack, lost / scale.length) <= max(_BALANCED, increment.allowed_lack):
                break
            start = result.state if law.piecewise_linear else result.y
        return IncrementAnswer(
            outcome=result.outcome,
            message=result.message,
            forces=forces,
            moved=moved,
            free=free,
            status=result.state,
            trace=result.trace,
            lost=lost,
            escape=None if result.escape is None or not law.floating else self.floating(result.escape),
        )

    def paired(self, elastic: CondensedSolver, interface: Interface) -> CondensedSolver:  # noqa: ARG002
        """Bodies with other pairs, see `ContactSolver.paired`: those are they.

        Parameters
        ----------
        elastic : the same bodies with these pairs
        interface : not looked at
        """
        return elastic

    def closing(self, compliance: Array, rest: Array) -> CondensedSolver:
        """Bodies whose interface closes otherwise along its normals; nothing is factorised again.

        Parameters
        ----------
        compliance, rest : (n,) length per force, and what it has closed without force, length
        """
        condensed = self.condensed.closing(compliance[self.active])
        return replace(self, condensed=condensed, law=replace(self.law, image=condensed.image), rest=rest)

    def rested(self, offset: Array) -> Array:
        """(d, n) Motions of the pairs that loads do not cause, and what the interface has closed without force."""
        return offset if self.rest is None else np.concatenate([offset[:1] + self.rest, offset[1:]])

    def _allowed(self, lack: float, scale: Scale) -> float:
        """Residual of the law where forces and motions of the pairs lack a part of the sizes of the data."""
        if not lack or not self.law.scale or not self.law.pairs:
            return 0.0
        root = self.condensed.root
        size = min(scale.force / float(root.max(initial=0.0)), scale.length * float(root.min(initial=np.inf)))
        return min(lack * size / self.law.scale, _MOST_ALLOWED)

    def floating(self, escape: Array) -> Array:
        """(k,) The combination of floating motions that a motion of the pairs (d a,) is."""
        return np.asarray(np.linalg.lstsq(self.law.motions, escape, rcond=None)[0], dtype=np.float64)

    def _in_law(self, b: Array, start: Array | IntArray | None, allowed: float) -> ContactAnswer:
        """The answer of the law under a load (d a,); parameters as of `solve_contact`.

        Where rounding of thin bodies keeps every method a little above the tolerance that will do: what is posed tells.
        """
        law = replace(self.law, b=b)
        result = solve_contact(law, start, settings=self.settings, allowed=allowed)
        if result.outcome is Outcome.NOT_FOUND and result.residual <= _ROUNDED_TOLERANCES * self.settings.tolerance:
            return solve_contact(
                law, start, settings=self.settings, allowed=_ROUNDED_TOLERANCES * self.settings.tolerance
            )
        return result

    def _start(self, increment: Increment) -> Array | IntArray | None:
        """What the law's solver starts from: states of the pairs, in space their ``y = r - h``; None at rest."""
        state, near, law = increment.state, increment.near, self.law
        if near is None and (increment.start is not None or not state.forces.any()):
            return increment.start
        root, active = self.condensed.root, self.condensed.active
        r = (state if near is None else near).forces[:, active] / root
        if law.piecewise_linear:
            return law.pieces.coded(state.status[active] if near is None else near.status, r[0])
        still = np.concatenate([state.gap[None], np.zeros_like(state.tangential)])
        start: Array = r - root * (still if near is None else near.moved)[:, active]
        return start

    def follow(self, start: PathState, b: Array, stops: PathSettings | None, tell: Callable[[float], None]) -> Segment:
        """Follow the load of the law straight to another.

        Parameters
        ----------
        start : where the history stands
        b : (d a,) load at the end
        stops : how increments are chosen in space; None: event by event
        tell : is called with the part that is behind
        """
        return follow(self.law, start, b, settings=stops or self._stops, tell=tell)

    @property
    def _stops(self) -> PathSettings:
        """Every event ends an increment."""
        return PathSettings(solver=self.settings)

    def land(self, start: PathState, segment: Segment, stops: PathSettings | None) -> Landing | Spent | None:
        """Where a jump at the end of a segment lands; where that is not found, why if it is known.

        Parameters
        ----------
        start : where the segment began
        segment : as far as it was followed
        stops : as of `follow`
        """
        return land(self.law, start, segment, settings=stops or self._stops)


def _friction(condensed: Condensed, interface: Interface) -> dict[str, Any]:
    """The friction of the active pairs as the laws take it, forces scaled."""
    active = condensed.active
    posed = interface.friction.among(active).posed(interface.area[active] / condensed.root)
    if interface.directions == 2:
        return posed
    axes, of_bound = interface.anisotropy[active].T, isinstance(posed["friction"], Bound)
    if not active.any():
        posed["friction"] = np.zeros((interface.directions - 1, 0))  # tells a law without pairs its directions
    elif not of_bound:
        posed["friction"] = posed["friction"] * axes
    return posed | {"facets": interface.facets[active], "axes": axes if of_bound and active.any() else None}


def _size(condensed: Condensed, interface: Interface, scale: Scale) -> float:
    """Of the right-hand side of the law: what compresses, for forces to have their digits.

    Gaps far larger than that, and displacements of what bends, leave their rounding in it.
    """
    return compression(interface, scale, condensed.active) * (float(condensed.root.max(initial=0.0)) or 1.0)


def compression(interface: Interface, scale: Scale, active: BoolArray) -> float:
    """How far loads move pairs by compressing bodies, length, no less than the digits of all that pairs are moved by.

    Parameters
    ----------
    interface, scale : gaps and sizes of the data of the moment
    active : (n,) pairs that the law is asked of
    """
    gap = float(np.abs(interface.gap[active]).max(initial=0.0))
    return max(scale.compressed, _LENGTH_PER_GAP * max(gap, scale.length))
