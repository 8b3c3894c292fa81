# SPDX-License-Identifier: BSD-3-Clause
"""What a reader should know of a step: how it was followed, and what of it the model does not bear out.

One increment with friction, contacts that stay open, patches of a few pairs, overlaps that nobody gave, bodies that
strain or turn far, contacts that slip far.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from scipy.sparse.csgraph import connected_components

from signorini.arrays import Array, BoolArray, IntArray, distinct, extent
from signorini.engine.examine import Examined
from signorini.engine.prepare import Prepared
from signorini.engine.step_parts import FollowedPart
from signorini.engine.turning import turning_notes
from signorini.fem.locking import modes_in_flow
from signorini.fem.rigid import ConnectedBody
from signorini.law.states import OPEN
from signorini.meshing.facets import facet_corners
from signorini.solution.state import State
from signorini.sparse_rows import of_entries

ONE_INCREMENT = "one increment: assumes that the final state was reached from zero slip"
"""What a step with friction says when it was solved in one increment (METHOD 5)."""

GROWN = "the contact grew under friction: in one increment tractions can be off by tens of percent, take more"
"""What it says further where pairs closed that were open before."""

_PAIRS_ACROSS = 4  # closed pairs: with fewer the pressure is a matter of the mesh
_OVERLAP_TOL = 1e-9  # of the size of the model: less is no overlap
_STRAINED = 0.25  # of the size of a body
_SLID = 0.1  # of the size of what touches
_DEEP = 0.1  # of the facets beside a node: beyond it the bodies are not those that were meshed
_AT_ONCE = 1 << 16  # nodes whose displacements are asked for together: what they take does not grow with the mesh
_FLOWED = 0.05  # equivalent plastic strain: beyond it small strains and those of true-stress tables differ visibly


def step_notes(prepared: Prepared, followed: FollowedPart) -> Iterator[str]:
    """All notes on a step that was followed."""
    before, state = followed.before, followed.after
    yield from followed.notes
    yield from _friction_notes(prepared, followed)
    yield from _facet_notes(prepared)
    yield from finer_notes(prepared)
    yield from _open_notes(prepared, followed)
    if not before.forces.any() and not before.nodal[0].any():
        yield from overlap_notes(prepared)
    yield from patch_notes(prepared, state)
    yield from large_notes(prepared, state)
    if prepared.model.slides:
        yield from turning_notes(prepared, state)
    yield from flow_notes(prepared, state)
    yield from wear_notes(prepared, state)


def _friction_notes(prepared: Prepared, followed: FollowedPart) -> Iterator[str]:
    """Friction in one increment, which knows nothing of the way to its end."""
    rubbing = prepared.interface.friction.bounded
    if followed.path != "single" or not rubbing.any():
        return
    yield ONE_INCREMENT
    # what has happened before the loads of the step is no growth
    begun = [shot.state for shot in followed.snapshots if shot.what in ("change", "approach")]
    gap = (begun[-1] if begun else followed.before).gap
    if (rubbing & (followed.after.status != OPEN) & (gap > 1e-9 * prepared.scale.length)).any():
        yield GROWN


def _facet_notes(prepared: Prepared) -> Iterator[str]:
    """Contacts whose friction cone is not the exact one."""
    for contact in prepared.model.contacts:
        if contact.facets:
            yield (
                f"contact '{contact.label}': solved and certified on a cone of {contact.facets} facets, not on the "
                "exact one"
            )


def finer_notes(examined: Examined) -> Iterator[str]:
    """Contacts whose nonmortar side is the finer one."""
    for contact, sides in zip(examined.model.contacts, examined.interface.sides, strict=True):
        if sides.finer and not contact.tied:
            yield (
                f"contact '{contact.label}': the nonmortar side is the finer one, its pressures can oscillate; name "
                "the sides the other way round, or take side = 'coarser'"
            )


def _open_notes(prepared: Prepared, followed: FollowedPart) -> Iterator[str]:
    """Contacts that nothing brings together: a wrong place, or a wrong direction of a load."""
    interface, gap = prepared.interface, followed.after.gap
    states = (followed.before, *(shot.state for shot in followed.snapshots))
    for i, contact in enumerate(prepared.model.contacts):
        own = interface.contact == i
        bonded = contact.cohesion is not None  # those that were torn off were together
        if not bonded and all((state.status[own] == OPEN).all() for state in states):
            yield (
                f"contact '{contact.label}' is open everywhere: its sides are {gap[own].min():.4g} apart, "
                f"{interface.gap[own].min():.4g} to begin with"
            )


def overlap_notes(examined: Examined) -> Iterator[str]:
    """Contacts whose sides overlap to begin with, as they are meshed."""
    interface, model = examined.interface, examined.model
    size = float(model.mesh.extent.max())
    for i, contact in enumerate(model.contacts):
        gap = interface.gap[interface.contact == i]
        if gap.min(initial=0.0) < -_OVERLAP_TOL * size and contact.interference == 0.0 and contact.gap == "geometry":
            yield f"contact '{contact.label}' overlaps by up to {-gap.min():.4g} at the start; it will be pressed"


def patch_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """Contacts that end between open pairs and hold fewer than four closed ones across.

    In the plane they are counted, twice where the patch begins at an end of its side, an axis or a plane of symmetry;
    in space layer by layer from open ones inwards. What ends where a side does has its edges there, whatever the mesh.
    """
    interface = prepared.interface
    for i, contact in enumerate(prepared.model.contacts):
        own = np.flatnonzero(interface.contact == i)
        if contact.tied or contact.cohesion is not None or not len(own):
            continue
        closed = state.status[own] != OPEN
        few = _fewest(prepared, i, interface.node[own], closed) if closed.any() and not closed.all() else _PAIRS_ACROSS
        if few < _PAIRS_ACROSS:
            yield (
                f"contact '{contact.label}' touches with {few} pair{'s' if few > 1 else ''} across, between open ones: "
                "too few to tell its size and largest pressure; a finer mesh there would, if units and loads are right"
            )


def _fewest(prepared: Prepared, i: int, nodes: IntArray, closed: BoolArray) -> int:
    """Pairs across the smallest patch of a contact that ends between open pairs; four where there are enough."""
    space = prepared.space
    named = space.mesh.facets(prepared.interface.sides[i].nonmortar)  # of cells, which are many, nothing is asked
    place = np.full(space.mesh.number_of_nodes, -1)
    place[nodes] = np.arange(len(nodes))
    facets = [place[given[:, : facet_corners(space.dimension, given.shape[1])]] for given in named]
    one, two = np.concatenate([np.stack([at, np.roll(at, -1, axis=1)]).reshape(2, -1) for at in facets], axis=1)
    both = (one >= 0) & (two >= 0)
    one, two = np.concatenate([one[both], two[both]]), np.concatenate([two[both], one[both]])
    within = closed[one] & closed[two]
    edges = distinct(one[within] * len(nodes) + two[within])
    graph = of_entries(np.ones(len(edges)), *np.divmod(edges, len(nodes)), (len(nodes), len(nodes)))
    _, patch = connected_components(graph, connection="strong")  # edges lead both ways: nothing is transposed
    ending = closed[one] & ~closed[two]
    ends = patch[distinct(one[ending] * len(nodes) + two[ending]) // len(nodes)]
    ended = distinct(ends)
    if space.dimension == 3:
        return int(_layers(facets, one, two, closed, patch)[ended].min(initial=_PAIRS_ACROSS))
    size = np.bincount(patch[closed], minlength=len(nodes))[ended]
    half = np.bincount(ends, minlength=len(nodes))[ended] == 1
    return int(np.where(half, 2 * size - 1, size).min(initial=_PAIRS_ACROSS))


def _layers(facets: list[IntArray], one: IntArray, two: IntArray, closed: BoolArray, patch: IntArray) -> IntArray:
    """(n,) Pairs across every patch in space, four where there are more: two a layer, one where the last is a line.

    Parameters
    ----------
    facets : pairs at the corners of facets, -1 where there is none
    one, two : pairs at the ends of their edges, in both directions
    closed, patch : (n,) whether pairs are closed, and their patch
    """
    across = np.zeros(len(closed), dtype=np.int64)
    inside = closed.copy()
    for layer in range(_PAIRS_ACROSS // 2 + 1):
        across[patch[inside]] = 2 * layer + 1
        for at in facets:
            filled = ((at >= 0) & inside[at]).all(axis=1)
            across[patch[at[filled, 0]]] = 2 * layer + 2
        outside = ~inside
        inside = inside.copy()
        inside[one[outside[two]]] = False
    return np.minimum(across, _PAIRS_ACROSS)


def _surely_small(prepared: Prepared, state: State, bodies: Sequence[ConnectedBody]) -> bool:
    """Whether no body can strain or turn that much, because no displacement is that large."""
    if prepared.turns or prepared.model.twists:
        return False
    across = 2.0 * np.abs(state.nodal[0]).max(initial=0.0) * np.sqrt(prepared.model.components)
    return bool(across <= 2.0 * _STRAINED * min((part.size for part in bodies), default=np.inf))


def _spread(prepared: Prepared, u: Any, nodes: IntArray) -> Array:
    """(c,) How far apart displacements (dofs,) move nodes, length, without the turn of a body around the axis.

    Some nodes at a time: on ranks nobody has the displacements of all.
    """
    space, chunks = prepared.space, [nodes[i : i + _AT_ONCE] for i in range(0, len(nodes), _AT_ONCE)]

    def around(chunk: IntArray) -> Array:
        return space.mesh.places_of(chunk)[:, 0]

    turn = 0.0
    if prepared.model.twists:
        sums = [(u[space.dofs(chunk)[:, 2]] @ around(chunk), around(chunk) @ around(chunk)) for chunk in chunks]
        along, size = np.sum(sums, axis=0)
        turn = float(along / max(size, 1e-300))
    ends = []
    for chunk in chunks:
        moved = u[space.dofs(chunk)]
        if turn:
            moved[:, 2] -= turn * around(chunk)
        ends += [moved.min(axis=0), moved.max(axis=0)]
    return extent(np.array(ends))


def large_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """Bodies that strain or turn by a quarter of their size, contacts that slip by a tenth of theirs.

    Around the axis bodies of revolution turn and slip by any angle: they are the same all around.
    """
    bodies = [part for part in prepared.parts if part.kind == ConnectedBody.kind]
    if not _surely_small(prepared, state, bodies):
        u = prepared.frames.elastic(state.displacement) if prepared.turns else state.nodal[0]
        for part in bodies:
            change = float(np.linalg.norm(_spread(prepared, u, part.nodes))) / (2.0 * part.size)
            if change > _STRAINED:
                yield (
                    f"{part.label} strains or turns by {change:.0%} of its size: equilibrium is that of the undeformed "
                    "bodies, which holds for small displacements"
                )
    interface = prepared.interface
    along = state.slip[: prepared.model.dimension - 1]
    slip = np.where(state.status == OPEN, 0.0, np.linalg.norm(along, axis=0))
    for i, contact in enumerate(prepared.model.contacts):
        own = (interface.contact == i) & (state.status != OPEN)
        if not own.any():
            continue
        across = float(np.linalg.norm(extent(prepared.space.mesh.places_of(interface.node[own]))))
        if slip[own].max() > _SLID * across > 0.0 and not contact.slides:
            yield (
                f"contact '{contact.label}' slips by up to {slip[own].max():.4g}, and what touches is {across:.4g} "
                "across: its sides are opposite each other as they were to begin with, which holds for small slips"
            )


def flow_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """Bodies with plastic strains of more than a twentieth somewhere, and those whose cells flow too stiffly."""
    bodies, plastic = prepared.yielding, state.plastic
    if bodies is None or plastic is None:
        return
    stiff = modes_in_flow(prepared.model)
    for i in np.unique(bodies.body):
        name, largest = prepared.model.bodies[i].name, float(plastic.equivalent[bodies.body == i].max())
        if largest > _FLOWED:
            yield (
                f"'{name}' has equivalent plastic strains of up to {largest:.0%}: its law is one of small strains, "
                "which holds to about 5%"
            )
        if largest > 0.0 and name in stiff:
            yield stiff[name]


def wear_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """Contacts whose sides are worn: what becomes of it, and whether that is much beside the facets there."""
    sides, wear = prepared.wearing, state.wear
    if sides is None or wear is None:
        return
    for i in np.unique(sides.contact):
        own = sides.contact == i
        deepest = float(wear.beyond[own].max(initial=0.0))
        if wear.depth[own].max(initial=0.0) == 0.0:
            continue
        words = "debris neither carries nor rubs, what is worn is gone"
        if wear.taken[own].any():
            words += f"; its mesh has moved with that, and bodies were condensed again, {wear.moves} times so far"
        width = float(np.median(sides.area[own & (sides.area > 0.0)])) / prepared.model.thickness
        if prepared.space.dimension == 2 and not prepared.model.axisymmetric and deepest > _DEEP * width:
            words += (
                f"; it is up to {deepest:.4g} deep, {deepest / width:.0%} of the facets there: gaps know it, bodies "
                "keep the shape and the stiffness of their meshes"
            )
        yield f"contact '{prepared.model.contacts[i].label}' wears: {words}"
