# SPDX-License-Identifier: BSD-3-Clause
"""Where Newton's method alone is lost: sweeps that come near, and Newton's method with an interface layer that shrinks.

A layer of compliance alpha around the last forces makes every system regular and the law contract; its solution is
the last forces moved towards the answer (the proximal point method).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.friction.spatial.certificate import certify
from signorini.friction.spatial.equilibrium import Equilibrium
from signorini.friction.spatial.law import tangent
from signorini.friction.spatial.newton import NewtonEnd, newton
from signorini.friction.spatial.problem import SpatialProblem
from signorini.friction.spatial.sweeps import gauss_seidel
from signorini.trace import Attempt

LAYER = 1e-2
THINNEST = 1e-7
FAST = 6


def proximal(problem: SpatialProblem, *, rounds: int, sweeps: int, steps: int, tolerance: float) -> Iterator[NewtonEnd]:
    """Rounds of sweeps and one proximal Newton run, each from where the last ended; the better of the two is given.

    Parameters
    ----------
    rounds, sweeps, steps : most rounds, sweeps of each, and systems of each Newton run
    tolerance : of `certify`; the runs go a hundred times closer
    """
    alpha = LAYER
    r, a = np.zeros(3 * problem.pairs), np.zeros(problem.motions.shape[1])
    exact = Equilibrium.of(problem)
    for _ in range(rounds):
        r, a = gauss_seidel(problem, r, a, count=sweeps)
        y = r - exact.moved(r, a)
        swept = certify(problem, y)
        yield NewtonEnd(
            force=r,
            rigid=a,
            y=y,
            residual=swept,
            attempt=Attempt(method="gauss-seidel", iterations=sweeps, end=f"residual {swept:.1e}"),
            converged=False,
        )
        layer = Equilibrium(problem=problem, alpha=alpha, force=r, motion=a)
        end = newton(
            layer,
            tangent(problem, y),
            force=r,
            rigid=a,
            limit=steps,
            tolerance=1e-2 * tolerance,
            method="proximal newton",
        )
        yield end
        if end.residual < swept:
            r, a = end.force, end.rigid
        if not end.converged:
            alpha = min(3.0 * alpha, 1.0)
        elif end.attempt.iterations < FAST:
            alpha = max(alpha / 3.0, THINNEST)
