# SPDX-License-Identifier: BSD-3-Clause
"""From a file to plain tables and the line of everything in them."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

from signorini.deck.error import DeckError
from signorini.deck.scan import scan
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
