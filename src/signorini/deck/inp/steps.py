# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a deck: which keywords belong to each, its times and its increments."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from signorini.deck.inp.card import Card, to_number
from signorini.deck.inp.keywords import HARMLESS, STEP_WORDS, unsupported
from signorini.deck.inp.refusals import Refusals

_MAX_INCREMENTS = 100_000  # of a step: more are no path but a mistake in the units of time
IGNORED = ("INC", "INCF", "NAME", "UNSYMM", "SOLVER", "CONVERT SDI", "EXTRAPOLATION", "PERTURBATION MASS")


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckStep:
    """One ``*STEP``.

    Attributes
    ----------
    card : where it begins
    name : as given, or ``"step 1"``
    start, end : total time, which ``TIME RESET`` takes back by the period and ``TOTAL TIME AT START`` sets
    increments : that the deck asks for at first: its period over its first increment
    held : loads without an amplitude act at once (``AMPLITUDE=STEP``)
    nlgeom : large displacements are asked for
    cards : the keywords in it
    """

    card: Card
    name: str
    start: float
    end: float
    increments: int
    held: bool
    nlgeom: bool
    cards: tuple[Card, ...]

    @property
    def period(self) -> float:
        """Its length in time."""
        return self.end - self.start


def split_steps(cards: list[Card], refusals: Refusals) -> tuple[list[Card], list[DeckStep]]:
    """Keywords before and between the steps, and the steps but those that are refused."""
    outside: list[Card] = []
    inside: list[tuple[Card, list[Card]]] = []
    members = outside
    for card in cards:
        if card.keyword == "STEP":
            if members is not outside:
                raise card.error("begins before the step before it has ended; expected *END STEP")
            members = []
            inside.append((card, members))
        elif card.keyword == "END STEP":
            if members is outside:
                raise card.error("ends no step")
            members = outside
        else:
            members.append(card)
    if members is not outside:
        raise inside[-1][0].error("is not ended; expected *END STEP")
    steps: list[DeckStep] = []
    for card, members in inside:
        with refusals.gather():
            steps.append(_step(card, members, steps))
    return outside, steps


def _step(card: Card, members: list[Card], before: Sequence[DeckStep]) -> DeckStep:
    card.refuse_unknown(("NLGEOM", "AMPLITUDE"), IGNORED)
    statics = [other for other in members if other.keyword in ("STATIC", "VISCO")]
    if len(statics) != 1:
        other = next((other for other in members if other.keyword not in (*STEP_WORDS, *HARMLESS)), None)
        if not statics and other is not None:
            raise other.error(unsupported(other.keyword, "instead of *STATIC"))
        found = "no *STATIC" if not statics else "two *STATIC"
        raise card.error(f"has {found}; expected one: only static steps can be solved")
    static = statics[0]
    static.refuse_unknown(
        ("SOLVER", "DIRECT", "TIME RESET", "TOTAL TIME AT START"),
        ("STABILIZE", "FACTOR", "ALLSDTOL", "CONTINUE", "FULLY PLASTIC", "CETOL"),
    )
    row = next(static.rows(), None)
    first = row.number(0, "the first increment", 1.0) if row else 1.0
    period = row.number(1, "the period", 1.0) if row else 1.0
    first, period = first or 1.0, period or 1.0
    if not (first > 0.0 and period > 0.0):
        raise static.error(f"has the increment {first:g} and the period {period:g}; expected numbers > 0")
    start = before[-1].end if before else 0.0
    if "TOTAL TIME AT START" in static.parameters:
        given = to_number(static.value("TOTAL TIME AT START", "a time"))
        if given is None:
            raise static.error(f"TOTAL TIME AT START={static.get('TOTAL TIME AT START')}: expected a time, a number")
        start = given
    if "TIME RESET" in static.parameters:
        start -= period
    if not start < start + period < math.inf:
        raise static.error(f"has the period {period:g} after {start:g}; expected one that can be added to that")
    nlgeom = "NLGEOM" in card.parameters and card.get("NLGEOM") != "NO"
    if "NLGEOM" not in card.parameters and before:
        nlgeom = before[-1].nlgeom
    return DeckStep(
        card=card,
        name=card.parameters.get("NAME", "") or f"step {len(before) + 1}",
        start=start,
        end=start + period,
        increments=max(1, math.ceil(min(period / first, _MAX_INCREMENTS) - 1e-6)),
        held=card.choice("AMPLITUDE", ("RAMP", "STEP"), "RAMP") == "STEP",
        nlgeom=nlgeom,
        cards=tuple(members),
    )
