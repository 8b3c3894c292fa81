# SPDX-License-Identifier: BSD-3-Clause
"""Arrays over all displacements whose entries are on the ranks, where they are computed with as if they were here.

Whoever has the formulas need not know: arithmetic of NumPy with such an array is done by every rank on its own entries,
and sums go to the first rank alone, added in the order of the ranks.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from signorini.arrays import Array, IntArray, frozen, index_type
from signorini.distributed.kept_rows import RowsKept, give, keep, rows_of_all
from signorini.distributed.ranks import Team


class Cut:
    """Which entries of an array every rank has.

    Attributes
    ----------
    team : the ranks
    size : entries of all of them
    number : under which every rank holds the numbers of its own, ascending
    rank_of : (k,) the rank of each of some entries (k,)
    entries_of : the entries of a rank, ascending

    Parameters
    ----------
    team, size, rank_of, entries_of : as above
    """

    def __init__(
        self,
        team: Team,
        size: int,
        rank_of: Callable[[IntArray], IntArray],
        entries_of: Callable[[int], IntArray],
    ) -> None:
        self.team, self.size, self.rank_of, self.entries_of = team, size, rank_of, entries_of
        self.number = team.kept(self)
        narrow = index_type(size)
        team.everywhere(keep, self.number, pieces=(own.astype(narrow) for own in self.entries()))

    def entries(self) -> Iterator[IntArray]:
        """Numbers of the entries of every rank, ascending; made one after the other, they are not kept here."""
        return (self.entries_of(rank) for rank in range(self.team.size))

    def of(self, values: Any) -> ArrayOnRanks:
        """An array (size,) on the ranks; itself if it is there."""
        if isinstance(values, ArrayOnRanks):
            if values.cut is self and not values.home:
                return values
            values = values.whole()
        if isinstance(values, RowsKept) and not values.home and values.shape == (self.size,):
            return self.made(_kept_by_rows, self.number, *values.place, dtype=values.dtype)
        found = ArrayOnRanks(self, values.dtype)
        self.team.everywhere(keep, found.number, pieces=(values[own] for own in self.entries()))
        return found

    @property
    def zeros(self) -> ArrayOnRanks:
        """(size,) Zeros."""
        return self.made(_zeros, self.number)

    def spread(self, numbers: IntArray, values: Array) -> ArrayOnRanks:
        """Values (k,) at some entries (k,), zero elsewhere."""
        found, ranks = ArrayOnRanks(self, np.dtype(np.float64)), self.rank_of(numbers)
        own = (ranks == rank for rank in range(self.team.size))
        pieces = ((numbers[here], values[here]) for here in own)
        self.team.everywhere(_spread, self.number, found.number, pieces=pieces)
        return found

    def made(self, work: Callable[..., Any], *given: Any, dtype: Any = np.float64) -> ArrayOnRanks:
        """What a function makes on every rank of what is given, entries of arrays on ranks among it.

        Parameters
        ----------
        work : ``work(team, *given)``, a function of a module
        given : its arguments
        dtype : of what it makes
        """
        found = ArrayOnRanks(self, dtype)
        self.team.soon(_made, found.number, work, references(given))
        return found


class _There(NamedTuple):
    """In place of what is on ranks: its number."""

    number: int


class KeptThere:
    """Something that ranks keep, each its part, until nobody has this any more.

    Attributes
    ----------
    number : under which they do

    Parameters
    ----------
    team, parts : the ranks, and an array for each of them
    """

    def __init__(self, team: Team, parts: Iterable[Array]) -> None:
        self.number = team.kept(self)
        team.everywhere(keep, self.number, pieces=parts)


def references(given: Sequence[Any]) -> tuple[Any, ...]:
    """What ranks are given in place of what they have: its numbers."""
    return tuple(_There(each.number) if isinstance(each, ArrayOnRanks | KeptThere) else each for each in given)


def found_there(team: Team, given: Sequence[Any]) -> tuple[Any, ...]:
    """What this rank has by the `references` that it was given."""
    return tuple(team.held[each.number] if isinstance(each, _There) else each for each in given)


class ArrayOnRanks(NDArrayOperatorsMixin):
    """An array (n,) whose entries are on the ranks, see `signorini.arrays.ArrayElsewhere`.

    Functions of NumPy that go entry by entry are done there, and so are products of two such arrays, the largest entry,
    and the choice of some entries. Whatever else is asked of it is given all of it, which takes messages. It comes home
    when the ranks are let go.

    Attributes
    ----------
    cut : which entries every rank has
    dtype, shape, ndim : as of an array
    number : under which the ranks hold their entries

    Parameters
    ----------
    cut, dtype : as above
    """

    ndim = 1
    __hash__ = object.__hash__  # by what it is; as with arrays, equality is of the entries

    def __init__(self, cut: Cut, dtype: Any) -> None:
        self.cut, self.dtype, self.shape = cut, np.dtype(dtype), (cut.size,)
        self.number = cut.team.kept(self)
        self._home: Array | None = None
        cut.team.away.add(self)

    @property
    def home(self) -> bool:
        """Whether the ranks were let go."""
        return self._home is not None

    def whole(self) -> Array:
        """All of it, read-only."""
        if self._home is not None:
            return self._home
        result, team = np.empty(self.shape, self.dtype), self.cut.team
        for rank, own in enumerate(self.cut.entries()):
            result[own] = team.everywhere(give, self.number, rank)[rank]
        result.flags.writeable = False
        return result

    def kept(self, *shape: int) -> RowsKept:
        """A copy of which every rank has an even share of the rows: of its first entries as an array of a shape."""
        shape = shape or self.shape
        return RowsKept(self.cut.team, shape, self.dtype, gathered=(self.number, self.cut.number))

    def blocks(self) -> Iterator[tuple[int, Array]]:
        """Its entries, some at a time, each with the number of the first."""
        yield from [(0, self._home)] if self._home is not None else self.kept().blocks()

    def come_home(self) -> None:
        """Fetch all of it, for ranks that will not be asked again."""
        self._home = self.whole()

    def __len__(self) -> int:
        return self.cut.size

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        """All of it, for what is not done on ranks."""
        del copy  # it is one
        return np.asarray(self.whole(), dtype)

    def __reduce__(self) -> tuple[Any, ...]:
        """Whoever copies it or sends it has the array."""
        return frozen, (self.whole(), self.dtype)

    def __getitem__(self, index: Any) -> Any:
        """Entries with numbers (...); slices of all of it."""
        if isinstance(index, slice) or self._home is not None:
            return self.whole()[index]
        numbers = np.asarray(index)
        numbers = np.flatnonzero(numbers) if numbers.dtype == np.bool_ else numbers
        flat, team = numbers.ravel(), self.cut.team
        ranks, found = self.cut.rank_of(flat), np.empty(len(flat), self.dtype)
        own = [np.flatnonzero(ranks == rank) for rank in range(team.size)]
        parts = team.everywhere(_chosen, self.number, self.cut.number, pieces=(flat[here] for here in own))
        for here, part in zip(own, parts, strict=True):
            found[here] = part
        return found.reshape(numbers.shape) if numbers.ndim else found[0]

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **keywords: Any) -> Any:
        """A function of NumPy that goes entry by entry, or a product of two arrays."""
        if method != "__call__" or keywords or not self._goes_with(inputs):
            return getattr(ufunc, method)(*map(_whole, inputs), **keywords)
        given = self._there(inputs)
        if ufunc is np.matmul:
            return float(sum(self.cut.team.everywhere(_product, *(each.number for each in given))))
        return self.cut.made(_entrywise, ufunc, *given, dtype=_type_of(ufunc, given))

    def __array_function__(self, func: Any, kinds: Any, given: Any, keywords: Any) -> Any:
        """Choices between arrays on the ranks, zeros there, where something is; anything else of all of it."""
        del kinds
        if func is np.zeros_like and self._home is None:
            return self.cut.zeros
        if func is np.where and len(given) == 3 and self._goes_with(given):
            there = self._there(given)
            return self.cut.made(_entrywise, func, *there, dtype=_type_of(func, there))
        if func is np.flatnonzero and self._home is None:
            found = self.cut.team.everywhere(_not_zero, self.number, self.cut.number)
            return np.sort(np.concatenate(found))
        if func in {np.argmax, np.argmin} and self._home is None:
            ends = self.cut.team.everywhere(_extreme, func, self.number, self.cut.number)
            entries, values = zip(*sorted(end for end in ends if end), strict=True)
            return entries[int(func(values))]  # of equal ones the first
        return func(*_all_whole(given), **{name: _all_whole(value) for name, value in keywords.items()})

    def _goes_with(self, others: Sequence[Any]) -> bool:
        """Whether every rank can do its part: the others are numbers, or have as many entries."""
        return self._home is None and all(_shape(each) in {(), self.shape} for each in others)

    def _there(self, given: Sequence[Any]) -> list[Any]:
        """Numbers as they are, and arrays on the ranks."""
        return [self.cut.of(each) if _shape(each) else each for each in given]

    def max(self, initial: float = -np.inf) -> float:
        """The largest entry, or ``initial`` where that is larger; not a number where any is none."""
        if self._home is not None:
            return float(self._home.max(initial=initial))
        return float(np.max([initial, *self.cut.team.everywhere(_largest, self.number)]))

    def sum(self) -> float:
        """The sum of all entries."""
        return float(self._home.sum() if self._home is not None else sum(self._of_ranks(np.sum)))

    def all(self) -> bool:
        """Whether no entry is zero or False."""
        return bool(self._home.all() if self._home is not None else all(self._of_ranks(np.all)))

    def any(self) -> bool:
        """Whether any entry is not zero or True."""
        return bool(self._home.any() if self._home is not None else any(self._of_ranks(np.any)))

    def _of_ranks(self, work: Callable[[Array], Any]) -> list[Any]:
        return self.cut.team.everywhere(_reduced, work, self.number)


class Remembered:
    """Arrays of the first rank that all have, each as long as the first one has it."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[weakref.ref[Any], ArrayOnRanks]] = {}

    def of(self, cut: Cut, values: Any) -> ArrayOnRanks:
        """An array (size,), which nobody changes, on the ranks.

        Parameters
        ----------
        cut : which entries they have
        values : the array
        """
        if isinstance(values, ArrayOnRanks):
            return cut.of(values)
        known = self._known.get(id(values))
        if known is None or known[0]() is not values:
            self._known = {key: found for key, found in self._known.items() if found[0]() is not None}
            known = self._known[id(values)] = weakref.ref(values), cut.of(values)
        return known[1]


