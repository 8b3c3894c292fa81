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
from signorini.friction.candidate import NewtonEnd
from signorini.friction.certificate import certify
from signorini.friction.linear import Equilibrium
from signorini.friction.newton import searched
from signorini.friction.problem import ContactProblem
from signorini.friction.space.sweeps import gauss_seidel

SWEPT_LAYER, FIRST_LAYER = 1e-2, 1.0
"""First compliance of the layer, with and without sweeps, in units of 1 / D."""

LEAST_LAYER, LARGEST_LAYER = 1e-7, 10.0  # in units of 1 / D
EASY_STEPS = 6  # of a run: after as few the next layer is thinner


def proximal_rounds(
    problem: ContactProblem, *, rounds: int, steps: int, tolerance: float, sweeps: int = 0
) -> Iterator[NewtonEnd]:
    """Rounds of one proximal Newton run, each from where the last converged; or, with sweeps, from the better of both.

    Parameters
    ----------
    problem : the problem; in space where sweeps go before
    rounds, steps : most rounds, and systems of each Newton run
    tolerance : of `certify`; the runs go a hundred times closer
    sweeps : before each run
    """
    alpha, thinner = (SWEPT_LAYER, 3.0) if sweeps else (FIRST_LAYER, 2.0)
    r, a = np.zeros((problem.directions, problem.pairs)), np.zeros(problem.motions.shape[1])
    for _ in range(rounds):
        residual = 0.0
        if sweeps:
            r, a = gauss_seidel(problem, r, a, count=sweeps)
            y = r - Equilibrium(problem=problem).moved(r, a)
            residual = certify(problem, y)
            attempt = MethodRun(method="gauss-seidel", iterations=sweeps, end=f"residual {residual:.1e}")
            yield NewtonEnd(force=r, rigid=a, y=y, residual=residual, attempt=attempt, converged=False)
        end = _run(problem, alpha, r, a, steps, tolerance)
        yield end
        if end.residual < residual if sweeps else end.converged:
            r, a = end.force, end.rigid
        alpha = _next(alpha, end, thinner)


def _run(problem: ContactProblem, alpha: float, r: Array, a: Array, steps: int, tolerance: float) -> NewtonEnd:
    """Newton's method with a layer around r and a, from there."""
    y = r - Equilibrium(problem=problem).moved(r, a)
    layer = Equilibrium(problem=problem, alpha=alpha, beta=alpha, force=r, motion=a)
    return searched(
        layer,
        problem.law.tangent(y),
        force=r,
        rigid=a,
        limit=steps,
        tolerance=1e-2 * tolerance,
        method="proximal newton",
    )


def _next(alpha: float, end: NewtonEnd, thinner: float) -> float:
    """A softer layer after a run that failed, a thinner one after an easy one."""
    if not end.converged:
        return min(3.0 * alpha, LARGEST_LAYER)
    return max(alpha / thinner, LEAST_LAYER) if end.attempt.iterations <= EASY_STEPS else alpha
