# SPDX-License-Identifier: BSD-3-Clause
"""How materials of decks yield: ``*PLASTIC`` and ``*CYCLIC HARDENING``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from signorini.arrays import Array
from signorini.deck.inp.card import Card, Row
from signorini.errors import InputError
from signorini.model.plastic import Plastic

_VOCE_ERROR = 1e-4  # of the first yield stress: what a table misses of Voce's law at most
_VOCE_SPACING = 0.9  # of the spacing at which chords of a parabola would miss that much: the exponential is none
_KINEMATIC_NOTE = "kinematic hardening keeps its slope beyond the last row of *PLASTIC, where CalculiX ends it"
_COMBINED_NOTE = "*PLASTIC, HARDENING=COMBINED: its rows are a line, as CalculiX takes them; Abaqus fits a backstress"
_VOCE_NOTE = "*CYCLIC HARDENING: its parameters become a table of {} rows, within {:g} of the first yield stress"


@dataclass(frozen=True, kw_only=True, eq=False)
class Flow:
    """What a deck says of how a material yields.

    Attributes
    ----------
    card : ``*PLASTIC``
    law : what it means
    notes : how that differs from the deck
    """

    card: Card
    law: Plastic
    notes: tuple[str, ...] = ()


def make_flow(card: Card) -> Flow:
    """Read ``*PLASTIC``: a table of yield stress and plastic strain, or parameters of backstresses.

    Raises
    ------
    DeckError
        For curves that soften or jump, and for kinematic curves that are no line or depend on temperature.
    """
    card.refuse_unknown(("HARDENING", "DATA TYPE", "NUMBER BACKSTRESSES"))
    hardening = card.choice("HARDENING", ("ISOTROPIC", "KINEMATIC", "COMBINED"), "ISOTROPIC")
    if hardening == "COMBINED" and "DATA TYPE" in card.parameters:
        card.choice("DATA TYPE", ("PARAMETERS",), "")
        return Flow(card=card, law=_with_backstresses(card))
    for key in ("DATA TYPE", "NUMBER BACKSTRESSES"):
        if key in card.parameters:
            raise card.error(f"parameter {key} goes with HARDENING=COMBINED and DATA TYPE=PARAMETERS; expected these")
    law, rows = _tabular(card)
    if hardening == "ISOTROPIC" or len(rows) == 1:
        return Flow(card=card, law=law)
    if law.varies_with_heat:
        raise card.error(f"HARDENING={hardening} depends on temperature, which is not supported; expected one")
    if len(rows) > 2:
        raise card.at(rows[2]).error(
            f"HARDENING={hardening} has {len(rows)} rows, and no backstress follows such a curve exactly; expected "
            "two, a line, or HARDENING=COMBINED, DATA TYPE=PARAMETERS with backstresses that fit it"
        )
    (_, first), (strain, last) = law.curve
    if first == last:
        return Flow(card=card, law=Plastic(first))
    prager = Plastic(first, backstresses=(((last - first) / strain, 0.0),))
    notes = (_KINEMATIC_NOTE, _COMBINED_NOTE) if hardening == "COMBINED" else (_KINEMATIC_NOTE,)
    return Flow(card=card, law=prager, notes=notes)


def with_cyclic_hardening(flow: Flow, card: Card) -> Flow:
    """The flow with the yield stress of ``*CYCLIC HARDENING``: a table, or the parameters of Voce's law.

    Parameters
    ----------
    flow : what ``*PLASTIC`` before it says
    card : ``*CYCLIC HARDENING``

    Raises
    ------
    DeckError
        Where it belongs to no combined hardening, or begins at another yield stress.
    """
    card.refuse_unknown(("PARAMETERS",))
    if flow.card.get("HARDENING") != "COMBINED":
        raise card.error("belongs to *PLASTIC, HARDENING=COMBINED; expected that before it")
    first = float(flow.law.curve[0, 1])
    notes: tuple[str, ...] = ()
    if "PARAMETERS" in card.parameters:
        law = _voce(card)
        notes = (_VOCE_NOTE.format(len(law.curve), _VOCE_ERROR),) if len(law.curve) > 1 else ()
    else:
        law, _ = _tabular(card)
    if law.varies_with_heat:
        raise card.error("depends on temperature, which is not supported; expected one")
    if law.curve[0, 1] != first:
        raise card.at(card.row("a yield stress")).error(
            f"begins at the yield stress {law.curve[0, 1]:g}, *PLASTIC at {first:g}; expected the same"
        )
    whole = replace(flow.law, yield_stress=law.yield_stress)
    return replace(flow, law=whole, notes=(*flow.notes, *notes))


def _tabular(card: Card) -> tuple[Plastic, Sequence[Row]]:
    """The law of rows of stress, plastic strain and temperature."""
    rows = list(card.rows())
    if not rows:
        raise card.error("has no data line; expected yield stress and plastic strain")
    words = ((1, "the plastic strain", 0.0), (0, "the yield stress", None), (2, "the temperature", 0.0))
    curve = [tuple(row.number(*word) for word in words) for row in rows]
    varies = len({row[2] for row in curve}) > 1
    try:
        return Plastic(tuple(row if varies else row[:2] for row in curve)), rows
    except InputError as error:
        _, i, column = error.where
        what = ("plastic strain", "yield stress", "temperature")[int(column)]
        raise card.at(rows[int(i)]).error(f"the {what} {error.message}") from error


def above_initial(law: Plastic, card: Card, initial: Array) -> Plastic:
    """The law in temperatures above the initial one, as loads have them.

    Parameters
    ----------
    law : in temperatures of the deck
    card : ``*PLASTIC``, for errors
    initial : (n,) temperatures of the nodes of the body at the beginning

    Raises
    ------
    DeckError
        Where they differ: the law would be another one at every node.
    """
    if not law.varies_with_heat or not initial.any():
        return law
    if np.ptp(initial):
        raise card.error(
            f"the yield stress depends on temperature, and the body begins at temperatures from {initial.min():g} to "
            f"{initial.max():g}; expected one in *INITIAL CONDITIONS"
        )
    return replace(law, yield_stress=np.array(law.yield_stress) - [0.0, 0.0, initial[0]])


def _with_backstresses(card: Card) -> Plastic:
    """sigma_0, C_1, gamma_1, ... of as many backstresses as there are, in as many lines as that takes."""
    given = card.get("NUMBER BACKSTRESSES", "1")
    if not given.isdigit() or not 1 <= int(given) <= 10:
        raise card.error(f"NUMBER BACKSTRESSES is '{given}'; expected a whole number from 1 to 10")
    values = _parameters(card, 1 + 2 * int(given), "the yield stress, then C and gamma of every backstress")
    return _law(card, values[0], backstresses=tuple(zip(values[1::2], values[2::2], strict=True)))


def _voce(card: Card) -> Plastic:
    """``sigma_0 + Q (1 - exp(-b p))`` as rows at equal steps of ``exp(-b p / 2)``, which chords miss equally."""
    first, rise, rate = _parameters(card, 3, "the yield stress, its rise Q and the rate b")
    if rise < 0.0 or rate < 0.0:
        raise card.error(f"Q is {rise:g} and b {rate:g}: the material softens; expected numbers >= 0")
    constant, allowed = _law(card, first), _VOCE_ERROR * first
    if rise * rate == 0.0 or rise <= allowed:
        return constant
    end = np.sqrt(allowed / rise)  # beyond the last row the rest of the rise is missing
    count = 2 + int((1.0 - end) / (_VOCE_SPACING * np.sqrt(2.0) * end))
    root = np.linspace(1.0, end, count)
    return _law(card, np.column_stack([2.0 / rate * np.log(1.0 / root), first + rise * (1.0 - root**2)]))


def _parameters(card: Card, count: int, what: str) -> list[float]:
    """Numbers through all data lines; one more is the temperature that they belong to."""
    fields = [(row, i) for row in card.rows() for i in range(len(row.fields))]
    if len(fields) not in (count, count + 1):
        raise card.error(f"has {len(fields)} numbers; expected {count}: {what}, at one temperature")
    return [row.number(i, what) for row, i in fields[:count]]


def _law(card: Card, yield_stress: Any, **parts: Any) -> Plastic:
    """The law of parameters; what is wrong is said of the keyword."""
    try:
        return Plastic(yield_stress, **parts)
    except InputError as error:
        if error.where[0] == "yield_stress":
            raise card.error(f"the yield stress {error.message}") from error
        _, i, column = error.where
        raise card.error(f"{('C', 'gamma')[int(column)]} of backstress {int(i) + 1} {error.message}") from error
