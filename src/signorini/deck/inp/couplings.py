# SPDX-License-Identifier: BSD-3-Clause
"""``*COUPLING`` with ``*KINEMATIC``: nodes of a surface that follow the motion of a reference node."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from signorini.arrays import Array, distinct
from signorini.deck.inp.card import Card
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.grid import DeckGrid
from signorini.deck.inp.links import DeckEquation, DeckRigid, named_node, refuse_shared
from signorini.deck.inp.places import Places
from signorini.deck.inp.sets import Sets
from signorini.deck.inp.surfaces import ElementFaces, Surfaces
from signorini.model.links import AXES, Equation, RigidBody, Term, directions

_ROUNDING = 1e-12  # of the longest arm: shorter ones are none
COUPLINGS = ("KINEMATIC", "DISTRIBUTING")
"""Keywords that say how the ``*COUPLING`` before them couples."""


def make_couplings(
    placed: Sequence[Placed],
    rigid: list[DeckRigid],
    nodes: Sets,
    surfaces: Surfaces,
    edges: ElementFaces,
    grid: DeckGrid,
    places: Places,
) -> tuple[list[DeckRigid], list[DeckEquation]]:
    """Read all ``*COUPLING`` keywords: rigid bodies where they couple all directions, otherwise equations too.

    ``u_i(x) = u_i + (theta x (x - point))_i`` in every direction i that is coupled, with the displacement u and the
    rotation theta of the reference node at ``point``.

    Parameters
    ----------
    rigid : the rigid bodies of the deck, whose nodes and names are taken

    Returns
    -------
    All rigid bodies, those of the deck first, and the equations

    Raises
    ------
    DeckError
        For an unknown surface or node, directions that there are not, or another kind of coupling.
    """
    bodies = list(rigid)
    equations: list[DeckEquation] = []
    dimension = 3 if grid.groups[0].type.kind == "3d" else 2
    for item, kinematic in _pairs(placed):
        card = item.card
        card.refuse_unknown(("REF NODE", "SURFACE"), ("CONSTRAINT NAME",))
        surface = surfaces.find(card.value("SURFACE"), item.scope, card)
        faces = edges.ends[surfaces.keys[surface.upper()]]
        members = distinct(surfaces.nodes.get(surface.upper(), faces[faces >= 0]))
        card.value("REF NODE", "a node")
        reference = named_node(item, "REF NODE", nodes)
        refuse_shared(card, (reference,), bodies)
        members = members[members != reference]
        if not len(members):
            raise card.error(f"surface '{surface}' holds no node but the reference node")
        coupled = _directions(kinematic, dimension)
        whole = len(coupled) == dimension
        own = np.array([reference])
        on = places.at_nodes(distinct(np.append(members, own)) if whole else own, f"coupling {surface}")
        name = places.unused(f"rigid {surface}", [other.body.name for other in bodies])
        point = grid.points[reference, :dimension]
        body = RigidBody(name, on, tuple(float(x) for x in point))
        followed = set(directions(dimension))
        if not whole:
            at = kinematic.row("directions")
            labels = nodes.numbering.labels[members].tolist()
            own_terms = list(_followed(name, labels, grid.points[members, :dimension] - point, coupled))
            followed = {direction for terms in own_terms for place, direction, _ in terms if place == name}
            equations += [DeckEquation(equation=Equation(terms), row=at, card=card) for terms in own_terms]
        idle = tuple(i for i, direction in enumerate(directions(dimension)) if direction not in followed)
        bodies.append(DeckRigid(body=body, reference=reference, turning=-1, card=card, idle=idle))
    return bodies, equations


def _pairs(placed: Sequence[Placed]) -> Iterator[tuple[Placed, Card]]:
    """Every ``*COUPLING`` and the keyword behind it that says how."""
    before: Placed | None = None
    for item in placed:
        asked = before is not None and before.card.keyword == "COUPLING"
        if item.card.keyword in COUPLINGS:
            if before is None or not asked:
                raise item.card.error("stands without *COUPLING before it")
            if item.card.keyword == "DISTRIBUTING":
                raise item.card.error("is not supported; expected *KINEMATIC")
            yield before, item.card
        elif before is not None and asked:
            raise before.card.error("expected *KINEMATIC behind it")
        before = item
    if before is not None and before.card.keyword == "COUPLING":
        raise before.card.error("expected *KINEMATIC behind it")


def _directions(card: Card, dimension: int) -> list[int]:
    """Coupled directions from 0: ranges of 1 to 6 in the data lines, all without any; rotations have no say here."""
    card.refuse_unknown(())
    found: set[int] = set() if card.has_data else set(range(dimension))
    for row in card.rows():
        first = row.whole(0, "a direction")
        last = row.whole(1, "the last direction", first)
        if not 1 <= first <= last <= 6:
            raise row.error(f"*KINEMATIC: directions {first} to {last}; expected 1 to {dimension}")
        found |= {axis - 1 for axis in range(first, last + 1) if axis <= dimension}
    if not found:
        raise card.error(f"couples no displacement; expected directions of 1 to {dimension}")
    return sorted(found)


def _followed(name: str, labels: Sequence[int], arms: Array, coupled: Sequence[int]) -> Iterator[list[Term]]:
    """``u_i(k) - u_i - (theta x r_k)_i = 0`` for every node k with the arm r_k, (nodes, d), and direction i."""
    dimension = arms.shape[1]
    turns = directions(dimension)[dimension:]
    for axis in coupled:
        shares = _turned(arms, axis)
        shares[np.abs(shares) <= _ROUNDING * np.abs(arms).max()] = 0.0
        for label, share in zip(labels, shares.tolist(), strict=True):
            turning = [(name, turn, -value) for turn, value in zip(turns, share, strict=True) if value]
            yield [(label, AXES[axis], 1.0), (name, AXES[axis], -1.0), *turning]


def _turned(arms: Array, axis: int) -> Array:
    """``d (theta x r)_axis / d theta``, (nodes, rotations)."""
    if arms.shape[1] == 2:
        return arms[:, 1 - axis, None] * (1.0 if axis else -1.0)
    shares = np.zeros_like(arms)
    left, right = (axis + 1) % 3, (axis + 2) % 3
    shares[:, left], shares[:, right] = arms[:, right], -arms[:, left]
    return shares
