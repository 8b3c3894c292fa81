# SPDX-License-Identifier: BSD-3-Clause
"""Quadratic facets against a rigid obstacle: pairs at their corners, which see weighted means of the facets."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import FacetBlock
from signorini.interface.common_parts import dual_functions
from signorini.interface.coupling import Coupling, spread


def corner_coupling(side: Boundary, areas: Sequence[Array], normals: Sequence[Array], count: int) -> Coupling:
    """Forces ``int psi_k N_j n`` with psi dual to the hats of the corners, N the shape functions.

    The consistent weights of a quadratic facet are 0 or negative at its corners; these are positive.

    Parameters
    ----------
    areas : for every block of the side the area of its quadrature points, (m, q)
    normals : of the obstacle there, (m, q, d)
    count : nodes of the mesh

    References
    ----------
    Popp, Wohlmuth, Gee, Wall (2012), SIAM Journal on Scientific Computing 34:B421-B446.
    """
    nodes = side.corner_nodes
    by_block = [_of_block(*given, count) for given in zip(side.blocks, areas, normals, strict=True)]
    forces = tuple(sp.csr_array(sum(parts[1:], parts[0])[nodes]) for parts in zip(*by_block, strict=True))
    vectors = np.column_stack([force.sum(axis=1) for force in forces])
    return Coupling(nodes=nodes, normal_areas=vectors, forces=forces)


def _of_block(block: FacetBlock, areas: Array, normals: Array, count: int) -> tuple[sp.csr_array, ...]:
    """The forces of facets of one kind, for each direction (count, count): rows of corners, columns of nodes."""
    corners, hats = block.corner_nodes, block.hats
    mass = np.einsum("mq,qa,qb->mab", areas, hats, hats)
    multiplier = np.einsum("mab,qb,mq,mqd->dmqa", dual_functions(mass), hats, areas, normals)
    values = np.einsum("dmqa,qj->dmaj", multiplier, block.shapes[0])
    return spread(corners, block.facets, values, count)
