# SPDX-License-Identifier: BSD-3-Clause
"""The pairs of one contact: which side carries them, how they see the other side, how far apart they are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy.sparse as sp
from scipy.spatial import KDTree

from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError, Where
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.facet_block import FacetBlock
from signorini.fem.measure import contact_measure, facet_areas
from signorini.fem.obstacles import Placed, placed
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.fem.varying import at_nodes
from signorini.interface.corners import corner_coupling
from signorini.interface.coupling import Coupling, FacetGaps, geometric_gap, joined_gaps, point_coupling
from signorini.interface.facing import in_one_place, search_distance
from signorini.interface.frames import in_symmetry_planes, symmetric_partners
from signorini.interface.gaps import initial_gaps, normal_gap, refuse_deep_overlap, resolved
from signorini.interface.matching import facing_cells, match_nodes
from signorini.interface.mortar import mortar_coupling
from signorini.interface.points import node_pairs, node_to_facet
from signorini.model.contact import Contact
from signorini.model.model import Model
from signorini.model.obstacle import Obstacle, Plane
from signorini.model.triangulated import Surface
from signorini.model.varying import Varying
from signorini.sparse_rows import selection

_FINER_RATIO = 0.8  # of the mortar side's mean facet length


@dataclass(frozen=True, kw_only=True)
class Sides:
    """How a contact was paired.

    Attributes
    ----------
    nonmortar, mortar : the sides as they were taken; an obstacle in words
    coupling : "nodes", "mortar", "node-to-segment" or "obstacle"
    finer : whether the nonmortar side has clearly the shorter facets: its pressures can oscillate
    """

    nonmortar: str
    mortar: str
    coupling: str
    finer: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class Pairs:
    """The pairs of one contact.

    Attributes
    ----------
    own : (m,) nodes of the nonmortar side
    coupling : with the normals in the planes of symmetry
    gap : (k,)
    given : (k,) of it what is given, not of the geometry
    sliding : as ``coupling.forces`` for the tangential part; it differs on planes of symmetry in 2D
    mirrored : (k, d) in space whether a pair lies on a plane of symmetry across a coordinate axis
    sides : how they were found
    obstacle : number of the moving obstacle that is the other side, otherwise -1
    """

    own: IntArray
    coupling: Coupling
    gap: Array
    given: Array
    sliding: tuple[sp.csr_array, ...]
    mirrored: BoolArray
    sides: Sides
    obstacle: int = -1


def make_pairs(space: Space, model: Model, constraints: Constraints, i: int) -> Pairs:
    """Pair the surfaces of contact ``i`` of a model.

    Parameters
    ----------
    space, model : of the bodies and their contacts
    constraints : what supports hold: planes of symmetry
    i : number of the contact

    Raises
    ------
    InputError
        If the sides share nodes, do not face each other, overlap by more than an element, or should match and do not.
    """
    contact, where = model.contacts[i], ("contact", i)
    side = boundary(space, contact.nonmortar, (*where, "nonmortar"))
    moving = {obstacle.name: j for j, obstacle in enumerate(model.obstacles)}
    if isinstance(contact.mortar, Obstacle):
        key = type(contact.mortar).__name__.lower()
        pairs = _on_obstacle(space, model, side, contact, contact.mortar, (*where, key))
    elif contact.mortar in moving:
        j = moving[contact.mortar]
        shape = placed(space, model, j) if contact.slides else model.obstacles[j].shape
        pairs = _on_obstacle(space, model, side, contact, shape, (*where, "mortar"))
        pairs = replace(pairs, obstacle=j, sides=replace(pairs.sides, mortar=contact.mortar))
    else:
        mortar = boundary(space, contact.mortar, (*where, "mortar"))
        names = (contact.nonmortar, contact.mortar)
        if contact.side == "coarser" and side.lengths.mean() < (1.0 - 1e-9) * mortar.lengths.mean():
            side, mortar, names = mortar, side, names[::-1]
        pairs = _on_side(space, model, constraints, side, mortar, contact, names, where)
    refuse_deep_overlap(pairs.gap, space.mesh.labels[pairs.coupling.nodes], contact, float(side.lengths.max()), where)
    return pairs


def _on_obstacle(
    space: Space, model: Model, side: Boundary, contact: Contact, obstacle: Obstacle | Placed, where: Where
) -> Pairs:
    """Nodes against a rigid obstacle, along its own normals; of quadratic facets weighted means at their corners."""
    points = space.mesh.points
    distance, normals = obstacle.nearest(points[side.nodes])
    if (np.sum(side.nodal_normals * normals, axis=1) >= 0).all():
        raise InputError(f"'{contact.nonmortar}' faces away from {_faced_away(obstacle)}", where=where)
    areas = [facet_areas(model, block) for block in side.blocks]
    if side.quadratic:
        there = [obstacle.nearest(b.at.reshape(-1, b.dimension))[1].reshape(b.at.shape) for b in side.blocks]
        coupling = corner_coupling(side, areas, there, len(points))
        on_facets = [distance[np.searchsorted(side.nodes, block.facets)] for block in side.blocks]
        coupling = replace(
            coupling, facets=joined_gaps([_nodal_gaps(*own) for own in zip(side.blocks, on_facets, strict=True)])
        )
    else:
        # the trapezoidal rule, except that a node on the axis has its share of the circle around it, pi h^2 / 3
        coupling = point_coupling(side.nodes, side.nodal(areas)[:, None] * normals, selection(side.nodes, len(points)))
    _refuse_no_normal(space, coupling, where)
    seen = partial(_seen, space, side, coupling, normals, where[:2])
    gap = resolved(normal_gap(coupling, side.nodes, normals, distance), coupling, seen(1.0, ""))
    gap, given = initial_gaps(gap, contact, seen, farthest=float(np.abs(points).max()))
    return Pairs(
        own=side.nodes,
        coupling=coupling,
        gap=gap,
        given=given,
        sliding=coupling.forces,
        mirrored=np.zeros(coupling.normals.shape, bool),
        sides=Sides(nonmortar=contact.nonmortar, mortar=str(obstacle), coupling="obstacle"),
    )


def _seen(
    space: Space, side: Boundary, coupling: Coupling, normals: Array, where: Where, given: Varying, key: str
) -> Array:
    """What pairs see of a gap that a key of the contact gives along the normals of the nonmortar side, (n,)."""
    if isinstance(given, float | int):
        if given == 0.0:
            return np.zeros(len(coupling.nodes))
        return given * normal_gap(coupling, side.nodes, normals, np.ones(len(side.nodes)))
    return normal_gap(coupling, side.nodes, normals, at_nodes(given, space, side.nodes, (*where, key), side))


def _nodal_gaps(block: FacetBlock, distance: Array) -> FacetGaps:
    """Gaps of facets that are known at their nodes, (m, k)."""
    corners = block.corners
    return FacetGaps(
        corners=block.facets[:, :corners],
        ends=distance[:, :corners],
        low=distance.min(axis=1),
        high=distance.max(axis=1),
    )


def _faced_away(obstacle: Obstacle | Placed) -> str:
    """What a side faces away from, and what is expected."""
    if isinstance(obstacle, Plane):
        return f"the plane; its normal {obstacle.normal} must point from the obstacle towards the body"
    words = f"{obstacle}, or is behind it; expected the obstacle outside the body"
    if isinstance(obstacle, Surface):
        words += ", its triangles counter-clockwise seen from there ('flip' turns what is read)"
    return words


def _on_side(
    space: Space,
    model: Model,
    constraints: Constraints,
    side: Boundary,
    mortar: Boundary,
    contact: Contact,
    names: tuple[str, str],
    where: Where,
) -> Pairs:
    """Two meshed sides."""
    points = space.mesh.points
    shared = np.intersect1d(side.nodes, mortar.nodes)
    if len(shared):
        raise InputError(
            f"both sides hold node {space.mesh.labels[shared[0]]}; bodies that touch need nodes of their own",
            where=where,
        )
    if contact.tied and in_one_place(side, mortar):
        mortar = mortar.turned()
    coupling, how = _couple(space, model, side, mortar, contact, where)
    _refuse_no_normal(space, coupling, where)
    whole, coupling = coupling, replace(coupling, normal_areas=in_symmetry_planes(space, constraints, coupling))
    plane = side.dimension == 2
    seen = partial(_seen, space, side, coupling, -side.nodal_normals, where)
    gap = geometric_gap(coupling, points)
    if not contact.slides:  # where the nearest points are changes as the sides slide
        gap = resolved(gap, whole, seen(1.0, ""))
    partner = symmetric_partners(space, constraints, coupling.nodes, coupling.normals, mortar.nodes)
    coupling = replace(coupling, forces=_without_removed(whole, coupling.normal_areas, partner))
    gap, given = initial_gaps(gap, contact, seen, farthest=float(np.abs(points).max()))
    pairs = Pairs(
        own=side.nodes,
        coupling=coupling,
        gap=gap,
        given=given,
        sliding=_mirrored(coupling, partner.max(axis=1)) if plane else coupling.forces,
        mirrored=(partner >= 0) & (not plane),
        sides=Sides(
            nonmortar=names[0],
            mortar=names[1],
            coupling=how,
            finer=how == "mortar" and float(side.lengths.mean()) < _FINER_RATIO * float(mortar.lengths.mean()),
        ),
    )
    if not contact.slides:
        return pairs
    return _of_all_nodes(pairs, side, points, search_distance(side, mortar, contact.search))


def _of_all_nodes(pairs: Pairs, side: Boundary, points: Array, reach: float) -> Pairs:
    """Pairs of all nodes that ever carry one, so that their number stays as sides slide.

    What has nothing opposite has a pair that sees nothing, as far apart as sides may be opposite each other; a gap that
    is given it has from the nearest pair that has something.

    Parameters
    ----------
    pairs : of the nodes that something is opposite
    side : the nonmortar side
    points : (nodes, d) of the mesh
    reach : how far apart sides may be and still be opposite each other, length
    """
    nodes = side.corner_nodes
    there = np.searchsorted(nodes, pairs.coupling.nodes)
    areas = -side.nodal((block.outward for block in side.blocks), corners=True)[np.searchsorted(side.nodes, nodes)]
    areas[there] = pairs.coupling.normal_areas
    gap, mirrored = np.full(len(nodes), reach), np.zeros(areas.shape, bool)
    gap[there], mirrored[there] = pairs.gap, pairs.mirrored
    given = np.zeros(len(nodes))
    if pairs.given.any():
        given = pairs.given[KDTree(points[nodes[there]]).query(points[nodes])[1]]
    rows = selection(there, len(nodes)).T
    forces, sliding = (tuple(sp.csr_array(rows @ part) for part in of) for of in (pairs.coupling.forces, pairs.sliding))
    coupling = Coupling(nodes=nodes, normal_areas=areas, forces=forces)
    return replace(pairs, coupling=coupling, gap=gap, given=given, sliding=sliding, mirrored=mirrored)


def _couple(
    space: Space, model: Model, side: Boundary, mortar: Boundary, contact: Contact, where: Where
) -> tuple[Coupling, str]:
    """The coupling of two meshed sides, and its name."""
    _refuse_no_area(space, side, mortar, where)
    share = _share(model, side, mortar)
    linear = contact.coupling == "auto" and not (side.quadratic or mortar.quadratic or contact.slides)
    if contact.coupling == "nodes" or linear:
        faces = contact.coupling == "auto" and side.dimension == 3
        partner, reason = match_nodes(side, mortar, space.mesh.labels, faces=faces)
        if not reason:
            return node_pairs(side, mortar, partner, _nodal_areas(model, side, mortar)[1], share), "nodes"
        if contact.coupling == "nodes":
            raise InputError(reason, where=where)
    if contact.coupling == "node-to-segment":
        nodes, areas = _nodal_areas(model, side, mortar)
        return node_to_facet(side, mortar, nodes, areas, search=contact.search, where=where), "node-to-segment"
    measure = partial(contact_measure, model)
    return mortar_coupling(side, mortar, share=share, search=contact.search, measure=measure, where=where), "mortar"


def _nodal_areas(model: Model, side: Boundary, mortar: Boundary) -> tuple[IntArray, Array]:
    """Nodes that can bear forces, all of edges and the corners of faces, and normals into the body times area there."""
    if side.dimension == 2:
        (block,) = side.blocks
        thickness = contact_measure(model, block.at, block.cells, facing_cells(side, mortar))
        return side.nodes, -side.nodal([block.outward * thickness[..., None]])
    nodes = side.corner_nodes
    areas = side.nodal((block.outward for block in side.blocks), corners=True)
    return nodes, -areas[np.searchsorted(side.nodes, nodes)]


def _share(model: Model, *sides: Boundary) -> float:
    """Of the first of two sides in the stiffness of both, 0 to 1: of the moduli of the cells there."""
    moduli = np.array([body.material.smallest_modulus for body in model.bodies])[model.body_of_cells()]
    first, second = (float(moduli[side.cells].mean()) for side in sides)
    return first / (first + second)


def _refuse_no_area(space: Space, side: Boundary, mortar: Boundary, where: Where) -> None:
    """A face of a collapsed cell may have no area: it has no normal either."""
    for block in (*side.blocks, *mortar.blocks):
        flat = np.flatnonzero(np.linalg.norm(block.outward.sum(axis=1), axis=1) <= 0.0)
        if len(flat):
            numbers = space.mesh.labels[block.facets[flat[0]]].tolist()
            raise InputError(f"has a face without area, with nodes {numbers}", where=where)


def _refuse_no_normal(space: Space, coupling: Coupling, where: Where) -> None:
    lost = np.flatnonzero(~(coupling.area > 0.0))
    if len(lost):
        number = space.mesh.labels[coupling.nodes[lost[0]]]
        raise InputError(f"node {number} has no normal: a face there has no area", where=where)


def _without_removed(seen: Coupling, kept: Array, partner: IntArray) -> tuple[sp.csr_array, ...]:
    """Forces without what the mirror image takes away, left to the two nodes on the plane, where supports bear it."""
    count = seen.forces[0].shape[1]
    parts = []
    for i, force in enumerate(seen.forces):
        there = np.nonzero((partner[:, i] >= 0) & (seen.normal_areas[:, i] != kept[:, i]))[0]
        if not len(there):
            parts.append(force)
            continue
        across = selection(seen.nodes[there], count) - selection(partner[there, i], count)
        taken = sp.diags_array((kept - seen.normal_areas)[there, i]) @ across
        parts.append(sp.csr_array(force + selection(there, len(partner)).T @ taken))
    return tuple(parts)


def _mirrored(coupling: Coupling, partner: IntArray) -> tuple[sp.csr_array, ...]:
    """The weights of the sliding: node against node on planes of symmetry."""
    there = np.nonzero(partner >= 0)[0]
    if not len(there):
        return coupling.forces
    count, rows = coupling.forces[0].shape[1], selection(there, len(partner)).T
    pairs = selection(coupling.nodes[there], count) - selection(partner[there], count)
    keep = sp.diags_array(np.where(partner >= 0, 0.0, 1.0))
    return tuple(
        sp.csr_array(keep @ force + rows @ (sp.diags_array(coupling.normal_areas[there, i]) @ pairs))
        for i, force in enumerate(coupling.forces)
    )
