# SPDX-License-Identifier: BSD-3-Clause
"""Values of a parameter as a command line says them, and all combinations of several parameters."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping, Sequence

import numpy as np

from signorini.errors import InputError

Value = float | int | str | bool

MOST_ROWS = 1_000_000
"""Combinations of a study: more of them are a slip of the pen."""

_DIGITS = 12  # of values between the ends, so that they are what a hand would write
_SPELLING = "FROM:TO:NUMBER, as in 0.1:0.9:9, or values between commas, as in 0.1,0.2"


def asked_values(words: str) -> tuple[str, tuple[Value, ...]]:
    """Key and values of ``KEY=FROM:TO:NUMBER`` or ``KEY=A,B,C``.

    Raises
    ------
    InputError
        If the words are neither.

    Examples
    --------
    >>> asked_values("friction.c=0.1:0.9:5"), asked_values("mesh.nx=8,16"), asked_values("mesh.nx=10:30:3")
    (('friction.c', (0.1, 0.3, 0.5, 0.7, 0.9)), ('mesh.nx', (8, 16)), ('mesh.nx', (10, 20, 30)))
    """
    key, sign, given = words.partition("=")
    where = ("--set",)
    if not (sign and key.strip() and given.strip()):
        raise InputError(f"is '{words}'; expected KEY={_SPELLING}", where=where)
    parts = given.split(":")
    if len(parts) == 1:
        found = tuple(_value(part.strip()) for part in given.split(","))
        if "" in found:
            raise InputError(f"is '{words}', with an empty value; expected KEY={_SPELLING}", where=where)
        return key.strip(), found
    ends = [_value(part.strip()) for part in parts]
    low, high, number = ends if len(ends) == 3 else ("", "", "")
    plain = all(isinstance(end, int | float) and not isinstance(end, bool) and math.isfinite(end) for end in ends)
    if len(ends) != 3 or not plain or not isinstance(number, int) or not 2 <= number <= MOST_ROWS:
        raise InputError(f"is '{words}'; expected KEY={_SPELLING}, NUMBER at least 2", where=where)
    return key.strip(), _between(low, high, number)


def combinations(values: Mapping[str, Sequence[Value]]) -> list[dict[str, Value]]:
    """All combinations of values, the last parameter changes first.

    Raises
    ------
    InputError
        If there are too many.

    Examples
    --------
    >>> combinations({"a": (1, 2), "b": ("x", "y")})[:2]
    [{'a': 1, 'b': 'x'}, {'a': 1, 'b': 'y'}]
    """
    number = math.prod(len(own) for own in values.values())
    if number > MOST_ROWS:
        raise InputError(f"there are {number} combinations; expected at most {MOST_ROWS}", where=("--set",))
    return [dict(zip(values, row, strict=True)) for row in itertools.product(*values.values())]


def _between(low: Value, high: Value, number: int) -> tuple[Value, ...]:
    """Equally many numbers apart, whole where both ends and all between are."""
    spaced = np.linspace(float(low), float(high), number)
    found = [float(f"{value:.{_DIGITS}g}") for value in spaced]
    whole = isinstance(low, int) and isinstance(high, int) and all(value.is_integer() for value in found)
    return tuple(int(value) for value in found) if whole else tuple(found)


def _value(words: str) -> Value:
    """A number where the words are one, a truth, or the words."""
    if words in ("true", "false"):
        return words == "true"
    if re.fullmatch(r"[+-]?\d+", words):
        return int(words)
    try:
        return float(words)
    except ValueError:
        return words
