# SPDX-License-Identifier: BSD-3-Clause
"""What outputs are read from: a history at its points, with its bodies or what a parameter makes of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.derivative.points import TapePoint, with_trials
from signorini.engine.increments import applied, free_load
from signorini.engine.path_states import offsets
from signorini.errors import InputError, one_of
from signorini.fem.space import Space
from signorini.interface.interface import Interface
from signorini.model.model import Model

_SAME_LOAD = 1e-9  # of a step: load factors that are one


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionHistory:
    """Tangential motions and friction at all points of a history, of all pairs.

    Attributes
    ----------
    h, r : (p, d - 1, n) motions since the beginning, length, and forces
    known : (p, n) pairs that the law is asked of
    moves : (p, d - 1, n) whether pairs may have moved in a piece: the law is asked of them and does not hold them
    late : (p, n) 1 of pairs that slip under the friction at the end of a piece, 0 of those under its mean
    """

    h: Array
    r: Array
    known: BoolArray
    moves: BoolArray
    late: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class HistoryView:
    """A history as outputs read it.

    Attributes
    ----------
    points : of the history
    model, space, interface : bodies and pairs; with what a parameter has changed of them, forces and motions do not
    """

    points: Sequence[TapePoint]
    model: Model
    space: Space
    interface: Interface

    @classmethod
    def of(cls, points: Sequence[TapePoint]) -> HistoryView:
        """A history as it was followed."""
        prepared = points[-1].system.prepared
        return cls(points=points, model=prepared.model, space=prepared.space, interface=prepared.interface)

    @cached_property
    def every(self) -> Sequence[TapePoint]:
        """The points, and behind them the ends of the trials that told lengths of increments."""
        return with_trials(self.points)

    def number(self, load_factor: float | None) -> int:
        """Of the point at a load factor, the last one where None is given.

        Raises
        ------
        InputError
            If no straight part of the loads ends there.
        """
        if load_factor is None:
            return len(self.points) - 1
        ends: dict[float, int] = {}
        for i, point in enumerate(self.points):
            if not point.at_event and point.quiet is None:  # a step ends before what the next one changes at once
                ends.setdefault(point.load_factor, i)
        nearest = min(ends, key=lambda end: abs(end - load_factor))
        if abs(nearest - load_factor) > _SAME_LOAD:
            told = ", ".join(f"{end:g}" for end in sorted({round(end, 9) for end in ends}))
            raise InputError(
                f"is {load_factor:g}; expected one of {told}, or ask for it with 'at' of the step",
                where=("load_factor",),
            )
        return ends[nearest]

    def pairs(self, contact: str) -> BoolArray:
        """(n,) The pairs of a contact; of all contacts where none is named.

        Raises
        ------
        InputError
            If there is no such contact.
        """
        labels = [part.label for part in self.model.contacts]
        if not contact:
            return np.ones(len(self.interface), dtype=np.bool_)
        if contact not in labels:
            raise InputError(one_of(contact, labels, "contact"))
        if self.model.contacts[labels.index(contact)].tied:
            raise InputError(f"contact '{contact}' is tied: its forces are no unknowns of the law")
        return np.asarray(self.interface.contact == labels.index(contact), dtype=np.bool_)

    def forces(self, i: int) -> Array:
        """(d, n) Forces of all pairs at a point; 0 of those that the law is not asked of."""
        return self._whole(i, self.points[i].r * self.points[i].system.root)

    def motions(self, i: int) -> Array:
        """(d, n) Gaps and tangential motions of all pairs at a point; 0 of those that the law is not asked of."""
        return self._whole(i, self.points[i].h / self.points[i].system.root)

    def displacement(self, i: int) -> Array:
        """(dofs,) Displacements at a point, see `displacement_at`."""
        return displacement_at(self.points[i])

    @cached_property
    def friction(self) -> FrictionHistory:
        """Tangential motions and friction at all points."""
        points, n = self.points, len(self.interface)
        d = points[0].system.directions
        h, r = np.zeros((2, len(points), d - 1, n))
        (known, late), moves = np.zeros((2, len(points), n)), np.zeros(h.shape, dtype=np.bool_)
        for system in dict.fromkeys(point.system for point in points):
            own = np.array([i for i, point in enumerate(points) if point.system is system])
            at = own[:, None, None], np.arange(d - 1)[:, None], system.active
            h[at] = np.stack([points[i].h[1:] for i in own]) / system.root
            r[at] = np.stack([points[i].r[1:] for i in own]) * system.root
            known[own[:, None], system.active] = 1.0
            moves[at] = ~np.stack([points[i].states.held for i in own])
            for i in own:
                late[i, system.active] = points[i].increment
        return FrictionHistory(h=h, r=r, known=known > 0.0, moves=moves, late=late)

    def _whole(self, i: int, rows: Array) -> Array:
        system = self.points[i].system
        whole = np.zeros((system.directions, len(self.interface)))
        whole[:, system.active] = rows
        return whole


def displacement_at(point: TapePoint) -> Array:
    """(dofs,) Displacements at a point, where vectors of all of them are."""
    system, prepared = point.system, point.system.prepared
    offset = offsets(prepared, point.load)[:, system.active]
    reduced = system.condensed.reduce(free_load(prepared, point.load))
    free = system.condensed.displacement(reduced, point.h / system.root, point.r * system.root, offset)
    found: Array = prepared.constraints.displaced(free) + applied(prepared, point.load)[1]
    return found
