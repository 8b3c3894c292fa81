# SPDX-License-Identifier: BSD-3-Clause
"""Block Gauss-Seidel: one pair after the other takes the force that its law and the others' forces ask for. Compiled.

Slow and hardly ever lost: it brings Newton's method near where that cycles.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel
from signorini.friction.problem import ContactProblem
from signorini.law.section import nearest_point

_LOCAL_STEPS = 30  # of the fixed point of one pair
_SETTLED = 1e-14  # of its forces: a change that is rounding


@kernel(brief=True)
def _sweep(
    A: Array, c: Array, axes: Array, slopes: Array, starts: Array, facets: IntArray, step: Array, r: Array, count: int
) -> None:
    """Relax r in place for ``h = A r + c``; a pair's own problem by a projected fixed point of step ``step``."""
    n = len(step)
    u, start, force = np.empty(3), np.empty(3), np.empty(3)
    for _ in range(count):
        for i in range(n):
            for e in range(3):
                u[e] = c[e * n + i] + np.dot(A[e * n + i], r)
                start[e] = force[e] = r[e * n + i]
            for _ in range(_LOCAL_STEPS):
                change = 0.0
                x_0, x_1, x_2 = force[0], force[1], force[2]
                for e in range(3):
                    moved = u[e]
                    for f in range(3):
                        moved += A[e * n + i, f * n + i] * (force[f] - start[f])
                    if e == 0:
                        x_0 -= step[i] * moved
                    elif e == 1:
                        x_1 -= step[i] * moved
                    else:
                        x_2 -= step[i] * moved
                p = max(x_0, 0.0)
                s = np.inf
                for j in range(len(slopes)):
                    s = min(s, starts[j, i] + slopes[j, i] * p)
                t_1, t_2, _, _, _, _ = nearest_point(x_1, x_2, axes[0, i], axes[1, i], s, facets[i])
                change = abs(p - force[0]) + abs(t_1 - force[1]) + abs(t_2 - force[2])
                force[0], force[1], force[2] = p, t_1, t_2
                if change <= _SETTLED * (abs(p) + abs(t_1) + abs(t_2)):
                    break
            for e in range(3):
                r[e * n + i] = force[e]


def gauss_seidel(problem: ContactProblem, force: Array, rigid: Array, *, count: int) -> tuple[Array, Array]:
    """Sweep over the pairs; the rigid motion is dragged after the resultants like the multiplier of a penalty.

    Parameters
    ----------
    problem : the problem, in space, with a bound of straight branches
    force, rigid : (3, n) and (k,) where to start
    count : number of sweeps

    Returns
    -------
    force, rigid : new arrays

    References
    ----------
    Jourdan, Alart, Jean (1998), Computer Methods in Applied Mechanics and Engineering 155:31-47.

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.3, 0.4]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> gauss_seidel(problem, np.zeros((3, 1)), np.zeros(0), count=1)[0].round(12).tolist()
    [[2.0], [-0.12], [-0.16]]
    """
    n, R, A = problem.pairs, problem.image.R, problem.image.A
    if R.shape[1]:
        A = A + R @ R.T
    pull = R.T @ problem.b
    c = problem.free_motion() + R @ (rigid + pull)
    blocks = A.reshape(3, n, 3, n)[:, np.arange(n), :, np.arange(n)]
    largest = np.linalg.eigvalsh(blocks)[:, -1]
    step = 1.0 / np.where(largest > 0, largest, 1.0)
    r = force.flatten()
    bound, section = problem.pieces, problem.section
    _sweep(np.ascontiguousarray(A), c, section.axes, bound.slopes, bound.starts, section.sides, step, r, count)
    return problem.by_pair(r), rigid + R.T @ r + pull
