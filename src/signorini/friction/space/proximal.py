# SPDX-License-Identifier: BSD-3-Clause
"""Where Newton's method alone is lost: sweeps that come near, and Newton's method with an interface layer that shrinks.

A layer of compliance alpha around the last forces makes every system regular and the law contract; its solution is
the last forces moved towards the answer (the proximal point method). Two ways: with sweeps between and a thin layer,
fast where it works; without sweeps from a layer as soft as the interface, slow and harder to lose.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array
from signorini.attempt import MethodRun
from signorini.friction.space.sweeps import gauss_seidel
from signorini.friction.spatial.certificate import certify
from signorini.friction.spatial.equilibrium import Equilibrium
from signorini.friction.spatial.law import tangent
from signorini.friction.spatial.newton import NewtonEnd, newton
from signorini.friction.spatial.problem import SpatialProblem

THIN, SOFT = 1e-2, 1.0
"""First compliance of the layer, with and without sweeps, in units of 1 / D."""

THINNEST, SOFTEST = 1e-7, 10.0
FAST = 6  # steps up to which a run was easy: the next layer is thinner


def swept_rounds(
    problem: SpatialProblem, *, rounds: int, sweeps: int, steps: int, tolerance: float
) -> Iterator[NewtonEnd]:
    """Rounds of sweeps and one proximal Newton run, the next from the better of the two.

    Parameters
    ----------
    rounds, sweeps, steps : most rounds, sweeps of each, and systems of each Newton run
    tolerance : of `certify`; the runs go a hundred times closer
    """
    alpha, (r, a) = THIN, _nothing(problem)
    exact = Equilibrium.of(problem)
    for _ in range(rounds):
        r, a = gauss_seidel(problem, r, a, count=sweeps)
        y = r - exact.moved(r, a)
        residual = certify(problem, y)
        attempt = MethodRun(method="gauss-seidel", iterations=sweeps, end=f"residual {residual:.1e}")
        yield NewtonEnd(force=r, rigid=a, y=y, residual=residual, attempt=attempt, converged=False)
        end = _run(problem, alpha, r, a, steps, tolerance)
        yield end
        if end.residual < residual:
            r, a = end.force, end.rigid
        alpha = _next(alpha, end, thinner=3.0)


def proximal_rounds(problem: SpatialProblem, *, rounds: int, steps: int, tolerance: float) -> Iterator[NewtonEnd]:
    """Proximal Newton runs alone, each from where the last converged; parameters as of `swept_rounds`."""
    alpha, (r, a) = SOFT, _nothing(problem)
    for _ in range(rounds):
        end = _run(problem, alpha, r, a, steps, tolerance)
        yield end
        if end.converged:
            r, a = end.force, end.rigid
        alpha = _next(alpha, end, thinner=2.0)


def _nothing(problem: SpatialProblem) -> tuple[Array, Array]:
    return np.zeros(3 * problem.pairs), np.zeros(problem.motions.shape[1])


def _run(problem: SpatialProblem, alpha: float, r: Array, a: Array, steps: int, tolerance: float) -> NewtonEnd:
    """Newton's method with a layer around r and a, from there."""
    y = r - Equilibrium.of(problem).moved(r, a)
    layer = Equilibrium(problem=problem, alpha=alpha, beta=alpha, force=r, motion=a)
    return newton(
        layer,
        tangent(problem, y),
        force=r,
        rigid=a,
        limit=steps,
        tolerance=1e-2 * tolerance,
        method="proximal newton",
    )


def _next(alpha: float, end: NewtonEnd, *, thinner: float) -> float:
    """A softer layer after a run that failed, a thinner one after an easy one."""
    if not end.converged:
        return min(3.0 * alpha, SOFTEST)
    return max(alpha / thinner, THINNEST) if end.attempt.iterations <= FAST else alpha
