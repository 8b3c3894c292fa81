# SPDX-License-Identifier: BSD-3-Clause
"""From files to keywords with their data, each with its line and its instance; nothing is understood yet.

A line that begins with ``*`` is a keyword, with ``**`` a comment; every other line is data of the keyword before it
(before the first keyword it is a title). Case, blanks and line ends do not matter; a keyword line that ends with a
comma goes on in the next line, if that can be parameters.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from signorini.arrays import Array
from signorini.deck.error import DeckError
from signorini.deck.inp.card import Card, Row, Scope, decode
from signorini.deck.inp.keywords import canonical
from signorini.errors import InputError
from signorini.sources import Reach

_MAX_DEPTH = 10  # of files that include files: more include themselves
_MAX_INCLUDES = 1000  # of a deck: ten files that each include the next one ten times are ten thousand million
_SHOWN_CHARACTERS = 60  # of a line, in messages


def read_cards(path: Path, reach: Reach | None = None) -> list[Card]:
    """All keywords of a deck in order, with those of the files within reach, by default near it, that it includes."""
    cards: list[Card] = []
    _read(path, reach or Reach.of(path), cards, [], 0, None)
    return cards


def _read(path: Path, reach: Reach, cards: list[Card], included: list[Path], depth: int, by: Card | None) -> None:
    """Append the keywords of one file; data before its first keyword belong to the keyword before it, if any."""
    for line, starred, data in _pieces(_bytes(path, by)):
        if not starred:
            if cards and data and not data.isspace():
                cards[-1].chunks.append((path, line, data))
            continue
        card = _keyword(data, path, line)
        if card.keyword == "INCLUDE":
            if depth == _MAX_DEPTH:
                raise card.error(f"is the {_MAX_DEPTH + 1}th file inside another; does a file include itself?")
            included.append(_input_file(card, reach))
            if len(included) > _MAX_INCLUDES:
                raise card.error(
                    f"is the {_MAX_INCLUDES + 1}th file that is included; expected at most {_MAX_INCLUDES}"
                )
            _read(included[-1], reach, cards, included, depth + 1, card)
            continue
        cards.append(card)
        if card.keyword in ("NODE", "ELEMENT", "NSET", "ELSET", "AMPLITUDE") and "INPUT" in card.parameters:
            file = _input_file(card, reach)
            card.chunks.append((file, 1, _bytes(file, card)))


def _bytes(path: Path, by: Card | None) -> bytes:
    try:
        data = path.read_bytes()
    except OSError as error:
        words = "file not found" if isinstance(error, FileNotFoundError) else f"cannot be read: {error.strerror}"
        if isinstance(error, IsADirectoryError):
            words = "is a folder; expected a deck"
        if by is None:
            raise DeckError(words, path=path) from error
        raise by.error(f"'{path}': {words}") from error
    except ValueError as error:  # a name that no file can have
        raise DeckError(f"cannot be read: {error}", path=path) from error
    if b"\0" in data:
        message = "is not a text file; expected a deck of keywords, like *NODE"
        raise DeckError(message, path=path) if by is None else by.error(f"'{path}' {message}")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data.removeprefix(b"\xef\xbb\xbf")


def _pieces(data: bytes) -> Iterator[tuple[int, bool, bytes]]:
    """First line, whether it is a keyword, and bytes of every keyword line and every run of data; no comments."""
    at, line = 0, 1
    for start in _starred(data):
        if start < at:
            continue  # a continuation of a keyword line that begins with an asterisk
        if start > at:
            yield line, False, data[at:start]
            line += data.count(b"\n", at, start)
        end = _end(data, start)
        words = data[start:end].strip()
        comment = words.startswith(b"**") or words == b"*"
        while not comment and data[start:end].rstrip().endswith(b",") and _goes_on(data[end : _end(data, end)]):
            end = _end(data, end)
        if not comment:
            yield line, True, data[start:end]
        line += data.count(b"\n", start, end)
        at = end
    if at < len(data):
        yield line, False, data[at:]


def _starred(data: bytes) -> Iterator[int]:
    """Where lines begin whose first mark is an asterisk."""
    star = data.find(b"*")
    while star >= 0:
        start = data.rfind(b"\n", 0, star) + 1
        if not data[start:star].strip():
            yield start
        star = data.find(b"*", _end(data, star))


def _goes_on(line: bytes) -> bool:
    """Whether a line can go on with the parameters of the one before: it is neither a keyword nor data."""
    if b"=" in line:
        return not line.lstrip().startswith(b"*")
    words = [word.strip() for word in line.split(b",")]
    return all(word[:1].isalpha() for word in words if word) and any(words)


def _end(data: bytes, start: int) -> int:
    """Where the line that starts at ``start`` ends, its line end included."""
    end = data.find(b"\n", start)
    return len(data) if end < 0 else end + 1


def _keyword(data: bytes, path: Path, line: int) -> Card:
    name, *words = _fields(decode(data).strip()[1:].replace("\n", " "))
    parameters: dict[str, str] = {}
    card = Card(keyword=canonical(name), parameters=parameters, path=path, line=line, chunks=[])
    for word in words:
        key, _, value = word.partition("=")
        key = canonical(key)
        if key:
            if key in parameters:
                raise card.error(f"has {key} twice")
            parameters[key] = _unquoted(value.strip())
        elif value:
            raise card.error(f"has '{word.strip()[:_SHOWN_CHARACTERS]}'; expected NAME=value")
    return card


def _fields(text: str) -> list[str]:
    """Parts between commas, those inside quotation marks not counted."""
    if '"' not in text:
        return text.split(",")
    return re.findall(r'(?:"[^"]*"|[^,])+', text) or [text]


def _unquoted(word: str) -> str:
    return word[1:-1] if len(word) > 1 and word[0] == word[-1] == '"' else word


def _input_file(card: Card, reach: Reach) -> Path:
    """The file that INPUT names."""
    name = card.parameters.get("INPUT", "")
    if not name:
        raise card.error("has no INPUT; expected INPUT= and a file")
    try:
        return reach.file(name)
    except InputError as error:
        raise card.error(error.message) from error


_OUTSIDE = ("ASSEMBLY", "END ASSEMBLY", "END PART", "END INSTANCE")


def flatten(cards: list[Card]) -> list[Card]:
    """Put the keywords of a part wherever an instance of it stands."""
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
