# SPDX-License-Identifier: BSD-3-Clause
"""Block principal pivoting: exchange all infeasible pairs at once, with a finite fall-back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array, BoolArray
from signorini.lcp.active import polish, solve_on
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status


@dataclass(frozen=True, kw_only=True)
class BlockPivoting:
    """Solve for the present basis, exchange every pair with a negative z_i or w_i, repeat.

    As long as the number of infeasible pairs falls every few steps all of them are exchanged, which is the active-set
    Newton method; otherwise only the one of least index, Murty's finite rule for P-matrices, until it falls again.

    Parameters
    ----------
    max_steps : limit on the factorisations, None stands for ``100 n + 1000``
    patience : block steps without a new least number of infeasible pairs before single exchanges begin
    noise : values above ``-noise`` times the largest, in balanced units, count as nonnegative
    shift : added to the diagonal, in balanced units, of a basis that is singular

    References
    ----------
    Judice, Pires (1994), A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
    problems, Computers and Operations Research 21:587-596.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0], method=BlockPivoting()).iterations
    2
    """

    name: ClassVar[str] = "block-pivoting"
    matrices: ClassVar[str] = "P, often any with regular principal blocks along the way"

    max_steps: int | None = None
    patience: int = 8
    noise: float = 1e-13
    shift: float = 1e-8

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        if isinstance(problem.M, LinearOperator):
            return Attempt.refused("It needs the entries of M.")
        active: BoolArray = np.zeros(problem.n, dtype=bool) if z0 is None else z0 > 0
        least, patience, z = problem.n + 1, self.patience, np.zeros(problem.n)
        limit = self.max_steps or 100 * problem.n + 1000
        for step in range(1, limit + 1):
            found, regular = self._basic_solution(problem, active)
            if found is None:
                return Attempt(z=z, ending=Status.SINGULAR, iterations=step)
            infeasible = self._infeasible(problem, found, active)
            z = np.maximum(found, 0.0)
            count = int(np.count_nonzero(infeasible))
            if count == 0 or (count < 8 and problem.residual(z).worst <= 1e-3 * tolerance):
                ending = Status.SOLVED if regular else Status.SINGULAR
                return Attempt(z=polish(problem, problem.M, z, active=active)[0], ending=ending, iterations=step)
            if count < least:
                least, patience = count, self.patience
            elif patience > 0:
                patience -= 1
            else:
                infeasible[np.flatnonzero(infeasible)[0] + 1 :] = False
            active = active ^ infeasible
        return Attempt(z=z, ending=Status.MAX_ITERATIONS, iterations=limit)

    def _basic_solution(self, problem: LCP, active: BoolArray) -> tuple[Array | None, bool]:
        """z of the basis; where it is singular, of the problem with a small balanced diagonal, which shows the way."""
        assert not isinstance(problem.M, LinearOperator)
        rows, columns = problem.sizes
        z = solve_on(problem.M, problem.q, active, refinements=1)
        if z is not None:
            return z, True
        return solve_on(problem.M, problem.q, active, shift=self.shift * rows / columns), False

    def _infeasible(self, problem: LCP, z: Array, active: BoolArray) -> BoolArray:
        """Pairs whose basic variable is negative beyond rounding."""
        rows, columns = problem.sizes
        x, y = z / columns, (problem.M @ z + problem.q) / rows
        largest = max(float(np.abs(x).max()), float(np.abs(problem.q / rows).max()))
        return np.asarray(np.where(active, x, y) < -self.noise * largest)
