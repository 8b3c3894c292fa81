# SPDX-License-Identifier: BSD-3-Clause
"""Motions of nodes that change pairs otherwise to one side than to the other, as those that bend a straight side.

Facets in one plane stand for themselves until a node leaves it; then for a surface that bends, which lies against a
smooth side opposite where it bends alike, and away from it where it does not. So the gap has a derivative to each side
of such a motion. Other edges of that kind are ends of both sides that are flush, and gaps at which ``adjust`` begins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray, extent
from signorini.derivative.body_changes import BodyChange
from signorini.derivative.body_side import BodySide, moved_side
from signorini.derivative.view import HistoryView
from signorini.engine.prepare import Prepared
from signorini.errors import InputError
from signorini.interface.interface import Interface

_PART = 1e-6  # of the size of the model: how far nodes move at most for differences
_EVEN = 1e-7  # of what a motion changes: a part that is even in it and smaller is rounding
_KINK = 1e-7  # of what a motion changes: from here on a difference between both sides is none of the differences


@dataclass(frozen=True, kw_only=True, eq=False)
class ShapeSides:
    """What a motion of the nodes changes at once, to both of its sides.

    Attributes
    ----------
    prepared : the model as it is
    motion : (nodes, d) length per unit
    """

    prepared: Prepared
    motion: Array

    @classmethod
    def of(cls, prepared: Prepared, motion: ArrayLike) -> ShapeSides:
        """Of a motion, (nodes, d).

        Raises
        ------
        InputError
            Where it has another shape, or moves nothing.
        """
        moved, points = np.asarray(motion, dtype=np.float64), prepared.model.mesh.points
        if moved.shape != points.shape or not moved.any():
            words = f"has shape {moved.shape}; expected {points.shape}, a motion of some node"
            raise InputError(words, where=("motion",))
        return cls(prepared=prepared, motion=moved)

    @cached_property
    def change(self) -> BodyChange:
        """What it changes where both sides are alike."""
        return self._between(-1.0, 1.0)

    def towards(self, way: float) -> Iterator[tuple[float, BodyChange]]:
        """Changes whose weighted sum is that to one side: differences over a step and over half of it, extrapolated.

        Parameters
        ----------
        way : 1 upwards, -1 downwards
        """
        for weight, part in ((2.0, 0.5), (-1.0, 1.0)):
            yield weight, self._between(*sorted((0.0, way * part)))

    @cached_property
    def kinked(self) -> IntArray:
        """Numbers of the pairs that it changes otherwise to one side than to the other, the most first."""
        middle, high, low = (self._numbers(side) for side in (self.prepared.interface, *self._beside))
        most = np.maximum(np.abs(high - low).max(axis=1, initial=0.0) / 2.0, _PART)[:, None]
        if (np.abs(high + low - 2.0 * middle) <= _EVEN * most).all():
            return np.zeros(0, dtype=np.int64)
        half = self._numbers(self._side(0.5).interface)
        bend = self._bend(middle, half, high, low) / most
        if bend.max() > _KINK:  # gaps of the model as it is prepared may be other ones than those of its mesh
            bend = self._bend(self._numbers(self._side(0.0).interface), half, high, low) / most
        worst = bend.max(axis=0)
        order = np.argsort(-worst, kind="stable")
        return np.asarray(order[worst[order] > _KINK])

    @property
    def _beside(self) -> tuple[Interface, Interface]:
        """The pairs a step forwards and backwards."""
        return self._side(1.0).interface, self._side(-1.0).interface

    @staticmethod
    def _bend(middle: Array, half: Array, high: Array, low: Array) -> Array:
        """Of numbers at parts of a step, by how much they grow otherwise forwards than both ways."""
        return np.abs(4.0 * half - 3.0 * middle - high - (high - low) / 2.0)

    def kink(self, view: HistoryView) -> str:
        """What it does to the pair that it changes most otherwise to one side than to the other, in words."""
        pair = int(self.kinked[0])
        node = view.model.mesh.labels[view.interface.node[pair]]
        name = view.model.contacts[view.interface.contact[pair]].label
        words = f"changes node {node} of '{name}' otherwise forwards than backwards, as where it bends a straight"
        return f"{words} side or moves flush ends"

    def _numbers(self, found: Interface) -> Array:
        """(2 + d, n) Gaps, areas and normals of pairs, in parts of the model and of the largest area."""
        area = self.prepared.interface.area
        return np.stack([found.gap / self._size, found.area / float(area.max(initial=0.0) or 1.0), *found.normals.T])

    def _between(self, first: float, last: float) -> BodyChange:
        """Differences from one part of the step to another."""
        low, high = self._side(first), self._side(last)
        return BodyChange(
            prepared=self.prepared,
            low=low,
            high=high,
            step=0.5 * (last - first) * self._step,
            tilts=True,
            motion=self.motion,
        )

    @cached_property
    def _sides(self) -> dict[float, BodySide]:
        return {}

    def _side(self, part: float) -> BodySide:
        """The bodies a part of the step away, kept."""
        if part not in self._sides:
            self._sides[part] = moved_side(self.prepared, self.motion, part * self._step)
        return self._sides[part]

    @cached_property
    def _step(self) -> float:
        return _PART * self._size / float(np.abs(self.motion).max())

    @cached_property
    def _size(self) -> float:
        """Of the model, length."""
        return float(extent(self.prepared.model.mesh.points).max())
