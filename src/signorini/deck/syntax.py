# SPDX-License-Identifier: BSD-3-Clause
"""From a file to plain tables and the line of everything in them."""

from __future__ import annotations

import itertools
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from signorini.deck.error import DeckError
from signorini.errors import Where

_PLACE = re.compile(r" \(at line (\d+), column (\d+)\)$")


def parse(path: Path) -> tuple[dict[str, Any], dict[Where, int]]:
    """Tables of a TOML file and their lines.

    Raises
    ------
    DeckError
        If there is no such file, it cannot be read, or it is not TOML, with the line.
    """
    try:
        text = path.read_bytes().decode("utf-8")
    except FileNotFoundError as error:
        raise DeckError("file not found", path=path) from error
    except IsADirectoryError as error:
        raise DeckError("is a folder; expected a deck, a TOML file", path=path) from error
    except UnicodeDecodeError as error:
        raise DeckError("is not a text file (UTF-8); expected a deck, a TOML file", path=path) from error
    except OSError as error:
        raise DeckError(f"cannot be read: {error.strerror}", path=path) from error
    try:
        return tomllib.loads(text), scan(text)
    except tomllib.TOMLDecodeError as error:
        raise _said(str(error), path, text) from error
    except RecursionError as error:
        raise DeckError("lists or tables are nested too deeply; expected a deck", path=path) from error
    except ValueError as error:  # a whole number of thousands of digits
        raise DeckError(f"not valid TOML: {error}", path=path) from error


def _said(message: str, path: Path, text: str) -> DeckError:
    found = _PLACE.search(message)
    if found is None:
        return DeckError(f"not valid TOML: {message}", path=path, line=text.count("\n") + 1)
    line, column = int(found[1]), int(found[2])
    words = message[: found.start()]
    shown = text.splitlines()[line - 1].strip() if line <= len(text.splitlines()) else ""
    return DeckError(f"not valid TOML: {words} at column {column}, in '{shown}'", path=path, line=line)


_KEY = re.compile(r"""[A-Za-z0-9_-]+|"(?:[^"\\]|\\.)*"|'[^']*'""")
_TEXT = re.compile(r"""\"\"\"(?:[^\\]|\\.)*?\"{3,5}|'''.*?'{3,5}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'""", re.DOTALL)
_BARE = re.compile(r"[^,\]}#\n]+")
_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")


def scan(text: str) -> dict[Where, int]:
    """Line of every table, key and entry of a valid TOML document, from 1, which the standard parser does not tell.

    Only the structure is followed, not its rules.

    Examples
    --------
    >>> scan('''[mesh]
    ... nx = 2
    ... [[load]]
    ... on = "top"
    ... force = [0.0,
    ...          "free"]
    ... ''')[("load", 0, "force", 1)]
    6
    """
    return _Scanner(text).document()


def line_of(lines: Mapping[Where, int], where: Where) -> int | None:
    """The line of a path, or of the nearest part of the document around it.

    >>> line_of({("load", 0): 3}, ("load", 0, "on"))
    3
    """
    for end in range(len(where), 0, -1):
        if where[:end] in lines:
            return lines[where[:end]]
    return None


class _Scanner:
    """Walks through a document once; ``_at`` is the place of the next character."""

    def __init__(self, text: str) -> None:
        self._text = text.replace("\r\n", "\n")
        self._at = 0
        self._lines: dict[Where, int] = {}
        self._entries: dict[Where, int] = {}  # arrays of tables and how many they have

    def document(self) -> dict[Where, int]:
        table: Where = ()
        while self._next():
            if self._text.startswith("[", self._at):
                table = self._header()
            else:
                self._pair(table)
        return self._lines

    def _next(self) -> str:
        """Skip what means nothing; the next character, empty at the end."""
        found = _BLANK.match(self._text, self._at)
        self._at = found.end() if found else self._at
        return self._text[self._at : self._at + 1]

    def _header(self) -> Where:
        line = self._line()
        double = self._text.startswith("[[", self._at)
        self._at += 2 if double else 1
        *outer, last = self._dotted()
        self._at += 2 if double else 1
        table: Where = ()
        for part in outer:
            table = self._inside((*table, part))
            self._lines.setdefault(table, line)
        table = (*table, last)
        if double:
            number = self._entries.get(table, 0)
            self._entries[table] = number + 1
            self._lines.setdefault(table, line)
            table = (*table, number)
        else:
            table = self._inside(table)
        self._lines[table] = line
        return table

    def _inside(self, table: Where) -> Where:
        """A path that goes through an array of tables goes through its last entry."""
        return (*table, self._entries[table] - 1) if table in self._entries else table

    def _pair(self, table: Where) -> None:
        line = self._line()
        path = table
        for part in self._dotted():
            path = (*path, part)
            self._lines.setdefault(path, line)
        self._next()
        self._at += 1  # the equals sign
        self._next()
        self._value(path)

    def _dotted(self) -> list[str]:
        parts = []
        while True:
            self._next()
            found = _KEY.match(self._text, self._at)
            assert found, f"no key at character {self._at} of a document that was said to be valid"
            parts.append(_bare(found.group()))
            self._at = found.end()
            if self._next() != ".":
                return parts
            self._at += 1

    def _value(self, path: Where) -> None:
        character = self._text[self._at]
        if character == "[":
            for number in self._members("]"):
                self._lines[(*path, number)] = self._line()
                self._value((*path, number))
        elif character == "{":
            for _ in self._members("}"):
                self._pair(path)
        else:
            pattern = _TEXT if character in "\"'" else _BARE
            found = pattern.match(self._text, self._at)
            assert found, f"no value at character {self._at} of a document that was said to be valid"
            self._at = found.end()

    def _members(self, end: str) -> Iterator[int]:
        """Stand at every member of an array or an inline table in turn, numbered from 0, and at last behind its end."""
        for number in itertools.count():
            self._at += 1  # the bracket, or the comma
            if self._next() == end:
                break
            yield number
            if self._next() == end:
                break
        self._at += 1

    def _line(self) -> int:
        return self._text.count("\n", 0, self._at) + 1


def _bare(key: str) -> str:
    """A key without its quotes; escapes are rare enough in keys to be read by the parser of values."""
    if key[0] == "'":
        return key[1:-1]
    if key[0] == '"':
        return str(tomllib.loads(f"key = {key}")["key"])
    return key
