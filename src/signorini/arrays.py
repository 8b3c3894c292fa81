# SPDX-License-Identifier: BSD-3-Clause
"""Array types and the few helpers that every layer shares."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from typing import Any, Protocol, TypeVar, runtime_checkable

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
SingleArray = NDArray[np.float32]
RealArray = NDArray[np.floating[Any]]
IntArray = NDArray[np.integer[Any]]
Int32Array = NDArray[np.int32]
BoolArray = NDArray[np.bool_]
Data = TypeVar("Data")


@runtime_checkable
class ArrayElsewhere(Protocol):
    """An array that is not in this process, which can ask for it."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]

    def whole(self) -> Array:
        """All of it, read-only; it is not kept here."""

    def blocks(self) -> Iterator[tuple[int, Array]]:
        """Its rows, some at a time, each with the number of the first."""


class _MaybeElsewhere:
    """A field of frozen data that is asked for where it is elsewhere."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, data: Any, _kind: Any = None) -> Any:
        value = self if data is None else vars(data)[self._name]
        whole = None if data is None else getattr(value, "whole", None)
        return value if whole is None else whole()

    def __set__(self, data: Any, value: Any) -> None:
        vars(data)[self._name] = value


def elsewhere(*names: str) -> Callable[[type[Data]], type[Data]]:
    """Let fields of a dataclass be arrays elsewhere: whoever asks for them has them whole, `stored` has what is here.

    Parameters
    ----------
    names : of the fields; without defaults

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @elsewhere("values")
    ... @dataclass(frozen=True)
    ... class Result:
    ...     values: Array
    >>> Result(np.ones(2)).values
    array([1., 1.])
    """

    def changed(kind: type[Data]) -> type[Data]:
        for name in names:
            setattr(kind, name, _MaybeElsewhere(name))
        return kind

    return changed


def stored(data: Any, name: str) -> Any:
    """A field of a dataclass as it is here: an array that is elsewhere is not asked for.

    Parameters
    ----------
    data, name : the data and their field
    """
    return vars(data)[name]


def replaced(data: Data, **others: Any) -> Data:
    """Frozen data with other fields, as ``dataclasses.replace`` has them; arrays that are elsewhere stay there.

    Parameters
    ----------
    data : of a dataclass
    others : fields that change

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Result:
    ...     name: str
    ...     values: Array
    >>> replaced(Result("one", np.ones(2)), name="other")
    Result(name='other', values=array([1., 1.]))
    """
    known: Any = data
    return type(data)(**{field.name: stored(data, field.name) for field in fields(known)} | others)


def in_blocks(values: Any) -> Iterator[tuple[int, NDArray[Any]]]:
    """The rows of an array, all at once or, of one elsewhere, some at a time, each with the number of the first.

    Parameters
    ----------
    values : the array

    Examples
    --------
    >>> list(in_blocks(np.ones(2)))
    [(0, array([1., 1.]))]
    """
    yield from [(0, values)] if isinstance(values, np.ndarray) else values.blocks()


def largest(values: Array | ArrayElsewhere) -> float:
    """Largest size of an entry, 0 of none; of an array elsewhere some rows after the others.

    >>> largest(np.array([1.0, -2.0]))
    2.0
    """
    return max((float(np.abs(part).max(initial=0.0)) for _, part in in_blocks(values)), default=0.0)


def operand(data: Any, name: str) -> Any:
    """A field of a dataclass to be computed with: the array, or one elsewhere that is computed with where it is.

    Parameters
    ----------
    data, name : the data and their field
    """
    value = stored(data, name)
    return value if isinstance(value, NDArrayOperatorsMixin) else getattr(data, name)


def frozen(values: ArrayLike, dtype: Any = np.float64) -> NDArray[Any]:
    """A read-only copy: values that are shared are never edited.

    >>> frozen([1, 2]).flags.writeable
    False
    """
    array = np.array(values, dtype=dtype)
    array.flags.writeable = False
    return array


def read_only(values: ArrayLike) -> Array:
    """Numbers that nobody can edit: the array itself where that is so, large ones are shared; else a copy.

    >>> one = read_only([1.0])
    >>> read_only(one) is one
    True
    """
    array = np.asarray(values, dtype=np.float64)
    return array if not array.flags.writeable and array.base is None else frozen(array)


def index_type(largest: int) -> type[np.integer[Any]]:
    """Of numbers up to the largest one: half as wide as usual where they fit.

    >>> index_type(7).__name__, index_type(2**31).__name__
    ('int32', 'int64')
    """
    return np.int32 if largest <= np.iinfo(np.int32).max else np.int64


def distinct(values: IntArray) -> IntArray:
    """The different values in ascending order; on many scattered ones several times faster than ``np.unique``.

    >>> distinct(np.array([3, 1, 3]))
    array([1, 3])
    """
    found = np.sort(values, axis=None)
    return found[np.concatenate([np.ones(min(1, len(found)), bool), found[1:] != found[:-1]])]


def extent(points: Array) -> Array:
    """(d,) Size of the box around points (n, d); of many points far faster than ``np.ptp``, direction by direction.

    >>> extent(np.array([[0.0, 1.0], [2.0, 5.0]])).tolist()
    [2.0, 4.0]
    """
    return np.asarray(np.ptp(np.ascontiguousarray(points.T), axis=1))


def among(lists: Iterable[IntArray], count: int) -> BoolArray:
    """(count,) Whether any of the lists holds a number.

    >>> among([np.array([3, 1]), np.array([[3, 0]])], 5)
    array([ True,  True, False,  True, False])
    """
    found = np.zeros(count, bool)
    for numbers in lists:
        found[numbers] = True
    return found


def places_among(numbers: IntArray, ascending: IntArray) -> tuple[BoolArray, IntArray]:
    """Which of some numbers (k,) an ascending list holds, and the places of these in it.

    >>> [part.tolist() for part in places_among(np.array([7, 3, 9]), np.array([3, 5, 7]))]
    [[True, True, False], [2, 0]]
    """
    place = np.searchsorted(ascending, numbers)
    here = place < len(ascending)
    here[here] = ascending[place[here]] == numbers[here]
    return here, place[here]


def sharing(values: IntArray) -> tuple[IntArray, IntArray]:
    """All pairs of entries that have one value, an entry and itself too: places of the first and of the second.

    >>> [part.tolist() for part in sharing(np.array([7, 3, 7]))]
    [[1, 0, 0, 2, 2], [1, 0, 2, 0, 2]]
    """
    order = np.argsort(values, kind="stable")
    _, start, count = np.unique(values[order], return_index=True, return_counts=True)
    each = np.repeat(count, count)
    within = np.arange(each.sum()) - np.repeat(np.cumsum(each) - each, each)
    return np.repeat(order, each), order[np.repeat(np.repeat(start, count), each) + within]


def padded(values: Array, width: int) -> Array:
    """Values (n,) or (n, k) with columns of zeros up to ``width``: what a plane model has in space.

    >>> padded(np.array([1.0, 2.0]), 2)
    array([[1., 0.],
           [2., 0.]])
    """
    table = values.reshape(len(values), -1) if values.size else np.zeros((len(values), width))
    return np.column_stack([table, np.zeros((len(table), width - table.shape[1]))])
