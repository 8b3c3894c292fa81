# SPDX-License-Identifier: BSD-3-Clause
"""Projected conjugate gradients with active sets, for symmetric positive semidefinite M given by its products alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.lcp.problem import LCP
from signorini.lcp.solution import Attempt, Status

POWER_STEPS = 12  # of the power method: the norm to a few per cent


@dataclass(frozen=True, kw_only=True)
class MPRGP:
    """Modified proportioning with reduced gradient projections: minimise ``z' M z / 2 + q' z`` over z >= 0.

    Conjugate gradients on the free variables; where the path leaves z >= 0 the step is cut and followed by a projected
    gradient step; where the bound ones want to move more than the free ones, a gradient step frees them.

    Parameters
    ----------
    max_products : limit on the products with M
    gamma : weight of the bound variables in that comparison
    step : length of the projected gradient steps over ``1 / |M|``, in (0, 2)
    every : products between two evaluations of the residual

    References
    ----------
    Dostal, Schoberl (2005), Minimizing quadratic functions subject to bound constraints with the rate of convergence
    and finite termination, Computational Optimization and Applications 30:23-43.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> print(solve([[2.0, 1.0], [1.0, 2.0]], [-5.0, -6.0], method=MPRGP()).z.round(5))
    [1.33333 2.33333]
    """

    name: ClassVar[str] = "mprgp"
    matrices: ClassVar[str] = "symmetric positive semidefinite, also as a linear operator"

    max_products: int = 20_000
    gamma: float = 1.0
    step: float = 1.9
    every: int = 25

    def attempt(self, problem: LCP, z0: Array | None, tolerance: float) -> Attempt:
        """Solve a problem from z0 to a tolerance, see ``Method.attempt``."""
        if not symmetric_in_products(problem):
            note = "M is not symmetric: x'My and y'Mx differ for random x, y."
            return Attempt.refused(note)
        scale = np.sqrt(problem.sizes[1] / problem.sizes[0])
        norm = _norm_estimate(problem, scale)
        unit = float(np.abs(scale * problem.q).max()) or 1.0
        run = _Run(problem, scale, scale * problem.q / unit, self.step / norm if norm > 0 else 1.0)
        z = np.zeros(problem.n) if z0 is None else np.maximum(z0 / scale / unit, 0.0)
        run.start(z)
        while run.products < self.max_products:
            if run.products - run.tested >= self.every:
                run.tested = run.products
                if not np.isfinite(run.z).all() or np.abs(run.z).max() > 1e100:
                    return Attempt(z=None, ending=Status.NONFINITE, iterations=run.products)
                if problem.residual(unit * scale * run.z).worst <= 0.5 * tolerance:
                    return Attempt(z=unit * scale * run.z, ending=Status.SOLVED, iterations=run.products)
            if run.settled():
                return Attempt(z=unit * scale * run.z, ending=Status.SOLVED, iterations=run.products)
            if not run.advance(self.gamma):
                note = "p'Mp < 0: M is not positive semidefinite."
                return Attempt.refused(note, iterations=run.products)
        return Attempt(z=unit * scale * run.z, ending=Status.MAX_ITERATIONS, iterations=run.products)


class _Run:
    """Iterate, gradient and conjugate direction of one run, in scaled units."""

    def __init__(self, problem: LCP, scale: Array, q: Array, length: float) -> None:
        self.problem, self.scale, self.q, self.length = problem, scale, q, length
        self.products = self.tested = 0

    def start(self, z: Array) -> None:
        """Gradient and direction anew at z."""
        self.z = z
        self.g = self.multiply(z) + self.q
        self.free: BoolArray = z > 0
        self.p = np.where(self.free, self.g, 0.0)

    def multiply(self, x: Array) -> Array:
        """The scaled M times x."""
        self.products += 1
        return np.asarray(self.scale * (self.problem.M @ (self.scale * x)))

    def settled(self) -> bool:
        """Whether nothing wants to move."""
        return not np.where(self.free, self.g, np.minimum(self.g, 0.0)).any()

    def advance(self, gamma: float) -> bool:
        """One step of the method; False where M shows negative curvature."""
        phi = np.where(self.free, self.g, 0.0)
        beta = np.where(self.free, 0.0, np.minimum(self.g, 0.0))
        reduced = np.minimum(self.z / self.length, phi)
        if beta @ beta > gamma**2 * (reduced @ phi):
            return self._proportion(beta)
        Mp = self.multiply(self.p)
        curvature, slope = float(self.p @ Mp), float(self.g @ self.p)
        noise = 1e-14 * float(np.abs(self.p) @ np.abs(Mp))
        if curvature < -noise - 1e-300:
            return False
        falling = self.p > 0
        feasible = float((self.z[falling] / self.p[falling]).min(initial=np.inf))
        best = slope / curvature if curvature > noise else np.inf
        if not np.isfinite(min(best, feasible)):
            best = self.length
        if best <= feasible:
            self.z = self.z - best * self.p
            self.g = self.g - best * Mp
            phi = np.where(self.free, self.g, 0.0)
            self.p = phi - (phi @ Mp) / curvature * self.p if curvature > noise else phi
            return True
        half = np.maximum(self.z - feasible * self.p, 0.0)
        g = self.g - feasible * Mp
        self.start(np.maximum(half - self.length * np.where(self.free, g, 0.0), 0.0))
        return True

    def _proportion(self, beta: Array) -> bool:
        """A gradient step that frees bound variables."""
        Mb = self.multiply(beta)
        curvature, slope = float(beta @ Mb), float(self.g @ beta)
        if curvature < -1e-14 * float(np.abs(beta) @ np.abs(Mb)) - 1e-300:
            return False
        best = slope / curvature if curvature > 0 else self.length
        self.z = np.maximum(self.z - best * beta, 0.0)
        self.g = self.g - best * Mb
        self.free = self.z > 0
        self.p = np.where(self.free, self.g, 0.0)
        return True


def symmetric_in_products(problem: LCP) -> bool:
    """Whether ``x' M y = y' M x`` to rounding for two fixed random vectors."""
    x, y = np.random.default_rng(0).uniform(0.5, 1.0, (2, problem.n))
    scale = np.sqrt(problem.sizes[1] / problem.sizes[0])
    x, y = scale * x, scale * y
    Mx, My = problem.M @ x, problem.M @ y
    size = float(np.abs(x) @ np.abs(My) + np.abs(y) @ np.abs(Mx))
    return abs(float(x @ My - y @ Mx)) <= 1e-12 * size


def _norm_estimate(problem: LCP, scale: Array) -> float:
    """Largest eigenvalue of the scaled M, a few percent too large (power method)."""
    x = np.random.default_rng(1).standard_normal(problem.n)
    value = 0.0
    for _ in range(POWER_STEPS):
        y = scale * (problem.M @ (scale * x))
        value = float(np.linalg.norm(y) / np.linalg.norm(x))
        if not value > 0:
            return 0.0
        x = y / np.linalg.norm(y)
    return 1.1 * value
