# SPDX-License-Identifier: BSD-3-Clause
"""Gasket elements: contacts of the faces that they stand between, across what closes by their loading curve.

An element joins a face of one body, which its first nodes are, to a face of another, opposite which its others are. It
resists being pressed together, and next to nothing else, so that it is a contact that closes by a law.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import IntArray, distinct
from signorini.deck.error import DeckError
from signorini.deck.inp.card import Card, Row, to_number
from signorini.deck.inp.grid import DeckGrid
from signorini.deck.inp.keywords import collect, look_up, of_keyword
from signorini.deck.inp.known import Known
from signorini.deck.inp.surfaces import DeckSurface
from signorini.errors import InputError
from signorini.law.closure import Closure
from signorini.model.contact import Contact

GASKET_NOTE = (
    "gasket elements are contacts of the faces that they stand between, which close by their loading curve, beyond its "
    "last point as between the last two: they bear no tension (Abaqus: a thousandth of the first stiffness), spring "
    "back by one stiffness from any pressure, and slide freely, or stick on their transverse shear stiffness while "
    "they are pressed"
)

_WORDS = ("GASKET THICKNESS BEHAVIOR", "GASKET ELASTICITY")
_OTHER_WORDS = ("CREEP", "DENSITY", "ELASTIC", "EXPANSION", "PLASTIC", "VISCOELASTIC")  # that a material may have
_SLOPE_DROP = 0.1  # of a slope: what the loading curve gets softer by where it yields, if nothing is said
_STRAIGHT = 0.01  # of a stiffness: what lines of unloading, whose points are written with few digits, may differ by


@dataclass(frozen=True, kw_only=True, eq=False)
class GasketBehavior:
    """What the keywords of a gasket say so far.

    Attributes
    ----------
    card : where it begins
    loading, unloading : curves, or None
    shear : traction along the faces per displacement, 0 for none
    """

    card: Card
    loading: Card | None = None
    unloading: Card | None = None
    shear: float = 0.0

    @property
    def name(self) -> str:
        """Name as the deck spells it."""
        return self.card.value("NAME")

    @property
    def closure(self) -> Closure:
        """Pressure over closure of its loading curve, and how it springs back."""
        if self.loading is None:
            raise self.card.error("has no *GASKET THICKNESS BEHAVIOR, DIRECTION=LOADING; expected one")
        rows = list(self.loading.rows())
        points = [(row.number(1, "the closure"), row.number(0, "the pressure")) for row in rows]
        try:
            law = Closure(points)
            return replace(law, unloading=self._unloading(np.array(law.points)))
        except DeckError:
            raise
        except InputError as error:
            if error.where == ("unloading",):
                raise self.loading.error(f"pressure per closure with which it springs back {error.message}") from error
            row = rows[int(error.where[1]) if len(error.where) > 1 else 0]
            raise row.error(f"*{self.loading.keyword}: pressure and closure: {error.message}") from error

    def _unloading(self, points: np.ndarray) -> float | None:
        """Pressure per closure with which it springs back; None where it does so along its loading curve."""
        loading = self.loading
        assert loading is not None
        if loading.get("TYPE") == "DAMAGE":
            if self.unloading is not None:
                raise self.unloading.error(
                    "springs back to no closure (TYPE=DAMAGE), which is not supported; expected "
                    "TYPE=ELASTIC-PLASTIC, or the loading curve alone"
                )
            return None
        if self.unloading is not None:
            return _one_stiffness(self.unloading)
        closed, pressed = np.diff(points, axis=0).T
        slopes = np.divide(pressed, closed, out=np.full(len(closed), np.inf), where=closed > 0.0)
        lines = _before_yield(loading, points, slopes)
        if lines is None:
            return None
        if lines > 1:
            raise loading.error(
                f"springs back along its first {lines} lines, which is not supported; expected one line up to where it "
                "yields, or DIRECTION=UNLOADING"
            )
        return float(slopes[0])


def _before_yield(card: Card, points: np.ndarray, slopes: np.ndarray) -> int | None:
    """Number of lines up to where a loading curve yields; None where it does not.

    Parameters
    ----------
    card : of the curve
    points : (k, 2) closures and pressures
    slopes : (k - 1,) pressure per closure between them
    """
    softer = np.nonzero(slopes[1:] < slopes[:-1])[0] + 1
    if "YIELD ONSET" in card.parameters:
        onset = _parameter(card, "YIELD ONSET", "a closure")
        found = [int(k) for k in softer if np.isclose(points[k, 0], onset, rtol=_STRAIGHT)]
        if not found:
            raise card.error(
                f"YIELD ONSET={onset:g} is no closure at which the loading curve gets softer; expected one"
            )
        return found[0]
    drop = _parameter(card, "SLOPE DROP", "a share") if "SLOPE DROP" in card.parameters else _SLOPE_DROP
    yields = softer[slopes[softer] < (1.0 - drop) * slopes[softer - 1]]
    return int(yields[0]) if len(yields) else None


def _parameter(card: Card, name: str, what: str) -> float:
    value = to_number(card.value(name, what))
    if value is None or not value > 0.0:
        raise card.error(f"{name}={card.get(name)}: expected {what}, a number > 0")
    return value


def _one_stiffness(card: Card) -> float:
    """Pressure per closure of unloading curves, lines from a closure that stays to the loading curve."""
    card.row("pressure, closure and plastic closure")
    curves: dict[float, list[Row]] = {}
    for row in card.rows():
        curves.setdefault(row.number(2, "the plastic closure"), []).append(row)
    found: list[tuple[float, Row]] = []
    for stays, rows in curves.items():
        points = np.array([(row.number(1, "the closure") - stays, row.number(0, "the pressure")) for row in rows])
        last = int(points[:, 1].argmax())
        if not points[last].min() > 0.0:
            raise rows[last].error(f"*{card.keyword}: ends at pressure {points[last, 1]:g}; expected one above 0")
        stiffness = points[last, 1] / points[last, 0]
        bent = np.abs(points[:, 1] - stiffness * points[:, 0]) > _STRAIGHT * points[last, 1]
        if bent.any():
            raise rows[int(bent.argmax())].error(
                f"*{card.keyword}: the curve to the plastic closure {stays:g} bends, which is not supported; expected "
                "a straight line to the loading curve"
            )
        found.append((float(stiffness), rows[last]))
    first = found[0][0]
    for stiffness, row in found:
        if abs(stiffness - first) > _STRAIGHT * first:
            raise row.error(
                f"*{card.keyword}: springs back by {stiffness:g}, others by {first:g}, which is not supported; "
                "expected one pressure per closure for all curves"
            )
    return max(stiffness for stiffness, _ in found)


def _begun(card: Card) -> GasketBehavior:
    card.refuse_unknown(("NAME",))
    return GasketBehavior(card=card)


def _with(found: GasketBehavior, card: Card) -> GasketBehavior:
    if card.keyword == "GASKET ELASTICITY":
        return replace(found, shear=_shear(card))
    card.refuse_unknown(("DIRECTION", "TYPE", "VARIABLE", "SLOPE DROP", "YIELD ONSET"), ("TENSILE STIFFNESS FACTOR",))
    card.choice("TYPE", ("ELASTIC-PLASTIC", "DAMAGE"), "ELASTIC-PLASTIC")
    if card.choice("VARIABLE", ("STRESS", "FORCE"), "STRESS") == "FORCE":
        raise card.error("VARIABLE=FORCE is of links and lines, which are not supported; expected STRESS")
    card.row("pressure and closure")
    side = card.choice("DIRECTION", ("LOADING", "UNLOADING"), "LOADING")
    for row in card.rows():
        if any(row.fields[2 if side == "LOADING" else 3 :]):
            raise row.error(f"*{card.keyword}: a curve that depends on temperature is not supported")
    return replace(found, loading=card) if side == "LOADING" else replace(found, unloading=card)


def _shear(card: Card) -> float:
    """Transverse shear stiffness, traction per displacement."""
    card.refuse_unknown(("COMPONENT", "VARIABLE"))
    if card.choice("COMPONENT", ("MEMBRANE", "TRANSVERSE SHEAR"), "TRANSVERSE SHEAR") == "MEMBRANE":
        raise card.error("COMPONENT=MEMBRANE is not supported; expected none, or a layer of solid elements as stiff")
    if card.choice("VARIABLE", ("STRESS", "FORCE"), "STRESS") == "FORCE":
        raise card.error("VARIABLE=FORCE is of links and lines, which are not supported; expected STRESS")
    rows = list(card.rows())
    if len(rows) != 1 or any(rows[0].fields[1:]):
        raise card.error("expected one data line with a stiffness; one that depends on temperature is not supported")
    stiffness = rows[0].number(0, "the shear stiffness, traction per displacement")
    if stiffness < 0.0:
        raise rows[0].error(f"*{card.keyword}: the stiffness is {stiffness:g}; expected a number >= 0")
    return stiffness


def _refuse_other_words(cards: Sequence[Card]) -> None:
    """Keywords of materials behind those of a gasket are its own, and none of them acts here."""
    inside = False
    for card in cards:
        if inside and card.keyword in _OTHER_WORDS:
            raise card.error("of a *GASKET BEHAVIOR is not supported; expected its thickness and shear behavior alone")
        inside = card.keyword == "GASKET BEHAVIOR" or (inside and card.keyword in (*_WORDS, "GASKET CONTACT AREA"))


def make_gaskets(cards: Sequence[Card], known: Known) -> Iterator[tuple[Contact, Card]]:
    """Read all ``*GASKET SECTION`` keywords: the contact of each, and the card that errors name.

    Parameters
    ----------
    cards : outside the steps
    known : what has a number or a name; the faces on both sides become surfaces

    Raises
    ------
    DeckError
        What is not supported; elements without a section, or whose nodes are no faces of bodies.
    """
    _refuse_other_words(cards)
    behaviors = collect(cards, "GASKET BEHAVIOR", _WORDS, _begun, _with, known.refusals)
    known.refusals.stop()
    owned: list[IntArray] = []
    for card in of_keyword(cards, "GASKET SECTION"):
        card.refuse_unknown(("ELSET", "BEHAVIOR"), ("ORIENTATION", "STABILIZATION STIFFNESS"))
        behavior: GasketBehavior = look_up(card, "BEHAVIOR", behaviors, "gasket behavior")
        name, members = known.elements.find(card.value("ELSET"), card)
        members = distinct(members)
        below, above = (_side(members, half, name, card, known) for half in (0, 1))
        sticks = {"friction": "stick", "tangential_compliance": 1.0 / behavior.shear} if behavior.shear else {}
        yield (
            Contact(below, above, gap=_gap(card, known), closure=behavior.closure, name=name, **sticks),  # type: ignore[arg-type]
            card,
        )
        owned.append(members)
    _refuse_bare(known.grid, owned)


def _refuse_bare(grid: DeckGrid, owned: Sequence[IntArray]) -> None:
    every = np.concatenate([np.empty(0, np.int64), *owned])
    for group in grid.gaskets:
        bare = group.index[~np.isin(group.index, every)]
        if len(bare):
            number = grid.elements.labels[bare[0]]
            raise grid.at(int(bare[0])).error(f"element {number} has no section; expected *GASKET SECTION")


def _side(members: IntArray, half: int, name: str, card: Card, known: Known) -> str:
    """The surface of the faces that the first or the other half of the nodes of gasket elements are.

    Parameters
    ----------
    members : elements
    half : 0 or 1
    name, card : of their set, and their section
    known : faces and surfaces; it takes this one
    """
    grid, tables = known.grid, list[IntArray]()
    inside = np.concatenate([np.empty(0, np.int64), *(group.index for group in grid.gaskets)])
    if not len(members) or not np.isin(members, inside).all():
        raise card.error(f"'{name}' holds other elements than gaskets, or none; expected gasket elements alone")
    elements = list[IntArray]()
    for group in grid.gaskets:
        own, count = np.isin(group.index, members), group.type.nodes // 2
        tables.append(group.nodes[own, half * count : (half + 1) * count])
        elements.append(group.index[own])
    keys, lacking = known.faces.with_nodes(tables)
    if lacking.any():
        element, side = int(np.concatenate(elements)[lacking.argmax()]), ("first", "last")[half]
        raise grid.at(element).error(
            f"the {side} nodes of element {grid.elements.labels[element]} are no face of a solid element; expected "
            "gaskets whose nodes are those of the bodies on both sides, bottom first"
        )
    label = f"{name} {('bottom', 'top')[half]}"
    surface = DeckSurface(name=known.places.at_faces(keys, label)[0], keys=keys, given=None, faces=known.faces)
    known.surfaces.add(surface, card)
    return surface.name


def _gap(card: Card, known: Known) -> str | float:
    """The initial gap of a section, which closes before anything is pressed."""
    for row in card.rows():
        if row.number(2, "the initial void", 0.0):
            raise row.error(f"*{card.keyword}: an initial void is not supported; expected 0 in field 3")
        width, usual = row.number(3, "the width", 0.0), known.sections[0].thickness
        if width and known.dimension == 2 and width != usual:
            raise row.error(f"*{card.keyword}: is {width:g} wide, bodies are {usual:g} thick; expected the same")
        gap = row.number(1, "the initial gap", 0.0)
        if gap < 0.0:
            raise row.error(f"*{card.keyword}: the initial gap is {gap:g}; expected a number >= 0")
        return gap or "zero"
    return "zero"