def _shape(value: Any) -> tuple[int, ...]:
    return value.shape if isinstance(value, ArrayOnRanks) else np.shape(value)


def _whole(value: Any) -> Any:
    return value.whole() if isinstance(value, ArrayOnRanks) else value


def _all_whole(given: Any) -> Any:
    """Arguments of a function of NumPy, which may be lists of arrays."""
    return type(given)(_all_whole(each) for each in given) if isinstance(given, list | tuple) else _whole(given)


def _type_of(work: Callable[..., Any], given: Sequence[Any]) -> Any:
    """Type of the entries that a function of NumPy makes of arrays on the ranks and numbers."""
    return work(*(np.empty(0, each.dtype) if isinstance(each, ArrayOnRanks) else each for each in given)).dtype


def _made(team: Team, number: int, work: Callable[..., Any], given: tuple[Any, ...]) -> None:
    """Make entries of this rank, and keep them."""
    team.held[number] = work(team, *found_there(team, given))


def _entrywise(team: Team, work: Callable[..., Any], *given: Any) -> Any:
    del team
    return work(*given)


def _kept_by_rows(team: Team, entries: int, number: int, ends: IntArray) -> Array:
    return rows_of_all(team, number, ends, team.held[entries])


def _zeros(team: Team, entries: int) -> Array:
    return np.zeros(len(team.held[entries]))


