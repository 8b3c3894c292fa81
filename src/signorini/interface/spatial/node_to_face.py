# SPDX-License-Identifier: BSD-3-Clause
"""Nodes on the faces opposite: the simple coupling of sides that do not match; and node opposite node."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.interface.coupling import Coupling, picked, point_coupling
from signorini.interface.matching import match_nodes
from signorini.interface.near import near
from signorini.interface.smooth import Smooth, rises
from signorini.interface.spatial.faces import shapes_at
from signorini.interface.spatial.facing import FACING
from signorini.interface.spatial.projection import meet
from signorini.interface.spatial.surface import Block, Surface, search_distance
from signorini.interface.tilt import areas_between
from signorini.meshing.faces import CORNERS

_BESIDE = 1e-9  # of the reference face: how far beyond its edge a node still lies on it


def node_to_face(nonmortar: Surface, mortar: Surface, *, search: float | None = None, where: Where = ()) -> Coupling:
    """Every nonmortar corner node against the point that its normal meets on the mortar side; nodes that meet none are
    left.

    It fails the patch test where the meshes do not match.

    Parameters
    ----------
    nonmortar, mortar : the sides, on the same array of points
    search : how far apart node and face can be, length; None: half the size of the smaller side
    where : what errors call the contact

    Raises
    ------
    InputError
        If no node meets a face.
    """
    reach = search_distance(nonmortar, mortar) if search is None else search
    n, nodes = len(nonmortar.points), nonmortar.corners
    own = np.searchsorted(nonmortar.nodes, nodes)
    best, fallen, gives = np.full(len(nodes), np.inf), np.zeros(len(nodes)), sp.csr_array((len(nodes), n))
    for block, smooth in zip(mortar.blocks, mortar.smooth, strict=True):
        normals = nonmortar.nodal_normals[own]
        distance, weights, behind = _nearest(nonmortar.points[nodes], normals, block, smooth, reach, n)
        nearer = distance < best
        best, fallen = np.minimum(best, distance), np.where(nearer, behind, fallen)
        keep, take = sp.diags_array(np.where(nearer, 0.0, 1.0)), sp.diags_array(np.where(nearer, 1.0, 0.0))
        gives = sp.csr_array(keep @ gives + take @ weights)
    met = np.nonzero(np.isfinite(best))[0]
    if not len(met):
        raise InputError(
            f"no node of the nonmortar side meets the mortar side within {reach:.4g} along its normal; expected "
            "surfaces that face each other, or another 'search'",
            where=where,
        )
    areas = -nonmortar.nodal_normal_areas[own[met]]
    return point_coupling(nodes[met], areas, sp.csr_array((picked(nodes, n) - gives)[met]), fallen=fallen[met])


def node_pairs(
    nonmortar: Surface, mortar: Surface, *, share: float = 0.5, faces: bool = False
) -> tuple[Coupling | None, str]:
    """Node opposite node, where two linear sides match; otherwise None and why they do not, in words.

    Parameters
    ----------
    share : of the nonmortar side in the stiffness of both, see :mod:`signorini.interface.tilt`
    faces : whether faces have to be opposite faces too: where a quadrilateral is opposite two triangles, or triangles
        are cut along the other diagonal, uniform pressure does not pass from node to node
    """
    if not (nonmortar.linear and mortar.linear):
        return None, "quadratic faces have no pairs at their middle nodes; expected linear faces"
    partner, reason = match_nodes(nonmortar.points, nonmortar, mortar, np.arange(1, len(nonmortar.points) + 1))
    if reason:
        return None, reason
    nodes, n = nonmortar.nodes, len(nonmortar.points)
    if faces and not _same_faces(nonmortar, mortar, partner):
        return None, "nodes are opposite nodes, but not faces opposite faces; expected meshes that match"
    relative = sp.csr_array(picked(nodes, n) - picked(partner, n))
    opposite = mortar.nodal_normals[np.searchsorted(mortar.nodes, partner)]
    areas = areas_between(-nonmortar.nodal_normal_areas, nonmortar.nodal_normals, opposite, share)
    return point_coupling(nodes, areas, relative), ""


def _same_faces(nonmortar: Surface, mortar: Surface, partner: IntArray) -> bool:
    """Whether the faces of one side are those of the other with every node replaced by its partner."""
    place = np.zeros(len(nonmortar.points), np.int64)
    place[nonmortar.nodes] = partner
    for count in (3, 4):
        one = [place[block.faces] for block in nonmortar.blocks if block.nodes_a_face == count]
        other = [block.faces for block in mortar.blocks if block.nodes_a_face == count]
        if bool(one) != bool(other) or (one and not np.array_equal(_ordered(one), _ordered(other))):
            return False
    return True


def _ordered(faces: Sequence[IntArray]) -> IntArray:
    """Faces in an order, and with their nodes in one, that depends on which they are alone."""
    rows = np.sort(np.concatenate(faces), axis=1)
    return rows[np.lexsort(rows.T)]


def _nearest(
    points: Array, normals: Array, block: Block, smooth: Smooth, search: float, n: int
) -> tuple[Array, sp.csr_array, Array]:
    """Distance (p,) of points to the nearest face of a block along their normals, infinite where there is none, the
    weights (p, n) of its nodes, and how far it lies behind the surface that it stands for, (p,).
    """
    i, j = _near(points, block, search)
    places, distance = meet(points, normals, block.points, i, j)
    outward = block.outward(np.full((1, 2), 1.0 / 3.0))[:, 0]
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    facing = np.sum(normals[i] * outward[j], axis=1) < FACING
    there = np.nonzero(_within(block.nodes_a_face, places) & (np.abs(distance) <= search) & facing)[0]
    there = there[np.lexsort([np.abs(distance[there]), i[there]])]
    found, first = np.unique(i[there], return_index=True)
    chosen = there[first]
    result = np.full(len(points), np.inf)
    result[found] = np.abs(distance[chosen])
    values = shapes_at(block.nodes_a_face, places[chosen])
    rows = np.repeat(found, block.nodes_a_face)
    entries = (values.ravel(), (rows, block.faces[j[chosen]].ravel()))
    at = np.einsum("pa,pad->pd", values, block.points[j[chosen]])
    fallen = np.zeros(len(points))
    fallen[found] = rises(smooth, j[chosen], at[:, None], values[:, None], -normals[found])[:, 0]
    return result, sp.csr_array(entries, shape=(len(points), n)), fallen


def _near(points: Array, block: Block, search: float) -> tuple[IntArray, IntArray]:
    """Pairs of a point and a face that it may meet."""
    centres = block.points.mean(axis=1)
    radius = np.linalg.norm(block.points - centres[:, None], axis=2).max()
    return near(points, centres, radius, search)


def _within(count: int, places: Array) -> BoolArray:
    """Reference coordinates that lie on the face; NaN do not."""
    x, y = places.T
    if CORNERS[count] == 3:
        return np.asarray((x >= -_BESIDE) & (y >= -_BESIDE) & (x + y <= 1 + _BESIDE), dtype=np.bool_)
    return np.asarray((np.abs(x) <= 1 + _BESIDE) & (np.abs(y) <= 1 + _BESIDE), dtype=np.bool_)
