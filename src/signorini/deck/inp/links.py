# SPDX-License-Identifier: BSD-3-Clause
"""``*EQUATION``, ``*RIGID BODY`` and ``*COUPLING``: what couples displacements without an element."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, IntArray, distinct
from signorini.deck.inp.card import Card, Row
from signorini.deck.inp.grid import nodes_of
from signorini.deck.inp.keywords import of_keyword
from signorini.deck.inp.known import Known
from signorini.model.kind import TWIST, Kind
from signorini.model.links import AXES, Equation, RigidBody, Term, directions

SLOTS_PER_NODE = 6
"""Three displacements and three rotations, also in the plane."""

_MAX_TERMS = 100_000  # of an equation times its nodes: each is a row of numbers in the model
_PLANE_MOTIONS = {0: 0, 1: 1, 5: 2}  # of the six directions those of a plane model, as `directions` counts them
_TWISTING_MOTIONS = {0: 0, 1: 1, 4: 2}  # of elements that twist: 5 goes around the axis


@dataclass(frozen=True, eq=False)
class NodeSlots:
    """Directions of nodes as one number each: SLOTS_PER_NODE of them a node.

    Attributes
    ----------
    slots : (m,)

    Examples
    --------
    >>> packed = NodeSlots.pack(np.array([7, 9]), 2)
    >>> packed, NodeSlots(packed).nodes, NodeSlots(packed).axes
    (array([44, 56]), array([7, 9]), array([2, 2]))
    """

    slots: IntArray

    @staticmethod
    def pack(nodes: int | IntArray, axes: int | IntArray) -> IntArray:
        """Slots of nodes in directions from 0."""
        return np.asarray(SLOTS_PER_NODE * nodes + axes, np.int64)

    @property
    def nodes(self) -> IntArray:
        """(m,)"""
        return self.slots // SLOTS_PER_NODE

    @property
    def axes(self) -> IntArray:
        """(m,) directions from 0: 3 to 5 are rotations."""
        return self.slots % SLOTS_PER_NODE


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckRigid:
    """A ``*RIGID BODY``, or the reference node of a ``*COUPLING``.

    Attributes
    ----------
    body : its counterpart in the model
    reference, turning : its REF NODE and its ROT NODE, -1 where it has none
    card : where it stands
    idle : displacements and rotations that nothing follows, where single directions are coupled
    """

    body: RigidBody
    reference: int
    turning: int
    card: Card
    idle: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckEquation:
    """One equation and its keyword, at the line that it begins at."""

    equation: Equation
    card: Card


def rigid_slots(rigid: Sequence[DeckRigid], nodes: IntArray, axes: Sequence[int]) -> tuple[IntArray, IntArray]:
    """Slots of the reference nodes among some nodes, and the other nodes; directions of a ROT NODE are rotations.

    Parameters
    ----------
    rigid : what has reference nodes
    nodes : (m,)
    axes : directions of the deck, 1 .. 6
    """
    given = np.array(axes, np.int64) - 1
    slots: list[IntArray] = [np.empty(0, np.int64)]
    rest = nodes
    for item in rigid:
        if item.reference in rest:
            slots.append(NodeSlots.pack(item.reference, given))
        if item.turning in rest:
            slots.append(NodeSlots.pack(item.reference, given[given < 3] + 3))
        rest = rest[(rest != item.reference) & (rest != item.turning)]
    return np.concatenate(slots), rest


def rigid_motion(axis: int, kind: Kind) -> int | None:
    """Number of the displacement or rotation of a rigid body in a direction from 0, None where the plane has none.

    >>> rigid_motion(5, "plane strain"), rigid_motion(5, "3d"), rigid_motion(2, "axisymmetric")
    (2, 5, None)
    """
    if kind == "3d":
        return axis
    return (_TWISTING_MOTIONS if kind == TWIST else _PLANE_MOTIONS).get(axis)


def make_rigid_bodies(cards: Sequence[Card], known: Known) -> list[DeckRigid]:
    """Read all ``*RIGID BODY`` keywords."""
    found: list[DeckRigid] = []
    for card in of_keyword(cards, "RIGID BODY"):
        card.refuse_unknown((*_MEMBERS, "REF NODE", "ROT NODE", "POSITION"), ("ISOTHERMAL",))
        card.choice("POSITION", ("INPUT",), "INPUT")
        label, members = _members(card, known)
        card.value("REF NODE", "a node")
        reference, turning = (named_node(card, key, known) for key in ("REF NODE", "ROT NODE"))
        refuse_shared(card, (reference, turning), found)
        nodes = distinct(np.append(members[members != turning], reference))
        body = rigid_body(label, label, nodes, reference, known, found)
        found.append(DeckRigid(body=body, reference=reference, turning=turning, card=card))
    return found


def rigid_body(
    label: str, place: str, nodes: IntArray, reference: int, known: Known, others: Sequence[DeckRigid]
) -> RigidBody:
    """A rigid body of the model, under a name of its own.

    Parameters
    ----------
    label : what the deck calls it
    place : a name for its nodes
    nodes : sorted; they follow it
    reference : the node at its point
    known : what has names already
    others : rigid bodies, which have names too
    """
    on = known.places.at_nodes(nodes, place)
    name = known.places.unused(f"rigid {label}", [other.body.name for other in others])
    return RigidBody(name, on, tuple(known.grid.points[reference, : known.dimension].tolist()))


_MEMBERS = ("NSET", "TIE NSET", "PIN NSET", "ELSET")


def _members(card: Card, known: Known) -> tuple[str, IntArray]:
    given = [key for key in _MEMBERS if key in card.parameters]
    if not given:
        raise card.error("names no nodes; expected NSET= or ELSET=")
    found = []
    for key in given:
        sets = known.elements if key == "ELSET" else known.nodes
        label, members = sets.find(card.value(key), card)
        found.append((label, nodes_of(known.grid, members) if key == "ELSET" else members))
    return found[0][0], distinct(np.concatenate([members for _, members in found]))


def named_node(card: Card, key: str, known: Known) -> int:
    """The known node that a card names by the parameter ``key``, -1 without it."""
    if key not in card.parameters:
        return -1
    label, members = known.nodes.find(card.value(key, "a node"), card)
    if len(members) != 1:
        raise card.error(f"{key}: '{label}' holds {len(members)} nodes; expected one")
    return int(members[0])


def refuse_shared(card: Card, own: tuple[int, ...], others: Sequence[DeckRigid]) -> None:
    """Stop where a card's own reference nodes, -1 for none, are those of others: rigid bodies or couplings."""
    for other in others:
        if set(own) & {other.reference, other.turning} - {-1}:
            raise card.error(
                f"has a node in common with the rigid body of line {other.card.line}: its REF NODE or ROT NODE"
            )


