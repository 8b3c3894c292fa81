# SPDX-License-Identifier: BSD-3-Clause
"""The rows of M that hang together, so that their sizes can be compared: strongly connected parts of its graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from signorini.arrays import Array, IntArray
from signorini.lcp.linear import scaled

COUPLING = 1e-10  # balanced entries below it tie no rows together: the rounding they carry is below all tolerances


@dataclass(frozen=True, kw_only=True)
class ConnectedRows:
    """The parts of a matrix; between them the factor of units that balancing leaves open is any number.

    Attributes
    ----------
    label : (n,) part of every row and its column
    count : number of parts
    across : ``|M|`` with the entries inside the parts left out, None where there is one part
    """

    label: IntArray
    count: int
    across: Any | None

    @staticmethod
    def of(magnitude: Any, rows: Array, columns: Array) -> ConnectedRows:
        """The parts of a matrix of a magnitude ``|M|`` balanced by sizes of rows and columns (``residual.balance``).

        Examples
        --------
        >>> M = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [5.0, 0.0, 1.0]])
        >>> parts = ConnectedRows.of(M, np.array([3.0, 3.0, 6.0]), np.ones(3))
        >>> parts.label[0] == parts.label[1], parts.label[0] == parts.label[2]
        (np.True_, np.False_)
        """
        n = len(rows)
        if isinstance(magnitude, np.ndarray):
            if _reaches_all(magnitude, rows, columns) and _reaches_all(magnitude.T, 1.0 / columns, 1.0 / rows):
                return ConnectedRows(label=np.zeros(n, dtype=np.int64), count=1, across=None)
            strong: Any = sp.csr_array(magnitude * columns > COUPLING * rows[:, None])
        else:
            strong = sp.csr_array(scaled(magnitude, 1.0 / rows, columns) > COUPLING)
        count, label = connected_components(strong, directed=True, connection="strong")
        if count == 1:
            return ConnectedRows(label=label, count=1, across=None)
        if isinstance(magnitude, np.ndarray):
            return ConnectedRows(label=label, count=count, across=np.where(label[:, None] != label, magnitude, 0.0))
        entries = magnitude.tocoo()
        foreign = label[entries.row] != label[entries.col]
        taken = (entries.data[foreign], (entries.row[foreign], entries.col[foreign]))
        return ConnectedRows(label=label, count=count, across=sp.csr_array(taken, shape=magnitude.shape))

    def largest(self, sizes: Array) -> Array:
        """(n,) the largest size in the part of every row."""
        if self.count == 1:
            return np.full(len(sizes), sizes.max(initial=0.0))
        most = np.zeros(self.count)
        np.maximum.at(most, self.label, sizes)
        return np.asarray(most[self.label])


def _reaches_all(magnitude: Array, rows: Array, columns: Array) -> bool:
    """Whether every row can be reached from the first one along entries that together are not weak."""
    reached = np.zeros(len(rows), dtype=bool)
    fresh = np.arange(len(rows)) == 0
    while fresh.any():
        reached |= fresh
        fresh = ((fresh / rows) @ magnitude * columns > COUPLING) & ~reached
    return bool(reached.all())
