# SPDX-License-Identifier: BSD-3-Clause
"""Decks written anew from their keywords: with what they include, and with smaller loads."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from signorini.deck.inp.block import Block, Row, decode, to_number

_LOADS = {"CLOAD": 2, "DLOAD": 2, "DSLOAD": 2, "BOUNDARY": 3, "TEMPERATURE": 1}
"""Where the value of a load stands in its data lines."""


def deck_text(blocks: Iterable[Block], *, share: float = 1.0) -> str:
    """A deck with a share of its loads, of its prescribed displacements and of its temperatures.

    CalculiX's springs of contact pull a little where the sides are apart, by up to the second number of their law,
    which is taken to the square of the share: what is left of it goes with the square of the load.
    """
    lines: list[str] = []
    for block in blocks:
        lines.append(keyword_line(block))
        lines += data_lines(block) if share == 1.0 else scaled_lines(block, share)
    return "\n".join([*lines, ""])


def keyword_line(block: Block) -> str:
    given = [f"{key}={value}" if value else key for key, value in block.parameters.items()]
    return ", ".join([f"*{block.keyword}", *given])


def data_lines(block: Block) -> list[str]:
    """As they stand."""
    return [line for _, _, data in block.chunks for line in decode(data).splitlines() if line.strip()]


def scaled_lines(block: Block, share: float) -> Iterator[str]:
    """The data lines of a keyword with a share of its loads."""
    if block.keyword == "SURFACE BEHAVIOR" and block.get("PRESSURE-OVERCLOSURE") == "LINEAR":
        return (_scaled(row, 1, share**2) for row in block.rows())
    if block.keyword in _LOADS:
        return (_scaled(row, _LOADS[block.keyword], share) for row in block.rows())
    return iter(data_lines(block))


def _scaled(row: Row, place: int, share: float) -> str:
    value = to_number(row.fields[place]) if len(row.fields) > place and row.fields[place] else None
    if value is None:
        return ", ".join(row.fields)
    return ", ".join([*row.fields[:place], f"{share * value:.12g}", *row.fields[place + 1 :]])
