# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of a history that ranks keep by rows, an even share each, and the first one asks for when it needs them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from signorini.arrays import Array, frozen
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
    array : what they are to keep
    """

    def __init__(self, team: Team, array: Array) -> None:
        self.shape, self.dtype = array.shape, array.dtype
        self._team, self._number = team, team.kept(self)
        self._home: Array | None = None
        self._ends = np.linspace(0, len(array), team.size + 1).astype(np.int64)
        parts = (array[first:last] for first, last in zip(self._ends[:-1], self._ends[1:], strict=True))
        team.everywhere(_keep, self._number, pieces=parts)
        team.away.add(self)

    def blocks(self) -> Iterator[tuple[int, Array]]:
        """Its rows, a rank's at a time, each with the number of the first."""
        for rank, first in enumerate(self._ends[:-1]):
            if self._home is None:
                yield int(first), self._team.everywhere(_give, self._number, rank)[rank]
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


def put_away(array: Array) -> Any:
    """An array that ranks keep, a `RowsKept`, where there are several and it is large; otherwise the array itself.

    Parameters
    ----------
    array : read-only

    Examples
    --------
    >>> one = frozen(np.zeros((1000, 3)))
    >>> put_away(one) is one
    True
    """
    team = several_ranks()
    return array if team is None or array.nbytes < _WORTH else RowsKept(team, array)


def _keep(team: Team, rows: Array, number: int) -> None:
    """Keep rows of an array: a copy, so that the rest of it can go."""
    team.held[number] = frozen(rows, rows.dtype)


def _give(team: Team, number: int, rank: int) -> Array | None:
    """What this rank keeps, where it is asked for."""
    found: Array = team.held[number]
    return found if team.rank == rank else None
