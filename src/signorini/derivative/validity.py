# SPDX-License-Identifier: BSD-3-Clause
"""How far a parameter may change before another sequence of events takes the place of the one that was followed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.derivative.forward import PointChange, change_of_conditions
from signorini.derivative.points import ZERO, TapePoint
from signorini.derivative.quiet_ends import TriedLength
from signorini.derivative.view import HistoryView
from signorini.solution.sensitivities import Validity

SHARED_EVENT = 1e-7
"""Of the largest move of an event: by how much events that share a load may move apart."""

NOTHING_APART = 1e-11
"""Of what a parameter changes of all conditions: of those on edges less is rounding."""


def validity(view: HistoryView, changes: Sequence[PointChange], at_start: Sequence[PathEdge]) -> Validity:
    """The interval of a parameter, from what it changes at every point.

    Parameters
    ----------
    view : the history
    changes : what the parameter changes at every point
    at_start : edges of the history's beginning
    """
    low, high, ends = -np.inf, np.inf, ["", ""]
    for edge in [*at_start, *edges(view, changes)]:
        which = 0 if edge.change > 0.0 else 1
        ends[which] = edge.words
        low, high = (0.0, high) if which == 0 else (low, 0.0)
    for value, rate, words in _conditions(view, changes):
        end = np.divide(-value, rate, out=np.full(len(value), np.nan), where=rate != 0.0)
        above, below = np.where(end > 0.0, end, np.inf), np.where(end < 0.0, end, -np.inf)
        if len(end) and above.min() < high:
            high, ends[1] = float(above.min()), words(int(above.argmin()))
        if len(end) and below.max() > low:
            low, ends[0] = float(below.max()), words(int(below.argmax()))
    return Validity(low=low, high=high, ends=(ends[0], ends[1]))


@dataclass(frozen=True, kw_only=True, eq=False)
class PathEdge:
    """A condition that vanishes at a load that is given, or at one where another does; or pairs that turn alike.

    Attributes
    ----------
    point : its number, -1 where the history begins
    condition : number of the condition in its piece, of a pair where no condition is
    change : what a parameter changes of it there, per unit: on one side of the parameter the pair goes on as it is
    words : what happens, and where
    """

    point: int
    condition: int
    change: float
    words: str


def on_edge(point: TapePoint) -> list[int]:
    """Numbers of the conditions that vanish at a given load; at an event those beyond that of the event."""
    if point.quiet is not None or point.at_rest:
        return []
    if point.at_event:
        return point.shared
    return np.flatnonzero(np.abs(point.conditions.value) <= ZERO * (point.system.law.scale or 1.0)).tolist()


def edges(view: HistoryView, changes: Sequence[PointChange], rounding: float = 0.0) -> list[PathEdge]:
    """Where a parameter has another derivative to each of its sides: pairs that share an event, or end on one.

    Parameters
    ----------
    view : the history
    changes : what the parameter changes at every point
    rounding : of the data of the law, per unit: what a change of a condition is as good as none below
    """
    moves = max((abs(change.part) for change in changes), default=0.0)
    rounding = least_apart(view, changes, rounding)
    found = list[PathEdge]()
    for i, (point, change) in enumerate(zip(view.points, changes, strict=True)):
        found += _turning_alike(view, i, change, ZERO * moves)
        found += _staying(view, i)
        on = on_edge(point)
        grown = change_of_conditions(point, change) if on else np.zeros(0)
        for k in on:
            rate, grows = float(point.conditions.rate[k]), float(grown[k])
            scale = point.system.law.scale or 1.0
            apart = (
                abs(grows / rate) > SHARED_EVENT * moves
                if point.at_event
                else abs(grows) > SHARED_EVENT * float(np.abs(grown).max())
            )
            if apart and abs(grows) > scale * max(ZERO * moves, rounding):
                found.append(PathEdge(point=i, condition=k, change=grows, words=edge_words(view, point, k)))
    return found


def least_apart(view: HistoryView, changes: Sequence[PointChange], rounding: float) -> float:
    """What a change of a condition is as good as none below, of the data of the law, per unit of a parameter.

    A history that retraces what it did before comes to the events of all pairs at one load whatever is varied: where
    nothing else moves, all that tells them apart is rounding.

    Parameters
    ----------
    view, changes, rounding : of `edges`
    """
    both = zip(view.points, changes, strict=True)
    most = (np.abs(change_of_conditions(*one)).max(initial=0.0) / (one[0].system.law.scale or 1.0) for one in both)
    return max(rounding, NOTHING_APART * float(max(most, default=0.0)))


def _turning_alike(view: HistoryView, i: int, change: PointChange, least: float) -> Iterator[PathEdge]:
    """The pairs that turn as far as the one that tells where an increment ends, and not so far or farther by a change.

    Parameters
    ----------
    view : the history
    i, change : number of the point, and what the change makes of it
    least : angle per unit that is as good as none
    """
    point = view.points[i]
    for trial, turned in _turns(point, change):
        spare, alike = turned[trial.pair] - turned, trial.alike
        apart = np.abs(spare[alike]) > max(least, SHARED_EVENT * float(np.abs(turned).max()))
        for pair in alike[apart].tolist():
            words = _words(view, point, np.array([pair]), ["turns as far as another"])(0)
            yield PathEdge(point=i, condition=pair, change=float(spare[pair]), words=words)


def _staying(view: HistoryView, i: int) -> Iterator[PathEdge]:
    """The pairs that stick at their limit in the increment up to a point: rounding tells what they count."""
    point = view.points[i]
    for k in point.stays.tolist():
        pair = point.conditions.pair[[k]]
        yield PathEdge(
            point=i,
            condition=k,
            change=1.0,
            words=_words(view, point, pair, ["stays at its limit without slipping"])(0),
        )


def _turns(point: TapePoint, change: PointChange) -> Iterator[tuple[TriedLength, Array]]:
    """The trials that tell where a point is, and (n,) how far friction turns otherwise in each by a change."""
    yield from zip(point.quiet.trials, change.turned, strict=False) if point.quiet is not None else ()


def edge_words(view: HistoryView, point: TapePoint, condition: int) -> str:
    """What happens where a condition vanishes together with another, or at a load that is given.

    Parameters
    ----------
    view : the history
    point : where that is
    condition : its number there
    """
    named = np.array([condition])
    words = _words(view, point, point.conditions.pair[named], _what(point, named))(0)
    return words.replace("before load", "with another at load" if point.at_event else "at load")


def _conditions(
    view: HistoryView, changes: Sequence[PointChange]
) -> Iterator[tuple[Array, Array, Callable[[int], str]]]:
    """What must stay positive: values, their changes per unit of the parameter, and what happens where one does not."""
    last: TapePoint | None = None
    none = np.zeros_like(changes[0].h)
    before, part = (none, none), 0.0
    for i, (point, change) in enumerate(zip(view.points, changes, strict=True)):
        known, scale = point.conditions, point.system.law.scale or 1.0
        happens = [known.number(point.event), *point.shared] if point.at_event else []
        there = (known.value > ZERO * scale) & ~np.isin(np.arange(len(known.value)), happens)
        named = np.flatnonzero(there)
        words = _words(view, point, known.pair[named], _what(point, named))
        yield known.value[there], change_of_conditions(point, change)[there], words
        for trial, turned in _turns(point, change):
            less = np.setdiff1d(np.flatnonzero(trial.angle > 0.0), trial.alike)
            spare, more = ((angle[trial.pair] - angle[less]) for angle in (trial.angle, turned))
            yield spare, more, _words(view, point, less, ["turns farthest"] * len(less))
        moved = view.motions(i)
        (slips, ways), active = point.slips, point.system.active
        away, rate = (
            (ways * (now - then)[1:, active[slips]]).sum(axis=0)
            for now, then in ((moved, before[0]), (change.h, before[1]))
        )
        yield away, np.where(away > 0.0, rate, 0.0), _words(view, point, slips, ["sticks"] * len(slips))
        if last is not None and last.leg == point.leg and last.at_event:
            yield (
                np.array([point.part - last.part]),
                np.array([change.part - part]),
                _words(
                    view,
                    point,
                    point.acting[:1] if point.at_event else last.acting[:1],
                    ["changes places with another"],
                ),
            )
        last, before, part = point, (moved, change.h), change.part


def _what(point: TapePoint, numbers: IntArray) -> list[str]:
    """What happens where conditions vanish."""
    known = point.conditions
    kinds = np.where(
        known.gap[numbers] != 0.0,
        0,
        np.where((known.friction[:, numbers] != 0.0).any(axis=0), 1, np.where(known.kink[numbers] != 0.0, 2, 3)),
    )
    tangent = point.states.tangent
    if tangent is not None:
        kinds[(kinds == 1) & (tangent.left[known.pair[numbers]] == 1)] = 4
    words = ("closes", "slips", "comes to a kink of its friction", "opens", "comes to a corner of its polygon")
    return [words[kind] for kind in kinds]


def _words(view: HistoryView, point: TapePoint, pairs: IntArray, what: Sequence[str]) -> Callable[[int], str]:
    """Names the pair of a condition, what it does and where."""

    def told(k: int) -> str:
        pair = int(point.system.active[pairs[k]])
        contact = view.model.contacts[view.interface.contact[pair]].label
        node = view.model.mesh.labels[view.interface.node[pair]]
        return f"node {node} of '{contact}' {what[k]} before load factor {point.load_factor:.6g}"

    return told
