# SPDX-License-Identifier: BSD-3-Clause
"""The laws of contact by name."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from signorini.deck.inp.bonds import BOND_NOTE, BOND_WORDS, Bond, bonds_apart, with_bond
from signorini.deck.inp.card import Card, Row, to_number
from signorini.deck.inp.keywords import collect
from signorini.deck.inp.refusals import Refusals
from signorini.errors import InputError
from signorini.law.closure import Closure
from signorini.law.friction import TabularFriction

_INTERACTION_WORDS = ("SURFACE BEHAVIOR", "FRICTION", *BOND_WORDS)
"""Keywords that belong to the ``*SURFACE INTERACTION`` before them and that are read here."""

EXPONENTIAL_NOTE = (
    "PRESSURE-OVERCLOSURE=EXPONENTIAL is p0 exp(-ln(100) gap / c0), as in CalculiX, by secants within 1 %; Abaqus "
    "means another curve, that of closure = { clearance = c0, pressure = p0 }"
)

FRICTION_NOTE = (
    "*FRICTION over pressure: between its lines the traction is straight, not the coefficient, and beyond the last it "
    "goes on as between the last two; Abaqus has the coefficient straight, and constant beyond the last"
)

_EXPONENTIAL_TOLERANCE = 0.01  # of the pressure, as of `Closure.exponential`
_EXPONENTIAL_END = 2.0  # of c0: the overlap where p is 10^4 p0, from which on the last secant goes on


@dataclass(frozen=True, kw_only=True, eq=False)
class Interaction:
    """A law of contact.

    Attributes
    ----------
    card : where it begins
    friction : Coulomb's coefficient, "stick", or a table over pressure
    normal_compliance, tangential_compliance : length per pressure
    shear_limit : largest traction of friction, or None
    tied : the surfaces never part
    closure : pressure over overlap as a table, or None
    bond : what is told of a bond, or None
    note : where Abaqus and CalculiX differ, and which of them is followed
    """

    card: Card
    friction: float | Literal["stick"] | TabularFriction = 0.0
    normal_compliance: float = 0.0
    tangential_compliance: float = 0.0
    shear_limit: float | None = None
    tied: bool = False
    closure: Closure | None = None
    bond: Bond | None = None
    note: str = ""

    @property
    def name(self) -> str:
        """Name as the deck spells it; empty of a law that no keyword begins."""
        return self.card.parameters.get("NAME", "")


def make_interactions(cards: Sequence[Card], refusals: Refusals) -> dict[str, Interaction]:
    """Read all ``*SURFACE INTERACTION`` keywords, of Signorini's and Coulomb's law, by name in capitals."""
    _, cards = bonds_apart(cards)
    return collect(cards, "SURFACE INTERACTION", _INTERACTION_WORDS, _begun, _with, refusals)


def _begun(card: Card) -> Interaction:
    card.refuse_unknown(("NAME",))
    return Interaction(card=card)


def _with(law: Interaction, card: Card) -> Interaction:
    if card.keyword in BOND_WORDS:
        return replace(law, bond=with_bond(law.bond, card), note=law.note or BOND_NOTE)
    if card.keyword == "FRICTION":
        friction, compliance = read_friction(card)
        note = "; ".join(filter(None, [law.note, FRICTION_NOTE if isinstance(friction, TabularFriction) else ""]))
        return replace(law, friction=friction, tangential_compliance=compliance, shear_limit=_limit(card), note=note)
    enforcement = ("PENALTY", "AUGMENTED LAGRANGE", "DIRECT", "MECHANICAL CONSTRAINT")  # ours is exact
    card.refuse_unknown(("PRESSURE-OVERCLOSURE",), enforcement)
    kind = card.choice("PRESSURE-OVERCLOSURE", ("HARD", "LINEAR", "TABULAR", "EXPONENTIAL", "TIED"), "HARD")
    if kind == "TIED":
        return replace(law, tied=True)
    if kind == "LINEAR":
        row = card.row("the stiffness, pressure per overlap")
        return replace(law, normal_compliance=1.0 / _positive(row, 0, "the stiffness, pressure per overlap"))
    if kind == "TABULAR":
        return replace(law, closure=_tabular(card))
    if kind == "EXPONENTIAL":
        return replace(law, closure=_exponential(card), note=EXPONENTIAL_NOTE)
    return law


def _tabular(card: Card) -> Closure:
    """Pressures and overlaps, a line each; a first overlap below 0 is a clearance at which pressure begins."""
    points, rows = [], list(card.rows())
    for row in rows:
        if any(row.fields[2:]):
            raise row.error("*SURFACE BEHAVIOR: a table that depends on temperature is not supported")
        points.append((row.number(1, "the overlap"), row.number(0, "the pressure")))
    try:
        return Closure(points)
    except InputError as error:
        place = error.where[1] if len(error.where) > 1 else 0
        at = rows[int(place)] if rows else card
        raise at.error(f"*SURFACE BEHAVIOR: pressure and overlap: {error.message}") from error


def _exponential(card: Card) -> Closure:
    """CalculiX's law by secants: ``p = p_0 exp(-ln(100) gap / c_0)``, less its ten-thousandth part at a gap 2 c_0."""
    row = card.row("the clearance c0 and the pressure p0")
    clearance, pressure = _positive(row, 0, "the clearance c0"), _positive(row, 1, "the pressure p0")
    decay = math.log(100.0)
    law = Closure.secants(
        lambda x: math.exp(decay * x) - math.exp(-2.0 * decay), -2.0, _EXPONENTIAL_END, _EXPONENTIAL_TOLERANCE
    )
    return Closure([(clearance * x, pressure * p) for x, p in law.points])


