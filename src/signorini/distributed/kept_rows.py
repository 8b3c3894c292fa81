# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of a history that ranks keep by rows, an even share each, and the first one asks for when it needs them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.distributed.ranks import Team, several_ranks

_WORTH = 4096
"""Bytes from which an array is worth the messages."""


class RowsKept:
    """An array whose rows are on all ranks, see `signorini.arrays.ArrayElsewhere`.

    It comes home when the ranks are let go, and is forgotten by them when the first one has no use for it any more.

    Attributes
    ----------
    shape, dtype : of the array

    Parameters
    ----------
    team : the ranks
    shape, dtype : of the array
    gathered : numbers under which ranks hold entries of it, ascending, and those entries themselves
    array : all of it, where it is here
    """

    def __init__(
        self,
        team: Team,
        shape: tuple[int, ...],
        dtype: Any,
        *,
        gathered: tuple[int, int] | None = None,
        array: Array | None = None,
    ) -> None:
        self.shape, self.dtype = shape, np.dtype(dtype)
        self._team, self._number = team, team.kept(self)
        self._home: Array | None = None
        self._ends = np.linspace(0, shape[0], team.size + 1).astype(np.int64)
        if array is not None:
            parts = (array[first:last] for first, last in zip(self._ends[:-1], self._ends[1:], strict=True))
            team.everywhere(keep, self._number, pieces=parts)
        elif gathered is not None:
            team.everywhere(_gather, *gathered, self._ends, shape[1:], self._number)
        team.away.add(self)

    @classmethod
    def of(cls, team: Team, array: Array) -> RowsKept:
        """An array that is here.

        Parameters
        ----------
        team, array : the ranks and what they are to keep
        """
        return cls(team, array.shape, array.dtype, array=array)

    def kept(self, *_shape: int) -> RowsKept:
        """Itself, which has its shape."""
        return self

    def blocks(self) -> Iterator[tuple[int, Array]]:
        """Its rows, a rank's at a time, each with the number of the first."""
        for rank, first in enumerate(self._ends[:-1]):
            if self._home is None:
                yield int(first), self._team.everywhere(give, self._number, rank)[rank]
            else:
                yield int(first), self._home[first : self._ends[rank + 1]]

    def whole(self) -> Array:
        """All of it, read-only."""
        if self._home is not None:
            return self._home
        result = np.empty(self.shape, self.dtype)
        for first, rows in self.blocks():
            result[first : first + len(rows)] = rows
        result.flags.writeable = False
        return result

    def __getitem__(self, numbers: IntArray) -> Array:
        """(k, ...) Some rows, by their numbers (k,) in any order."""
        if self._home is not None:
            return self._home[numbers]
        rank = np.searchsorted(self._ends, numbers, side="right") - 1
        result = np.empty((len(numbers), *self.shape[1:]), self.dtype)
        own = [np.flatnonzero(rank == r) for r in range(self._team.size)]
        pieces = (numbers[here] - first for here, first in zip(own, self._ends, strict=False))
        for here, rows in zip(own, self._team.everywhere(_chosen, self._number, pieces=pieces), strict=True):
            result[here] = rows
        return result

    @property
    def home(self) -> bool:
        """Whether the ranks were let go."""
        return self._home is not None

    @property
    def place(self) -> tuple[int, IntArray]:
        """Where ranks find the rows that others keep, see `rows_of_all`."""
        return self._number, self._ends

    def come_home(self) -> None:
        """Fetch all of it, for ranks that will not be asked again."""
        self._home = self.whole()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """All of it, for NumPy, which writes it."""
        del copy  # it is one
        return np.asarray(self.whole(), dtype)

    def __reduce__(self) -> tuple[Any, ...]:
        """Whoever copies it or sends it has the array."""
        return frozen, (self.whole(), self.dtype)


def put_away(array: Any, shape: tuple[int, ...] = ()) -> Any:
    """An array that ranks keep, a `RowsKept`, where there are several and it is large; otherwise the array itself.

    Parameters
    ----------
    array : read-only, or on ranks in other shares
    shape : of the first entries of what is on ranks, if that is what is wanted of it

    Examples
    --------
    >>> one = frozen(np.zeros((1000, 3)))
    >>> put_away(one) is one
    True
    """
    team = several_ranks()
    if not isinstance(array, np.ndarray):
        kept = array.kept(*shape)
        return kept if team is not None else kept.whole()
    return array if team is None or array.nbytes < _WORTH else RowsKept.of(team, array)


