# SPDX-License-Identifier: BSD-3-Clause
"""Initial gaps: from the geometry or as asked for, without what chords of curved surfaces feign."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary
from signorini.model.contact import Contact

_KINK = np.pi / 6.0  # a turn between two facets beyond this is a corner, not a curve
_STRAIGHT = 1e-9  # a turn below this is rounding


def initial_gaps(geometry: Array, contact: Contact) -> Array:
    """What a contact makes of the gaps that the geometry has, (n,) length, negative: overlap."""
    if contact.gap == "zero" or contact.tied:
        gap = np.zeros(len(geometry))
    elif contact.gap == "geometry":
        gap = geometry if contact.adjust is None else np.where(geometry <= contact.adjust, 0.0, geometry)
    else:
        gap = np.full(len(geometry), contact.gap)
    return gap - contact.interference


def without_chords(gap: Array, nodes: IntArray, relative: sp.csr_array, nonmortar: Boundary, mortar: Boundary) -> Array:
    """Gaps (n,), 0 where they are no more than what chords leave between two surfaces that are meant to match.

    Two different polygons on one curve of curvature kappa are up to ``h^2 kappa / 8`` of both apart, which would ruin
    the pressure. All gaps must be as small as that, and one side hollow where the other bulges: otherwise they are
    meant, and stay.

    Parameters
    ----------
    nodes : (n,) nonmortar nodes of the pairs
    relative : (n, nodes of the mesh), see :class:`signorini.interface.coupling.Coupling`
    """
    count = relative.shape[1]
    own, other = _sags(nonmortar, count), _sags(mortar, count)
    pattern = relative.tocoo()
    opposite = np.zeros(len(nodes))
    np.minimum.at(opposite, pattern.row, np.minimum(other[pattern.col], 0.0))
    hollow = -opposite
    np.maximum.at(opposite, pattern.row, np.maximum(other[pattern.col], 0.0))
    bulging, mine = opposite, own[nodes]
    sag = np.where(mine > 0.0, mine + hollow, -mine + bulging)
    curved = np.where(mine > 0.0, hollow > 0.0, (mine < 0.0) & (bulging > 0.0))
    return np.zeros_like(gap) if (curved & (np.abs(gap) <= sag)).all() else gap


def _sags(side: Boundary, count: int) -> Array:
    """Largest ``h^2 kappa / 8`` of the facets at each node, positive where the side bulges, (count,); 0 elsewhere."""
    start, end = side.facets[:, 0], side.facets[:, 1]
    leaving = np.full(count, -1)
    leaving[start] = np.arange(len(start))
    following = leaving[end]
    one, two = side.normals, side.normals[following]
    turn = np.arctan2(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], np.sum(one * two, axis=1))
    smooth = (following >= 0) & (np.abs(turn) < _KINK) & (np.abs(turn) > _STRAIGHT)
    at, turn = end[smooth], turn[smooth]
    here, after = side.lengths[smooth], side.lengths[following[smooth]]
    sag = turn * np.maximum(here, after) ** 2 / (4.0 * (here + after))  # kappa = 2 turn / (h_1 + h_2)
    result = np.zeros(count)
    result[at] = sag
    # at the ends of a side the curve goes on as beside them
    for near, far in ((start[smooth], at), (end[following[smooth]], at)):
        lone = result[near] == 0.0
        result[near[lone]] = result[far[lone]]
    return result


def refuse_deep_overlap(gap: Array, nodes: IntArray, contact: Contact, element: float, where: Where) -> None:
    """An overlap of more than an element is no small displacement.

    Raises
    ------
    InputError
        With the node where it is deepest.
    """
    if len(gap) and -gap.min() > element:
        worst = int(np.argmin(gap))
        by = f" with the interference of {contact.interference:g}" if contact.interference else ""
        raise InputError(
            f"the two sides overlap{by} by {-gap[worst]:.4g} at node {nodes[worst] + 1}, more than the longest facet "
            f"there, {element:.4g}; displacements are small here. Expected bodies that hardly overlap: move one, or "
            "say gap = 'zero' or adjust",
            where=where,
        )
