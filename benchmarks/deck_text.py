# SPDX-License-Identifier: BSD-3-Clause
"""Decks written anew from their keywords: with what they include, and with smaller loads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from signorini.deck.inp.card import Card, Row, decode, to_number

_LOADS = {"CLOAD": 2, "DLOAD": 2, "DSLOAD": 2, "BOUNDARY": 3, "TEMPERATURE": 1}
"""Where the value of a load stands in its data lines."""


def deck_text(cards: Iterable[Card], *, share: float = 1.0) -> str:
    """A deck with a share of its loads, of its prescribed displacements and of its temperatures.

    CalculiX's springs of contact pull a little where the sides are apart, by up to the second number of their law,
    which is taken to the square of the share: what is left of it goes with the square of the load.
    """
    lines: list[str] = []
    for card in cards:
        lines.append(keyword_line(card))
        lines += data_lines(card) if share == 1.0 else scaled_lines(card, share)
    return "\n".join([*lines, ""])


def keyword_line(card: Card) -> str:
    given = [f"{key}={value}" if value else key for key, value in card.parameters.items()]
    return ", ".join([f"*{card.keyword}", *given])


def data_lines(card: Card) -> list[str]:
    """As they stand."""
    return [line for _, _, data in card.chunks for line in decode(data).splitlines() if line.strip()]


def scaled_lines(card: Card, share: float) -> Iterator[str]:
    """The data lines of a keyword with a share of its loads."""
    if card.keyword == "SURFACE BEHAVIOR" and card.get("PRESSURE-OVERCLOSURE") == "LINEAR":
        return (_scaled(row, 1, share**2) for row in card.rows())
    if card.keyword in _LOADS:
        return (_scaled(row, _LOADS[card.keyword], share) for row in card.rows())
    return iter(data_lines(card))


def _scaled(row: Row, place: int, share: float) -> str:
    value = to_number(row.fields[place]) if len(row.fields) > place and row.fields[place] else None
    if value is None:
        return ", ".join(row.fields)
    return ", ".join([*row.fields[:place], f"{share * value:.12g}", *row.fields[place + 1 :]])
