# SPDX-License-Identifier: BSD-3-Clause
"""Elastic foundations: springs per area on boundaries."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.fem.boundary import boundary
from signorini.fem.facet_block import FacetBlock, unit_tangents
from signorini.fem.measure import facet_areas
from signorini.fem.space import Space
from signorini.model.conditions import Foundation
from signorini.model.model import Model


def make_springs(space: Space, model: Model) -> dict[str, sp.csr_array]:
    """Springs of every foundation by name: sparse S, (springs, dofs), stiffness ``S^T S``.

    A spring at every quadrature point of a facet in each direction that has a stiffness:
    ``sqrt(k dA) e . sum_a N_a u_a``.
    """
    return {
        foundation.label: _springs(space, model, foundation, ("foundation", i))
        for i, foundation in enumerate(model.foundations)
    }


def _springs(space: Space, model: Model, foundation: Foundation, where: tuple[str | int, ...]) -> sp.csr_array:
    side = boundary(space, foundation.on, (*where, "on"))
    return sp.csr_array(
        sp.vstack([part for block in side.blocks for part in _of_block(space, model, foundation, block)])
    )


def _of_block(space: Space, model: Model, foundation: Foundation, block: FacetBlock) -> list[sp.csr_array]:
    """Springs on facets of one kind: along the normal, then along tangents, with twist the hoop too."""
    normals = block.outward / block.weights[..., None]
    tangents = list(np.moveaxis(unit_tangents(normals), -2, 0))
    areas, parts = facet_areas(model, block), []
    if model.twists:
        normals, *tangents = (np.pad(axes, ((0, 0), (0, 0), (0, 1))) for axes in (normals, *tangents))
        tangents.append(np.broadcast_to(np.eye(3)[2], normals.shape))
    for stiffness, directions in (
        (foundation.normal_stiffness, normals),
        *((foundation.tangential_stiffness, along) for along in tangents),
    ):
        if stiffness > 0.0:
            size = np.sqrt(stiffness * np.maximum(areas, 0.0))[..., None] * directions
            values = np.einsum("mqi,qa->mqai", size, block.shapes[0])
            rows = np.arange(areas.size).reshape(*areas.shape, 1, 1)
            columns = space.dofs(block.facets)[:, None]
            rows, columns = np.broadcast_to(rows, values.shape), np.broadcast_to(columns, values.shape)
            entries = (values.ravel(), (rows.ravel(), columns.ravel()))
            parts.append(sp.csr_array(entries, shape=(areas.size, space.number_of_dofs)))
    return parts
