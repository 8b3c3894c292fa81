# SPDX-License-Identifier: BSD-3-Clause
"""Bonds of surface interactions, as Abaqus writes them: stiffness, where damage begins, how it goes on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from signorini.deck.inp.card import Card, Row
from signorini.law.cohesion import Cohesion

BOND_WORDS = ("COHESIVE BEHAVIOR", "DAMAGE INITIATION", "DAMAGE EVOLUTION")
"""Keywords that belong to the ``*SURFACE INTERACTION`` before them; those of damage may be of a material instead."""

_INTERACTION_WORDS = ("SURFACE BEHAVIOR", "FRICTION", *BOND_WORDS)
"""Keywords that may stand between that one and those of its bond."""

BOND_NOTE = (
    "*COHESIVE BEHAVIOR: surfaces that touch at the beginning are bonded and open by tension alone; beyond the "
    "strength along them a bond that softens ends the history by name; its stiffness counts under pressure and behind "
    "it, too"
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Bond:
    """What the keywords of a bond say so far.

    Attributes
    ----------
    card : where it begins
    compliances : normal and tangential, length per pressure
    strengths : in tension and along the sides, force per area; None before damage is told
    opening : beyond where damage begins, length, at which the bond is gone; None where the energy is given
    energy : per area that its opening takes, or None
    """

    card: Card
    compliances: tuple[float, float] = (0.0, 0.0)
    strengths: tuple[float, float] | None = None
    opening: float | None = None
    energy: float | None = None

    @property
    def cohesion(self) -> Cohesion:
        """The bond.

        Raises
        ------
        DeckError
            Where its damage is not told.
        """
        if self.strengths is None or (self.opening is None and self.energy is None):
            lacks = "*DAMAGE INITIATION" if self.strengths is None else "*DAMAGE EVOLUTION"
            raise self.card.error(f"has no {lacks}, and never breaks; expected it, or PRESSURE-OVERCLOSURE=TIED")
        strength, along = self.strengths
        if self.energy is not None:
            return Cohesion.by_energy(strength, energy=self.energy, shear_strength=along)
        opening = self.opening + strength * self.compliances[0] if self.opening else 0.0
        return Cohesion(strength, opening=opening, shear_strength=along)


def bonds_apart(cards: Sequence[Card]) -> tuple[list[Card], list[Card]]:
    """Cards that are of no bond, and those that surface interactions may have, bonds among them; each in order.

    Parameters
    ----------
    cards : of the deck, outside its steps
    """
    others, of_interactions, inside = [], [], False
    for card in cards:
        inside = card.keyword == "SURFACE INTERACTION" or (inside and card.keyword in _INTERACTION_WORDS)
        bond = card.keyword in BOND_WORDS
        if not bond or not inside:
            others.append(card)
        if not bond or inside:
            of_interactions.append(card)
    return others, of_interactions


def with_bond(bond: Bond | None, card: Card) -> Bond:
    """What a bond is with one more of its keywords."""
    if card.keyword == "COHESIVE BEHAVIOR":
        return Bond(card=card, compliances=_compliances(card))
    if bond is None:
        raise card.error("stands before any *COHESIVE BEHAVIOR of its surface interaction")
    if card.keyword == "DAMAGE INITIATION":
        return replace(bond, strengths=_strengths(card))
    return _evolving(bond, card)


def _compliances(card: Card) -> tuple[float, float]:
    """Normal and tangential, 0 where no stiffness is given."""
    card.refuse_unknown(("TYPE", "ELIGIBILITY"))
    card.choice("TYPE", ("UNCOUPLED",), "UNCOUPLED")
    card.choice("ELIGIBILITY", ("CURRENT CONTACTS", "ORIGINAL CONTACTS"), "CURRENT CONTACTS")
    rows = list(card.rows())
    if not rows:
        return 0.0, 0.0
    normal, along = _alike(rows[0], "the stiffness, traction per separation,")
    return 1.0 / normal, 1.0 / along


def _strengths(card: Card) -> tuple[float, float]:
    """In tension and along the sides."""
    card.refuse_unknown(("CRITERION",))
    card.choice("CRITERION", ("MAXS",), "MAXS")
    return _alike(card.row("the strengths"), "the strength")


def _evolving(bond: Bond, card: Card) -> Bond:
    """How damage goes on: to an opening, or by an energy."""
    card.refuse_unknown(("TYPE", "SOFTENING", "MIXED MODE BEHAVIOR"))
    card.choice("SOFTENING", ("LINEAR",), "LINEAR")
    card.choice("MIXED MODE BEHAVIOR", ("MODE INDEPENDENT",), "MODE INDEPENDENT")
    kind = card.choice("TYPE", ("DISPLACEMENT", "ENERGY"), "DISPLACEMENT")
    row = card.row("the opening or the energy at which the bond is gone")
    value = row.number(0, f"the {kind.lower()} at which the bond is gone")
    if not value >= 0.0 or (kind == "ENERGY" and value == 0.0):
        raise row.error(f"has {value:g} in field 1; expected a number {'> 0' if kind == 'ENERGY' else '>= 0'}")
    return replace(bond, energy=value) if kind == "ENERGY" else replace(bond, opening=value)


def _alike(row: Row, what: str) -> tuple[float, float]:
    """Values > 0 across the sides and along them, the same in both directions; of the tension where one is given."""
    if any(row.fields[3:]):
        raise row.error(f"{what.rstrip(',')} that depends on temperature is not supported")
    found = [
        row.number(i, f"{what} {along} the sides")
        for i, along in enumerate(("across", "along", "along")[: max(1, len(row.fields))])
    ]
    for i, value in enumerate(found):
        if not value > 0.0:
            raise row.error(f"has {value:g} in field {i + 1}; expected {what.rstrip(',')}, a number > 0")
    if len(found) == 3 and found[1] != found[2]:
        raise row.error(f"has {found[1]:g} and {found[2]:g} along the sides; expected the same in both directions")
    return found[0], found[1] if len(found) > 1 else found[0]
