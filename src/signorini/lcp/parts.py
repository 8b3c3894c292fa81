# SPDX-License-Identifier: BSD-3-Clause
"""Which rows of M hang together, so that their sizes can be compared: the strongly connected parts of its graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from signorini.arrays import Array, IntArray

WEAK = 1e-10
"""Entries below it, in balanced units, tie no rows together: what they carry of rounding is below all tolerances."""


@dataclass(frozen=True, kw_only=True)
class Parts:
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
    def of(magnitude: Any, rows: Array, columns: Array) -> Parts:
        """The parts of ``|M|`` balanced by sizes of rows and columns (``lcp.residual.balance``).

        Examples
        --------
        >>> M = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [5.0, 0.0, 1.0]])
        >>> parts = Parts.of(M, np.array([3.0, 3.0, 6.0]), np.ones(3))
        >>> parts.label[0] == parts.label[1], parts.label[0] == parts.label[2]
        (np.True_, np.False_)
        """
        n = len(rows)
        if isinstance(magnitude, np.ndarray):
            if _reaches_all(magnitude, rows, columns) and _reaches_all(magnitude.T, 1.0 / columns, 1.0 / rows):
                return Parts(label=np.zeros(n, dtype=np.int64), count=1, across=None)
            strong: Any = sp.csr_array(magnitude * columns > WEAK * rows[:, None])
        else:
            strong = sp.csr_array(sp.diags_array(1.0 / rows) @ magnitude @ sp.diags_array(columns) > WEAK)
        count, label = connected_components(strong, directed=True, connection="strong")
        if count == 1:
            return Parts(label=label, count=1, across=None)
        if isinstance(magnitude, np.ndarray):
            return Parts(label=label, count=count, across=np.where(label[:, None] != label, magnitude, 0.0))
        entries = magnitude.tocoo()
        foreign = label[entries.row] != label[entries.col]
        taken = (entries.data[foreign], (entries.row[foreign], entries.col[foreign]))
        return Parts(label=label, count=count, across=sp.csr_array(taken, shape=magnitude.shape))

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
        fresh = ((fresh / rows) @ magnitude * columns > WEAK) & ~reached
    return bool(reached.all())
