# SPDX-License-Identifier: BSD-3-Clause
"""Tables of a deck and their keys, checked."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeVar

from signorini.checks import text
from signorini.errors import InputError, Where

Made = TypeVar("Made")


def table(value: Any, where: Where) -> dict[str, Any]:
    """A table, or what was found instead."""
    if not isinstance(value, dict):
        raise InputError(f"is {value!r}; expected a table", where=where)
    return value


def tables(data: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    """The entries of an array of tables, none if the key is not there."""
    value = data.get(key, [])
    if isinstance(value, dict):
        raise InputError(f"is a single table; expected [[{key}]], in double brackets, for each", where=(key,))
    if not isinstance(value, list):
        raise InputError(f"is {value!r}; expected [[{key}]] tables", where=(key,))
    return [table(entry, (key, i)) for i, entry in enumerate(value)]


def check_keys(data: Mapping[str, Any], where: Where, *, known: Collection[str], needed: Collection[str] = ()) -> None:
    """Refuse keys that are not known (the nearest known one is named) and tables that lack one.

    Parameters
    ----------
    data : a table
    where : its path in the deck
    known, needed : keys that it may have, and those that it must

    Examples
    --------
    >>> check_keys({"nx": 2, "hight": 1.0}, ("mesh",), known=["nx", "ny", "height"])
    Traceback (most recent call last):
    signorini.errors.InputError: mesh.hight: unknown key; did you mean 'height'? Known: nx, ny, height
    """
    for key in data:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"; did you mean '{near[0]}'?" if near else "."
            raise InputError(f"unknown key{hint} Known: {', '.join(known)}", where=(*where, key))
    for key in needed:
        if key not in data:
            raise InputError(f"has no '{key}'; expected it", where=where)


def make(kind: Callable[..., Made], data: Mapping[str, Any], where: Where) -> Made:
    """Call a constructor with the keys of a table: its parameters are the known keys, those without default needed.

    Parameters
    ----------
    kind : the constructor
    data : the table
    where : its path in the deck

    Raises
    ------
    InputError
        What :func:`check_keys` or the constructor finds wrong, with the path from the top of the deck.
    """
    parameters = inspect.signature(kind).parameters
    needed = [name for name, parameter in parameters.items() if parameter.default is parameter.empty]
    check_keys(data, where, known=list(parameters), needed=needed)
    if "name" in data:
        text(data["name"], (*where, "name"))
    try:
        return kind(**data)
    except InputError as error:
        raise error.inside(*where) from error
