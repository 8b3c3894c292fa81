# SPDX-License-Identifier: BSD-3-Clause
"""Mortar coupling with dual multipliers: sides whose facets need not match, in kind or place."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary
from signorini.interface.common_parts import CommonParts, dual_functions
from signorini.interface.coupling import Coupling, joined_gaps, spread
from signorini.interface.edge_parts import Measure, edge_parts, unit
from signorini.interface.face_parts import face_parts
from signorini.interface.facing import search_distance

_COVERED_LEAST = 1e-8  # of the full weight of a node: with less it carries no pair


def mortar_coupling(
    nonmortar: Boundary,
    mortar: Boundary,
    *,
    share: float = 0.5,
    search: float | None = None,
    measure: Measure = unit,
    where: Where = (),
) -> Coupling:
    """Weigh both sides with the functions dual to the hats of the nonmortar corner nodes.

    On the covered part of every nonmortar facet, ``psi = diag(int N) (int N N^T)^-1 N``, N the hats of its corners, so
    that ``int psi_a N_b = delta_ab int N_a``; a unit pressure of pair k puts the forces

        int psi_k N_j n dA  on the nonmortar,  - int psi_k N_l^mortar n dA  on the mortar side,

    n the normal of the nonmortar side where it is, curved as it is, turned where the sides are tilted against each
    other (see :mod:`signorini.interface.tilt`). The psi_k sum to 1, so that a uniform pressure passes exactly, also
    where the sides are curved: on the nonmortar side as ``int N_j n dA``, on the mortar side as its own where the two
    coincide. Facets see each other along these normals: of linear edges the forces of every pair are in balance, with
    their moments. On straight edges and plane triangles only the pair's own node bears its forces. Quadratic facets
    have pairs at their corners only (their own dual functions oscillate).

    Parameters
    ----------
    nonmortar, mortar : the sides, on the same array of points; the coarser one is the better nonmortar side
    share : of the nonmortar side in the stiffness of both, 0 to 1
    search : how far apart facets can be along their normal, length; None: half the size of the smaller side
    measure : in the plane the thickness, or circumference, over which bodies touch
    where : what errors call the contact

    Raises
    ------
    InputError
        If no facets are opposite each other.

    References
    ----------
    Wohlmuth (2000), SIAM Journal on Numerical Analysis 38:989-1012. Puso, Laursen (2004), Computer Methods in Applied
    Mechanics and Engineering 193:601-629. Popp, Gitterle, Gee, Wall (2010), International Journal for Numerical Methods
    in Engineering 83:1428-1465. Popp, Wohlmuth, Gee, Wall (2012), SIAM Journal on Scientific Computing 34:B421-B446.

    Examples
    --------
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> upper, lower = Boundary.of(2 * square, [[3, 2, 1, 0]]), Boundary.of(2 * square, [[4, 5, 6, 7]])
    >>> coupling = mortar_coupling(upper, lower)
    >>> coupling.area.round(12).tolist(), (coupling.relative.toarray()[0].round(12) + 0.0).tolist()
    ([0.25, 0.25, 0.25, 0.25], [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0])
    """
    reach = search_distance(nonmortar, mortar, search)
    if nonmortar.dimension == 2:
        parts = edge_parts(nonmortar, mortar, share=share, search=reach, measure=measure, where=where)
    else:
        parts = face_parts(nonmortar, mortar, share=share, search=reach)
    n = len(nonmortar.points)
    smoothing = np.zeros(n)
    forces = [sp.csr_array((n, n)) for _ in range(nonmortar.dimension)]
    vectors = np.zeros((n, nonmortar.dimension))
    for part in parts:
        dual = dual_functions(part.mass)
        np.add.at(smoothing, part.block.corner_nodes, np.einsum("mab,mb->ma", dual, part.over))
        np.add.at(vectors, part.block.corner_nodes, -np.einsum("mab,mbjd->mad", dual, part.own))
        for i, given in enumerate(zip(*_forces(part, dual, n), strict=True)):
            forces[i] = sum(given, forces[i])
    full = np.zeros(n)
    full[nonmortar.nodes] = nonmortar.nodal(
        (block.weights * measure(block.at, block.cells, block.cells) for block in nonmortar.blocks), corners=True
    )
    nodes = np.nonzero(np.linalg.norm(vectors, axis=1) > _COVERED_LEAST * full)[0]
    if not len(nodes):
        raise InputError(
            f"no face of the nonmortar side has one of the mortar side opposite it within {reach:.4g} along its "
            "normal; expected surfaces that face each other, or another 'search'",
            where=where,
        )
    return Coupling(
        nodes=nodes,
        normal_areas=vectors[nodes],
        forces=tuple(sp.csr_array(force[nodes]) for force in forces),
        facets=joined_gaps([part.gaps for part in parts]),
        smoothing=smoothing[nodes] if any(part.curved for part in parts) else None,
    )


def _forces(part: CommonParts, dual: Array, n: int) -> Iterator[tuple[sp.csr_array, ...]]:
    """``int psi_k N_j n`` of the nonmortar facets and minus that of every mortar block, d of (n, n) each.

    The normals n of the facets point outward: the forces into the nonmortar body have the other sign. Along edges and
    triangles n is constant, and only the pair's own node bears them.
    """
    corners = part.block.corner_nodes
    own = -np.einsum("mab,mbjd->dmaj", dual, part.own)
    if part.block.count == part.block.dimension:
        own = own.sum(axis=3, keepdims=True)
        yield spread(corners.reshape(-1, 1), corners.reshape(-1, 1), own.reshape(len(own), -1, 1, 1), n)
    else:
        yield spread(corners, part.block.facets, own, n)
    for seen in part.opposite:
        yield spread(corners[seen.first], seen.nodes, np.einsum("kab,kbld->dkal", dual[seen.first], seen.other), n)
