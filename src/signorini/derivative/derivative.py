# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of a history: of one output by everything that is given, and of everything by one parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array
from signorini.derivative.adjoint import adjoint_of
from signorini.derivative.body_changes import BodyChange
from signorini.derivative.by_name import ByName
from signorini.derivative.changes import ChangeWithLocks, LoadChange, LockChange
from signorini.derivative.direct_changes import pulled_by, read_otherwise
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.functionals import value
from signorini.derivative.moduli import ModulusChange
from signorini.derivative.modulus_pairs import ModulusPairs
from signorini.derivative.node_gradient import node_gradient
from signorini.derivative.one_sided import beyond
from signorini.derivative.parameters import change_of, names_of, split
from signorini.derivative.points import TapePoint, tape_points
from signorini.derivative.recursion import Change, PointChange, changed, forward
from signorini.derivative.refusals import refuse_tape
from signorini.derivative.shape_sides import ShapeSides
from signorini.derivative.touching_start import GapRate, TouchingStart
from signorini.derivative.validity import PathEdge, edges, validity
from signorini.derivative.view import HistoryView
from signorini.engine.prepare import Prepared
from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.model.outputs import Displacement, Output
from signorini.solution.sensitivities import Validity

_SAME_CONDITION = 1e-12  # of the data of the law: by how much conditions differ between bodies that are the same
_TWO_SIDES = 1e-6  # of a derivative: what those to both sides may differ by and still be the same up to differences


class TapedHistory:
    """A history with all that its derivatives go through.

    Parameters
    ----------
    tape : of the history
    model : that was solved

    Raises
    ------
    InputError
        Where the history goes through what derivatives do not know, by name.
    """

    def __init__(self, tape: Tape, model: Model) -> None:
        refuse_tape(tape, model)
        self.view, self.legs = HistoryView.of(tape_points(tape)), tape.legs
        self._probe = EdgeProbe(self.view.points)
        self._changes: dict[tuple[str, str], Change] = {}
        self._forward: dict[tuple[str, str], list[PointChange]] = {}
        self._edges: dict[tuple[str, str], list[PathEdge]] = {}
        self._locked: dict[str, Derivative] = {}
        self._seen = ModulusPairs(self.prepared)
        self.start = TouchingStart(legs=self.legs, points=self.view.points)

    @property
    def prepared(self) -> Prepared:
        """The model, as it is at the end."""
        return self.legs[-1].prepared

    def locks(self) -> Iterator[tuple[LockChange, Derivative]]:
        """The shortening of every bolt that locks, and its derivative at the end of the history before, kept."""
        points = self.view.points
        for name, dof in points[-1].system.locked.items():
            if name not in self._locked:
                before = [point for point in points if name not in point.system.locked]
                node, axis = divmod(dof, self.view.model.components)
                along = tuple(float(k == axis) for k in range(self.view.model.components))
                self._locked[name] = Derivative(self.on(before), Displacement(node=node, along=along))
            yield LockChange(name=name), self._locked[name]

    def on(self, points: Sequence[TapePoint]) -> TapedHistory:
        """The history with other states at some points."""
        other = copy(self)
        other.view, other._probe = replace(self.view, points=points), EdgeProbe(points)
        other._forward, other._edges = {}, {}
        return other

    def forward(self, kind: str, name: str) -> list[PointChange]:
        """What a parameter changes at every point, kept."""
        if (kind, name) not in self._forward:
            self._forward[kind, name] = self._forward_along(self.change(kind, name))
        return self._forward[kind, name]

    def _forward_along(self, change: Change) -> list[PointChange]:
        """What a change makes of every point."""
        shortenings = {lock.name: shortening.along(change) for lock, shortening in self.locks()}
        at_once = ChangeWithLocks(change=change, shortenings=shortenings) if shortenings else change
        return forward(self.view.points, at_once)

    def edges(self, kind: str, name: str) -> list[PathEdge]:
        """Where a parameter has another derivative to each of its sides, kept."""
        if (kind, name) not in self._edges:
            self._edges[kind, name] = self.edges_along(self.change(kind, name), lambda _: self.forward(kind, name))
        return self._edges[kind, name]

    def edges_along(self, change: Change, known: Callable[[Change], list[PointChange]] | None = None) -> list[PathEdge]:
        """Where a change has another derivative to each of its sides; ``known`` gives what it makes of every point."""
        if not self._probe or not (self.view.points[-1].system.locked or self._probe.takes_apart(change)):
            return []
        rounding = _SAME_CONDITION / change.step if isinstance(change, BodyChange) else 0.0
        return edges(self.view, (known or self._forward_along)(change), rounding)

    def change(self, kind: str, name: str) -> Change:
        """What a parameter changes at once, kept."""
        if (kind, name) not in self._changes:
            self._changes[kind, name] = change_of(self.prepared, kind, name, self._seen)
        return self._changes[kind, name]

    def holds(self, kind: str, name: str) -> Validity:
        """In which changes of a parameter the sequence of events stays."""
        at_start = self.start.edges(self.view, GapRate.of(self.change(kind, name)))
        return validity(self.view, self.forward(kind, name), at_start)


