# SPDX-License-Identifier: BSD-3-Clause
"""Keywords that are read, and that can be left out without changing the answer; finding them, and what they name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Protocol, TypeVar

from signorini.deck.inp.card import Card
from signorini.deck.inp.refusals import ADVICE, Refusals
from signorini.errors import one_of

# fmt: off
_OUTPUT = (
    "CONTACT OUTPUT", "ELEMENT OUTPUT", "ENERGY FILE", "ENERGY OUTPUT", "ENERGY PRINT", "FACE PRINT", "FILE FORMAT",
    "FILE OUTPUT", "FILTER", "MONITOR", "NODE OUTPUT", "OUTPUT", "PREPRINT", "PRINT", "RESTART", "SECTION FILE",
    "SECTION PRINT", "TIME POINTS", "USER OUTPUT VARIABLES",
)
"""Requests for output that is not written here: they do not change the answer."""

PRINTED = ("CONTACT FILE", "CONTACT PRINT", "EL FILE", "EL PRINT", "NODE FILE", "NODE PRINT")
"""Requests for output that is written: ``.frd`` always, ``.dat`` as asked for."""

HARMLESS = (
    *_OUTPUT, "CONDUCTIVITY", "CONTACT CONTROLS", "CONTACT CONTROLS ASSIGNMENT", "CONTACT FORMULATION",
    "CONTACT STABILIZATION", "CONTROLS", "DAMPING", "DIAGNOSTICS",
    "GAP CONDUCTANCE", "GAP HEAT GENERATION", "GASKET CONTACT AREA", "HOURGLASS STIFFNESS", "PHYSICAL CONSTANTS",
    "SECTION CONTROLS", "SOLUTION TECHNIQUE", "SPECIFIC HEAT",
)
"""Keywords that do not act in a static analysis of displacements, or tell other programs how to find the answer."""

MODEL_WORDS = (
    "AMPLITUDE", "BOUNDARY", "CLEARANCE", "CONTACT", "CONTACT EXCLUSIONS", "CONTACT INCLUSIONS", "CONTACT PAIR",
    "CONTACT PROPERTY ASSIGNMENT", "COUPLING", "CYCLIC HARDENING",
    "CYCLIC SYMMETRY MODEL", "DENSITY", "DISTRIBUTING",
    "ELASTIC", "ELEMENT", "ELSET", "EQUATION", "EXPANSION", "FRICTION", "GASKET BEHAVIOR",
    "GASKET ELASTICITY", "GASKET SECTION", "GASKET THICKNESS BEHAVIOR", "HEADING", "INITIAL CONDITIONS", "KINEMATIC",
    "MATERIAL", "NODE", "NSET", "ORIENTATION", "PLASTIC", "PRE-TENSION SECTION", "RIGID BODY", "SOLID SECTION",
    "SURFACE", "SURFACE BEHAVIOR", "SURFACE INTERACTION", "TIE", "TRANSFORM",
)
"""Keywords that are read outside the steps."""

STEP_WORDS = (
    *PRINTED, "AMPLITUDE", "BOUNDARY", "CHANGE CONTACT PAIR", "CHANGE FRICTION", "CLOAD", "DLOAD", "DSLOAD",
    "ELSET", "FRICTION", "MODEL CHANGE", "NSET", "STATIC", "TEMPERATURE", "VISCO",
)
"""Keywords that are read inside the steps."""

MODES_WORDS = ("FREQUENCY",)
"""Keywords of a step that asks for natural modes, which is taken out before the others are read."""

STRUCTURE = (
    "ASSEMBLY", "END ASSEMBLY", "END INSTANCE", "END PART", "END STEP", "INCLUDE", "INSTANCE", "PART", "STEP",
)
"""Keywords that order the others."""

_PARAMETERS = (
    "ALL EXTERIOR", "AUGMENTED LAGRANGE", "CONSTRAINT NAME", "CONVERT SDI", "CYCLIC SYMMETRY", "DATA TYPE",
    "ELASTIC SLIP", "EXTENSION ZONE", "LOAD CASE", "LONG TERM", "NUMBER BACKSTRESSES", "PIN NSET",
    "POSITION TOLERANCE", "REF NODE", "ROT NODE", "MECHANICAL CONSTRAINT", "SLIP TOLERANCE", "SMALL SLIDING",
    "TIE NSET", "TIME RESET", "TOTAL TIME AT START",
)
# fmt: on
_KNOWN = {word.replace(" ", ""): word for word in (*HARMLESS, *MODEL_WORDS, *STEP_WORDS, *STRUCTURE, *_PARAMETERS)}


def canonical(word: str) -> str:
    """A keyword or parameter in capitals with single blanks where its parts meet.

    >>> canonical(" solidSection"), canonical("unknown  word")
    ('SOLID SECTION', 'UNKNOWN WORD')
    """
    parts = word.upper().split()
    return _KNOWN.get("".join(parts), " ".join(parts))


class _WithName(Protocol):
    @property
    def name(self) -> str: ...


Named = TypeVar("Named", bound=_WithName)


def of_keyword(cards: Sequence[Card], keyword: str) -> Iterator[Card]:
    """Cards of one keyword."""
    return (card for card in cards if card.keyword == keyword)


def look_up(card: Card, key: str, found: Mapping[str, Named], what: str) -> Named:
    """What a parameter of a card names.

    Parameters
    ----------
    card, key : the keyword and its parameter
    found : what there is, by name in capitals
    what : a word for it in messages
    """
    name = card.value(key)
    if name.upper() not in found:
        raise card.error(one_of(name, [item.name for item in found.values()], what))
    return found[name.upper()]


def refuse_unsupported(cards: Sequence[Card], known: Sequence[str], where: str, refusals: Refusals) -> dict[str, int]:
    """Keywords among the cards that are left out, with the line of the first of each; what changes the answer stops.

    Parameters
    ----------
    cards : that stand there
    known : keywords that are read there
    where : words for the place, as "in a step"
    refusals : gathers those of keywords that would change the answer
    """
    ignored: dict[str, int] = {}
    for card in cards:
        keyword = card.keyword
        if keyword in PRINTED:
            continue
        if keyword in HARMLESS:
            ignored.setdefault(keyword, card.line)
        elif keyword not in known:
            with refusals.gather():
                raise card.error(unsupported(keyword, where))
    return ignored


def unsupported(keyword: str, where: str) -> str:
    """Why a keyword stops a deck, and what to write instead; ``where`` is where it is not read, in words."""
    if keyword in MODEL_WORDS or keyword in STEP_WORDS:
        return f"is not supported {where}"
    advice = f"; {ADVICE[keyword]}" if keyword in ADVICE else ""
    return f"is not supported, and it may change the answer{advice}"


def collect(
    cards: Sequence[Card],
    opening: str,
    words: Sequence[str],
    begun: Callable[[Card], Named],
    extended: Callable[[Named, Card], Named],
    refusals: Refusals,
) -> dict[str, Named]:
    """All that a keyword begins, by name in capitals.

    Parameters
    ----------
    cards : of the deck, outside its steps
    opening : the keyword, with a NAME
    words : keywords that belong to the last one before them
    begun : what the keyword alone says
    extended : what it says with one of the words
    refusals : gathers those of single cards
    """
    found: dict[str, Named] = {}
    current: str | None = None
    opened = False
    for card in cards:
        with refusals.gather():
            if card.keyword == opening:
                opened, current = True, None
                first, name = begun(card), card.value("NAME").upper()
                if name in found:
                    raise card.error(f"there is another {opening.lower()} '{card.value('NAME')}'")
                found[name], current = first, name
            elif card.keyword in words:
                if not opened:
                    raise card.error(f"stands before any *{opening}")
                if current is not None:
                    found[current] = extended(found[current], card)
    return found
