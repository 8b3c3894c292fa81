# SPDX-License-Identifier: BSD-3-Clause
"""Checks of single values that users give: each returns the value, typed, or says what was found and expected."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError, Where, one_of

MAX_NUMBER = 1e100
"""Size of a number that is given: what is larger leaves no room to compute, its square least of all."""

_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")
"""Line ends, what terminals obey, and what turns the direction of writing."""


def number(
    value: Any, where: Where, *, above: float = -math.inf, below: float = math.inf, least: float = -math.inf
) -> float:
    """A finite number with ``above < value < below`` and ``value >= least``, named by where it stands.

    >>> number(-1, ("E",), above=0)
    Traceback (most recent call last):
    signorini.errors.InputError: E: is -1; expected a number > 0
    """
    limits = [
        f"{sign} {limit:g}" for sign, limit in ((">", above), (">=", least), ("<", below)) if math.isfinite(limit)
    ]
    expected = f"a number{' ' if limits else ''}{' and '.join(limits)}"
    if isinstance(value, bool) or not hasattr(value, "__float__") or np.ndim(value):
        raise InputError(f"is {value!r}; expected {expected}", where=where)
    try:
        found = float(value)
    except OverflowError as error:
        raise InputError(f"is {_shown(value)}; expected {expected}", where=where) from error
    if math.isfinite(found) and abs(found) > MAX_NUMBER:
        raise InputError(f"is {found!r}; expected {expected} of at most {MAX_NUMBER:g}", where=where)
    if not (math.isfinite(found) and above < found < below and found >= least):
        raise InputError(f"is {value!r}; expected {expected}", where=where)
    return found


def whole(value: Any, where: Where, *, least: int = 1, most: int | None = None) -> int:
    """The value as a whole number of at least ``least`` and at most ``most``, named by where it stands."""
    expected = f"a whole number >= {least}" + (f" and <= {most}" if most is not None else "")
    if isinstance(value, bool) or not hasattr(value, "__index__") or int(value) < least:
        shown = _shown(value) if hasattr(value, "__index__") else repr(value)
        raise InputError(f"is {shown}; expected {expected}", where=where)
    if most is not None and int(value) > most:
        raise InputError(f"is {_shown(value)}; expected {expected}", where=where)
    return int(value)


def text(value: Any, where: Where) -> str:
    """A non-empty text in one line, which a terminal shows as it is."""
    if not isinstance(value, str) or not value:
        raise InputError(f"is {value!r}; expected a name (text)", where=where)
    if _CONTROL.search(value):
        raise InputError(f"is {value!r}; expected a name without line ends and control characters", where=where)
    return value


def choice(value: Any, known: Collection[str], where: Where, what: str) -> str:
    """The value as one of the known words for what it names, itself named by where it stands."""
    if not isinstance(value, str) or value not in known:
        raise InputError(one_of(str(value), known, what), where=where)
    return value


def vector(value: Any, where: Where, *, dimension: int | None = None) -> tuple[float, ...]:
    """The value as a list of finite numbers, of the given dimension, named by where it stands."""
    return tuple(part for part in components(value, where, dimension=dimension, free=False) if part is not None)


def components(
    value: Any, where: Where, *, dimension: int | None = None, free: bool = True
) -> tuple[float | None, ...]:
    """The value as a list of components, each a finite number or, where ``free`` allows it, None.

    In a deck that is ``"free"``; ``dimension`` is how many there must be, and ``where`` names them.

    >>> components([0.0, None], ("u",), dimension=2)
    (0.0, None)
    """
    size = "a list of" if dimension is None else f"a list of {dimension}"
    kind = 'numbers or "free"' if free else "numbers"
    if isinstance(value, str) or (not isinstance(value, Sequence) and not hasattr(value, "__array__")):
        raise InputError(f"is {value!r}; expected {size} {kind}", where=where)
    if dimension is not None and len(value) != dimension:
        raise InputError(f"has {len(value)} components, {list(value)!r}; expected {size} {kind}", where=where)
    parts: list[float | None] = []
    for i, part in enumerate(value):
        if free and (part is None or part == "free"):
            parts.append(None)
        elif free and isinstance(part, str):
            raise InputError(f'is {part!r}; expected a number or "free"', where=(*where, i))
        else:
            parts.append(number(part, (*where, i)))
    return tuple(parts)


def _shown(value: Any) -> str:
    """A number as it is, if that is short."""
    return f"{value!r}" if -(10**30) < value < 10**30 else "a number of more than 30 digits"


def rows(value: Any, where: Where, *, size: int) -> Array:
    """The value as rows of finite numbers, (n, size), named by where it stands.

    >>> rows([[0, 1], [2.5, 3]], ("points",), size=2).tolist()
    [[0.0, 1.0], [2.5, 3.0]]
    """
    try:
        found = np.asarray(value, float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"holds what is no number; expected rows of {size} numbers", where=where) from error
    if found.ndim != 2 or found.shape[1] != size:
        raise InputError(f"has shape {found.shape}; expected (n, {size})", where=where)
    if not np.isfinite(found).all():
        raise InputError("holds what is no finite number", where=where)
    return found


def members(values: Any, kind: type, part: str) -> tuple[Any, ...]:
    """Values of one class, or a single one.

    Parameters
    ----------
    values : one or several
    kind : their class
    part : plural under which a model has them, for messages
    """
    irregular = {"bodies": "body", "rigid_bodies": "rigid_body", "cyclic_symmetries": "cyclic_symmetry"}
    singular = irregular.get(part, part.removesuffix("s"))
    if isinstance(values, kind):
        values = (values,)
    for i, value in enumerate(values):
        if not isinstance(value, kind):
            raise InputError(f"is {value!r}; expected a {kind.__name__}", where=(singular, i))
    return tuple(values)


def refuse_beside(key: str, *found: tuple[bool, str]) -> None:
    """Refuse a value beside what does not go with it: whether each is there, with its words.

    Parameters
    ----------
    key : of the value
    found : what does not go with it

    Raises
    ------
    InputError
        For the first that is there.
    """
    for there, words in found:
        if there:
            raise InputError(f"is given, but {words}; expected one of both", where=(key,))
