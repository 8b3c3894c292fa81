# SPDX-License-Identifier: BSD-3-Clause
"""Proof that loads pull bodies away: a rigid motion that contact cannot resist and along which the loads work."""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

from signorini.arrays import Array, IntArray
from signorini.friction.pull_away import GAIN, STRONGEST, Pull, pull_along, size_of
from signorini.friction.spatial.problem import SpatialProblem
from signorini.friction.spatial.section import outermost

_ROUNDS = 60


def pulled_away(problem: SpatialProblem) -> Pull | None:
    """A rigid motion rho with ``rho_n >= |(mu_1 rho_1, mu_2 rho_2)|`` at every pair and ``b.rho > 0``, or None.

    Equilibrium needs forces in the friction cones with ``R'(r + b) = 0``; but r.rho >= 0 for such a rho, so that
    ``rho.(r + b) > 0``: no state of the pairs whatever is in equilibrium. The motion sought is what of the load the
    forces in the cones cannot take, ``a = R'(r + b)`` of least length: a nonnegative least squares problem in the edges
    of the cones, of which each round adds those that resist the present motion most. What they resist in the end counts
    with forces up to `STRONGEST`.

    None where nothing is proved, which includes pairs in Tresca's law: their friction knows no cone.

    Examples
    --------
    >>> problem = SpatialProblem.of(
    ...     W=np.eye(3), b=np.array([1.0, 0.0, 0.0]), friction=[0.3], motions=np.eye(3), scale=1.0
    ... )
    >>> pulled_away(problem).motion.tolist()
    [1.0, 0.0, 0.0]
    """
    R = problem.image.R
    if not R.shape[1] or problem.bounded.any():
        return None
    load = R.T @ problem.b / (problem.scale or 1.0)
    a = unresisted(R, problem.mu, problem.sides, load)
    return None if a is None else pull_along(R, a, load)


def unresisted(R: Array, mu: Array, sides: IntArray, load: Array) -> Array | None:
    """The motion that a load favours of those that friction does not resist; None where friction can bear the load.

    Parameters
    ----------
    R : (3n, k) motions of the pairs
    mu, sides : (n, 2) finite half-axes, and (n,) corners of the sections
    load : (k,) its work along each motion, relative to the data
    """
    n, most = len(mu), size_of(load)
    if not n:
        return load
    edges = R[:n] / np.sqrt(1.0 + (mu**2).sum(axis=1))[:, None]
    for _ in range(_ROUNDS):
        try:
            multipliers, _ = nnls(edges.T, -load)
        except RuntimeError:  # its iteration limit: nothing proved
            return None
        a: Array = load + edges.T @ multipliers
        size = float(np.linalg.norm(a))
        if size <= GAIN * np.sqrt(n) * most:
            return None
        strongest = np.einsum("ni,ink->nk", strongest_edges(mu, sides, R @ a), R.reshape(3, n, -1))
        work = strongest @ a
        resisted = STRONGEST * most * work < -0.25 * size**2
        if not resisted.any():
            return a if load @ a > 0.75 * size**2 else None
        edges = np.concatenate([edges[multipliers > 0], strongest[resisted]])
    return None


def strongest_edges(mu: Array, sides: IntArray, rho: Array) -> Array:
    """(n, 3) Edge of each pair's cone that works most against the motion, scaled to length 1."""
    slip = rho[len(mu) :].reshape(2, -1).T
    return unit_edges(outermost(-slip, mu, sides))


def unit_edges(share: Array) -> Array:
    """(n, 3) Forces of length 1 with tangential parts (n, 2) per normal force."""
    edge = np.column_stack([np.ones(len(share)), share])
    return np.asarray(edge / np.linalg.norm(edge, axis=1)[:, None])
