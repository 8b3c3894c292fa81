# SPDX-License-Identifier: BSD-3-Clause
"""``*COUPLING`` with ``*KINEMATIC``: nodes of a surface that follow the motion of a reference node."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.card import Card
from signorini.deck.inp.known import Known
from signorini.deck.inp.links import (
    DeckEquation,
    DeckRigid,
    make_equations,
    make_rigid_bodies,
    named_node,
    refuse_shared,
    rigid_body,
)
from signorini.model.links import AXES, Equation, RigidBody, Term, directions

_ARM_TOL = 1e-12  # of the longest arm: shorter ones are rounding of the coordinates
COUPLINGS = ("KINEMATIC", "DISTRIBUTING")
"""Keywords that say how the ``*COUPLING`` before them couples."""


def make_deck_links(cards: Sequence[Card], known: Known) -> tuple[list[DeckRigid], list[DeckEquation]]:
    """Read all ``*RIGID BODY``, ``*COUPLING`` and ``*EQUATION`` keywords: what couples displacements."""
    rigid, equations = _couplings(cards, known, make_rigid_bodies(cards, known))
    return rigid, equations + make_equations(cards, known, rigid)


def _couplings(
    cards: Sequence[Card], known: Known, rigid: Sequence[DeckRigid]
) -> tuple[list[DeckRigid], list[DeckEquation]]:
    """Read all ``*COUPLING`` keywords: rigid bodies where they couple all directions, otherwise equations too.

    ``u_i(x) = u_i + (theta x (x - point))_i`` in every direction i that is coupled, with the displacement u and the
    rotation theta of the reference node at ``point``.

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
    for card, kinematic in _pairs(cards):
        card.refuse_unknown(("REF NODE", "SURFACE"), ("CONSTRAINT NAME",))
        surface = known.surfaces.find(card.value("SURFACE"), card)
        card.value("REF NODE", "a node")
        reference = named_node(card, "REF NODE", known)
        refuse_shared(card, (reference,), bodies)
        members = surface.nodes[surface.nodes != reference]
        if not len(members):
            raise card.error(f"surface '{surface.name}' holds no node but the reference node")
        coupled = _directions(kinematic, known.dimension)
        whole = len(coupled) == known.dimension
        nodes = distinct(np.append(members, reference)) if whole else np.array([reference])
        body = rigid_body(surface.name, f"coupling {surface.name}", nodes, reference, known, bodies)
        idle: tuple[int, ...] = ()
        if not whole:
            line = card.at(kinematic.row("directions"))
            terms = list(_followed(body, members, known, coupled))
            equations += [DeckEquation(equation=Equation(each), card=line) for each in terms]
            followed = {direction for each in terms for place, direction, _ in each if place == body.name}
            idle = tuple(i for i, word in enumerate(directions(known.dimension)) if word not in followed)
        bodies.append(DeckRigid(body=body, reference=reference, turning=-1, card=card, idle=idle))
    return bodies, equations


def _pairs(cards: Sequence[Card]) -> Iterator[tuple[Card, Card]]:
    """Every ``*COUPLING`` and the keyword behind it that says how."""
    for before, card in itertools.pairwise((None, *cards, None)):
        open_ = before if before is not None and before.keyword == "COUPLING" else None
        if card is not None and card.keyword in COUPLINGS:
            if open_ is None:
                raise card.error("stands without *COUPLING before it")
            if card.keyword == "DISTRIBUTING":
                raise card.error("is not supported; expected *KINEMATIC")
            yield open_, card
        elif open_ is not None:
            raise open_.error("expected *KINEMATIC behind it")


def _directions(card: Card, dimension: int) -> list[int]:
    """Coupled displacements from 0: data lines are ranges of 1 to 6, whose rotations say nothing; all without lines."""
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


def _followed(body: RigidBody, members: IntArray, known: Known, coupled: Sequence[int]) -> Iterator[list[Term]]:
    """``u_i(k) - u_i - (theta x r_k)_i = 0`` for every node k at r_k from the body's point, and direction i."""
    arms = known.grid.points[members, : known.dimension] - body.point
    labels = known.nodes.numbering.labels[members].tolist()
    turns = directions(known.dimension)[known.dimension :]
    for axis in coupled:
        shares = _turned(arms, axis)
        shares[np.abs(shares) <= _ARM_TOL * np.abs(arms).max()] = 0.0
        for label, share in zip(labels, shares.tolist(), strict=True):
            turning = [(body.name, turn, -value) for turn, value in zip(turns, share, strict=True) if value]
            yield [(label, AXES[axis], 1.0), (body.name, AXES[axis], -1.0), *turning]


def _turned(arms: Array, axis: int) -> Array:
    """``d (theta x r)_axis / d theta``, (nodes, rotations)."""
    if arms.shape[1] == 2:
        return arms[:, 1 - axis, None] * (1.0 if axis else -1.0)
    shares = np.zeros_like(arms)
    left, right = (axis + 1) % 3, (axis + 2) % 3
    shares[:, left], shares[:, right] = arms[:, right], -arms[:, left]
    return shares