def _spread(team: Team, piece: tuple[IntArray, Array], entries: int, number: int) -> None:
    """Keep values at some of the entries of this rank."""
    numbers, values = piece
    own = team.held[entries]
    result = team.held[number] = np.zeros(len(own))
    result[np.searchsorted(own, numbers)] = values


def _chosen(team: Team, numbers: IntArray, number: int, entries: int) -> Array:
    found: Array = team.held[number][np.searchsorted(team.held[entries], numbers)]
    return found


def _not_zero(team: Team, number: int, entries: int) -> IntArray:
    """Numbers of entries of this rank that are not zero."""
    found: IntArray = team.held[entries][team.held[number] != 0]
    return found


def _extreme(team: Team, func: Callable[[Array], Any], number: int, entries: int) -> tuple[int, Any] | None:
    """Number and value of the largest or smallest entry of this rank; None where it has none."""
    own = team.held[number]
    k = int(func(own)) if len(own) else 0
    return (int(team.held[entries][k]), own[k]) if len(own) else None


def _product(team: Team, one: int, other: int) -> float:
    return float(team.held[one] @ team.held[other])


def _largest(team: Team, number: int) -> float:
    return float(team.held[number].max(initial=-np.inf))


def _reduced(team: Team, work: Callable[[Array], Any], number: int) -> Any:
    return work(team.held[number])
