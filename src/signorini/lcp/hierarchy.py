# SPDX-License-Identifier: BSD-3-Clause
"""Smoothed aggregation: a hierarchy of smaller matrices made from the entries of a symmetric positive definite one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.lcp.linear import factorised

if TYPE_CHECKING:
    from signorini.linalg.vcycle import VCycle

COARSEST_SIZE = 300  # unknowns: the size at which a level is factorised
SLOWEST_COARSENING = 0.7  # of the unknowns of a level: where the next one keeps more, it gains nothing
STRENGTH = 0.08  # of sqrt(A_ii A_jj): entries above it make neighbours


@dataclass(frozen=True, kw_only=True)
class Hierarchy:
    """Matrices from fine to coarse, each the Galerkin product of the one before.

    Attributes
    ----------
    matrices : (n, n) CSR arrays, columns sorted
    prolongations : (n, coarse n) CSR arrays from every matrix to the one before, >= 0 for Z-matrices
    cycle : an approximate inverse of the finest matrix, symmetric positive definite
    """

    matrices: tuple[Any, ...]
    prolongations: tuple[Any, ...]
    cycle: VCycle

    @property
    def coarser(self) -> Hierarchy:
        """All but the finest level."""
        cycle = replace(self.cycle, levels=self.cycle.levels[1:])
        return Hierarchy(matrices=self.matrices[1:], prolongations=self.prolongations[1:], cycle=cycle)

    def truncated(self, free: BoolArray) -> Hierarchy:
        """The hierarchy of ``A x = r`` for the free unknowns (n,) alone, the others held at 0, same prolongations.

        What is prolonged to unknowns that are held is cut off on the finest level, and the coarser matrices are made
        anew: without that, coarse corrections carry from one side of a narrow contact to the other.

        References
        ----------
        Kornhuber (1994), Monotone multigrid methods for elliptic variational inequalities I, Numer. Math. 69:167-184.
        """
        kept = sp.diags_array(free.astype(float))
        A = _sorted(kept @ self.matrices[0] @ kept + sp.diags_array((~free).astype(float)))
        prolongations = [(kept @ P).tocsr() if k == 0 else P for k, P in enumerate(self.prolongations)]
        matrices = [A]
        for P in prolongations:
            A = P.T @ A @ P
            A = _sorted(A + sp.diags_array((A.diagonal() <= 0).astype(float)))  # where nothing is left
            matrices.append(A)
        return _assembled(matrices, prolongations)


def hierarchy(A: Any) -> Hierarchy:
    """Coarsen A, (n, n) CSR array, symmetric with positive diagonal, until a factorisation costs nothing.

    References
    ----------
    Vanek, Mandel, Brezina (1996), Algebraic multigrid by smoothed aggregation, Computing 56:179-196.
    """
    matrices, prolongations = [_sorted(A)], []
    while (size := matrices[-1].shape[0]) > COARSEST_SIZE:
        P = _prolongation(matrices[-1])
        if not 0 < P.shape[1] <= SLOWEST_COARSENING * size:
            break
        prolongations.append(P)
        matrices.append(_sorted(P.T @ matrices[-1] @ P))
    return _assembled(matrices, prolongations)


def _assembled(matrices: list[Any], prolongations: list[Any]) -> Hierarchy:
    """Matrices and prolongations with their V-cycle."""
    from signorini.linalg.vcycle import MultigridLevel, VCycle  # Numba takes longer than most problems

    levels = tuple(
        MultigridLevel(
            A=sp.bsr_array((A.data[:, None, None], A.indices, A.indptr), shape=A.shape),
            P=P,
            R=P.T.tocsr(),
            inverses=_inverted(A.diagonal())[:, None, None],
        )
        for A, P in zip(matrices[:-1], prolongations, strict=True)
    )
    diagonal = _inverted(matrices[-1].diagonal())
    coarsest = factorised(matrices[-1].tocsc()) or (lambda r: diagonal * r)
    cycle = VCycle(levels=levels, coarsest=coarsest)
    return Hierarchy(matrices=tuple(matrices), prolongations=tuple(prolongations), cycle=cycle)


def _prolongation(A: Any) -> Any:
    """Piecewise constants on aggregates, smoothed by one damped Jacobi step."""
    from pyamg.aggregation import standard_aggregation  # takes longer to import than most problems to solve
    from pyamg.strength import symmetric_strength_of_connection

    constant = standard_aggregation(symmetric_strength_of_connection(sp.csr_matrix(A), theta=STRENGTH))[0]
    return sp.csr_array(constant - sp.diags_array(2.0 / 3.0 / A.diagonal()) @ (A @ constant))


def _sorted(A: Any) -> Any:
    rows = sp.csr_array(A)
    rows.sort_indices()
    return rows


def _inverted(diagonal: Array) -> Array:
    """What a diagonal is divided by; nothing moves where it is not positive."""
    return np.divide(1.0, diagonal, out=np.zeros(len(diagonal)), where=diagonal > 0)
