# SPDX-License-Identifier: BSD-3-Clause
"""What a linearised law in space leaves unknown, by GMRES: `equilibrium.directions` without a matrix."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.friction.krylov import Unknowns, iterate
from signorini.friction.spatial.equilibrium import prescribed
from signorini.friction.spatial.law import SpatialTangent
from signorini.friction.spatial.problem import SpatialProblem

_FAR = 1.0  # slip per force, scaled, from which compliance counts little beside it
_FORWARD = 1e-2, 1e-4  # of what the last iterate lacks: what may be left while states change, and once none does


def balanced(
    problem: SpatialProblem, law: SpatialTangent, r: Array, a: Array, *, settled: bool
) -> tuple[Array, Array, Array] | None:
    """Forces r (3n,), rigid motion a (k,) and motions h (3n,) that nearly balance under a linearised law.

    Parameters
    ----------
    law : of every pair, linear
    r, a : (3n,) and (k,) where the last iterate ended
    settled : whether no state changed there

    Returns
    -------
    r, a, h; None where the iteration does not get there

    Examples
    --------
    >>> from signorini.friction.spatial.law import sticking
    >>> problem = SpatialProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.2, 0.1]), friction=[0.3], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> r, a, h = balanced(problem, sticking(problem), np.zeros(3), np.zeros(0), settled=True)
    >>> r.round(3).tolist(), h.tolist()
    ([2.0, -0.4, -0.2], [0.0, 0.0, 0.0])
    """
    found = iterate(problem, unknowns(law), problem.free_motion, r, a, forward=_FORWARD[settled])
    if found is None:
        return None
    force, rigid, motion = found
    return force, rigid, prescribed(law, motion)


def unknowns(law: SpatialTangent) -> Unknowns:
    """What a law leaves unknown of every pair: the normal force, and both tangential forces or the one along tau."""
    n, stick, one = len(law.left), law.left == 2, law.left == 1
    force, motion, resisting = np.zeros((3, 3, n)), np.zeros((3, 3, n)), np.zeros((3, n))
    soft = 1.0 + law.kappa  # across a slip rows are divided by it: kappa may be as large as it likes
    motion[0, 0] = law.closed
    motion[1, 1:] = np.where(one, law.tau.T / soft, 0.0)
    motion[1, 1, stick] = motion[2, 2, stick] = 1.0
    force[0, 0] = 1.0
    force[1:, 0] = law.share.T
    force[1:, 1] = np.where(one, law.tau.T, motion[1, 1:])
    force[2, 2] = stick
    resisting[1] = np.where(one, law.kappa / soft, 0.0)
    apart = np.zeros((3, n))
    apart[1] = one & (law.kappa > _FAR)
    fixed = np.concatenate([np.zeros(n), law.fixed.T.ravel()])
    return Unknowns(force=force, motion=motion, fixed=fixed, resisting=resisting.ravel(), apart=apart.ravel())
