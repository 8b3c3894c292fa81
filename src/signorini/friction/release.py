# SPDX-License-Identifier: BSD-3-Clause
"""The same problem without pairs that stay open: what makes a long path short where few of many candidates touch."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from signorini.arrays import Array, BoolArray
from signorini.errors import InputError
from signorini.friction.problem import CoulombProblem


def released(problem: CoulombProblem, kept: BoolArray) -> CoulombProblem | None:
    """The problem of the kept pairs, all others open: the springs D of their image form are taken away.

    With o the released and c the kept unknowns, r_o = 0 leaves::

        W_c = W_cc + W_co G_oo^-1 W_oc,    b_c = b_c + W_co G_oo^-1 b_o

    Parameters
    ----------
    problem : the problem
    kept : (n,) pairs that may close

    Returns
    -------
    problem : None where the kept pairs do not hold the bodies (G_oo is singular, or the motions seen are dependent)

    Examples
    --------
    >>> W = np.array([[0.5, 0.25, 0, 0], [0.25, 0.5, 0, 0], [0, 0, 0.5, 0], [0, 0, 0, 0.5]])
    >>> problem = CoulombProblem.of(W=W, b=np.ones(4), friction=[0.3, 0.3], motions=np.zeros((4, 0)), scale=1.0)
    >>> released(problem, np.array([True, False])).W.round(12).tolist()
    [[0.625, 0.0], [0.0, 0.5]]
    """
    c, o = np.flatnonzero(np.tile(kept, 2)), np.flatnonzero(~np.tile(kept, 2))
    G = np.eye(len(o)) - problem.W[np.ix_(o, o)]
    coupling = problem.W[np.ix_(o, c)]
    try:
        answer = cho_solve(cho_factor(G, lower=True), np.column_stack([coupling, problem.b[o]]))
        W: Array = problem.W[np.ix_(c, c)] + coupling.T @ answer[:, :-1]
        return CoulombProblem.of(
            W=(W + W.T) / 2,
            b=problem.b[c] + coupling.T @ answer[:, -1],
            friction=problem.friction[kept],
            adhesion=None if problem.adhesion is None else problem.adhesion[kept],
            limit=None if problem.limit is None else problem.limit[kept],
            motions=problem.motions[c],
            scale=problem.scale,
        )
    except (np.linalg.LinAlgError, InputError):
        return None
