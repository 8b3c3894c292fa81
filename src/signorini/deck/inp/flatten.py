# SPDX-License-Identifier: BSD-3-Clause
"""Parts, instances and assemblies of Abaqus decks as one list of keywords, each with the instance it belongs to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.deck.inp.card import Card, Row, Scope

_OUTSIDE = ("ASSEMBLY", "END ASSEMBLY", "END PART", "END INSTANCE")


def flatten(cards: list[Card]) -> list[Card]:
    """Put the keywords of a part wherever an instance of it stands.

    Raises
    ------
    DeckError
        If an instance names no part, a part or an instance is not ended, or its motion is malformed.
    """
    parts: dict[str, list[Card]] = {}
    flat: list[Card] = []
    stream = iter(cards)
    for card in stream:
        if card.keyword == "PART":
            parts[card.value("NAME").upper()] = list(_until(stream, "END PART", card))
        elif card.keyword == "INSTANCE":
            card.refuse_unknown(("NAME", "PART"))
            name = card.value("PART").upper()
            if name not in parts:
                raise card.error(f"there is no part '{name}' before it")
            scope = _scope(card)
            inner = list(_until(stream, "END INSTANCE", card))
            flat += [replace(part, scope=scope) for part in (*parts[name], *inner)]
        elif card.keyword not in _OUTSIDE:
            flat.append(card)
    return flat


def _until(stream: Iterator[Card], end: str, start: Card) -> Iterator[Card]:
    for card in stream:
        if card.keyword == end:
            return
        yield card
    raise start.error(f"is not ended; expected *{end}")


def _scope(card: Card) -> Scope:
    """Translation in the first data line, then rotation about the line from a to b by an angle in degrees."""
    rows = list(card.rows())
    if len(rows) > 2:
        raise rows[2].error("*INSTANCE: has a third data line; expected a translation and a rotation")
    shift = _numbers(rows[0], 3) if rows else np.zeros(3)
    turn = np.eye(3)
    if len(rows) == 2:
        values = _numbers(rows[1], 7)
        a, axis = values[:3], values[3:6] - values[:3]
        size = np.linalg.norm(axis)
        if not size > 0.0:
            raise rows[1].error("*INSTANCE: the two points of the axis of rotation coincide")
        turn = rotation(axis / size, np.radians(values[6]))
        shift = turn @ (shift - a) + a  # the translation comes first
    return Scope(name=card.value("NAME").upper(), turn=turn, shift=shift)


def _numbers(row: Row, count: int) -> Array:
    return np.array([row.number(i, "a coordinate or an angle", 0.0) for i in range(count)])


def rotation(axis: Array, angle: float) -> Array:
    """Rodrigues' matrix of a turn by an angle, radians, about a unit axis (3,).

    >>> rotation(np.array([0.0, 0.0, 1.0]), np.pi / 2).round(12)[:, 0]
    array([0., 1., 0.])
    """
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Array = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return turn
