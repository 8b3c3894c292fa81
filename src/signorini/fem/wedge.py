# SPDX-License-Identifier: BSD-3-Clause
"""The wedge with 15 nodes, which scikit-fem does not have."""

from __future__ import annotations

import numpy as np
import skfem

from signorini.arrays import Array

_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]], dtype=np.float64)
_EDGES = ((0, 1), (1, 2), (2, 0))
_MIDDLES = (*_EDGES, (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))


class QuadraticWedge(skfem.ElementH1):
    """Serendipity functions on the wedge of a triangle and a height from 0 to 1, nodes in the order of meshio.

    With L_i the area coordinates of the triangle and zeta from -1 to 1 along the height:
    ``L_i ((2 L_i - 1) (1 -+ zeta) - (1 - zeta^2)) / 2`` at corners, ``2 L_i L_j (1 -+ zeta)`` on the edges of the
    triangles and ``L_i (1 - zeta^2)`` on the upright ones.

    References
    ----------
    Zienkiewicz, Taylor, The Finite Element Method, vol. 1, 8.12; C3D15 of Abaqus and CalculiX.
    """

    nodal_dofs = 1
    edge_dofs = 1
    maxdeg = 3
    dofnames = ("u", "u")
    refdom = skfem.refdom.RefWedge
    doflocs = np.vstack([_CORNERS, *((_CORNERS[[a]] + _CORNERS[[b]]) / 2.0 for a, b in _MIDDLES)])

    def lbasis(self, X: Array, i: int) -> tuple[Array, Array]:
        """Function i and its gradient, (q,) and (3, q), at reference points X (3, q)."""
        x, y, z = X
        zeta = 2.0 * z - 1.0
        L = (1.0 - x - y, x, y)
        slope = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])  # of the area coordinates along x and y
        bubble = 1.0 - zeta**2
        if i < 6:
            k, side = i % 3, -1.0 if i < 3 else 1.0
            along = 1.0 + side * zeta
            value = 0.5 * L[k] * ((2.0 * L[k] - 1.0) * along - bubble)
            across = 0.5 * ((4.0 * L[k] - 1.0) * along - bubble)
            up = 0.5 * L[k] * ((2.0 * L[k] - 1.0) * side + 2.0 * zeta)
            return value, np.array([slope[0, k] * across, slope[1, k] * across, 2.0 * up])
        if i < 12:
            (k, m), side = _EDGES[(i - 6) % 3], -1.0 if i < 9 else 1.0
            along = 1.0 + side * zeta
            value = 2.0 * L[k] * L[m] * along
            across = [2.0 * along * (slope[j, k] * L[m] + slope[j, m] * L[k]) for j in (0, 1)]
            return value, np.array([*across, 4.0 * L[k] * L[m] * side])
        k = i - 12
        return L[k] * bubble, np.array([slope[0, k] * bubble, slope[1, k] * bubble, -4.0 * zeta * L[k]])
