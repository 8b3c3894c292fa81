# SPDX-License-Identifier: BSD-3-Clause
"""Words of decks, whose blanks and case do not matter: which they are here."""

from __future__ import annotations

from signorini.deck.inp.keywords import HARMLESS, MODEL_WORDS, STEP_WORDS, STRUCTURE

_PARAMETERS = (
    "AUGMENTED LAGRANGE",
    "CONSTRAINT NAME",
    "CONVERT SDI",
    "ELASTIC SLIP",
    "EXTENSION ZONE",
    "LOAD CASE",
    "LONG TERM",
    "PIN NSET",
    "POSITION TOLERANCE",
    "REF NODE",
    "ROT NODE",
    "MECHANICAL CONSTRAINT",
    "SLIP TOLERANCE",
    "SMALL SLIDING",
    "TIE NSET",
    "TIME RESET",
    "TOTAL TIME AT START",
)
_KNOWN = {word.replace(" ", ""): word for word in (*HARMLESS, *MODEL_WORDS, *STEP_WORDS, *STRUCTURE, *_PARAMETERS)}


def canonical(word: str) -> str:
    """A keyword or parameter in capitals with single blanks where its parts meet.

    >>> canonical(" solidSection"), canonical("unknown  word")
    ('SOLID SECTION', 'UNKNOWN WORD')
    """
    parts = word.upper().split()
    return _KNOWN.get("".join(parts), " ".join(parts))
