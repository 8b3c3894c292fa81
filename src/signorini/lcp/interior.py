# SPDX-License-Identifier: BSD-3-Clause
"""Mehrotra's predictor-corrector interior point method for monotone problems."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from scipy.sparse.linalg import LinearOperator

from signorini.arrays import Array
from signorini.lcp.active import polish
from signorini.lcp.linear import factorised, scaled, with_diagonal
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status


@dataclass(frozen=True, kw_only=True)
class InteriorPoint:
    """Follow ``z_i w_i = t`` to t = 0 with z, w > 0, from an infeasible start.

    M is scaled symmetrically, which keeps it monotone. One factorisation of ``M + diag(w / z)`` a step serves the
    predictor and the corrector; the basis of the last iterate is polished.

    Parameters
    ----------
    max_steps : limit on the steps
    shortening : share of the largest step that keeps z and w positive

    References
    ----------
    Wright (1997), Primal-Dual Interior-Point Methods, chapters 8 and 10.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> print(solve([[0.0, 1.0], [-1.0, 0.0]], [-1.0, 1.0], method=InteriorPoint()).z)
    [1. 1.]
    """

    name: ClassVar[str] = "interior-point"
    matrices: ClassVar[str] = "monotone (M + M' positive semidefinite)"

    max_steps: int = 100
    shortening: float = 0.995

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:  # noqa: ARG002
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        if isinstance(problem.M, LinearOperator):
            return Attempt.refused("It needs the entries of M.")
        scale = np.sqrt(problem.sizes[1] / problem.sizes[0])
        M = scaled(problem.M, scale, scale)
        unit = float(np.abs(problem.q * scale).max()) or 1.0
        q = problem.q * scale / unit
        z, w = np.ones(problem.n), np.ones(problem.n)
        ending, steps = Status.MAX_ITERATIONS, 0
        while steps < self.max_steps:
            steps += 1
            moved = self._step(M, q, z, w)
            if moved is None:
                ending = Status.SINGULAR
                break
            z, w = moved
            if z.max() > 1e14 or not np.isfinite(z).all():
                ending = Status.STAGNATION
                break
            gap, error = float(z @ w), float(np.abs(M @ z + q - w).max())
            if gap <= 1e-13 * problem.n * max(1.0, z.max()) and error <= 1e-13 * max(1.0, w.max()):
                ending = Status.SOLVED
                break
        if not np.isfinite(z).all():
            return Attempt(z=None, ending=Status.NONFINITE, iterations=steps)
        inner = np.where(z > w, z, 0.0) if ending is Status.SOLVED else z
        candidate = polish(problem, problem.M, unit * scale * inner, active=z > w)[0]
        return Attempt(z=candidate, ending=ending, iterations=steps, note=_about(ending))

    def _step(self, M: Any, q: Array, z: Array, w: Array) -> tuple[Array, Array] | None:
        """One predictor-corrector step."""
        diagonal = w / z
        inverse = factorised(with_diagonal(M, diagonal))
        if inverse is None:
            return None
        infeasibility = M @ z + q - w
        mu = float(z @ w) / len(q)

        def direction(products: Array) -> tuple[Array, Array]:
            dz = inverse(-infeasibility + products / z)
            return dz, products / z - diagonal * dz

        dz, dw = direction(-z * w)
        ahead_z, ahead_w = z + _longest(z, dz) * dz, w + _longest(w, dw) * dw
        centring = (max(float(ahead_z @ ahead_w), 0.0) / len(q) / mu) ** 3 if mu > 0 else 0.0
        dz, dw = direction(centring * mu - z * w - dz * dw)
        length = self.shortening * min(_longest(z, dz), _longest(w, dw))
        return z + length * dz, w + length * dw


def _longest(x: Array, dx: Array) -> float:
    """Largest step up to 1 / 0.995 that keeps x + step dx >= 0."""
    falling = dx < 0
    return min(1.0 / 0.995, float((-x[falling] / dx[falling]).min(initial=np.inf)))


def _about(ending: Status) -> str:
    return "z grew without bound: the problem is probably infeasible." if ending is Status.STAGNATION else ""
