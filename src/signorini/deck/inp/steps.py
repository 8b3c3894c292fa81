# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a deck: which keywords belong to each, its times and its increments."""

from __future__ import annotations

import math
from dataclasses import dataclass

from signorini.deck.inp.card import Card, to_number
from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.keywords import HARMLESS, STEP_WORDS

_MOST = 100_000  # increments of a step
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
    placed : the keywords in it
    """

    card: Card
    name: str
    start: float
    end: float
    increments: int
    held: bool
    nlgeom: bool
    placed: tuple[Placed, ...]

    @property
    def period(self) -> float:
        """Its length in time."""
        return self.end - self.start


def split_steps(placed: list[Placed]) -> tuple[list[Placed], list[DeckStep]]:
    """Keywords before and between the steps, and the steps.

    Raises
    ------
    DeckError
        If a step is not ended or is anything but static.
    """
    model: list[Placed] = []
    inside: list[tuple[Placed, list[Placed]]] = []
    open_ = False
    for item in placed:
        keyword = item.card.keyword
        if keyword == "STEP":
            if open_:
                raise item.card.error("begins before the step before it has ended; expected *END STEP")
            inside.append((item, []))
            open_ = True
        elif keyword == "END STEP":
            if not open_:
                raise item.card.error("ends no step")
            open_ = False
        else:
            (inside[-1][1] if open_ else model).append(item)
    if open_:
        raise inside[-1][0].card.error("is not ended; expected *END STEP")
    steps: list[DeckStep] = []
    for number, (item, members) in enumerate(inside, start=1):
        start = steps[-1].end if steps else 0.0
        steps.append(_step(item.card, number, members, start, steps[-1] if steps else None))
    return model, steps


def _step(card: Card, number: int, members: list[Placed], start: float, before: DeckStep | None) -> DeckStep:
    card.refuse_unknown(("NLGEOM", "AMPLITUDE"), IGNORED)
    statics = [item.card for item in members if item.card.keyword == "STATIC"]
    if len(statics) != 1:
        other = next((m.card for m in members if m.card.keyword not in (*STEP_WORDS, *HARMLESS)), None)
        if not statics and other is not None:
            raise other.error("is not supported; expected *STATIC")
        found = "no *STATIC" if not statics else "two *STATIC"
        raise card.error(f"has {found}; expected one: only static steps can be solved")
    static = statics[0]
    static.refuse_unknown(
        ("SOLVER", "DIRECT", "TIME RESET", "TOTAL TIME AT START"),
        ("STABILIZE", "FACTOR", "ALLSDTOL", "CONTINUE", "FULLY PLASTIC"),
    )
    row = next(static.rows(), None)
    first = row.number(0, "the first increment", 1.0) if row else 1.0
    period = row.number(1, "the period", 1.0) if row else 1.0
    first, period = first or 1.0, period or 1.0
    if not (first > 0.0 and period > 0.0):
        raise static.error(f"has the increment {first:g} and the period {period:g}; expected numbers > 0")
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
    if "NLGEOM" not in card.parameters and before is not None:
        nlgeom = before.nlgeom
    return DeckStep(
        card=card,
        name=card.parameters.get("NAME", "") or f"step {number}",
        start=start,
        end=start + period,
        increments=max(1, math.ceil(min(period / first, _MOST) - 1e-6)),
        held=card.choice("AMPLITUDE", ("RAMP", "STEP"), "RAMP") == "STEP",
        nlgeom=nlgeom,
        placed=tuple(members),
    )
