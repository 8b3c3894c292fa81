# SPDX-License-Identifier: BSD-3-Clause
"""Laying smooth curves and surfaces through the nodes of facets, see :mod:`signorini.interface.smooth`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, sharing
from signorini.fem.facet_block import FacetBlock, outward_normals, unit_tangents
from signorini.fem.facets import facet_nodes, facet_shapes
from signorini.interface.facing import piece_normals
from signorini.interface.smooth import Smooth, heights

_CORNER = 2.0 * np.sin(np.radians(35.0) / 2)  # between normals of neighbours: from here on they meet in a corner
_LEAST_TURN = 0.1  # of the largest at a facet's corners: one that turns less at one belongs to what is flat there
_STRAIGHT_TOL = 1e-9  # a turn, or a bulge of a length of one, below this is rounding
_LEAST_KINK = 0.1  # of that between parabolas of a circle: with less there is nothing to smooth
_INNER_QUADS = 1.25  # quadrilaterals at a node of a strip: with more it is between two, with less at the end
_CURVATURE_TOL = 1e-6  # of the largest entry: a curvature that the nodes say less about is none
_CORRECTIONS = 8  # of correcting for z^2 and for the limit above: each gains a digit and more
_FACETS_AT_ONCE = 10_000  # facets at once: 30 nodes each take 100 MB


def smooth_surfaces(kinds: Sequence[FacetBlock]) -> tuple[Smooth, ...]:
    """What facets of all kinds of one side stand for.

    Examples
    --------
    >>> from signorini.interface.smooth import rises
    >>> from signorini.fem.boundary import Boundary
    >>> angle = np.linspace(0.0, 1.0, 4)
    >>> points = 2.0 * np.stack([np.sin(angle), np.cos(angle)], axis=1)[::-1]
    >>> nodes = np.array([[0, 1], [1, 2], [2, 3]])
    >>> (circle,) = smooth_surfaces(Boundary.of(points, nodes).blocks)
    >>> middle = points[nodes].mean(axis=1)[:, None]
    >>> up = rises(circle, np.arange(3), middle, np.full((3, 1, 2), 0.5), circle.normal)
    >>> np.linalg.norm(middle[:, 0] + up * circle.normal, axis=1).round(9).tolist()
    [2.0, 2.0, 2.0]
    """
    normals = np.concatenate([_normals(kind) for kind in kinds])
    bent = np.concatenate([_bent(kind).any(axis=1) for kind in kinds])
    one, two = _neighbours(kinds, normals, bent)
    if not (bent.any() or (_apart(normals, one, two) > _STRAIGHT_TOL).any()):
        return tuple(_flat(kind) for kind in kinds)
    points = _all_points(kinds)
    stencil = _stencil(kinds, one, two, len(points))
    origin = np.concatenate([kind.points[:, : kind.corners].mean(axis=1) for kind in kinds])
    some = [slice(first, first + _FACETS_AT_ONCE) for first in range(0, len(normals), _FACETS_AT_ONCE)]
    parts = [_fitted(points, stencil[own], origin[own], normals[own]) for own in some]
    level, slope, bend, arch = (np.concatenate(part) for part in zip(*parts, strict=True))
    smooth = _smooth_already(kinds, bend, one, two) & bent
    result, start, none = [], 0, np.zeros((0, 0))
    for kind in kinds:
        own = slice(start, start + len(kind.facets))
        # length of the gradient of the module's formula over the origin
        size = np.sqrt(1.0 - 2.0 * arch[own] * level[own] + np.sum(slope[own] ** 2, axis=1))[:, None, None]
        itself = np.where(smooth[own], 0.0, 1.0)
        surface = Smooth(
            origin[own],
            normals[own],
            level[own] * itself,
            slope[own] * itself[:, None],
            bend[own] * itself[:, None, None],
            arch[own] * itself,
            bend[own] / size,
            none,
            none,
            bent[own],
            curved=True,
        )
        nodal, lean = _at_nodes(kind, surface)
        result.append(surface._replace(nodal=nodal, lean=lean))
        start += len(kind.facets)
    return tuple(result)


def _smooth_already(kinds: Sequence[FacetBlock], bend: Array, one: IntArray, two: IntArray) -> BoolArray:
    """Facets that meet their neighbours nearly without a kink, (m,): they stand for themselves, as parabolas may.

    Parabolas of a circle meet at an angle of a twelfth of the cubed angle that each turns by.
    """
    facet, node = _incidence(kinds)
    normals, turn, start = [], [], 0
    for kind in kinds:
        d, k = kind.dimension, kind.count
        own = outward_normals(kind.points, facet_shapes(k, facet_nodes(d, k)[: kind.corners])[1])
        size = np.linalg.norm(own, axis=2, keepdims=True)
        normals.append((own / np.where(size > 0.0, size, 1.0)).reshape(-1, d))
        ends = kind.points[:, _edges(kind)]
        along = ends[:, :, 1] - ends[:, :, 0]
        bends = np.abs(np.einsum("mei,mij,mej->me", along, bend[start : start + len(along)], along))
        start += len(along)
        turn.append((bends / np.linalg.norm(along, axis=2)).max(axis=1))
    at = np.concatenate(normals)
    entry, other = sharing(node)
    count = len(bend)
    beside = sp.csr_array((np.ones(len(one)), (one, two)), shape=(count, count))
    near = np.asarray(beside[facet[entry], facet[other]]).ravel() > 0.0
    kink = np.zeros(count)
    np.maximum.at(kink, facet[entry[near]], _apart(at, entry[near], other[near]))
    return np.asarray(kink < _LEAST_KINK * np.concatenate(turn) ** 3 / 12.0, dtype=np.bool_)


def _flat(kind: FacetBlock) -> Smooth:
    """Facets that stand for themselves."""
    m, k, d = kind.points.shape
    none, vector, tensor, nodal = np.zeros(m), np.zeros((m, d)), np.zeros((m, d, d)), np.zeros((m, k))
    straight = np.zeros(m, np.bool_)
    return Smooth(
        vector, _normals(kind), none, vector, tensor, none, tensor, nodal, np.ones_like(nodal), straight, curved=False
    )


def _normals(kind: FacetBlock) -> Array:
    """Outward unit normals of the corners of facets, (m, d)."""
    return piece_normals(kind.points[:, : kind.corners])


def _edges(kind: FacetBlock) -> IntArray:
    """First and second end of every edge of a facet, (e, 2) places among its nodes."""
    if kind.points.shape[2] == 2:
        return np.array([[0, 1]])
    first = np.arange(kind.corners)
    return np.stack([first, np.roll(first, -1)], axis=1)


def _bent(kind: FacetBlock) -> BoolArray:
    """Which edges of quadratic facets have their middle node beside the straight line, (m, e)."""
    ends = kind.points[:, _edges(kind)]
    count = ends.shape[1]
    if kind.facets.shape[1] == kind.corners:
        return np.zeros((len(ends), count), np.bool_)
    along = ends[:, :, 1] - ends[:, :, 0]
    off = kind.points[:, kind.corners : kind.corners + count] - ends[:, :, 0]
    square = np.sum(along**2, axis=2, keepdims=True)
    off -= np.sum(off * along, axis=2, keepdims=True) / square * along
    return np.asarray(np.sum(off**2, axis=2) > _STRAIGHT_TOL**2 * square[..., 0])


def _apart(normals: Array, one: IntArray, two: IntArray) -> Array:
    return np.asarray(np.linalg.norm(normals[one] - normals[two], axis=1))


def _neighbours(kinds: Sequence[FacetBlock], normals: Array, bent: BoolArray) -> tuple[IntArray, IntArray]:
    """Facets and those that share a corner and go on smoothly there, themselves too; none that go on into a plane."""
    facet, node = _incidence(kinds)
    entry, other = sharing(node)
    apart = _apart(normals, facet[entry], facet[other])
    smooth = apart < _CORNER
    turn = np.zeros(len(node))
    np.maximum.at(turn, entry[smooth], apart[smooth])
    inside = ~_rim(kinds, int(node.max()) + 1)[node]
    if not inside.any():  # a strip one facet wide: what goes on beside a facet is all that is known
        inside = np.bincount(node, _quadrilaterals(kinds))[node] > _INNER_QUADS
    inside[entry[~smooth]] = False
    most = np.zeros(len(normals))
    np.maximum.at(most, facet, turn)
    flat = most <= _STRAIGHT_TOL
    flat[facet[inside & (turn < _LEAST_TURN * most[facet])]] = True
    flat[facet[entry[smooth & bent[facet[other]]]]] = True  # straight beside facets that bend
    flat &= ~bent
    one, two = facet[entry[smooth]], facet[other[smooth]]
    kept = (one == two) | ~(flat[one] | flat[two])
    return one[kept], two[kept]


def _incidence(kinds: Sequence[FacetBlock]) -> tuple[IntArray, IntArray]:
    """Every corner of every facet: number of the facet, and node."""
    facet, node, start = [], [], 0
    for kind in kinds:
        facet.append(np.repeat(start + np.arange(len(kind.facets)), kind.corners))
        node.append(kind.corner_nodes.ravel())
        start += len(kind.facets)
    return np.concatenate(facet), np.concatenate(node)


def _quadrilaterals(kinds: Sequence[FacetBlock]) -> Array:
    """Of every corner of every facet what it counts: a triangle half a quadrilateral."""
    counts = [np.full(kind.corner_nodes.size, 0.5 if kind.corners == 3 else 1.0) for kind in kinds]
    return np.concatenate(counts)


def _rim(kinds: Sequence[FacetBlock], size: int) -> BoolArray:
    """Nodes at the end of the side, (size,)."""
    rim = np.zeros(size, np.bool_)
    if kinds[0].points.shape[2] == 2:
        rim[np.bincount(_incidence(kinds)[1], minlength=size) == 1] = True
        return rim
    edges = np.sort(np.concatenate([kind.facets[:, _edges(kind)].reshape(-1, 2) for kind in kinds]), axis=1)
    once, times = np.unique(edges, axis=0, return_counts=True)
    rim[once[times == 1]] = True
    return rim


def _all_points(kinds: Sequence[FacetBlock]) -> Array:
    points = np.zeros((max(int(kind.facets.max()) for kind in kinds) + 1, kinds[0].points.shape[2]))
    for kind in kinds:
        points[kind.facets] = kind.points
    return points


def _stencil(kinds: Sequence[FacetBlock], one: IntArray, two: IntArray, size: int) -> sp.csr_array:
    """(m, size) The nodes that say how a facet's surface bends: corners, and middles of edges that bend."""
    facet, node = _incidence(kinds)
    rows, columns, start = [facet], [node], 0
    for kind in kinds:
        i, edge = np.nonzero(_bent(kind))
        rows.append(start + i)
        columns.append(kind.facets[i, kind.corners + edge])
        start += len(kind.facets)
    count = start
    i, j = np.concatenate(rows), np.concatenate(columns)
    lie = sp.csr_array((np.ones(len(i)), (i, j)), shape=(count, size))
    near = sp.csr_array((np.ones(len(one)), (one, two)), shape=(count, count))
    return sp.csr_array(near @ lie)


