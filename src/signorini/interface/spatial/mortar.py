# SPDX-License-Identifier: BSD-3-Clause
"""Mortar coupling in space with dual multipliers: sides whose faces need not match, in kind or place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.interface.coupling import Coupling, FacetGaps, joined_gaps
from signorini.interface.dual import dual_functions
from signorini.interface.smooth import Smooth
from signorini.interface.spatial.clip import Side, integrate, overlap_areas
from signorini.interface.spatial.faces import pieces
from signorini.interface.spatial.facing import near_pairs, nearest_layers
from signorini.interface.spatial.gaps import spread_gaps, widen
from signorini.interface.spatial.surface import Block, Surface, reference_rule, search_distance
from signorini.interface.tilt import normals_between

_COVERED = 1e-8  # of the full weight of a node: with less it carries no pair
_DEGREE = {3: 1, 4: 2, 6: 2, 8: 3, 9: 4}  # of the shape functions, by nodes of a face
_FEW = 3  # Gauss points a direction for gaps between surfaces: exact for hats times parabolas
_MANY = 8  # Gauss points a direction where functions are no polynomials: exact to 1e-13


@dataclass(frozen=True, kw_only=True, eq=False)
class _Overlaps:
    """Pairs of pieces of one nonmortar and one mortar block, what the latter stands for, and their common parts."""

    mortar: Block
    smooth: Smooth
    i: IntArray
    j: IntArray
    area: Array
    chosen: BoolArray


def mortar_coupling(
    nonmortar: Surface, mortar: Surface, *, share: float = 0.5, search: float | None = None, where: Where = ()
) -> Coupling:
    """Weigh both sides with the functions dual to the hats of the nonmortar corner nodes.

    On the covered part of every nonmortar face, ``psi = diag(int N) (int N N^T)^-1 N``, N the hats of its corners, so
    that ``int psi_a N_b = delta_ab int N_a``; a unit pressure of pair k puts the forces

        int psi_k N_j n dA  on the nonmortar,  - int psi_k N_l^mortar n dA  on the mortar side.

    The psi_k sum to 1: uniform pressure passes exactly, on the mortar side where the two coincide. Quadratic faces have
    pairs at their corners only (their own dual functions oscillate); for clipping four plane pieces stand for each of
    them, but the points that are opposite each other are on the faces themselves. Areas and normals are those of the
    nonmortar faces, warped or curved as they are, the normals turned where the sides are tilted against each other.

    Parameters
    ----------
    nonmortar, mortar : the sides, on the same array of points; the coarser one is the better nonmortar side
    share : of the nonmortar side in the stiffness of both, see :mod:`signorini.interface.tilt`
    search : how far apart faces can be along their normal, length; None: half the size of the smaller side
    where : what errors call the contact

    Raises
    ------
    InputError
        If no faces are opposite each other.

    References
    ----------
    Puso, Laursen (2004), Computer Methods in Applied Mechanics and Engineering 193:601-629. Popp, Gitterle, Gee, Wall
    (2010), International Journal for Numerical Methods in Engineering 83:1428-1465. Popp, Wohlmuth, Gee, Wall (2012),
    SIAM Journal on Scientific Computing 34:B421-B446.

    Examples
    --------
    >>> from signorini.interface.spatial.surface import make_surface
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> upper, lower = make_surface(2 * square, [[3, 2, 1, 0]]), make_surface(2 * square, [[4, 5, 6, 7]])
    >>> coupling = mortar_coupling(upper, lower)
    >>> coupling.area.round(12).tolist(), (coupling.relative.toarray()[0].round(12) + 0.0).tolist()
    ([0.25, 0.25, 0.25, 0.25], [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0])
    """
    n = len(nonmortar.points)
    reach = search_distance(nonmortar, mortar) if search is None else search
    full = np.zeros(n)
    full[nonmortar.nodes] = nonmortar.nodal_areas
    keeps, gives = ([sp.csr_array((n, n)) for _ in range(3)] for _ in range(2))
    gaps: list[FacetGaps] = []
    smoothing = np.zeros(n)
    for block, smooth in zip(nonmortar.blocks, nonmortar.smooth, strict=True):
        seen = _overlaps(block, mortar, reach, _normals(block))
        normals = _between(nonmortar, mortar, block, seen, share)
        if (normals != _normals(block)).any():
            seen = _overlaps(block, mortar, reach, normals)
        gaps.append(_facet_gaps(block, smooth, seen, normals))
        own, other, over = _block_integrals(block, smooth, seen, normals, n)
        np.add.at(smoothing, block.corners, over)
        keeps = [one + two for one, two in zip(keeps, own, strict=True)]
        gives = [one + two for one, two in zip(gives, other, strict=True)]
    vectors = np.column_stack([part.sum(axis=1) for part in keeps])
    nodes = np.nonzero(np.linalg.norm(vectors, axis=1) > _COVERED * full)[0]
    if not len(nodes):
        raise InputError(
            f"no face of the nonmortar side has one of the mortar side opposite it within {reach:.4g} along its "
            "normal; expected surfaces that face each other, or another 'search'",
            where=where,
        )
    forces = tuple(sp.csr_array((one - two)[nodes]) for one, two in zip(keeps, gives, strict=True))
    return Coupling(
        nodes=nodes, normal_areas=vectors[nodes], forces=forces, facets=joined_gaps(gaps), smoothing=smoothing[nodes]
    )


def _corners(block: Block) -> Array:
    """(p, 3 or 4, 3) Corners of all pieces of a block, piece after piece of every face."""
    corners = block.plane_pieces
    return np.ascontiguousarray(corners.reshape(-1, *corners.shape[2:]))


def _side(block: Block, smooth: Smooth) -> Side:
    """A block as the integrals over common parts see it."""
    return Side(corners=_corners(block), nodes=block.points, places=pieces(block.nodes_a_face), smooth=smooth)


def _normals(block: Block) -> Array:
    """(p, 3) Outward unit normals of all pieces of a block."""
    corners = _corners(block)
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def _overlaps(block: Block, mortar: Surface, search: float, normals: Array) -> list[_Overlaps]:
    """Pairs of pieces that are opposite each other along normals (p, 3), by blocks of the mortar side."""
    first = _corners(block)
    found = []
    for other in zip(mortar.blocks, mortar.smooth, strict=True):
        second = _corners(other[0])
        i, j = near_pairs(first, second, search)
        found.append((other, i, j, *overlap_areas(first, second, normals, i, j)))
    i, area, distance = (np.concatenate([part[k] for part in found]) for k in (1, 3, 4))
    order = np.argsort(i, kind="stable")
    chosen = np.empty(len(i), np.bool_)
    # the pieces of a quadratic face are triangles or quadrilaterals in space, plane or nearly so
    spans = np.cross(first[:, 2] - first[:, 0], first[:, -1] - first[:, 1])
    whole = 0.5 * np.abs(np.sum(spans * normals, axis=1))
    chosen[order] = nearest_layers(area[order], distance[order], i[order], whole, search)
    result, start = [], 0
    for (other_block, smooth), i, j, area, _ in found:
        part = _Overlaps(mortar=other_block, smooth=smooth, i=i, j=j, area=area, chosen=chosen[start : start + len(i)])
        result.append(part)
        start += len(i)
    return result


def _between(nonmortar: Surface, mortar: Surface, block: Block, seen: list[_Overlaps], share: float) -> Array:
    """(p, 3) Unit normals along which the pieces of a nonmortar block see what is opposite."""
    own = _normals(block)
    turn = np.repeat(nonmortar.turns(block), len(pieces(block.nodes_a_face)))
    opposite = np.zeros_like(own)
    for part in seen:
        i, j, area = part.i[part.chosen], part.j[part.chosen], part.area[part.chosen]
        np.add.at(opposite, i, area[:, None] * _normals(part.mortar)[j])
        np.maximum.at(turn, i, mortar.turns(part.mortar)[j // len(pieces(part.mortar.nodes_a_face))])
    return normals_between(own, opposite, turn, share)


def _facet_gaps(block: Block, smooth: Smooth, overlaps: list[_Overlaps], normals: Array) -> FacetGaps:
    """Gaps on the faces of a block that anything is opposite; infinite at corners that nothing is."""
    corners = block.corners
    ends, low, high = np.full(corners.shape, np.inf), np.full(len(corners), np.inf), np.full(len(corners), -np.inf)
    for part in overlaps:
        own, other = _side(block, smooth), _side(part.mortar, part.smooth)
        spread_gaps(own, other, normals, part.i, part.j, part.chosen, ends, low, high)
    seen = low <= high
    return FacetGaps(corners=corners[seen], ends=ends[seen], low=low[seen], high=high[seen])


def _block_integrals(
    block: Block, smooth: Smooth, overlaps: list[_Overlaps], normals: Array, n: int
) -> tuple[list[sp.csr_array], list[sp.csr_array], Array]:
    """``int psi_k N_j n`` of the block itself and ``int psi_k N_l n`` of the other side, three of (n, n) each, and
    ``int psi_k`` of what the gap between the surfaces is larger than that of the faces at the corners, (m, c).

    The normals n of the faces point outward, psi_k is negative here: together they point into the body.
    """
    m, c = block.corners.shape
    mass, own, over = np.zeros((m, c, c)), np.zeros((m, c, block.nodes_a_face, 3)), np.zeros((m, c))
    others = []
    for part in overlaps:
        count = part.mortar.nodes_a_face
        other = np.zeros((len(part.i), c, count, 3))
        sides = _side(block, smooth), _side(part.mortar, part.smooth)
        i, j, chosen = part.i, part.j, part.chosen
        integrate(*sides, normals, i, j, chosen, *_rule(_points(block, part.mortar)), mass, own, other)
        if smooth.curved or part.smooth.curved:
            widen(*sides, normals, i, j, chosen, *_rule(_FEW), over)
        others.append(other)
    dual = -dual_functions(mass)
    keeps = _spread(block.corners, block.faces, np.einsum("mab,mbjd->dmaj", dual, own), n)
    gives = [sp.csr_array((n, n)) for _ in range(3)]
    per_face = len(pieces(block.nodes_a_face))
    for part, other in zip(overlaps, others, strict=True):
        k = np.nonzero(part.chosen)[0]
        face, opposite = part.i[k] // per_face, part.j[k] // len(pieces(part.mortar.nodes_a_face))
        values = np.einsum("kab,kbld->dkal", dual[face], other[k])
        seen = _spread(block.corners[face], part.mortar.faces[opposite], values, n)
        gives = [one + two for one, two in zip(gives, seen, strict=True)]
    return keeps, gives, -np.einsum("mab,mb->ma", dual, over)


def _rule(points: int) -> tuple[Array, Array]:
    """Barycentric coordinates and weights, which sum to 1, of a quadrature of the triangle."""
    places, weights = reference_rule(3, points)
    return np.column_stack([1.0 - places.sum(axis=1), places]), 2.0 * weights


def _points(block: Block, mortar: Block) -> int:
    """Gauss points a direction that integrate hats times shape functions; collapsed they are exact to 2 k - 2."""
    if not (block.parallelograms and mortar.parallelograms):
        return _MANY
    hats = _DEGREE[block.corners.shape[1]]
    return (hats + max(_DEGREE[block.nodes_a_face], _DEGREE[mortar.nodes_a_face])) // 2 + 2


def _spread(rows: IntArray, columns: IntArray, values: Array, n: int) -> list[sp.csr_array]:
    """Values (3, k, a, b) of rows (k, a) and columns (k, b), summed into three (n, n) matrices."""
    i, j = (np.broadcast_to(part, values.shape[1:]).ravel() for part in (rows[:, :, None], columns[:, None, :]))
    return [sp.csr_array((part.ravel(), (i, j)), shape=(n, n)) for part in values]
