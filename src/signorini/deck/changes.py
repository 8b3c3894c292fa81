# SPDX-License-Identifier: BSD-3-Clause
"""Keys of a deck by their dotted names, and a deck with other values of some of them."""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import Any

from signorini.errors import InputError, Where, one_of, spell

_INDEX = re.compile(r"\[(\d+)\]")
_LABELS = ("name", "on", "nonmortar")  # of entries of arrays of tables: the first that they have


def place_of(data: Mapping[str, Any], key: str) -> Where:
    """The path in a deck of a key that is spelled with dots: entries go by name or number, an only one by neither.

    The last part of the key need not be in the deck yet: its reader refuses what it does not know.

    Parameters
    ----------
    data : the whole deck
    key : as ``contact.hertz.friction``, ``contact[0].friction`` or ``load.pole.force[1]``

    Raises
    ------
    InputError
        If a table or an entry on the way is not there.

    Examples
    --------
    >>> deck = {"contact": [{"name": "a"}, {"nonmortar": "b.top", "friction": 0.1}], "mesh": {"nx": 2}}
    >>> place_of(deck, "contact.b.top.friction"), place_of(deck, "contact[0].gap"), place_of(deck, "mesh.nx")
    (('contact', 1, 'friction'), ('contact', 0, 'gap'), ('mesh', 'nx'))
    """
    where: Where = ()
    value: Any = data
    rest = key
    part: int | str
    while rest:
        if isinstance(value, list):
            part, rest = _entry(value, rest, where)
        elif isinstance(value, dict):
            part, rest = _own_key(value, rest)
        else:
            raise InputError(f"there is no '{key}' in the deck: '{spell(where)}' is {value!r}, which has no parts")
        where = (*where, part)
        if isinstance(part, str) and part not in value:
            if rest:
                raise InputError(f"there is no '{key}' in the deck: {one_of(part, map(str, value), 'key')}")
            return where
        value = value[part]
    return where


def changed(data: Mapping[str, Any], changes: Mapping[Where, Any]) -> dict[str, Any]:
    """The deck with other values.

    Parameters
    ----------
    data : the whole deck
    changes : path to value, as `place_of` has found it

    Examples
    --------
    >>> changed({"contact": [{"name": "a"}]}, {("contact", 0, "friction"): 0.3})
    {'contact': [{'name': 'a', 'friction': 0.3}]}
    """
    made = copy.deepcopy(dict(data))
    for where, value in changes.items():
        inner: Any = made
        for part in where[:-1]:
            inner = inner[part]
        inner[where[-1]] = value
    return made


def _entry(entries: list[Any], rest: str, where: Where) -> tuple[int, str]:
    """Number of the entry that a key begins with, and what is behind it."""
    found = _INDEX.match(rest)
    if found:
        number = int(found[1])
        if number >= len(entries):
            raise InputError(f"there is no {spell((*where, number))} in the deck; it has {len(entries)}")
        return number, rest[found.end() :].removeprefix(".")
    labels = [
        next((str(entry[key]) for key in _LABELS if key in entry), "") if isinstance(entry, dict) else ""
        for entry in entries
    ]
    fitting = [i for i, label in enumerate(labels) if label and _begins(rest, label)]
    if fitting:
        number = max(fitting, key=lambda i: len(labels[i]))
        return number, rest[len(labels[number]) :].removeprefix(".")
    if len(entries) == 1 and isinstance(entries[0], dict):
        return 0, rest
    raise InputError(one_of(rest.split(".")[0], filter(None, labels), f"{spell(where)} of the deck"))


def _own_key(table: Mapping[str, Any], rest: str) -> tuple[str, str]:
    """The key of a table that a name begins with, the longest where there are several, and what is behind it."""
    known = [str(key) for key in table if _begins(rest, str(key))]
    key = max(known, key=len) if known else re.split(r"[.\[]", rest)[0]
    return key, rest[len(key) :].removeprefix(".")


def _begins(rest: str, word: str) -> bool:
    return rest == word or rest.startswith((f"{word}.", f"{word}["))
