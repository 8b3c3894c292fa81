# SPDX-License-Identifier: BSD-3-Clause
"""General contact (``*CONTACT``): pairs of surfaces that lie opposite each other, found by closeness."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from signorini.arrays import Array, BoolArray, IntArray, distinct
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.grid import DeckGrid
from signorini.deck.inp.interactions import Interaction
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.surfaces import FACES, DeckSurface
from signorini.errors import one_of
from signorini.model.mesh import CORNERS

_OPPOSITE = -0.5  # cosine of the angle between the normals of faces that lie opposite each other, at most
_AHEAD = 0.5  # cosine of the angle between a face's normal and the way to the other, at least, where they are not close
_REACH = 0.5  # of the size of the smaller part: faces further apart than that are not looked for
_NEIGHBOURS = 24  # nearest faces of other parts that are looked at for each face


@dataclass(frozen=True, kw_only=True, eq=False)
class FacingPair:
    """Surfaces of two parts that lie opposite each other.

    Attributes
    ----------
    slave, master : the one of the larger faces comes first, on which pressures do not oscillate
    law : of their contact, None for contact without friction
    """

    slave: DeckSurface
    master: DeckSurface
    law: Interaction | None


@dataclass(frozen=True, kw_only=True, eq=False)
class _Outside:
    """Faces of a model that no other face covers.

    Attributes
    ----------
    keys : (n,) of the faces
    centre, normal : (n, d) of each, the normal pointing outwards
    size : (n,) length of each
    part : (n,) the number of the part that each belongs to: parts have no node in common
    """

    keys: IntArray
    centre: Array
    normal: Array
    size: Array
    part: IntArray


def find_facing(
    opening: Card, cards: Sequence[Card], known: Known, taken: Sequence[tuple[IntArray, IntArray]]
) -> list[FacingPair]:
    """Pairs of a deck with ``*CONTACT``; parts are what has no node in common.

    Parameters
    ----------
    opening : the ``*CONTACT``
    cards : outside the steps
    known : surfaces and laws of contact
    taken : keys of the faces of both sides of every contact pair and tie, which stay as they are

    Raises
    ------
    DeckError
        If nothing lies opposite anything else, and nothing was taken before.
    """
    opening.refuse_unknown((), ("OP",))
    included, excluded = _included(cards, known), _sides(cards, "CONTACT EXCLUSIONS", known)
    outside = _outside(known)
    first, second = _opposite(outside)
    a, b = outside.keys[first], outside.keys[second]
    wanted = _between(a, b, included) if included else np.ones(len(a), bool)
    wanted &= ~_between(a, b, [*excluded, *taken])
    first, second, a, b = first[wanted], second[wanted], a[wanted], b[wanted]
    if not len(first) and taken:
        return []  # all that could touch does so already
    if not len(first):
        raise opening.error("finds no faces of two parts that lie opposite each other; expected some, or *CONTACT PAIR")
    law, laws = np.full(len(first), -1), list(known.interactions)
    for sides, name in _assigned(cards, known):
        law[_between(a, b, [sides])] = laws.index(name)
    found = []
    for p, q, k in np.unique(np.column_stack([outside.part[first], outside.part[second], law]), axis=0).tolist():
        own = (outside.part[first] == p) & (outside.part[second] == q) & (law == k)
        faces = [distinct(first[own]), distinct(second[own])]
        faces.sort(key=lambda side: -float(outside.size[side].mean()))
        names = [_name(outside.keys[side], known) for side in faces]
        slave = _surface(outside.keys[faces[0]], f"{names[0]} facing {names[1]}", known, opening)
        master = _surface(outside.keys[faces[1]], f"{names[1]} facing {names[0]}", known, opening)
        found.append(FacingPair(slave=slave, master=master, law=known.interactions[laws[k]] if k >= 0 else None))
    return found


def _included(cards: Sequence[Card], known: Known) -> list[tuple[IntArray, IntArray]]:
    """Faces of both sides of every inclusion; none if all that lies outside is included."""
    for card in of_keyword(cards, "CONTACT INCLUSIONS"):
        card.refuse_unknown(("ALL EXTERIOR",))
        if "ALL EXTERIOR" in card.parameters or any(not any(row.fields) for row in card.rows()):
            return []
    return _sides(cards, "CONTACT INCLUSIONS", known)


def _sides(cards: Sequence[Card], keyword: str, known: Known) -> list[tuple[IntArray, IntArray]]:
    """Faces of both surfaces in every data line; where one is left out, all of the model."""
    return [sides for card in of_keyword(cards, keyword) for sides, _ in _rows(card, known)]


def _assigned(cards: Sequence[Card], known: Known) -> Iterator[tuple[tuple[IntArray, IntArray], str]]:
    """Faces of both surfaces in every data line of the assignments, and the name of their law in capitals."""
    for card in of_keyword(cards, "CONTACT PROPERTY ASSIGNMENT"):
        card.refuse_unknown(())
        for sides, (row, name) in _rows(card, known):
            if name.upper() not in known.interactions:
                names = [law.name for law in known.interactions.values()]
                raise card.at(row).error(one_of(name, names, "surface interaction"))
            yield sides, name.upper()


def _rows(card: Card, known: Known) -> Iterator[tuple[tuple[IntArray, IntArray], tuple[Row, str]]]:
    for row in card.rows():
        fields = [*row.fields, "", "", ""]
        pair = [known.faces.all_outer() if not word else known.surfaces.find(word, row).keys for word in fields[:2]]
        yield (pair[0], pair[1]), (row, fields[2])


def _between(a: IntArray, b: IntArray, sides: Sequence[tuple[IntArray, IntArray]]) -> BoolArray:
    """Which of the faces ``a`` and ``b``, opposite each other, are on two sides of one another, whichever way."""
    found = np.zeros(len(a), bool)
    for one, other in sides:
        found |= (np.isin(a, one) & np.isin(b, other)) | (np.isin(a, other) & np.isin(b, one))
    return found


def _outside(known: Known) -> _Outside:
    """The outer faces of all parts."""
    grid, faces = known.grid, known.faces
    keys = faces.all_outer()
    points = grid.points[:, : grid.dimension]
    corners = faces.ends[keys][:, :4]
    triangles = np.isin((faces.ends[keys] >= 0).sum(axis=1), (3, 6))  # of three corners, and three middles
    corners[triangles, 3:] = -1
    there = corners >= 0
    at = points[corners]
    centre = np.where(there[..., None], at, 0.0).sum(axis=1) / there.sum(axis=1)[:, None]
    along = at[:, 1] - at[:, 0]
    if grid.dimension == 2:
        normal = np.column_stack([along[:, 1], -along[:, 0]])
    else:
        normal = np.cross(along, at[:, 2] - at[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    middle, part = _cells(grid)
    inwards = np.einsum("ij,ij->i", normal, centre - middle[keys // FACES]) < 0.0
    normal[inwards] *= -1.0
    size = np.linalg.norm(np.where(there[..., None], at - centre[:, None], 0.0), axis=2).max(axis=1)
    return _Outside(keys=keys, centre=centre, normal=normal, size=2.0 * size, part=part[keys // FACES])


def _cells(grid: DeckGrid) -> tuple[Array, IntArray]:
    """Middle (elements, d) of every element, and the number of its part (elements,)."""
    count, n = len(grid.elements.labels), len(grid.points)
    middle, node = np.zeros((count, grid.dimension)), np.zeros(count, np.int64)
    rows, columns = [], []
    for group in grid.groups:
        middle[group.index] = grid.points[group.nodes[:, : CORNERS[group.type.family]], : grid.dimension].mean(axis=1)
        node[group.index] = group.nodes[:, 0]
        rows.append(np.repeat(group.nodes[:, 0], group.nodes.shape[1]))
        columns.append(group.nodes.ravel())
    row, column = np.concatenate(rows), np.concatenate(columns)
    part = connected_components(coo_array((np.ones(len(row)), (row, column)), shape=(n, n)), directed=False)[1]
    return middle, part[node].astype(np.int64)


def _opposite(outside: _Outside) -> tuple[IntArray, IntArray]:
    """Faces of two parts that lie opposite each other, the part of the lower number first; indices of both."""
    pairs: list[IntArray] = [np.empty((0, 2), np.int64)]
    sizes = {p: float(np.ptp(outside.centre[outside.part == p], axis=0).max()) for p in np.unique(outside.part)}
    for p in sizes:
        own, others = np.nonzero(outside.part == p)[0], np.nonzero(outside.part != p)[0]
        if not len(others):
            continue
        count = min(_NEIGHBOURS, len(others))
        distance, index = cKDTree(outside.centre[others]).query(outside.centre[own], k=count)
        distance, near = distance.reshape(-1, count), others[index.reshape(-1, count)]
        reach = np.minimum(sizes[p], np.array([sizes[q] for q in outside.part[near].ravel()]).reshape(near.shape))
        way = outside.centre[near] - outside.centre[own][:, None]
        ahead = np.einsum("ijk,ik->ij", way, outside.normal[own])
        facing = np.einsum("ijk,ik->ij", outside.normal[near], outside.normal[own]) < _OPPOSITE
        close = distance <= 0.5 * (outside.size[near] + outside.size[own][:, None])
        facing &= (distance <= _REACH * reach) & (close | (ahead > _AHEAD * distance))
        nearest = np.where(facing, distance, np.inf).min(axis=1, keepdims=True)
        facing &= distance <= nearest + outside.size[own][:, None]  # not through a part that lies between
        pairs.append(np.column_stack([np.broadcast_to(own[:, None], near.shape)[facing], near[facing]]))
    found = np.concatenate(pairs)
    turned = outside.part[found[:, 0]] > outside.part[found[:, 1]]
    found[turned] = found[turned][:, ::-1]
    found = np.unique(found, axis=0)
    return found[:, 0], found[:, 1]


def _name(keys: IntArray, known: Known) -> str:
    """Names of the sections that faces belong to."""
    elements = keys // FACES
    return " and ".join(section.name for section in known.sections if np.isin(elements, section.elements).any())


def _surface(keys: IntArray, label: str, known: Known, card: Card) -> DeckSurface:
    """A surface of faces by a name like the label; ``card`` is blamed for faces of two orders."""
    labels = known.places.at_faces(keys, label)
    if len(labels) > 1:
        raise card.error(f"finds faces of linear and of quadratic elements, '{label}'; expected elements of one order")
    return DeckSurface(name=labels[0], keys=keys, given=None, faces=known.faces)
