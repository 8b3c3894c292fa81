# SPDX-License-Identifier: BSD-3-Clause
"""One keyword of an Abaqus or CalculiX deck with its parameters and data lines."""

from __future__ import annotations

import itertools
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from signorini.arrays import Array
from signorini.checks import MAX_NUMBER
from signorini.deck.error import DeckError
from signorini.errors import one_of

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([EeDd][+-]?\d+)?")
NUMBER_LIMIT = 10**10
"""Numbers of nodes and elements are smaller: they have at most ten digits."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Scope:
    """Where names and numbers are known: an instance, or the deck itself (name "").

    Attributes
    ----------
    name : of the instance
    turn, shift : an instance's points are ``turn @ x + shift``
    """

    name: str = ""
    turn: Array = field(default_factory=lambda: np.eye(3))
    shift: Array = field(default_factory=lambda: np.zeros(3))

    def prefixed(self, name: str) -> str:
        """A name of this scope as the whole deck knows it: ``INSTANCE.NAME``."""
        return f"{self.name}.{name}" if self.name else name


DECK = Scope()


@dataclass(frozen=True, kw_only=True, eq=False)
class Row:
    """One data line: its fields without blanks around them, and where it stands.

    Attributes
    ----------
    fields : without the empty ones at the end
    path, line : where it stands, the line from 1
    scope : of its names and numbers
    """

    fields: tuple[str, ...]
    path: Path
    line: int
    scope: Scope = DECK

    def error(self, message: str) -> DeckError:
        """The message with the place of the line."""
        return DeckError(message, path=self.path, line=self.line)

    def text(self, i: int, what: str) -> str:
        """Field i, which must be there."""
        if i >= len(self.fields) or not self.fields[i]:
            raise self.error(f"has {len(self.fields)} fields; expected {what} in field {i + 1}")
        return self.fields[i]

    def number(self, i: int, what: str, default: float | None = None) -> float:
        """Field i as a number; D may stand for E in its exponent.

        Parameters
        ----------
        i : from 0
        what : is expected there, in words
        default : where the field is empty
        """
        if default is not None and (i >= len(self.fields) or not self.fields[i]):
            return default
        word = self.text(i, what)
        value = to_number(word)
        if value is None:
            raise self.error(f"has '{word}' in field {i + 1}; expected {what}, a number")
        return value

    def whole(self, i: int, what: str, default: int | None = None) -> int:
        """Field i as a whole number; ``what`` is expected there, the default where it is empty."""
        value = self.number(i, what, default)
        if value != int(value) or abs(value) >= NUMBER_LIMIT:
            raise self.error(
                f"has '{self.fields[i]}' in field {i + 1}; expected {what}, a whole number of at most ten digits"
            )
        return int(value)


@dataclass(frozen=True, kw_only=True, eq=False)
class Card:
    """A keyword line and the data lines that follow it.

    Attributes
    ----------
    keyword : in capitals with single blanks, without the asterisk: ``"CONTACT PAIR"``
    parameters : in capitals to their values as written, empty where there is none
    path, line : where the keyword stands, the line from 1
    chunks : the data lines as they stand, comments cut out: file, first line and bytes of each piece; files are read
        into it
    scope : of its names and numbers
    """

    keyword: str
    parameters: Mapping[str, str]
    path: Path
    line: int
    chunks: list[tuple[Path, int, bytes]]
    scope: Scope = DECK

    def error(self, message: str) -> DeckError:
        """The message with keyword and place."""
        return DeckError(f"*{self.keyword}: {message}", path=self.path, line=self.line)

    def at(self, row: Row) -> Card:
        """The keyword as one that stands at one of its data lines: whatever is said of it names that line."""
        return replace(self, path=row.path, line=row.line)

    def rows(self) -> Iterator[Row]:
        """The data lines that are not blank."""
        for path, first, data in self.chunks:
            for offset, words in enumerate(decode(data).split("\n")):
                if words.strip():
                    fields = [field.strip() for field in words.split(",")]
                    while fields and not fields[-1]:
                        fields.pop()
                    yield Row(fields=tuple(fields), path=path, line=first + offset, scope=self.scope)

    def row_with(self, field: int) -> Row:
        """The data line that holds a field, counted from 0 through all lines."""
        for row in self.rows():
            if field < len(row.fields):
                return row
            field -= len(row.fields)
        raise IndexError("the data lines have fewer fields")

    def row_of(self, number: int) -> Row:
        """A data line by its number, from 0, blank ones not counted."""
        return next(itertools.islice(self.rows(), number, None))

    @cached_property
    def has_data(self) -> bool:
        """Whether any data line is not blank."""
        return any(not data.isspace() and data for _, _, data in self.chunks)

    def row(self, what: str) -> Row:
        """The first data line, which must be there."""
        for row in self.rows():
            return row
        raise self.error(f"has no data line; expected {what}")

    def value(self, name: str, what: str = "a name") -> str:
        """A parameter that must be there, as written."""
        if not self.parameters.get(name):
            raise self.error(f"has no {name}; expected {name}= and {what}")
        return self.parameters[name]

    def get(self, name: str, default: str = "") -> str:
        """A parameter in capitals with single blanks, or the default."""
        return " ".join(self.parameters.get(name, default).upper().split())

    def choice(self, name: str, known: Collection[str], default: str) -> str:
        """The parameter ``name``, one of the known words, in capitals; the default without it."""
        found = self.get(name, default)
        if found not in known:
            raise self.error(f"{name}: {one_of(found, known, 'value')}")
        return found

    def refuse_unknown(self, known: Collection[str], ignored: Collection[str] = ()) -> None:
        """Stop at a parameter whose effect nobody here knows."""
        for name in self.parameters:
            if name not in known and name not in ignored:
                raise self.error(f"parameter {name} is not supported; known: {', '.join(sorted(known)) or 'none'}")


def to_number(word: str) -> float | None:
    """A number as decks spell it, or None.

    >>> to_number("1.5D-3"), to_number("1e5x")
    (0.0015, None)
    """
    if not _NUMBER.fullmatch(word):
        return None
    value = float(word.upper().replace("D", "E"))
    return value if abs(value) <= MAX_NUMBER else None


def decode(data: bytes) -> str:
    """Text of a deck, whatever its encoding: what is not UTF-8 can only be in comments and names."""
    return data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")