class Derivative:
    """The derivative of an output of a history by everything that is given, from one way back through its events.

    Every mapping is by name, and each of its numbers is found when it is asked for.

    Parameters
    ----------
    history : the history
    output : what is differentiated

    Attributes
    ----------
    value : of the output
    friction, adhesion, shear_limit : by contact, per unit of the coefficient or traction
    interference : by contact, per length
    gap : by contact, (n,) per length that the initial gap of each of its nodes grows by
    load, support : by name, per factor that multiplies the load, or what the support prescribes, all along the history
    E, nu, expansion : by body, per unit of it
    """

    def __init__(self, history: TapedHistory, output: Output) -> None:
        self._history, self.output = history, output
        self.value = value(output, history.view)
        self._adjoint, self._pulls = adjoint_of(history.view, output)

    def __repr__(self) -> str:
        return f"Derivative of {self.output!r}: {self.value:.6g}"

    @cached_property
    def friction(self) -> ByName:
        """By contact, per unit of the coefficient; by "contact@step" of one that a step gives."""
        return self._all("friction")

    @cached_property
    def adhesion(self) -> ByName:
        """By contact, per unit of the traction without pressure."""
        return self._all("adhesion")

    @cached_property
    def shear_limit(self) -> ByName:
        """By contact, per unit of the largest traction."""
        return self._all("shear_limit")

    @cached_property
    def interference(self) -> ByName:
        """By contact, per length."""
        return self._all("interference")

    @cached_property
    def gap(self) -> ByName:
        """By contact, (n,) per length that the gap of each of its nodes grows by."""
        return ByName(names_of(self._history.prepared, "gap"), self._gap)

    @cached_property
    def load(self) -> ByName:
        """By load, per factor that multiplies it all along the history."""
        return self._all("load")

    @cached_property
    def support(self) -> ByName:
        """By moving support or obstacle, per factor that multiplies what it prescribes."""
        return self._all("support")

    @cached_property
    def E(self) -> ByName:
        """By body, per unit of Young's modulus."""
        return self._all("E")

    @cached_property
    def nu(self) -> ByName:
        """By body, per unit of Poisson's ratio."""
        return self._all("nu")

    @cached_property
    def expansion(self) -> ByName:
        """By body, per unit of the thermal expansion."""
        return self._all("expansion")

    def by(self, parameter: str) -> float:
        """The derivative by a parameter as ``kind.name``, "friction.contact" or "E.pad"."""
        kind, name = split(parameter)
        return float(self._all(kind)[name])

    def sides(self, parameter: str) -> tuple[float, float]:
        """The derivatives by a parameter, ``kind.name``, downwards and upwards; the same but at an event at the end.

        Raises
        ------
        InputError
            Where pairs share an event on the way, or one is about to close at the end: then one side is not known.
        """
        kind, name = split(parameter)
        change = self._history.change(kind, name)
        low, high = self._beside(self._history.edges(kind, name), f"'{parameter}'")
        gap = GapRate.of(change)
        own = self.along(change)
        below, above = (own if one is self else one.along(change) for one in (low, high))
        return below + low.through_start(gap, -1.0), above + high.through_start(gap, 1.0)

    def _beside(self, found: list[PathEdge], what: str = "the motion") -> tuple[Derivative, Derivative]:
        """The derivatives below and above what is varied, of a history that has edges.

        Raises
        ------
        InputError
            Where one of both is not known.
        """
        view, last = self._history.view, self._history.view.number(self.output.load_factor)
        found = [edge for edge in found if edge.point <= last]
        if not found:
            return self, self
        at_end = len(found) == 1 and found[0].point == last
        other = beyond(view, found[0].condition, self._history.legs, last) if at_end else None
        if other is None:
            raise InputError(f"{found[0].words}: what {what} does on the other side is not known")
        across = Derivative(self._history.on(other), replace(self.output, load_factor=None))
        return (across, self) if found[0].change > 0.0 else (self, across)

    def holds(self, parameter: str) -> Validity:
        """In which changes of a parameter, ``kind.name``, the sequence of events stays; to first order."""
        return self._history.holds(*split(parameter))

    def shape(self, motion: ArrayLike) -> float:
        """The derivative by a motion of the nodes, (nodes, d): a dimension of the bodies as it grows by 1.

        Normals, areas, gaps and loads move along.

        Raises
        ------
        InputError
            Where the motion has another shape, moves nothing, or the output has another derivative to each side of it.
        """
        sides = ShapeSides.of(self._history.prepared, motion)
        low, high = self._to_sides(sides)
        if _apart(low, high):
            words = f"the derivative has two sides, {low:.6g} and {high:.6g}; shape_sides(motion) gives both"
            history, change = self._history, sides.change
            edges = history.start.edges(history.view, GapRate.of(change)) or history.edges_along(change)
            why = sides.kink(history.view) if len(sides.kinked) else edges[0].words
            raise InputError(f"{why}: {words}", where=("motion",))
        return self._upwards(sides.change) if len(sides.kinked) else high

    def shape_sides(self, motion: ArrayLike) -> tuple[float, float]:
        """The derivatives by a motion of the nodes, (nodes, d), backwards and forwards along it; mostly the same.

        They differ where nodes leave a straight side opposite a smooth one, part flush ends, or change gaps of pairs
        that touch before anything is loaded; and at an event.

        Raises
        ------
        InputError
            Where the motion has another shape, moves nothing, or one of both is not known.
        """
        return self._to_sides(ShapeSides.of(self._history.prepared, motion))

    def _to_sides(self, sides: ShapeSides) -> tuple[float, float]:
        """The derivatives backwards and forwards along a motion."""
        if len(sides.kinked):
            ways = [list(sides.towards(way)) for way in (-1.0, 1.0)]
            ends = [self._beside(self._history.edges_along(parts[0][1]))[k] for k, parts in enumerate(ways)]
            own = [
                sum(weight * end.along(part) for weight, part in parts) for end, parts in zip(ends, ways, strict=True)
            ]
            gaps = [GapRate.sum([(weight, GapRate.of(part)) for weight, part in parts]) for parts in ways]
        else:
            ends = list(self._beside(self._history.edges_along(sides.change)))
            own = [end.along(sides.change) for end in dict.fromkeys(ends)] * 2  # one where both are the same
            gaps = [GapRate.of(sides.change)] * 2
        low, high = (own[k] + ends[k].through_start(gaps[k], way) for k, way in enumerate((-1.0, 1.0)))
        return low, high

    def through_start(self, gap: GapRate, way: float) -> float:
        """What changes of gaps do besides where pairs touch without a force as the history begins, to one side.

        Parameters
        ----------
        gap : the change, per unit
        way : 1 upwards, -1 downwards

        Raises
        ------
        InputError
            Where that is not known.
        """
        start, remembered = self._history.start, self._adjoint.remembered
        found = sum(share * shortening.through_start(gap, way) for share, shortening in self._locks)
        if remembered.any() and start.moved(gap).any():
            found += way * float(np.vdot(remembered, start.memory(gap.times(way))))
        return found

    @cached_property
    def nodes(self) -> Array:
        """(nodes, d) By the place of every node, per length; `shape` of any motion is the sum of its products with it.

        Radii of nodes on the axis stay.

        Raises
        ------
        InputError
            Where motions of single nodes do not add up: those of a straight side opposite another meshed one.
        """
        found = node_gradient(self._history.view, self._adjoint, self.output)
        self._history.start.refuse_by_nodes(self._history.view, self._adjoint.remembered, "nodes")
        return found

    def _all(self, kind: str) -> ByName:
        return ByName(names_of(self._history.prepared, kind), lambda name: self._by(kind, name))

    def _by(self, kind: str, name: str) -> float:
        """The derivative by one parameter.

        Raises
        ------
        InputError
            Where it has two sides.
        """
        last = self._history.view.number(self.output.load_factor)
        on_the_way = [edge for edge in self._history.edges(kind, name) if edge.point <= last]
        if on_the_way:
            words = f"{on_the_way[0].words}: the derivative by '{kind}.{name}' has two sides there"
            raise InputError(f"{words}; sides('{kind}.{name}') gives both where that is known")
        change = self._history.change(kind, name)
        found, gap = self._upwards(change), GapRate.of(change)
        if _apart(found - self.through_start(gap, 1.0) + self.through_start(gap, -1.0), found):
            words = f"{self._history.start.edges(self._history.view, gap)[0].words}: the derivative by '{kind}.{name}'"
            raise InputError(f"{words} has two sides there; sides('{kind}.{name}') gives both")
        return found

    def _upwards(self, change: Change) -> float:
        """The derivative by a change to its upper side."""
        return self.along(change) + self.through_start(GapRate.of(change), 1.0)

    def along(self, change: Change) -> float:
        """What a change changes of the output, also by the shortenings at which bolts lock."""
        return self._along(change) + sum(share * shortening.along(change) for share, shortening in self._locks)

    @cached_property
    def _locks(self) -> list[tuple[float, Derivative]]:
        """How the output changes with the shortening at which a bolt locks, and the derivative of that."""
        found = ((self._along(lock), shortening) for lock, shortening in self._history.locks())
        return [(share, shortening) for share, shortening in found if share]

    def _along(self, change: Change) -> float:
        """What a change changes of the output while bolts that have locked are as long as they are."""
        view = self._history.view
        found = changed(view.every, self._adjoint, change)
        if isinstance(change, BodyChange | ModulusChange):
            found += read_otherwise(self.output, view, change)
        if isinstance(change, LoadChange):
            found += pulled_by(view, change, self._adjoint.pulled, self._pulls)
        return found

    def _gap(self, contact: str) -> Array:
        """(n,) The derivative by the gaps of a contact, node by node.

        Raises
        ------
        InputError
            Where that has two sides.
        """
        view, found = self._history.view, np.zeros(len(self._history.view.interface))
        self._history.start.refuse_by_nodes(view, self._adjoint.remembered, "gap")
        for stack in self._adjoint.stacks:
            found[stack.system.active] += stack.motion[:, 0].sum(axis=0)
        through_locks = (share * shortening.gap[contact] for share, shortening in self._locks)
        return sum(through_locks, found[view.pairs(contact)])


def _apart(low: float, high: float) -> bool:
    """Whether derivatives to both sides are not the same up to differences."""
    return abs(high - low) > _TWO_SIDES * (abs(high) + abs(low))
