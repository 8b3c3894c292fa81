# SPDX-License-Identifier: BSD-3-Clause
"""The faceted problem as a linear complementarity problem: checks the Newton method by an entirely different one."""

import numpy as np

from signorini.arrays import Array
from signorini.errors import InputError
from signorini.friction.problem import ContactProblem


def faceted_lcp(problem: ContactProblem) -> tuple[Array, Array]:
    """M and q of ``0 <= z  _|_  M z + q >= 0`` with z = (p, beta, lambda), facets + 2 rows a pair.

    The tangential force is ``sum_j beta_j d_j`` with d_j the corners of the section, lambda the slip's size::

        M = [ A_nn    A_nt d    0 ]      q = [ c_n    ]
            [ d'A_tn  d'A_tt d  E ]          [ d' c_t ]
            [ mu     -E'        0 ]          [ 0      ]

    ``decoded`` reads the forces off z. Lemke's method solves it where friction is moderate; dense, for few pairs.

    Raises
    ------
    InputError
        Where a body floats, or the problem has no facets or pairs in Tresca's law.

    References
    ----------
    Klarbring (1986), Computer Methods in Applied Mechanics and Engineering 58:185-200. Stewart, Trinkle (1996),
    International Journal for Numerical Methods in Engineering 39:2673-2691.

    Examples
    --------
    >>> from signorini.lcp import solve
    >>> problem = ContactProblem.of(
    ...     W=np.eye(3) / 2, b=np.array([-1, 0.5, 0]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0, facets=4
    ... )
    >>> decoded(problem, solve(*faceted_lcp(problem), method="lemke").z).round(12).tolist()
    [[2.0], [-0.2], [0.0]]
    """
    if (
        problem.floating
        or len(set(problem.section.sides)) != 1
        or not problem.section.sides[0]
        or problem.bounded.any()
    ):
        raise InputError("expected facets, as many at every pair, held bodies and Coulomb's law at every pair")
    n, k = problem.pairs, int(problem.section.sides[0])
    D, most = _corner_forces(problem)
    A, c = problem.image.A, problem.free_motion()
    forces = np.zeros((3 * n, n + n * k))
    forces[:n, :n] = np.eye(n)
    forces[n:, n:] = D
    E = np.kron(np.eye(n), np.ones((k, 1)))
    M = np.zeros((n * (k + 2), n * (k + 2)))
    M[: n + n * k, : n + n * k] = forces.T @ A @ forces
    M[n : n + n * k, n + n * k :] = E
    M[n + n * k :, :n] = np.diag(most)
    M[n + n * k :, n : n + n * k] = -E.T
    return M, np.concatenate([forces.T @ c, np.zeros(n)])


def decoded(problem: ContactProblem, z: Array) -> Array:
    """(3, n) Forces of a solution z of `faceted_lcp`."""
    n, k = problem.pairs, int(problem.section.sides[0])
    return problem.by_pair(np.concatenate([z[:n], _corner_forces(problem)[0] @ z[n : n + n * k]]))


def _corner_forces(problem: ContactProblem) -> tuple[Array, Array]:
    """(2n, n k) Tangential force of each beta, of length mu / max(mu), and the largest mu of each pair."""
    n, k = problem.pairs, int(problem.section.sides[0])
    most = problem.half_axes.max(axis=0)
    share = problem.half_axes / np.where(most > 0, most, 1.0)
    share[:, most == 0] = 1.0
    D = np.zeros((2, n, n, k))
    pairs, angle = np.arange(n), 2.0 * np.pi * np.arange(k) / k
    for axis, corner in enumerate((np.cos(angle), np.sin(angle))):
        D[axis, pairs, pairs] = share[axis, :, None] * corner
    return D.reshape(2 * n, n * k), most