def _fitted(points: Array, stencil: sp.csr_array, origin: Array, normal: Array) -> tuple[Array, Array, Array, Array]:
    """Level, slope, bend and arch of the surfaces through the nodes of stencils, by least squares."""
    m, d = normal.shape
    count = np.diff(stencil.indptr)
    facet = np.repeat(np.arange(m), count)
    r = points[stencil.indices] - origin[facet]
    size = np.sqrt(np.maximum.reduceat(np.sum(r**2, axis=1), stencil.indptr[:-1]))
    r /= size[facet, None]
    axes = unit_tangents(normal)
    x, z = np.einsum("pe,pke->pk", r, axes[facet]), np.sum(r * normal[facet], axis=1)
    i, j = np.triu_indices(d - 1)
    rows = np.column_stack([np.ones(len(x)), x, np.where(i == j, 0.5, 1.0) * x[:, i] * x[:, j]])
    mass = np.add.reduceat(rows[:, :, None] * rows[:, None], stencil.indptr[:-1])
    known = np.arange(d, rows.shape[1])
    mass[:, known, known] += _CURVATURE_TOL * mass[:, :1, 0]
    inverse = np.linalg.inv(mass)
    found, arch = np.zeros((m, rows.shape[1])), np.zeros(m)
    for _ in range(_CORRECTIONS):
        left = -z - 0.5 * arch[facet] * z**2 - np.sum(rows * found[facet], axis=1)
        found += np.einsum("mab,mb->ma", inverse, np.add.reduceat(rows * left[:, None], stencil.indptr[:-1]))
        form = np.zeros((m, d - 1, d - 1))
        form[:, i, j] = form[:, j, i] = found[:, d:]
        arch = _arch(form)
    bend = np.einsum("mae,mab,mbf->mef", axes, form, axes) / size[:, None, None]
    return found[:, 0] * size, np.einsum("ma,mae->me", found[:, 1:d], axes), bend, arch / size


