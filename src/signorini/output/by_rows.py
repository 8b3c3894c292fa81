# SPDX-License-Identifier: BSD-3-Clause
"""What files of text hold is asked for by rows, so many at a time, wherever it is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.output.fields import State

_AT_ONCE = 1 << 16
"""Rows that are asked for, and held as text, at a time: a few megabytes."""


class FieldsByRows(Protocol):
    """Fields of bodies at some nodes, and in some cells: of one process, or of ranks that it asks."""

    def at_nodes(self, state: State, what: str, nodes: IntArray) -> Array:
        """(k, c) Values at some nodes, means of the bodies that have them.

        Parameters
        ----------
        state : in which one
        what : "S" stresses xx, yy, zz, xy, yz, xz, "PEEQ" equivalent plastic strains, where bodies yield
        nodes : (k,) of cells
        """

    def in_cells(self, state: State, what: str, cells: IntArray) -> Array:
        """(k, p, c) Values at the points of some cells.

        Parameters
        ----------
        state : in which one
        what : "S" stresses, "E" strains as tensors, and where bodies yield "PEEQ", "PE" plastic strains
        cells : (k,) of one family
        """


def portions(count: int) -> Iterator[IntArray]:
    """Numbers from 0, so many at a time as are asked for at once.

    >>> [rows.tolist() for rows in portions(3)]
    [[0, 1, 2]]
    """
    for first in range(0, count, _AT_ONCE):
        yield np.arange(first, min(first + _AT_ONCE, count))
