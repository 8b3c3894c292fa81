# SPDX-License-Identifier: BSD-3-Clause
"""Where a floating body goes that no certified equilibrium holds: held by ever weaker springs it runs away."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.friction.spatial.equilibrium import Equilibrium
from signorini.friction.spatial.law import split, sticking, tangent
from signorini.friction.spatial.newton import newton
from signorini.friction.spatial.problem import SpatialProblem

_GROWTH = 10.0  # between two stiffnesses, a thousandth of each other


def escape_motion(problem: SpatialProblem, *, springs: tuple[float, ...], steps: int) -> Array | None:
    """(3n,) Motion, largest entry 1, that grows as the springs on the rigid motions weaken; None where none does.

    Parameters
    ----------
    problem : with rigid motions
    springs : stiffness of the springs, falling, in units of the interface stiffness
    steps : most systems of each Newton run

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=np.eye(3), b=np.array([-1.0, 0.5, 0.0]), friction=[0.3], motions=np.eye(3), scale=1.0
    ... )
    >>> escape_motion(problem, springs=(1e-3, 1e-6), steps=25).round(3).tolist()
    [0.0, 1.0, 0.0]
    """
    k = problem.motions.shape[1]
    zero = Equilibrium.of(problem)
    law, escape, before = sticking(problem), None, np.inf
    for beta in springs:
        held = Equilibrium(problem=problem, alpha=0.0, beta=beta, force=zero.force, motion=np.zeros(k))
        end = newton(held, law, limit=steps, tolerance=1e-10, method="springs")
        if not end.converged:
            return None
        y = end.force - held.moved(end.force, end.rigid)
        motion = split(problem, y)[0]
        size = float(np.abs(motion).max(initial=0.0))
        escape = motion / size if size > _GROWTH * max(before, problem.scale) else None
        before, law = size, tangent(problem, y)
    return escape
