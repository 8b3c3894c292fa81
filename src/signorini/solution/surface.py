# SPDX-License-Identifier: BSD-3-Clause
"""The surface of a contact: its faces, or its lines in the plane, on the nodes that carry results."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.model.model import Model
from signorini.solution.results import OPEN, SLIP, STICK, ContactResult


def contact_faces(model: Model, result: ContactResult) -> tuple[IntArray, ...]:
    """Corners of the nonmortar faces as indices into the nodes of a contact, (m, 3 or 4), by kinds of faces."""
    order = np.argsort(result.node)
    found = []
    for given in model.mesh.facets(result.nonmortar):
        corners = given[:, : 3 if given.shape[1] in (3, 6) else 4]
        at = np.searchsorted(result.node, corners, sorter=order)
        index: IntArray = order[np.minimum(at, len(order) - 1)]
        found.append(index[(result.node[index] == corners).all(axis=1)])
    return tuple(found)


def arc_length(model: Model, result: ContactResult) -> Array:
    """(n,) Way along the nonmortar side of a plane or axisymmetric contact, undeformed, from one end along the tangent.

    Parts of a side that are not connected follow each other; NaN at nodes of no facet.
    """
    way, length = np.full(len(result.node), np.nan), 0.0
    tangents = (result.tangents[:, 0] if result.twists else result.tangents)[:, : model.dimension]
    places = model.mesh.places_of(result.node)
    for chain, along in _chains(*_lines(model, result)):
        turned = np.vdot(np.diff(places[chain], axis=0), tangents[chain[1:]]) < 0.0
        way[chain] = length + (along[-1] - along if turned else along)
        length += along[-1]
    return way


def contact_lines(model: Model, result: ContactResult) -> IntArray:
    """(m, 2) Lines between neighbours on the nonmortar side of a contact of the plane, as indices into its nodes."""
    return _lines(model, result)[0]


def _lines(model: Model, result: ContactResult) -> tuple[IntArray, Array]:
    """Lines (m, 2) as of `contact_lines`, and how long they are, over the nodes between their ends, too."""
    lines, lengths = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    order = np.argsort(result.node)
    facets = model.mesh.facets(result.nonmortar) if result.nonmortar in model.mesh.boundaries else ()
    for given in facets:
        at = order[np.minimum(np.searchsorted(result.node, given, sorter=order), len(order) - 1)]
        known = result.node[at] == given
        parts = [[0, 1]] if given.shape[1] == 2 else [[0, 2], [2, 1]]
        places = model.mesh.places_of(given.ravel()).reshape(*given.shape, -1)
        length = [np.linalg.norm(np.diff(places[:, part], axis=1)[:, 0], axis=1) for part in parts]
        if len(parts) == 2:  # whole facets where the nodes between their corners carry no pairs
            whole = known[:, :2].all(axis=1) & ~known[:, 2]
            lines.append(at[whole, :2])
            lengths.append((length[0] + length[1])[whole])
        for part, own in zip(parts, length, strict=True):
            both = known[:, part].all(axis=1)
            lines.append(at[both][:, part])
            lengths.append(own[both])
    return np.concatenate(lines), np.concatenate(lengths)


def _chains(lines: IntArray, lengths: Array) -> Iterator[tuple[IntArray, Array]]:
    """Neighbours after neighbours (k,) of every connected part of lines (m, 2), and the way (k,) to each."""
    beside: dict[int, dict[int, float]] = {}
    for (one, two), length in zip(lines.tolist(), lengths.tolist(), strict=True):
        beside.setdefault(one, {})[two] = length
        beside.setdefault(two, {})[one] = length
    ends = [node for node, others in beside.items() if len(others) == 1]
    left = dict.fromkeys([*ends, *beside])
    while left:
        here: int | None = next(iter(left))
        chain, way = [], [0.0]
        while here is not None:
            del left[here]
            chain.append(here)
            beyond = next((node for node in beside[here] if node in left), None)
            if beyond is not None:
                way.append(way[-1] + beside[here][beyond])
            here = beyond
        yield np.array(chain), np.array(way)


def status_codes(result: ContactResult) -> IntArray:
    """0 open, 1 stick, 2 slip, (n,)."""
    codes: IntArray = np.select([result.status == name for name in (OPEN, STICK, SLIP)], [0, 1, 2])
    return codes