def keep(team: Team, rows: Array, number: int) -> None:
    """Keep rows of an array: a copy, so that the rest of it can go.

    Parameters
    ----------
    team, rows, number : the ranks, what this one keeps, and under which number
    """
    team.held[number] = frozen(rows, rows.dtype)


def give(team: Team, number: int, rank: int) -> Array | None:
    """What this rank keeps, where it is asked for.

    Parameters
    ----------
    team, number, rank : the ranks, under which number it is kept, and which of them is asked
    """
    found: Array = team.held[number]
    return found if team.rank == rank else None


def rows_of_all(team: Team, number: int, ends: IntArray, wanted: IntArray) -> Array:
    """(k, ...) Rows that this rank wants of those that all keep; all of them ask each other at once.

    Parameters
    ----------
    team : the ranks
    number, ends : under which they keep them, and where the shares of the ranks begin and end
    wanted : (k,) their numbers, ascending
    """
    asked = team.comm.alltoall(np.split(wanted, np.searchsorted(wanted, ends[1:-1])))
    own, first = team.held[number], ends[team.rank]
    return np.concatenate(team.comm.alltoall([own[rows - first] for rows in asked]))


class OwnRows(NamedTuple):
    """Rows of arrays that a rank has found.

    Attributes
    ----------
    numbers : (k,) of the rows, ascending
    arrays : (k, ...) by name
    """

    numbers: IntArray
    arrays: Mapping[str, Any]


class _ForNow:
    """What ranks keep something for that is asked for at once."""


def rows_together(team: Team, number: int, name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> Any:
    """An array of the rows that ranks have found, which they keep in even shares; here where it is small.

    Parameters
    ----------
    team : the ranks
    number : under which those hold `OwnRows` that have any
    name, shape, dtype : of the array
    """
    if dtype.itemsize * math.prod(shape) < _WORTH:
        result = np.empty(shape, dtype)
        for numbers, rows in filter(None, team.everywhere(_own_rows, number, name)):
            result[numbers] = rows
        result.flags.writeable = False
        return result
    now = _ForNow()
    values, entries = team.kept(now), team.kept(now)
    team.everywhere(_lay_out, number, name, math.prod(shape[1:]), dtype, values, entries)
    return RowsKept(team, shape, dtype, gathered=(values, entries))


def _own_rows(team: Team, number: int, name: str) -> tuple[IntArray, Any] | None:
    """Own rows of an array, with their numbers."""
    own: OwnRows | None = team.held.get(number)
    return None if own is None else (own.numbers, own.arrays[name])


def _lay_out(team: Team, number: int, name: str, width: int, dtype: np.dtype[Any], values: int, entries: int) -> None:
    """Keep the entries of own rows, and their numbers, as `_gather` asks for them."""
    numbers, rows = _own_rows(team, number, name) or (np.zeros(0, np.int64), np.zeros(0))
    team.held[values] = np.asarray(rows).ravel().astype(dtype, copy=False)
    team.held[entries] = (width * numbers[:, None] + np.arange(width)).ravel()


def _chosen(team: Team, numbers: IntArray, number: int) -> Array:
    """Rows of this rank's share."""
    found: Array = team.held[number][numbers]
    return found


def _gather(team: Team, number: int, entries: int, ends: IntArray, row: tuple[int, ...], kept: int) -> None:
    """Keep a share of rows of what other ranks hold entries of."""
    width = math.prod(row)
    values, own = team.held[number], team.held[entries]
    first = np.searchsorted(own, width * ends)
    sent = [(own[one:other], values[one:other]) for one, other in pairwise(first)]
    result = np.empty((int(np.diff(ends)[team.rank]), *row), values.dtype)
    flat = result.reshape(-1)
    for here, part in team.comm.alltoall(sent):
        flat[here - width * int(ends[team.rank])] = part
    team.held[kept] = frozen(result, result.dtype)
