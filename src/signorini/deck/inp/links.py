# SPDX-License-Identifier: BSD-3-Clause
"""``*EQUATION`` and ``*RIGID BODY``: what couples displacements without an element."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.grid import DeckGrid, nodes_of
from signorini.deck.inp.places import Places
from signorini.deck.inp.sets import Sets
from signorini.errors import Where
from signorini.model.links import Equation, RigidBody, Term, directions

STRIDE = 6
"""Slots of a node or section: three directions, also in the plane, and three rotations."""

_MOST = 100_000  # terms of an equation times its nodes


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckRigid:
    """A ``*RIGID BODY``, or the reference node of a ``*COUPLING``.

    Attributes
    ----------
    body : its counterpart in the model
    reference, turning : its REF NODE and its ROT NODE, -1 where it has none
    card : the keyword
    idle : displacements and rotations that nothing follows, where single directions are coupled
    """

    body: RigidBody
    reference: int
    turning: int
    card: Card
    idle: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckEquation:
    """One equation and the line that it begins at."""

    equation: Equation
    row: Row
    card: Card


def rigid_slots(rigid: Sequence[DeckRigid], nodes: IntArray, axes: Sequence[int]) -> tuple[IntArray, IntArray]:
    """Of nodes with directions 1 .. 6: slots of the reference nodes among them, and the other nodes.

    Directions of a ROT NODE are rotations of its body.
    """
    given = np.array(axes, np.int64)
    slots, rest = [np.empty(0, np.int64)], nodes
    for item in rigid:
        if item.reference in rest:
            slots.append(STRIDE * item.reference + given - 1)
        if item.turning in rest:
            slots.append(STRIDE * item.reference + given[given <= 3] + 2)
        rest = rest[(rest != item.reference) & (rest != item.turning)]
    return np.concatenate(slots), rest


def component(slot: int, dimension: int) -> int | None:
    """Which displacement or rotation of a rigid body a slot is, None where the plane has none.

    >>> component(STRIDE * 7 + 5, 2), component(STRIDE * 7 + 5, 3), component(STRIDE * 7 + 2, 2)
    (2, 5, None)
    """
    axis = slot % STRIDE
    if dimension == 3:
        return axis
    return {0: 0, 1: 1, 5: 2}.get(axis)


def make_rigid_bodies(
    placed: Sequence[Placed], nodes: Sets, elements: Sets, grid: DeckGrid, places: Places
) -> list[DeckRigid]:
    """Read all ``*RIGID BODY`` keywords.

    Raises
    ------
    DeckError
        For an unknown set or node, a reference node that two bodies have, or a position that is to be computed.
    """
    found: list[DeckRigid] = []
    for item in placed:
        card = item.card
        if card.keyword != "RIGID BODY":
            continue
        card.refuse_unknown(
            ("NSET", "TIE NSET", "PIN NSET", "ELSET", "REF NODE", "ROT NODE", "POSITION"), ("ISOTHERMAL",)
        )
        card.choice("POSITION", ("INPUT",), "INPUT")
        label, members = _members(item, nodes, elements, grid)
        card.value("REF NODE", "a node")
        reference, turning = (named_node(item, key, nodes) for key in ("REF NODE", "ROT NODE"))
        refuse_shared(card, (reference, turning), found)
        if turning in members:
            members = members[members != turning]
        on = places.at_nodes(distinct(np.append(members, reference)), label)
        point = tuple(float(x) for x in grid.points[reference, : 3 if grid.groups[0].type.kind == "3d" else 2])
        body = RigidBody(places.unused(f"rigid {label}", [other.body.name for other in found]), on, point)
        found.append(DeckRigid(body=body, reference=reference, turning=turning, card=card))
    return found


def link_places(rigid: Sequence[DeckRigid], equations: Sequence[DeckEquation]) -> dict[Where, Card]:
    """The keyword of every rigid body, and of every equation with its own line, by the place in the model."""
    places: dict[Where, Card] = {("rigid_body", j): item.card for j, item in enumerate(rigid)}
    return places | {
        ("equation", i): replace(item.card, path=item.row.path, line=item.row.line) for i, item in enumerate(equations)
    }


def _members(item: Placed, nodes: Sets, elements: Sets, grid: DeckGrid) -> tuple[str, IntArray]:
    card = item.card
    given = [key for key in ("NSET", "TIE NSET", "PIN NSET", "ELSET") if key in card.parameters]
    if not given:
        raise card.error("names no nodes; expected NSET= or ELSET=")
    found = []
    for key in given:
        sets = elements if key == "ELSET" else nodes
        label, members = sets.find(card.value(key), item.scope, card)
        found.append((label, nodes_of(grid, members) if key == "ELSET" else members))
    return found[0][0], distinct(np.concatenate([members for _, members in found]))


def named_node(item: Placed, key: str, nodes: Sets) -> int:
    """The node that a parameter names, -1 without it."""
    card = item.card
    if key not in card.parameters:
        return -1
    label, members = nodes.find(card.value(key, "a node"), item.scope, card)
    if len(members) != 1:
        raise card.error(f"{key}: '{label}' holds {len(members)} nodes; expected one")
    return int(members[0])


def refuse_shared(card: Card, own: tuple[int, ...], others: Sequence[DeckRigid]) -> None:
    """Reference nodes, -1 for none, that another rigid body or coupling has too, stop."""
    for other in others:
        if set(own) & {other.reference, other.turning} - {-1}:
            raise card.error(
                f"has a node in common with the rigid body of line {other.card.line}: its REF NODE or ROT NODE"
            )


def make_equations(placed: Sequence[Placed], nodes: Sets, rigid: Sequence[DeckRigid], kind: str) -> list[DeckEquation]:
    """Read all ``*EQUATION`` keywords; sets of n nodes make n equations.

    Raises
    ------
    DeckError
        For what is malformed: numbers of terms, directions, sets of different sizes.
    """
    found: list[DeckEquation] = []
    for item in placed:
        card = item.card
        if card.keyword != "EQUATION":
            continue
        card.refuse_unknown((), ("LOAD CASE",))
        rows = card.rows()
        for row in rows:
            for terms in _spread(_terms(row, rows, item, nodes, rigid, kind), row):
                found.append(DeckEquation(equation=Equation(terms), row=row, card=card))
    return found


def _terms(
    row: Row, rows: Iterator[Row], item: Placed, nodes: Sets, rigid: Sequence[DeckRigid], kind: str
) -> list[tuple[list[str | int], str, float]]:
    """Places, direction and coefficient of every term of an equation; they follow the line with their number."""
    count = row.whole(0, "the number of terms")
    if count < 1:
        raise row.error(f"*EQUATION: has {count} terms; expected 1 or more")
    terms: list[tuple[list[str | int], str, float]] = []
    while len(terms) < count:
        line = next(rows, None)
        if line is None:
            raise row.error(f"*EQUATION: has {len(terms)} terms; expected {count}")
        if len(line.fields) > 3 * (count - len(terms)) or not line.fields:
            raise line.error(f"*EQUATION: has {len(line.fields)} fields; expected 3 for each of {count} terms")
        for start in range(0, len(line.fields), 3):
            members = nodes.find(line.text(start, "a node or a node set"), item.scope, line)[1]
            axis = line.whole(start + 1, "a direction")
            value = line.number(start + 2, "a coefficient")
            if value == 0.0:
                raise line.error("*EQUATION: has the coefficient 0; expected another, or no such term")
            if not len(members):
                raise line.error(f"*EQUATION: '{line.fields[start]}' holds no node")
            places, word = _place(members, axis, nodes, rigid, kind, line)
            terms.append((places, word, value))
    return terms


def _place(
    members: IntArray, axis: int, nodes: Sets, rigid: Sequence[DeckRigid], kind: str, row: Row
) -> tuple[list[str | int], str]:
    """Places and the direction as the model calls them."""
    dimension = 3 if kind == "3d" else 2
    slots, rest = rigid_slots(rigid, members, [axis])
    if len(slots) and len(members) == 1:
        index = component(int(slots[0]), dimension)
        if index is None:
            raise row.error(f"*EQUATION: direction {axis} is not one of a plane model")
        reference = int(slots[0]) // STRIDE
        return [next(item.body.name for item in rigid if item.reference == reference)], directions(dimension)[index]
    if len(rest) < len(members):
        raise row.error("*EQUATION: a set holds the node of a rigid body; expected its number")
    if not 1 <= axis <= dimension:
        raise row.error(f"*EQUATION: direction {axis}; expected 1 to {dimension}")
    return nodes.numbering.labels[members].tolist(), "xyz"[axis - 1]


def _spread(terms: list[tuple[list[str | int], str, float]], row: Row) -> Iterator[list[Term]]:
    """One equation for every node of the sets."""
    count = max(len(places) for places, _, _ in terms)
    for places, _, _ in terms:
        if len(places) not in (1, count):
            raise row.error(f"*EQUATION: one set has {len(places)} nodes, another {count}; expected as many, or one")
    if count * len(terms) > _MOST:
        raise row.error(f"*EQUATION: has {len(terms)} terms of up to {count} nodes; expected at most {_MOST}")
    for i in range(count):
        yield [(places[i if len(places) > 1 else 0], axis, value) for places, axis, value in terms]
