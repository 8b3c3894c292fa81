# SPDX-License-Identifier: BSD-3-Clause
"""Projected successive over-relaxation; omega = 1 is projected Gauss-Seidel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.lcp.active import polish
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status


@dataclass(frozen=True, kw_only=True)
class ProjectedSOR:
    """Sweep over the rows: ``z_i <- max(0, z_i - omega w_i / M_ii)``.

    Converges for symmetric positive semidefinite M with positive diagonal (where a solution exists) for
    0 < omega < 2, and for strictly diagonally dominant and H-matrices for omega <= 1.

    Parameters
    ----------
    omega : relaxation factor
    max_sweeps : limit on the sweeps
    every : sweeps between two evaluations of the residual
    polished : whether the basis found is solved for exactly at the end (one factorisation)

    References
    ----------
    Cryer (1971), The solution of a quadratic programming problem using systematic overrelaxation, SIAM J. Control 9.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> print(solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0], method=ProjectedSOR()).z.round(5))
    [1.33333 2.33333]
    """

    name: ClassVar[str] = "projected-sor"
    matrices: ClassVar[str] = "symmetric positive semidefinite with positive diagonal; diagonally dominant (H)"

    omega: float = 1.0
    max_sweeps: int = 10_000
    every: int = 20
    polished: bool = True

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        from signorini.lcp.kernels import sweeps

        if isinstance(problem.M, LinearOperator):
            return Attempt.refused("It needs the rows of M.")
        M = sp.csr_array(problem.M)
        if not (M.diagonal() > 0).all():
            return Attempt.refused("It needs a positive diagonal.")
        z = np.zeros(problem.n) if z0 is None else np.maximum(z0, 0.0)
        ending, done = Status.MAX_ITERATIONS, 0
        while done < self.max_sweeps:
            count = min(self.every, self.max_sweeps - done)
            with np.errstate(over="ignore", invalid="ignore"):
                sweeps(M.indptr, M.indices, M.data, problem.q, z, self.omega, count, False)
            done += count
            if not np.isfinite(z).all():
                return Attempt(z=None, ending=Status.NONFINITE, iterations=done)
            if problem.residual(z).worst <= 0.1 * tolerance:
                ending = Status.SOLVED
                break
        z = polish(problem, problem.M, z)[0] if self.polished else z
        return Attempt(z=z, ending=ending, iterations=done)
