# SPDX-License-Identifier: BSD-3-Clause
"""Functions dual to the hats of faces, from their mass matrices: the same in the plane and in space."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array


def dual_functions(mass: Array) -> Array:
    """Coefficients of the functions dual to hats N, (m, c, c): ``psi = A N``, ``A = diag(int N) (int N N^T)^-1``.

    Parameters
    ----------
    mass : (m, c, c) ``int N N^T`` over the covered part of every face; zero where nothing is covered

    Examples
    --------
    >>> dual_functions(np.array([[[2.0, 1.0], [1.0, 2.0]]]) / 6).round(12).tolist()
    [[[2.0, -1.0], [-1.0, 2.0]]]
    """
    share = mass.sum(axis=2)
    total = share.sum(axis=1)
    covered = total > 0.0
    dual = np.zeros_like(mass)
    inverse = np.linalg.pinv(mass[covered] / total[covered, None, None], 1e-10, hermitian=True)
    dual[covered] = (share[covered] / total[covered, None])[:, :, None] * inverse
    return dual
