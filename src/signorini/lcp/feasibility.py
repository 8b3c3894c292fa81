# SPDX-License-Identifier: BSD-3-Clause
"""A proof that there is no solution: no ``z >= 0`` makes ``M z + q >= 0``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from scipy.optimize import linprog

from signorini.arrays import Array
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt
from signorini.lcp.status import Status


@dataclass(frozen=True, kw_only=True)
class Feasibility:
    """Look for ``y >= 0`` with ``M^T y <= 0`` and ``q . y < 0`` (Farkas) by one linear programme.

    Then ``y . (M z + q) < 0`` for every z >= 0, so that no w >= 0 exists and the problem has no solution. It never
    finds a solution: the last of a chain.

    Parameters
    ----------
    tolerance : positive entries of ``M^T y`` up to it, relative to ``|M|^T y``, count as rounding

    References
    ----------
    Cottle, Pang, Stone (1992), The Linear Complementarity Problem, sections 1.4 and 2.7.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> print(solve([[0.0, 0.0], [1.0, 1.0]], [-1.0, 2.0], method=Feasibility()).status.name)
    NO_SOLUTION
    """

    name: ClassVar[str] = "feasibility"
    matrices: ClassVar[str] = "any; proves that there is no solution where no z >= 0 makes w >= 0"

    tolerance: float = 1e-11

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """See ``Method.attempt``."""
        M = problem.dense()
        if M is None:
            return Attempt(z=None, ending=Status.NOT_APPLICABLE, iterations=0, note="The entries of M are needed.")
        found = linprog(problem.q, A_ub=M.T, b_ub=np.zeros(problem.n), bounds=(0.0, 1.0), method="highs")
        steps = int(getattr(found, "nit", 0))
        if found.status == 0:
            y = np.maximum(found.x, 0.0)
            slack = self.tolerance * (np.abs(M).T @ y)
            separated = problem.q @ y < -1e-9 * (np.abs(problem.q) @ y)
            if separated and (M.T @ y <= slack).all():
                note = "A vector y >= 0 with M'y <= 0 and q.y < 0 was found: no z >= 0 makes w >= 0."
                return Attempt(z=None, ending=Status.NO_SOLUTION, iterations=steps, note=note)
        note = "There may be z >= 0 with w >= 0: nothing is proved."
        return Attempt(z=None, ending=Status.STAGNATION, iterations=steps, note=note)
