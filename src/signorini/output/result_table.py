# SPDX-License-Identifier: BSD-3-Clause
"""Results as columns: a mapping of arrays, a CSV file, a pandas table where that is installed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from signorini.errors import InputError
from signorini.output.atomic_write import write_csv

if TYPE_CHECKING:
    import pandas

Column = np.ndarray[Any, np.dtype[Any]]


class ResultTable(Mapping[str, Column]):
    """Columns of equal length by name, in order; what is not known is NaN.

    >>> table = ResultTable({"load": np.array([0.5, 1.0]), "what": np.array(["event", "segment"])})
    >>> table
    ResultTable of 2 rows: load, what
    >>> table["load"].max().item(), list(table)
    (1.0, ['load', 'what'])

    Parameters
    ----------
    columns : known
    further : names of columns that take work, behind the others
    found : all of these, called when the first one is asked for
    """

    def __init__(
        self,
        columns: Mapping[str, Column],
        further: tuple[str, ...] = (),
        found: Callable[[], Mapping[str, Column]] | None = None,
    ) -> None:
        self._known, self._further, self._find = dict(columns), further, found

    @cached_property
    def _found(self) -> Mapping[str, Column]:
        return {} if self._find is None else self._find()

    def __getitem__(self, name: str) -> Column:
        if name in self._known:
            return self._known[name]
        if name not in self._further:
            raise KeyError(f"'{name}'; there are {', '.join(self)}")
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter((*self._known, *self._further))

    def __len__(self) -> int:
        """Columns."""
        return len(self._known) + len(self._further)

    @property
    def rows(self) -> int:
        """Length of every column."""
        return len(next(iter(self._known.values())))

    def __repr__(self) -> str:
        return f"ResultTable of {self.rows} rows: {', '.join(self)}"

    def to_dataframe(self) -> pandas.DataFrame:
        """The columns as a pandas table.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            words = "a DataFrame needs pandas; expected 'pip install pandas', or the columns as they are: 'dict(table)'"
            raise InputError(words) from None
        return pandas.DataFrame(dict(self))

    def write(self, path: str | Path) -> None:
        """Write the columns as ``*.csv``; numbers read back exactly, what is not known is empty.

        Raises
        ------
        InputError
            For any other name.
        """
        path = Path(path)
        if path.suffix.lower() != ".csv":
            raise InputError(f"is '{path}'; expected a name that ends in .csv", where=("path",))
        columns = {name: [_written(value) for value in self[name].tolist()] for name in self}
        rows = (dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True))
        write_csv(columns, rows, path)


def _written(value: Any) -> Any:
    if isinstance(value, float):
        return "" if math.isnan(value) else value + 0.0  # + 0.0: no "-0.0"
    return value
