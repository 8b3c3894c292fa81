# SPDX-License-Identifier: BSD-3-Clause
"""Integrals over the common parts of faces of any kinds; space."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.crew import by_ranges
from signorini.fem.boundary import Boundary
from signorini.fem.facet_block import FacetBlock
from signorini.fem.facets import facet_pieces, gauss_rule
from signorini.interface.clip import overlap_areas
from signorini.interface.common_parts import CommonParts, Opposite
from signorini.interface.coupling import FacetGaps
from signorini.interface.face_integrals import FacePieces, PiecePairs, Rule, Sums, integrate, spread_gaps, widen
from signorini.interface.facing import near_pairs, nearest_layers, piece_normals, piece_spans
from signorini.interface.fitting import smooth_surfaces
from signorini.interface.smooth import Smooth
from signorini.interface.tilt import normals_between, turning_angles

SHARED_PAIRS = 1000
"""Pairs of pieces from which threads share the integrals over them: ten milliseconds of one thread and more."""

_DEGREE = {3: 1, 4: 2, 6: 2, 8: 3, 9: 4}  # of the shape functions, by nodes of a face
_GAP_POINTS = 3  # of Gauss a direction for gaps between surfaces: exact for hats times parabolas
_RATIONAL_POINTS = 8  # of Gauss a direction where functions are no polynomials: exact to 1e-13


class _Kind(NamedTuple):
    """Faces of one kind, their pieces, what they stand for, normals of pieces and how far the side turns at them."""

    block: FacetBlock
    pieces: FacePieces
    smooth: Smooth
    normals: Array
    turn: Array

    @property
    def each(self) -> int:
        """Pieces of a face."""
        return len(self.pieces.places)


class _Sums(NamedTuple):
    """What is added up over the pairs of m faces with c corners.

    Attributes
    ----------
    mass, own : see `signorini.interface.face_integrals.Sums`
    over : (m, c), see `signorini.interface.face_integrals.widen`
    ends, low, high : (m, c), (m,) and (m,), see `signorini.interface.face_integrals.spread_gaps`
    """

    mass: Array
    own: Array
    over: Array
    ends: Array
    low: Array
    high: Array


class _Seen(NamedTuple):
    """Pairs of pieces that are opposite each other, of one nonmortar and one mortar kind, and their common areas."""

    other: _Kind
    i: IntArray
    j: IntArray
    area: Array


def face_parts(nonmortar: Boundary, mortar: Boundary, *, share: float, search: float) -> list[CommonParts]:
    """Integrals over what the faces of both sides have in common, by kinds of nonmortar faces.

    For clipping four plane pieces stand for each quadratic face, but the points that are opposite each other are on the
    faces themselves. Areas and normals are those of the nonmortar faces.

    Parameters
    ----------
    nonmortar, mortar, share, search : see :func:`signorini.interface.mortar.mortar_coupling`
    """
    own, others = _kinds(nonmortar), _kinds(mortar)
    return [_parts_of(one, others, share, search) for one in own]


def _kinds(side: Boundary) -> list[_Kind]:
    found = []
    for block, smooth in zip(side.blocks, smooth_surfaces(side.blocks), strict=True):
        corners, places = block.plane_pieces, facet_pieces(block.count)
        turn = np.repeat(turning_angles(block.normals, side.at_facets(block)), len(places))
        pieces = FacePieces(corners, block.points, places)
        found.append(_Kind(block, pieces, smooth, piece_normals(corners), turn))
    return found


def _parts_of(one: _Kind, others: list[_Kind], share: float, search: float) -> CommonParts:
    near = [near_pairs(one.pieces.corners, other.pieces.corners, search) for other in others]
    seen = _opposite(one, others, near, one.normals, search)
    normals = _between(one, seen, share)
    if (normals != one.normals).any():
        seen = _opposite(one, others, near, normals, search)
    block = one.block
    m, c = block.corner_nodes.shape
    sums = _Sums(
        mass=np.zeros((m, c, c)),
        own=np.zeros((m, c, block.count, 3)),
        over=np.zeros((m, c)),
        ends=np.full((m, c), np.inf),
        low=np.full(m, np.inf),
        high=np.full(m, -np.inf),
    )
    opposite = []
    for each in seen:
        face, other = each.i // one.each, each.other
        gives = np.zeros((len(face), c, other.block.count, 3))
        # a thread has all pairs of its faces, in their order: sums are the same whoever forms them
        by_ranges(partial(_add, one, each, normals, sums, gives), m, worth=len(face) > SHARED_PAIRS)
        opposite.append(Opposite(first=face, nodes=other.block.facets[each.j // other.each], other=gives))
    met = sums.low <= sums.high
    return CommonParts(
        block=block,
        mass=sums.mass,
        own=sums.own,
        over=sums.over,
        opposite=tuple(opposite),
        gaps=FacetGaps(corners=block.corner_nodes[met], ends=sums.ends[met], low=sums.low[met], high=sums.high[met]),
        curved=any(kind.smooth.curved for kind in (one, *others)),
    )


def _add(one: _Kind, seen: _Seen, normals: Array, sums: _Sums, gives: Array, low: int, high: int) -> None:
    """Add what the pairs of a range of faces add, and write what they give to the mortar side."""
    other, smooth = seen.other, (one.smooth, seen.other.smooth)
    own = slice(*np.searchsorted(seen.i, (low * one.each, high * one.each)).tolist())
    pairs = PiecePairs(one.pieces, other.pieces, normals, seen.i[own], seen.j[own])
    spread_gaps(pairs, *smooth, sums.ends, sums.low, sums.high)
    integrate(pairs, _rule(_points(one.block, other.block)), Sums(sums.mass, sums.own, gives[own]))
    if any(surface.curved for surface in smooth):
        widen(pairs, *smooth, _rule(_GAP_POINTS), sums.over)


def _opposite(
    one: _Kind, others: list[_Kind], near: list[tuple[IntArray, IntArray]], normals: Array, search: float
) -> list[_Seen]:
    """Pairs of pieces that are opposite each other along normals (p, 3), by kinds of the mortar side."""
    first = one.pieces.corners
    found = [
        (other, i, j, *_overlaps(first, other.pieces.corners, normals, i, j))
        for other, (i, j) in zip(others, near, strict=True)
    ]
    i, area, distance = (np.concatenate([part[k] for part in found]) for k in (1, 3, 4))
    order = np.argsort(i, kind="stable")
    chosen = np.empty(len(i), np.bool_)
    # the pieces of a quadratic face are triangles or quadrilaterals in space, plane or nearly so
    whole = 0.5 * np.abs(np.sum(piece_spans(first) * normals, axis=1))
    chosen[order] = nearest_layers(area[order], distance[order], i[order], whole, search)
    by_kind = np.split(chosen, np.cumsum([len(part[1]) for part in found[:-1]]))
    return [
        _Seen(other, i[kept], j[kept], area[kept]) for (other, i, j, area, _), kept in zip(found, by_kind, strict=True)
    ]


def _overlaps(first: Array, second: Array, normals: Array, i: IntArray, j: IntArray) -> tuple[Array, Array]:
    """Common areas and distances of pairs, see `overlap_areas`."""

    def some(low: int, high: int) -> tuple[Array, Array]:
        return overlap_areas(first, second, normals, i[low:high], j[low:high])

    area, distance = zip(*by_ranges(some, len(i), worth=len(i) > SHARED_PAIRS), strict=True)
    return np.concatenate(area), np.concatenate(distance)


def _between(one: _Kind, seen: list[_Seen], share: float) -> Array:
    """(p, 3) Unit normals along which the pieces of nonmortar faces see what is opposite."""
    turn, opposite = one.turn.copy(), np.zeros_like(one.normals)
    for other, i, j, area in seen:
        np.add.at(opposite, i, area[:, None] * other.normals[j])
        np.maximum.at(turn, i, other.turn[j])
    return normals_between(one.normals, opposite, turn, share)


def _rule(points: int) -> Rule:
    """Quadrature of a triangle with so many Gauss points a direction."""
    places, weights = gauss_rule(3, points)
    return Rule(np.column_stack([1.0 - places.sum(axis=1), places]), 2.0 * weights)


def _points(block: FacetBlock, mortar: FacetBlock) -> int:
    """Gauss points a direction that integrate hats times shape functions; collapsed they are exact to 2 k - 2."""
    if not (block.parallelograms and mortar.parallelograms):
        return _RATIONAL_POINTS
    return (_DEGREE[block.corners] + max(_DEGREE[block.count], _DEGREE[mortar.count])) // 2 + 2
