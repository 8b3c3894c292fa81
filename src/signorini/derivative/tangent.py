# SPDX-License-Identifier: BSD-3-Clause
"""What one parameter changes of the answers of a history, forwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.forward import PointChange
from signorini.derivative.functionals import weights
from signorini.derivative.points import TapePoint
from signorini.derivative.taped_history import TapedHistory
from signorini.derivative.tied_peaks import peak_nodes, tied_words
from signorini.derivative.touching_start import GapRate
from signorini.errors import InputError
from signorini.model.outputs import AtNode, Displacement, Output, Peak, Stress, WeightedSum


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


_SAME = 1e-6  # of the largest: motions and forces, and pressures of nodes, to both sides of what has one derivative


class HistoryTangent:
    """What one parameter changes of every answer.

    Parameters
    ----------
    history : the history
    changes : what the parameter changes at every point
    load_factor : where it is asked for; None at the end
    ways : 1 upwards, -1 downwards, or both
    """

    def __init__(
        self,
        history: TapedHistory,
        changes: Sequence[PointChange],
        load_factor: float | None,
        ways: tuple[float, ...],
    ) -> None:
        self._history, self._changes, self._load_factor, self._ways = history, changes, load_factor, ways
        self._number = history.view.number(load_factor)

    def apart(self, other: HistoryTangent) -> bool:
        """Whether that to the other side is another one, at a given load or at an event that both have."""
        if self._changes is other._changes:
            return False
        known = dict(other._at_points)
        both = [(change, known[point]) for point, change in self._at_points if point in known]
        both += zip(self._at_given_loads, other._at_given_loads, strict=True)
        for name in ("h", "r"):
            one, two = (np.stack([getattr(pair[k], name) for pair in both]) for k in range(2))
            if np.abs(one - two).max() > _SAME * max(np.abs(one).max(), np.abs(two).max()):
                return True
        return False

    @property
    def _at_points(self) -> list[tuple[TapePoint, PointChange]]:
        """Of every point what it changes there."""
        return list(zip(self._history.view.points, self._changes, strict=True))

    @property
    def _at_given_loads(self) -> list[PointChange]:
        """What it changes where loads are given."""
        return [change for point, change in self._at_points if not point.at_event and point.quiet is None]

    def to_both(self) -> HistoryTangent:
        """The same, of a parameter that changes the same to both sides."""
        return HistoryTangent(self._history, self._changes, self._load_factor, (-1.0, 1.0))

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
        found = 0.0
        for i, weight in weights(output, self._history.view).items():
            change = self._changes[i]
            found += float(np.vdot(weight.h, change.h) + np.vdot(weight.r, change.r))
        return found

    def _of_peak(self, nodes: Sequence[AtNode]) -> float:
        """What it changes of the largest pressure, which several nodes have."""
        rates = [self.of(node) for node in nodes]
        low, high = min(rates), max(rates)
        if len(self._ways) > 1 and high - low > _SAME * (abs(high) + abs(low)):
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
        HistoryTangent(side, side.forward(change, way), load_factor if side is history else None, (way,))
        for side, way in zip(history.beside(change, found, last, f"'{kind}.{name}'"), (-1.0, 1.0), strict=True)
    )
    return below, above
