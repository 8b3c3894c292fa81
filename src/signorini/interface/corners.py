# SPDX-License-Identifier: BSD-3-Clause
"""Quadratic facets against a rigid obstacle: pairs at their corners, which see weighted means of the facets."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.boundary import Boundary
from signorini.fem.facets import facet_shapes
from signorini.interface.coupling import Coupling
from signorini.interface.dual import dual_functions


def corner_coupling(side: Boundary, areas: Array, count: int) -> Coupling:
    """Weights ``int psi_k N_j / int psi_k`` with psi dual to the hats of the corners, N the shape functions.

    The consistent weights of a quadratic facet are 0 or negative at its corners; these are positive.

    Parameters
    ----------
    areas : (m, q) area of the quadrature points of the side
    count : nodes of the mesh

    References
    ----------
    Popp, Wohlmuth, Gee, Wall (2012), SIAM Journal on Scientific Computing 34:B421-B446.
    """
    corners = side.facets[:, : side.corners]
    hats = facet_shapes(side.dimension, side.corners, side.places)[0]
    mass = np.einsum("mq,qa,qb->mab", areas, hats, hats)
    multiplier = np.einsum("mab,qb,mq->mqa", dual_functions(mass), hats, areas)
    weights = np.einsum("mqa,qj->maj", multiplier, side.shapes[0])
    area = np.zeros(count)
    np.add.at(area, corners, mass.sum(axis=2))
    rows = np.broadcast_to(corners[:, :, None], weights.shape)
    columns = np.broadcast_to(side.facets[:, None, :], weights.shape)
    keeps = sp.csr_array((weights.ravel(), (rows.ravel(), columns.ravel())), shape=(count, count))
    nodes = np.unique(corners)
    return Coupling(
        nodes=nodes, area=area[nodes], relative=sp.csr_array(sp.diags_array(1.0 / area[nodes]) @ keeps[nodes])
    )
