# SPDX-License-Identifier: BSD-3-Clause
"""Whether a parameter takes apart what happens at once in a history, asked of all parameters by two ways back.

A pair that stands on the edge of its event, or shares one with another, mostly does so whatever is varied: it retraces
what it did before. Then nothing that any parameter changes of its condition is left but rounding, and no way forwards
for each parameter has to say so. Of pairs that turn alike on smooth cones and tell lengths, or stay at their limit,
only that way tells it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.adjoint_terms import Adjoint, BoundTerm, Weights
from signorini.derivative.points import TapePoint, with_trials
from signorini.derivative.recursion import Change, backward, changed
from signorini.derivative.validity import NOTHING_APART, edge_words, on_edge
from signorini.derivative.view import HistoryView


class EdgeProbe:
    """What parameters change of sums, of random weights, of the conditions on edges, and of all conditions there.

    Parameters
    ----------
    points : of the history
    """

    def __init__(self, points: Sequence[TapePoint]) -> None:
        self._points, self._every = points, with_trials(points)

    def __bool__(self) -> bool:
        """Whether the history has any edge."""
        return bool(self._on or self.unsure)

    @cached_property
    def unsure(self) -> list[int]:
        """Numbers of the points up to which pairs turn alike, and tell where these are, or stay at their limit."""
        return [i for i, point in enumerate(self._points) if point.tied or len(point.stays)]

    @property
    def points(self) -> list[int]:
        """Numbers of the points with conditions on edges."""
        return list(self._on)

    def conditions(self, i: int) -> IntArray:
        """Numbers of the conditions on edges of a point that has some."""
        return self._on[i]

    def words(self, view: HistoryView, i: int) -> str:
        """What happens at a point that has edges, and where."""
        return edge_words(view, self._points[i], int(self._on[i][0]))

    def takes_apart(self, change: Change) -> bool:
        """Whether a parameter may take any edge apart; where it does not, that is sure up to rounding."""
        if self.unsure:
            return True
        on_edges, of_all = (changed(self._every, adjoint, change) for adjoint in self._sums)
        return abs(on_edges) > NOTHING_APART * abs(of_all)

    def parted_by_gaps(self, numbers: Collection[int]) -> bool:
        """Whether gaps of single pairs take edges apart at any of some points."""
        return _parted(*(self._back({i: kept[i] for i in numbers}) for kept in self._kinds))

    @cached_property
    def parted(self) -> bool:
        """Whether gaps of single pairs take conditions on edges apart."""
        return bool(self._on) and _parted(*self._sums)

    @cached_property
    def _on(self) -> dict[int, IntArray]:
        """Numbers of the conditions on edges, by number of the point."""
        found = ((i, np.array(on_edge(point), dtype=np.int64)) for i, point in enumerate(self._points))
        return {i: on for i, on in found if len(on)}

    @cached_property
    def _sums(self) -> tuple[Adjoint, Adjoint]:
        """The ways back of the conditions on edges, and of all at the same points."""
        on_edges, of_all = (self._back(kept) for kept in self._kinds)
        return on_edges, of_all

    @property
    def _kinds(self) -> tuple[dict[int, IntArray], dict[int, IntArray]]:
        """Numbers of the conditions on edges and of all conditions, by number of the point, where there are edges."""
        return self._on, {i: np.arange(len(self._points[i].conditions.pair)) for i in self._on}

    def _back(self, chosen: Mapping[int, IntArray]) -> Adjoint:
        """The way back of the sum of chosen conditions, by number of the point."""
        generator = np.random.default_rng(0)
        weights: dict[int, Weights] = {}
        of_bounds: list[tuple[TapePoint, IntArray, Array]] = []
        for i, numbers in chosen.items():
            point = self._points[i]
            share = generator.uniform(0.5, 1.5, len(numbers))
            weights[i] = _weights(point, numbers, share)
            of_bounds.append((point, numbers, share))
        adjoint = backward(self._points, weights)
        for point, numbers, share in of_bounds:
            _add_bound(adjoint.bounds[point.system], point, numbers, share)
        return adjoint


def _parted(on_edges: Adjoint, of_all: Adjoint) -> bool:
    """Whether gaps of single pairs change conditions on edges, beside what they change of all conditions there."""
    return bool(np.abs(on_edges.by_gaps).max() > NOTHING_APART * np.abs(of_all.by_gaps).max())


def _weights(point: TapePoint, numbers: IntArray, share: Array) -> Weights:
    """How a sum of conditions changes with motions and forces (d, n) of all pairs."""
    known, system = point.conditions, point.system
    whole = np.zeros((2, system.directions, len(system.condensed.active)))
    own, root = known.pair[numbers], system.root[known.pair[numbers]]
    pairs = system.active[own]
    np.add.at(whole[0, 0], pairs, share * root * known.gap[numbers])
    np.add.at(whole[1, 0], pairs, share / root * known.pressure[numbers])
    for axis, friction in enumerate(known.friction[:, numbers], start=1):
        np.add.at(whole[1, axis], pairs, share / root * friction)
    return Weights(h=whole[0], r=whole[1])


def _add_bound(term: BoundTerm, point: TapePoint, numbers: IntArray, share: Array) -> None:
    """Add how a sum of conditions changes with the friction bound of the active pairs."""
    known = point.conditions
    at = known.branch[numbers], known.pair[numbers]
    for of_term, of_conditions in ((term.starts, known.start), (term.slopes, known.slope), (term.kinks, known.kink)):
        np.add.at(of_term, at, share * of_conditions[numbers])
