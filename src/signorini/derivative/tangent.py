# SPDX-License-Identifier: BSD-3-Clause
"""What one parameter changes of the answers of a history, forwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.forward import PointChange
from signorini.derivative.functionals import weights, weights_at_start
from signorini.derivative.taped_history import TapedHistory
from signorini.derivative.tied_peaks import peak_nodes, tied_words
from signorini.derivative.touching_start import GapRate
from signorini.errors import InputError
from signorini.model.outputs import AtNode, Displacement, Dissipation, Output, Peak, Stress, WeightedSum


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactTangent:
    """What a parameter changes of a contact, per unit of it.

    Attributes
    ----------
    name : of the contact
    node : (n,) node indices, from 0, as of the contact's result
    pressure, gap : (n,)
    traction, motion : (n,) along the tangent, in space (n, 2); of friction, and of the nodes since the beginning
    """

    name: str
    node: IntArray
    pressure: Array
    gap: Array
    traction: Array
    motion: Array


_SAME_CHANGE = 1e-6  # of the largest: what motions, forces and pressures differ by to both sides that are one


class HistoryTangent:
    """What one parameter changes of every answer.

    Parameters
    ----------
    history : the history
    changes : what the parameter changes at every point
    load_factor : where it is asked for; None at the end
    ways : 1 upwards, -1 downwards, or both
    at_start : (2, d - 1, n) what it changes of motions and friction where the history begins
    """

    def __init__(
        self,
        history: TapedHistory,
        changes: Sequence[PointChange],
        load_factor: float | None,
        ways: tuple[float, ...],
        at_start: Array,
    ) -> None:
        self._history, self._changes, self._load_factor, self._ways = history, changes, load_factor, ways
        self._at_start = at_start
        self._number = history.view.number(load_factor)

    def apart(self, other: HistoryTangent) -> bool:
        """Whether that to the other side is another one: of motions, of forces, or of what friction has taken."""
        if self._changes is other._changes:
            return False
        ends = list(zip(self._given_loads, other._given_loads, strict=True))
        fields = [(getattr(self._changes[i], name), getattr(other._changes[j], name)) for i, j in ends for name in "hr"]
        if any(
            np.abs(one - two).max() > _SAME_CHANGE * max(np.abs(one).max(), np.abs(two).max()) for one, two in fields
        ):
            return True
        points, contacts = self._history.view.points, self._history.view.model.contacts
        for factor, contact in product({points[i].load_factor for i, _ in ends}, contacts):
            work = Dissipation(load_factor=factor, contact="" if contact.tied else contact.label)
            one, two = self._terms(work), other._terms(work)
            if abs(one.sum() - two.sum()) > _SAME_CHANGE * max(np.abs(one).sum(), np.abs(two).sum()):
                return True
        return False

    @property
    def _given_loads(self) -> list[int]:
        """Numbers of the points at which loads are given."""
        points = self._history.view.points
        return [i for i, point in enumerate(points) if not point.at_event and point.quiet is None]

    def to_both(self) -> HistoryTangent:
        """The tangent of a parameter that changes the same to both sides."""
        return HistoryTangent(self._history, self._changes, self._load_factor, (-1.0, 1.0), self._at_start)

    def contact(self, name: str) -> ContactTangent:
        """What it changes of a contact, by name."""
        view, change = self._history.view, self._changes[self._number]
        own = view.pairs(name)
        area = view.interface.area[own]
        traction, motion = (change.r[1:, own] / area).T, change.h[1:, own].T
        plane = view.interface.directions == 2
        return ContactTangent(
            name=name,
            node=view.interface.node[own],
            pressure=change.r[0, own] / area,
            gap=change.h[0, own],
            traction=traction[:, 0] if plane else traction,
            motion=motion[:, 0] if plane else motion,
        )

    def of(self, output: Output) -> float:
        """What it changes of an output of contacts.

        Raises
        ------
        InputError
            For outputs of bodies, ask for the derivative of those; and where it has two sides.
        """
        if isinstance(output, WeightedSum):
            return sum(factor * self.of(part) for factor, part in output.parts)
        if isinstance(output, Peak) and len(nodes := peak_nodes(output, self._history.view)) > 1:
            return self._of_peak(nodes)
        if isinstance(output, Displacement | Stress):
            raise InputError(f"{output!r} is an output of bodies; ask for its derivative")
        return float(self._terms(output).sum())

    def _terms(self, output: Output) -> Array:
        """What it changes of an output of contacts by what it changes where the history begins and at its points."""
        view = self._history.view
        pairs = [(weight, self._changes[i]) for i, weight in weights(output, view).items()]
        terms = [np.vdot(weight.h, change.h) + np.vdot(weight.r, change.r) for weight, change in pairs]
        if self._at_start.any():
            terms.append(np.vdot(weights_at_start(output, view, self._history.start.ahead), self._at_start))
        return np.array(terms)

    def _of_peak(self, nodes: Sequence[AtNode]) -> float:
        """What it changes of the largest pressure, which several nodes have."""
        rates = [self.of(node) for node in nodes]
        low, high = min(rates), max(rates)
        if len(self._ways) > 1 and high - low > _SAME_CHANGE * (abs(high) + abs(low)):
            words = tied_words(self._history.view, nodes[0], nodes[1])
            raise InputError(f"{words}: what changes it has two sides; those of tangent_sides have one each")
        return high if self._ways[-1] > 0.0 else low


def tangent(history: TapedHistory, kind: str, name: str, load_factor: float | None) -> HistoryTangent:
    """What one parameter changes of every answer.

    Parameters
    ----------
    history : the history
    kind, name : of the parameter
    load_factor : where it is asked for; None at the end

    Raises
    ------
    InputError
        Where answers have two sides, or what happens is not known.
    """
    below, above = tangent_sides(history, kind, name, load_factor)
    if below.apart(above):
        change, last = history.change(kind, name), history.view.number(load_factor)
        on_way = [edge for edge in history.edges(change) if edge.point <= last]
        why = [*on_way, *history.start.edges(history.view, GapRate.of(change))][0].words
        words = f"what '{kind}.{name}' changes has two sides there; tangent_sides({kind}='{name}') gives both"
        raise InputError(f"{why}: {words}")
    return above.to_both()


def tangent_sides(
    history: TapedHistory, kind: str, name: str, load_factor: float | None
) -> tuple[HistoryTangent, HistoryTangent]:
    """What one parameter changes of every answer, downwards and upwards.

    Parameters
    ----------
    history : the history
    kind, name : of the parameter
    load_factor : where it is asked for; None at the end

    Raises
    ------
    InputError
        Where one of both is not known.
    """
    change, last = history.change(kind, name), history.view.number(load_factor)
    found = [edge for edge in history.edges(change) if edge.point <= last]
    below, above = (
        HistoryTangent(
            side,
            side.forward(change, way),
            load_factor if side is history else None,
            (way,),
            history.start.changes(GapRate.of(change), way),
        )
        for side, way in zip(history.beside(change, found, last, f"'{kind}.{name}'"), (-1.0, 1.0), strict=True)
    )
    return below, above
