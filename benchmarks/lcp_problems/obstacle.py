# SPDX-License-Identifier: BSD-3-Clause
"""A membrane over an obstacle: the large sparse symmetric problem."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from benchmarks.lcp_problems.posed import PosedLCP


def obstacle(side: int) -> PosedLCP:
    """The 5-point Laplacian on a square of ``side * side`` points, membrane clamped at height 0, spherical obstacle.

    ``u`` is the height, ``psi`` the obstacle, ``z = u - psi`` and ``w`` the contact force, ``w = -Laplace_h u``.

    References
    ----------
    Cottle, Pang, Stone (1992), The Linear Complementarity Problem, section 5.1 (obstacle problems).
    """
    h = 1.0 / (side + 1)
    x = h * np.arange(1, side + 1)
    line = sp.diags_array([-np.ones(side - 1), 2 * np.ones(side), -np.ones(side - 1)], offsets=[-1, 0, 1])
    eye = sp.eye_array(side)
    M = (sp.kron(line, eye) + sp.kron(eye, line)).tocsr() / h**2
    psi = (0.3 - 4 * ((x[:, None] - 0.45) ** 2 + (x - 0.55) ** 2)).ravel()
    return PosedLCP(
        name=f"obstacle, {side} x {side}",
        source="membrane over a paraboloid",
        M=M,
        q=M @ psi,
        unique=True,
        traits=frozenset({"P", "positive definite", "monotone", "symmetric", "Z", "copositive plus"}),
    )
