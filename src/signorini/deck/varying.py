# SPDX-License-Identifier: BSD-3-Clause
"""What varies over a body or a boundary, as decks say it."""

from __future__ import annotations

from typing import Any

from signorini.checks import text
from signorini.deck.keys import check_keys, make
from signorini.errors import InputError, Where
from signorini.model.varying import Along, ArcLength, Formula, NodeValues
from signorini.sources import Reach

_AXES = ("x", "y", "z", "r")
_FILE_KEYS = ("file", "column", "start")


def deck_value(entry: Any, where: Where, reach: Reach, dimension: int) -> Any:
    """A table as the model takes it; anything else as it is.

    Tables: ``{ x = [...], value = [...] }`` along a coordinate; ``{ s = [...], value = [...], start = [x, y] }`` over
    arc length; ``{ node = [...], value = [...] }``; ``{ file = "name.csv", column = "p" }``.

    Parameters
    ----------
    entry : the value in the deck
    where : its path
    reach : files that it may name
    dimension : of the bodies
    """
    if not isinstance(entry, dict):
        return entry
    if "file" in entry:
        return _from_file(entry, where, reach, dimension)
    if "s" in entry:
        check_keys(entry, where, known=["s", "value", "start"], needed=["s", "value", "start"])
        data = {"at": entry["s"], "values": entry["value"], "start": entry["start"]}
        return make(ArcLength, data, where)
    if "node" in entry:
        check_keys(entry, where, known=["node", "value"], needed=["node", "value"])
        return make(NodeValues, {"nodes": entry["node"], "values": entry["value"]}, where)
    axes = [key for key in entry if key in _AXES]
    if len(axes) != 1:
        raise InputError(
            f"has {', '.join(entry) or 'nothing'}; expected a coordinate, s, node or file, as in x, value", where=where
        )
    check_keys(entry, where, known=[*axes, "value"], needed=["value"])
    return make(Along, {"axis": axes[0], "at": entry[axes[0]], "values": entry["value"]}, where)


def deck_values(entries: list[Any], where: Where, reach: Reach, dimension: int) -> Any:
    """Values of several directions, see :func:`deck_value`.

    Parameters
    ----------
    entries : a list
    where : its path in the deck
    reach : files that they may name
    dimension : of the bodies
    """
    parts = [deck_value(part, (*where, i), reach, dimension) for i, part in enumerate(entries)]
    return [
        make(NodeValues, {"values": part}, (*where, i)) if isinstance(part, list) else part
        for i, part in enumerate(parts)
    ]


def _from_file(entry: dict[str, Any], where: Where, reach: Reach, dimension: int) -> Any:
    from signorini.meshing.values import read_values  # brings meshio with it

    check_keys(entry, where, known=_FILE_KEYS)
    given = dict(entry)
    file = reach.file(text(given.pop("file"), (*where, "file")), (*where, "file"))
    if "column" in given:
        text(given["column"], (*where, "column"))
    try:
        return read_values(file, dimension=dimension, **given)
    except InputError as error:
        inner = [part for part in error.where if part in entry]
        raise InputError(error.message, where=(*where, *inner[:1])) from error


def spelled(value: Any) -> Any:
    """What varies as plain data that a deck holds; other values as they are.

    Raises
    ------
    InputError
        If a deck cannot say it.
    """
    if isinstance(value, Formula):
        return value.text
    if isinstance(value, Along):
        return {value.axis: value.at, "value": value.values}
    if isinstance(value, ArcLength):
        return {"s": value.at, "value": value.values, "start": value.start}
    if isinstance(value, NodeValues):
        values = value.values.tolist()
        return values if value.nodes is None else {"node": value.nodes.tolist(), "value": values}
    if callable(value):
        raise InputError(f"{value!r} is a function, which a deck cannot say; expected numbers or a table")
    return value
