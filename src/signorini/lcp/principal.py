# SPDX-License-Identifier: BSD-3-Clause
"""Principal pivoting: Murty's least-index rule, one exchange at a time, finite for every P-matrix."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from signorini.arrays import Array
from signorini.lcp.active import polish
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status
from signorini.lcp.tableau import Tableau, equilibrate


@dataclass(frozen=True, kw_only=True)
class LeastIndex:
    """Exchange z_i and w_i for the least i whose basic variable is negative, until there is none.

    Parameters
    ----------
    max_pivots : limit, None stands for ``100 n + 1000`` (the worst case is exponential)
    noise : basic values above ``-noise`` times the largest count as nonnegative, in the equilibrated problem

    References
    ----------
    Murty (1974), Note on a Bard-type scheme for solving the complementarity problem, Opsearch 11:123-130.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> print(solve([[1.0, 2, 0], [0, 1, 2], [2, 0, 1]], [-1.0, -1, -1], method=LeastIndex()).z.round(5))
    [0.33333 0.33333 0.33333]
    """

    name: ClassVar[str] = "least-index"
    matrices: ClassVar[str] = "P"

    max_pivots: int | None = None
    noise: float = 1e-13

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        M, n = problem.dense(), problem.n
        if M is None:
            return Attempt.refused("It needs the entries of M.")
        scaled = equilibrate(M, problem.q, *problem.sizes)
        tableau = Tableau(scaled.M, scaled.q, np.zeros(n))
        active = np.zeros(n, dtype=bool)
        limit = self.max_pivots or 100 * n + 1000
        ending, pivots = Status.MAX_ITERATIONS, 0
        while pivots < limit:
            negative = np.flatnonzero(tableau.rhs < -self.noise * np.abs(tableau.rhs).max())
            if not len(negative):
                ending = Status.SOLVED
                break
            i = int(negative[0])
            entering = i if active[i] else n + i
            if not np.abs(tableau.column(entering)[i]) > self.noise:
                ending = Status.SINGULAR
                break
            tableau.pivot(i, entering)
            active[i] = not active[i]
            pivots += 1
        z = scaled.back(np.where(active, np.maximum(tableau.rhs, 0.0), 0.0))
        if not np.isfinite(z).all():
            return Attempt(z=None, ending=Status.NONFINITE, iterations=pivots)
        return Attempt(z=polish(problem, M, z, active=active)[0], ending=ending, iterations=pivots)