def make_equations(cards: Sequence[Card], known: Known, rigid: Sequence[DeckRigid]) -> list[DeckEquation]:
    """Read all ``*EQUATION`` keywords among the cards; sets of n nodes make n equations.

    Parameters
    ----------
    known : nodes and their sets
    rigid : rigid bodies, whose reference nodes may be in equations
    """
    found: list[DeckEquation] = []
    for card in of_keyword(cards, "EQUATION"):
        card.refuse_unknown((), ("LOAD CASE",))
        rows = card.rows()
        for row in rows:
            for terms in _spread(_terms(row, rows, known, rigid), row):
                found.append(DeckEquation(equation=Equation(terms), card=card.at(row)))
    return found


def _terms(
    row: Row, rows: Iterator[Row], known: Known, rigid: Sequence[DeckRigid]
) -> list[tuple[list[list[Term]], float]]:
    """Motions and coefficient of every term of an equation; they follow the line with their number."""
    count = row.whole(0, "the number of terms")
    if count < 1:
        raise row.error(f"*EQUATION: has {count} terms; expected 1 or more")
    terms: list[tuple[list[list[Term]], float]] = []
    while len(terms) < count:
        line = next(rows, None)
        if line is None:
            raise row.error(f"*EQUATION: has {len(terms)} terms; expected {count}")
        if len(line.fields) > 3 * (count - len(terms)) or not line.fields:
            raise line.error(f"*EQUATION: has {len(line.fields)} fields; expected 3 for each of {count} terms")
        for start in range(0, len(line.fields), 3):
            members = known.nodes.find(line.text(start, "a node or a node set"), line)[1]
            axis = line.whole(start + 1, "a direction")
            value = line.number(start + 2, "a coefficient")
            if value == 0.0:
                raise line.error("*EQUATION: has the coefficient 0; expected another, or no such term")
            if not len(members):
                raise line.error(f"*EQUATION: '{line.fields[start]}' holds no node")
            terms.append((_motions(members, axis, known, rigid, line), value))
    return terms


