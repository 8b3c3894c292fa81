# SPDX-License-Identifier: BSD-3-Clause
"""A matrix that is not in this process: what condensing asks of it in place of its entries."""

from __future__ import annotations

from typing import Any, Protocol, Self, TypeGuard

from numpy.typing import ArrayLike
from scipy import sparse

from signorini.arrays import Array, IntArray
from signorini.linalg.protocol import Factorisation


class MatrixElsewhere(Protocol):
    """A symmetric matrix (n, n) whose rows others hold and factorise."""

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n)."""

    @property
    def nnz(self) -> int:
        """Entries."""

    def diagonal(self) -> Array:
        """(n,) Its diagonal."""

    def rows(self, wanted: IntArray) -> sparse.csr_array:
        """(n, n) Some of its rows; the others are empty.

        Parameters
        ----------
        wanted : (m,) their numbers
        """

    def stiffened(self, springs: Array) -> Self:
        """This matrix with more on its diagonal.

        Parameters
        ----------
        springs : (n,) what is added
        """

    def held_by_springs(self, rigid: Any, stiffness: float) -> Self:
        """This matrix with a spring for each rigid motion, see :func:`signorini.condense.response.held_by_springs`.

        Parameters
        ----------
        rigid : (n, k) motions, where its rows are
        stiffness : of the springs where nothing deforms
        """

    def bordered(self, B: sparse.csr_array) -> Self:
        """``[[K, B^T], [B, 0]]``, see :func:`signorini.linalg.system.bordered`.

        Parameters
        ----------
        B : (m, n)
        """

    def factorised(self, interface: ArrayLike) -> Factorisation:
        """Factorise the interior and condense it onto the interface, see :func:`signorini.linalg.factorise`.

        Parameters
        ----------
        interface : (m,) unknowns that are not eliminated

        Raises
        ------
        NotPositiveDefinite
            If the interior is singular or indefinite.
        """


def is_elsewhere(matrix: Any) -> TypeGuard[MatrixElsewhere]:
    """Whether the rows of a matrix are elsewhere: known by one method, which takes no look at all of them.

    >>> is_elsewhere(sparse.csr_array((1, 1)))
    False
    """
    return hasattr(matrix, "factorised")
