# SPDX-License-Identifier: BSD-3-Clause
"""What the compiled walk along Lemke's path reads and says; apart from it, since Numba takes long to import."""

from __future__ import annotations

from typing import NamedTuple

from signorini.arrays import Array, IntArray

MORE, SOLVED, RAY, DOUBT = range(4)
"""The block of pivots is full; theta left; nothing blocks; theta is tied within rounding, to be judged outside."""


class DelayedTableau(NamedTuple):
    """The arrays of a tableau ``T - U V``; a named tuple, because compiled loops read it.

    Attributes
    ----------
    T : (n, n + 2) Fortran-ordered, the values in the last column
    U, V : (n, k) Fortran-ordered and (k, n + 2): a column and a row for each of up to k pivots
    basic, nonbasic, column_of, row_of : see ``lcp.tableau.Tableau``
    rows : (n,) to work in
    """

    T: Array
    U: Array
    V: Array
    basic: IntArray
    nonbasic: IntArray
    column_of: IntArray
    row_of: IntArray
    rows: IntArray


class Tolerances(NamedTuple):
    """What counts as zero on the path.

    Attributes
    ----------
    pivot : rates below it, relative to the largest, do not count
    tie, size : values left over below their product, less at small rates, are ties
    """

    pivot: float
    tie: float
    size: float