def _motions(members: IntArray, axis: int, known: Known, rigid: Sequence[DeckRigid], row: Row) -> list[list[Term]]:
    """Motion of every member in a direction, as the sum of terms that the model has for it."""
    slots, rest = rigid_slots(rigid, members, [axis])
    if len(slots) and len(members) == 1:
        packed = NodeSlots(slots[:1])
        motion = rigid_motion(int(packed.axes[0]), known.grid.kind)
        if motion is None:
            raise row.error(f"*EQUATION: direction {axis} is not one of a plane model")
        refuse_turned(row, int(packed.nodes[0]), known)
        name = next(item.body.name for item in rigid if item.reference == packed.nodes[0])
        return [[(name, directions(known.dimension)[motion], 1.0)]]
    if len(rest) < len(members):
        raise row.error("*EQUATION: a set holds the node of a rigid body; expected its number")
    if not 1 <= axis <= known.dimension:
        raise row.error(f"*EQUATION: direction {axis}; expected 1 to {known.dimension}")
    return [node_motion(int(node), axis - 1, known) for node in members]


def node_motion(node: int, axis: int, known: Known) -> list[Term]:
    """The displacement of a node along a direction of its own: terms whose sum it is, largest first.

    Parameters
    ----------
    node, axis : index of the node, and its direction, both from 0
    known : directions and labels of the nodes
    """
    label, unit = int(known.nodes.numbering.labels[node]), known.axes.along(node, axis)
    return [(label, AXES[i], float(unit[i])) for i in np.argsort(-np.abs(unit), kind="stable").tolist() if unit[i]]


def refuse_turned(at: Card | Row, node: int, known: Known) -> None:
    """Stop where a reference node has axes of its own: its motions are those of the model.

    Parameters
    ----------
    at : the keyword or line that acts on it
    node : its index
    known : directions and labels of the nodes
    """
    if known.axes.own(node):
        number = known.nodes.numbering.labels[node]
        raise at.error(f"acts on the reference node {number}, which *TRANSFORM turns; expected no axes of its own")


def _spread(terms: list[tuple[list[list[Term]], float]], row: Row) -> Iterator[list[Term]]:
    """One equation for every node of the sets."""
    count = max(len(motions) for motions, _ in terms)
    for motions, _ in terms:
        if len(motions) not in (1, count):
            raise row.error(f"*EQUATION: one set has {len(motions)} nodes, another {count}; expected as many, or one")
    if count * len(terms) > _MAX_TERMS:
        raise row.error(f"*EQUATION: has {len(terms)} terms of up to {count} nodes; expected at most {_MAX_TERMS}")
    for i in range(count):
        yield [
            (place, direction, share * value)
            for motions, value in terms
            for place, direction, share in motions[i if len(motions) > 1 else 0]
        ]


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
    """All rigid bodies, those of the deck first, with ``*COUPLING`` as more of them; equations where it couples a few.

    ``u_i(x) = u_i + (theta x (x - point))_i`` in every direction i that is coupled, with the displacement u and the
    rotation theta of the reference node at ``point``.
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
        coupled = _directions(kinematic, known)
        whole = len(coupled) == len(known.motions)
        if not whole and known.twists:
            raise card.error("couples some directions of elements that twist; expected 1, 2 and 5")
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


def _directions(card: Card, known: Known) -> list[int]:
    """Coupled displacements from 0: data lines are ranges of 1 to 6, whose rotations say nothing; all without lines."""
    card.refuse_unknown(())
    found: set[int] = set() if card.has_data else set(known.motions.values())
    for row in card.rows():
        first = row.whole(0, "a direction")
        last = row.whole(1, "the last direction", first)
        if not 1 <= first <= last <= 6:
            raise row.error(f"*KINEMATIC: directions {first} to {last}; expected {known.spelled}")
        found |= {known.motions[axis] for axis in range(first, last + 1) if axis in known.motions}
    if not found:
        raise card.error(f"couples no displacement; expected directions of {known.spelled}")
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
