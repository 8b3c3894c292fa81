# SPDX-License-Identifier: BSD-3-Clause
"""Data lines of numbers alone, read in bulk; where that fails, line by line, so that the wrong line can be named.

And numbers of nodes and elements, known inside an instance, as indices that count through everything.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.checks import MAX_NUMBER
from signorini.deck.inp.card import NUMBER_LIMIT, Card, Row, Scope

_EXPONENT = bytes.maketrans(b"Dd", b"ee")
_LETTERS = b"abcdfghijklmnopqrstuvwxyzABCDFGHIJKLMNOPQRSTUVWXYZ"  # but not e: 1e5


def bulk(data: bytes) -> tuple[Array, IntArray] | None:
    """All numbers of some lines and how many each line has (blank lines left out); None if that is not certain.

    >>> bulk(b"1, 0.5, 2\\n\\n2, 1.5D0,\\n")
    (array([1. , 0.5, 2. , 2. , 1.5]), array([3, 2]))
    >>> bulk(b"1, , 2\\n") is None
    True
    """
    plain = data.translate(_EXPONENT)
    compact = plain.translate(None, b" \t") + b"\n"
    if (
        b",," in compact
        or b"\n," in compact
        or compact.startswith(b",")
        or len(plain.translate(None, _LETTERS)) != len(plain)
    ):
        return None
    byte = np.frombuffer(compact, np.uint8)
    ends = np.flatnonzero(byte == ord("\n"))
    commas = np.searchsorted(np.flatnonzero(byte == ord(",")), ends)
    starts = np.concatenate([[0], ends[:-1] + 1])
    trailing = (ends > starts) & (byte[ends - 1] == ord(","))
    counts: IntArray = (np.diff(commas, prepend=0) + 1 - trailing)[ends > starts]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # how older NumPy tells unmatched data
            values = np.fromstring(plain.replace(b",", b" "), sep=" ")
    except (ValueError, DeprecationWarning):
        return None
    if len(values) != counts.sum() or not (np.abs(values) <= MAX_NUMBER).all():
        return None
    return values, counts


def number_table(card: Card, what: str, *, least: int, most: int) -> Array:
    """Data lines of numbers as a table, missing ones 0: (n, most).

    Parameters
    ----------
    card : of which the lines are
    what : what a line should hold, for messages
    least, most : numbers of a line
    """
    tables = []
    for part in _parts(card):
        found = bulk(part.chunks[0][2])
        if found is not None and len(found[1]) and found[1].min() == found[1].max() and least <= found[1][0] <= most:
            table = found[0].reshape(-1, int(found[1][0]))
            tables.append(np.pad(table, ((0, 0), (0, most - table.shape[1]))))
        else:
            tables.append(_by_line(part, what, least, most))
    return np.vstack(tables) if tables else np.empty((0, most))


def record_table(card: Card, size: int, what: str) -> IntArray:
    """Whole numbers in records of ``size``, each of which may go on over several lines: (n, size).

    Parameters
    ----------
    card : of which the lines are
    size : numbers of a record
    what : what a record should hold, for messages
    """
    tables = []
    for part in _parts(card):
        found = _bulk_of_whole(part)
        if found is None or len(found[0]) % size:
            return _records(card, size, what)
        if not np.isin(np.arange(size, len(found[0]) + 1, size), np.cumsum(found[1])).all():
            return _records(card, size, what)
        tables.append(found[0].reshape(-1, size))
    return np.vstack(tables) if tables else np.empty((0, size), np.int64)


def whole_numbers(card: Card) -> IntArray | None:
    """All data as whole numbers in one list; None if anything else is there (names, in sets)."""
    found = [_bulk_of_whole(part) for part in _parts(card)]
    if any(part is None for part in found):
        return None
    return np.concatenate([np.empty(0, np.int64), *(part[0] for part in found if part is not None)])


def _bulk_of_whole(part: Card) -> tuple[IntArray, IntArray] | None:
    """`bulk` of one piece of data where all numbers are whole and have at most ten digits."""
    found = bulk(part.chunks[0][2])
    if found is None or (found[0] != np.rint(found[0])).any() or np.abs(found[0]).max(initial=0) >= NUMBER_LIMIT:
        return None
    return found[0].astype(np.int64), found[1]


def _parts(card: Card) -> Iterator[Card]:
    """The card with one piece of its data at a time."""
    return (replace(card, chunks=[chunk]) for chunk in card.chunks)


def _by_line(card: Card, what: str, least: int, most: int) -> Array:
    rows = []
    for row in card.rows():
        if not least <= len(row.fields) <= most:
            raise row.error(f"*{card.keyword}: has {len(row.fields)} fields; expected {what}")
        rows.append([row.number(i, what, 0.0 if i else None) for i in range(most)])
    return np.array(rows, float).reshape(-1, most)


def _records(card: Card, size: int, what: str) -> IntArray:
    records: list[list[int]] = []
    current: list[int] = []
    last = None
    for last in card.rows():
        current += [last.whole(i, what) for i in range(len(last.fields))]
        if len(current) > size:
            raise last.error(f"*{card.keyword}: has {len(current)} numbers; expected {size}: {what}")
        if len(current) == size:
            records.append(current)
            current = []
    if current and last is not None:
        raise last.error(f"*{card.keyword}: ends after {len(current)} numbers; expected {size}: {what}")
    return np.array(records, np.int64).reshape(-1, size)


class Numbering:
    """Numbers of nodes or of elements, scope by scope.

    Parameters
    ----------
    what : "node" or "element", for messages
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self._sorted: dict[str, tuple[IntArray, IntArray]] = {}  # scope to numbers in order and their indices
        self._labels: list[IntArray] = []
        self._count = 0
        self._largest = 0

    def add(self, scope: str, numbers: IntArray) -> None:
        """Number what a scope holds, each number once; all of a scope at a time."""
        order = np.argsort(numbers, kind="stable")
        self._sorted[scope] = numbers[order], self._count + order
        shift = self._largest if self._labels and len(numbers) and self._clash(numbers) else 0
        self._labels.append(numbers + shift)
        self._count += len(numbers)
        self._largest = max(self._largest, int(numbers.max(initial=0)) + shift)

    def _clash(self, numbers: IntArray) -> bool:
        return bool(np.isin(numbers, np.concatenate(self._labels)).any())

    @property
    def labels(self) -> IntArray:
        """(n,) numbers for results: those of the deck; of instances that share numbers, the later ones are shifted."""
        return np.concatenate(self._labels) if self._labels else np.empty(0, np.int64)

    @property
    def shifted(self) -> bool:
        """Whether any number differs from the deck's."""
        return any(
            not np.array_equal(np.sort(a), b[0]) for a, b in zip(self._labels, self._sorted.values(), strict=True)
        )

    def find(self, scope: str, numbers: IntArray) -> tuple[IntArray, IntArray]:
        """Indices of numbers that are there, and places in ``numbers`` of those that are not."""
        known, index = self._sorted.get(scope, (np.empty(0, np.int64), np.empty(0, np.int64)))
        if not len(known):
            return np.empty(0, np.int64), np.arange(len(numbers))
        at = np.minimum(np.searchsorted(known, numbers), len(known) - 1)
        found = known[at] == numbers
        return index[at[found]], np.nonzero(~found)[0]

    def index(self, scope: Scope, numbers: IntArray, at: Card | Row | Callable[[int], Card]) -> IntArray:
        """Indices of numbers of a scope, all of which must be there; else ``at`` is blamed, or gives who is."""
        found, missing = self.find(scope.name, numbers)
        if len(missing):
            inside = f" in instance '{scope.name}'" if scope.name else ""
            blamed = at if isinstance(at, Card | Row) else at(int(missing[0]))
            raise blamed.error(f"there is no {self.what} {numbers[missing[0]]}{inside}")
        return found
