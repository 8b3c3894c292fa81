# SPDX-License-Identifier: BSD-3-Clause
"""A proof that there is no solution: no ``z >= 0`` makes ``M z + q >= 0``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy

from signorini.arrays import Array
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status


@dataclass(frozen=True, kw_only=True)
class Feasibility:
    """Look for ``y >= 0`` with ``M^T y <= 0`` and ``q . y < 0`` (Farkas) by one linear programme.

    Then ``y . (M z + q) < 0`` for every z >= 0, so that no w >= 0 exists and the problem has no solution. It never
    finds a solution: the last of a chain.

    Parameters
    ----------
    tolerance : positive entries of ``M^T y`` up to it, relative to ``|M|^T y``, count as rounding
    margin : of ``|q| . y``, what ``-q . y`` must be at least; less may be rounding

    References
    ----------
    Cottle, Pang, Stone (1992), The Linear Complementarity Problem, sections 1.4 and 2.7.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> found = solve([[0.0, 0.0], [1.0, 1.0]], [-1.0, 2.0], method=Feasibility())
    >>> print(found.status.name, found.message.partition("Margin")[2], sep="")
    NO_SOLUTION: -q.y is 1 of y.|q|, whatever z.
    """

    name: ClassVar[str] = "feasibility"
    matrices: ClassVar[str] = "any; proves that there is no solution where no z >= 0 makes w >= 0"

    tolerance: float = 1e-11
    margin: float = 1e-9

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        M = problem.dense()
        if M is None:
            return Attempt.refused("The entries of M are needed.")
        found = scipy.optimize.linprog(problem.q, A_ub=M.T, b_ub=np.zeros(problem.n), bounds=(0.0, 1.0), method="highs")
        steps = int(getattr(found, "nit", 0))
        if found.status == 0:
            y = np.maximum(found.x, 0.0)
            sizes, size = np.abs(M).T @ y, float(np.abs(problem.q) @ y)
            share = -float(problem.q @ y) / (size or 1.0)
            against = float(np.divide(M.T @ y, sizes, out=np.zeros_like(y), where=sizes > 0).max(initial=0.0))
            if share > self.margin and against <= self.tolerance:
                reach = f"as long as y.|M|z < {share / against:.0e} y.|q|" if against > 0.0 else "whatever z"
                note = (
                    "A vector y >= 0 with M'y <= 0 and q.y < 0 was found: no z >= 0 makes w >= 0. "
                    f"Margin: -q.y is {share:.2g} of y.|q|, {reach}."
                )
                return Attempt(z=None, ending=Status.NO_SOLUTION, iterations=steps, note=note)
        note = "There may be z >= 0 with w >= 0: nothing is proved."
        return Attempt(z=None, ending=Status.STAGNATION, iterations=steps, note=note)
