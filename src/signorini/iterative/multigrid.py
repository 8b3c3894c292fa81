# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation for elastic bodies and the springs of their contacts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Any

import numpy as np
import pyamg
import scipy.sparse as sp
from pyamg.util.utils import get_block_diag

from signorini.arrays import Array
from signorini.linalg.vcycle import MultigridLevel, VCycle

_COARSEST_BLOCKS = 100  # blocks that are solved for directly
_FREE_MOTION = 1e-13  # of the largest stiffness: motions that nothing resists


class Multigrid:
    """Smoothed aggregation of the bodies alone, to which the springs of contacts are added on every level.

    No coarse motion then reaches across a contact, so that the same ones serve whether it sticks or slips, and new
    springs cost less than an iteration. Made with the springs of one state they would take five times the
    iterations in another, and making them takes as long as twenty.

    Parameters
    ----------
    K : (n, n) stiffness in blocks of a node
    near_null : (n, k) motions that hardly need a force: rigid ones

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """

    def __init__(self, K: sp.bsr_array, near_null: Array) -> None:
        self._K, self._near_null = K, near_null

    def under(self, springs: sp.csr_array) -> VCycle:
        """The cycle for the bodies and springs (n, n) between them.

        Parameters
        ----------
        springs : symmetric, never negative
        """
        added, levels = sp.bsr_matrix(springs, blocksize=self._K.blocksize), []
        for K, P, R in self._finer:
            added.sort_indices()  # sorted alike they are added in order, as sweeps need them
            A = sp.bsr_matrix(K + added, blocksize=K.blocksize)
            levels.append(MultigridLevel(A=A, P=P, R=R, inverses=get_block_diag(A, A.blocksize[0], inv_flag=True)))
            added = R @ (added @ P)
        whole = (self._levels[-1].A + added).toarray()
        inverse = np.linalg.pinv(whole, rcond=_FREE_MOTION, hermitian=True)
        return VCycle(levels=tuple(levels), coarsest=lambda b: np.asarray(inverse @ b))

    @cached_property
    def _levels(self) -> list[Any]:
        """Levels of the bodies alone, the finest first."""
        with _repeatable():
            made = pyamg.smoothed_aggregation_solver(
                sp.bsr_matrix(self._K),
                B=self._near_null,
                strength=("symmetric", {"theta": 0.0}),
                improve_candidates=None,
                max_coarse=_COARSEST_BLOCKS,
            )
        return list(made.levels)

    @cached_property
    def _finer(self) -> list[tuple[sp.bsr_matrix, sp.bsr_matrix, sp.bsr_matrix]]:
        """Stiffness, prolongation and restriction of all but the coarsest."""
        return [(level.A.sorted_indices(), level.P, level.P.T.tobsr()) for level in self._levels[:-1]]


@contextmanager
def _repeatable() -> Iterator[None]:
    """PyAMG starts from vectors of NumPy's global generator: the same ones every time, and it is put back."""
    before = np.random.get_state()  # noqa: NPY002
    np.random.seed(0)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002