def read_friction(card: Card) -> tuple[float | Literal["stick"] | TabularFriction, float]:
    """Friction and tangential compliance of a ``*FRICTION``; CalculiX's stick slope is the compliance's inverse."""
    card.refuse_unknown(("ROUGH", "LAGRANGE", "TAUMAX"), ("SLIP TOLERANCE", "ELASTIC SLIP"))
    if "ROUGH" in card.parameters:
        return "stick", 0.0
    rows = list(card.rows())
    if not rows:
        raise card.error("has no data line; expected a coefficient of friction")
    if any(any(row.fields[3:]) for row in rows):
        raise card.error("a coefficient that depends on temperature is not supported")
    coefficients = [row.number(0, "the coefficient of friction") for row in rows]
    for row, value in zip(rows, coefficients, strict=True):
        if value < 0.0:
            raise row.error(f"*FRICTION: the coefficient is {value:g}; expected a number >= 0")
    row = rows[0]
    if len(rows) > 1:
        return _over_pressure(rows, coefficients), 0.0
    slope = _positive(row, 1, "the stick slope, traction per slip") if len(row.fields) > 1 and row.fields[1] else 0.0
    return coefficients[0], 1.0 / slope if slope else 0.0


def _over_pressure(rows: Sequence[Row], coefficients: Sequence[float]) -> TabularFriction:
    """Coefficients over pressures, a line each; from one at no pressure the way to the next goes through their mean."""
    for row in rows:
        if row.number(1, "the slip rate", 0.0) != 0.0:
            raise row.error("*FRICTION: a coefficient that depends on the slip rate is not supported")
    points = [(row.number(2, "the pressure"), mu) for row, mu in zip(rows, coefficients, strict=True)]
    if points[0][0] == 0.0:
        (_, first), (pressure, second) = points[:2]
        points[0] = 0.5 * pressure, 0.5 * (first + second)
    try:
        return TabularFriction(*zip(*points, strict=True))
    except InputError as error:
        place = int(error.where[1]) if len(error.where) > 1 else 0
        raise rows[place].error(f"*FRICTION: {error.where[0]}: {error.message}") from error


def _limit(card: Card) -> float | None:
    """``TAUMAX``, the largest traction of friction."""
    if "TAUMAX" not in card.parameters:
        return None
    limit = to_number(card.value("TAUMAX", "a traction"))
    if limit is None or not limit > 0.0 or "ROUGH" in card.parameters or len(list(card.rows())) > 1:
        raise card.error(f"TAUMAX={card.get('TAUMAX')}: expected a traction > 0, and no ROUGH or table over pressure")
    return limit


def _positive(row: Row, i: int, what: str) -> float:
    value = row.number(i, what)
    if not value > 0.0:
        raise row.error(f"has {value:g} in field {i + 1}; expected {what}, a number > 0")
    return value