def _arch(form: Array) -> Array:
    """(m,) One curvature of surfaces with forms (m, k, k): that of a sphere, of a cylinder where they are one.

    The mean of both, weighted by their squares: smooth where both are the same, too, as the larger one is not.

    Examples
    --------
    >>> _arch(np.array([np.diag([2.0, 2.0]), np.diag([0.0, 3.0]), np.zeros((2, 2))])).tolist()
    [2.0, 3.0, 0.0]
    """
    squares = np.sum(form**2, axis=(1, 2))
    cubes = np.sum(form * (form @ form), axis=(1, 2))
    return np.asarray(np.divide(cubes, squares, out=np.zeros(len(form)), where=squares > 0.0))


def _at_nodes(kind: FacetBlock, surface: Smooth) -> tuple[Array, Array]:
    """``nodal`` and ``lean``; over middle nodes of facets without a bent edge means of those at the corners."""
    m, k, d = kind.points.shape
    each = np.repeat(np.arange(m), k)
    found = heights(surface, each, kind.points.reshape(-1, d)).reshape(m, k, 2)
    bent = surface.bent
    if k > kind.corners:
        edges = _edges(kind)
        found[~bent, kind.corners : kind.corners + len(edges)] = found[:, edges].mean(axis=2)[~bent]
        found[~bent, kind.corners + len(edges) :] = found[:, : kind.corners].mean(axis=1, keepdims=True)[~bent]
    found[bent, :, 1] = 1.0
    return np.ascontiguousarray(found[..., 0]), np.ascontiguousarray(found[..., 1])
