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


def corner_coupling(side: Boundary, areas: Array, normals: Array, count: int) -> Coupling:
    """Forces ``int psi_k N_j n`` with psi dual to the hats of the corners, N the shape functions.

    The consistent weights of a quadratic facet are 0 or negative at its corners; these are positive.

    Parameters
    ----------
    areas : (m, q) area of the quadrature points of the side
    normals : (m, q, d) of the obstacle there
    count : nodes of the mesh

    References
    ----------
    Popp, Wohlmuth, Gee, Wall (2012), SIAM Journal on Scientific Computing 34:B421-B446.
    """
    corners = side.facets[:, : side.corners]
    hats = facet_shapes(side.dimension, side.corners, side.places)[0]
    mass = np.einsum("mq,qa,qb->mab", areas, hats, hats)
    multiplier = np.einsum("mab,qb,mq,mqd->dmqa", dual_functions(mass), hats, areas, normals)
    values = np.einsum("dmqa,qj->dmaj", multiplier, side.shapes[0])
    rows, columns = (np.broadcast_to(x, values.shape[1:]).ravel() for x in (corners[:, :, None], side.facets[:, None]))
    nodes = np.unique(corners)
    forces = tuple(
        sp.csr_array(sp.csr_array((part.ravel(), (rows, columns)), shape=(count, count))[nodes]) for part in values
    )
    vectors = np.column_stack([force.sum(axis=1) for force in forces])
    return Coupling(nodes=nodes, normal_areas=vectors, forces=forces)
