# SPDX-License-Identifier: BSD-3-Clause
"""Sparse factors of the bodies with the springs of their contacts: where multigrid would take long, and they fit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import SolveFailed
from signorini.iterative.springs import PairSprings
from signorini.linalg import NotPositiveDefinite, factorise
from signorini.linalg.symmetric_blocks import SymmetricBlocks
from signorini.outcome import Outcome

_MAX_ENTRIES = 1e8  # entries in all factorisations together: a minute or two
_LEAST_COST = 3000  # entries: what a factorisation of fewer costs
_WEAK_SPRING = 1e-10  # of the mean stiffness: springs to everything where the springs of contacts leave something free


class Direct:
    """One factorisation for every state of the springs; conjugate gradients mend what it loses.

    Thin bodies and flat cells cost it nothing: equilibrium is solved to the last digits, however far bodies bend.

    Parameters
    ----------
    K : (n, n) stiffness
    nodes : (n,) number of the place of every unknown
    points : (k, d) where those are
    """

    def __init__(self, K: SymmetricBlocks, nodes: IntArray, points: Array) -> None:
        self._K, self._nodes, self._points = K.whole, nodes, points
        self._none = np.zeros(0, dtype=np.int64)
        self._left = _MAX_ENTRIES

    def under(self, B: sp.csr_array, springs: PairSprings) -> Callable[[Array], Array]:
        """A solution x of ``(K + B' S B) x = b``, as a function of b.

        Parameters
        ----------
        B : (d a, n) motions of the pairs
        springs : of the pairs, S

        Raises
        ------
        SolveFailed
            After a fixed amount of work: what does not converge until then is not worth more.
        """
        A = sp.csr_array(self._K + B.T @ springs.matrix() @ B)
        self._left -= max(A.nnz, _LEAST_COST)
        if self._left < 0:
            raise SolveFailed("multipliers did not settle within the work that they may take", status=Outcome.NOT_FOUND)
        try:
            factor = factorise(A, self._none, nodes=self._nodes, points=self._points)
        except NotPositiveDefinite:
            weak = _WEAK_SPRING * float(A.diagonal().mean())
            held = sp.csr_array(A + sp.diags_array(np.full(A.shape[0], weak)))
            factor = factorise(held, self._none, nodes=self._nodes, points=self._points)
        nothing = np.zeros(0)
        return lambda b: factor.reduce(b).expand(nothing)
