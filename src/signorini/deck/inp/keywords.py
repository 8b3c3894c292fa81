# SPDX-License-Identifier: BSD-3-Clause
"""Which keywords are read, which can be left out without changing the answer, and which cannot."""

from __future__ import annotations

from collections.abc import Sequence

from signorini.deck.inp.flatten import Placed
from signorini.deck.inp.interactions import INTERACTION_WORDS
from signorini.deck.inp.materials import MATERIAL_WORDS

OUTPUT = (
    "CONTACT FILE",
    "CONTACT OUTPUT",
    "CONTACT PRINT",
    "EL FILE",
    "EL PRINT",
    "ELEMENT OUTPUT",
    "ENERGY FILE",
    "ENERGY OUTPUT",
    "ENERGY PRINT",
    "FACE PRINT",
    "FILE FORMAT",
    "FILE OUTPUT",
    "FILTER",
    "MONITOR",
    "NODE FILE",
    "NODE OUTPUT",
    "NODE PRINT",
    "OUTPUT",
    "PREPRINT",
    "PRINT",
    "RESTART",
    "SECTION FILE",
    "SECTION PRINT",
    "TIME POINTS",
    "USER OUTPUT VARIABLES",
)
"""What to write, which does not change the answer."""

HARMLESS = (
    *OUTPUT,
    "CONDUCTIVITY",
    "CONTACT CONTROLS",
    "CONTACT STABILIZATION",
    "CONTROLS",
    "DAMPING",
    "DIAGNOSTICS",
    "GAP CONDUCTANCE",
    "GAP HEAT GENERATION",
    "HOURGLASS STIFFNESS",
    "PHYSICAL CONSTANTS",
    "SECTION CONTROLS",
    "SOLUTION TECHNIQUE",
    "SPECIFIC HEAT",
)
"""What does not act in a static analysis of displacements, and how other programs find the answer."""

MODEL_WORDS = (
    "AMPLITUDE",
    "BOUNDARY",
    "CLEARANCE",
    "CONTACT PAIR",
    "ELEMENT",
    "ELSET",
    "HEADING",
    "MATERIAL",
    "NODE",
    "NSET",
    "SOLID SECTION",
    "SURFACE",
    "SURFACE INTERACTION",
    *INTERACTION_WORDS,
    *MATERIAL_WORDS,
)
"""What is read outside the steps."""

STEP_WORDS = ("BOUNDARY", "CLOAD", "DLOAD", "DSLOAD", "NSET", "ELSET", "STATIC")
"""What is read inside the steps."""


def refuse_unsupported(placed: Sequence[Placed], known: Sequence[str], where: str) -> dict[str, int]:
    """Stop at the first keyword that changes the answer and is not read.

    Parameters
    ----------
    known : keywords that are read here
    where : words for the place, as "in a step"

    Returns
    -------
    Keywords that are left out and the line of the first of each

    Raises
    ------
    DeckError
        With the line of the keyword.
    """
    ignored: dict[str, int] = {}
    for item in placed:
        keyword = item.block.keyword
        if keyword in HARMLESS:
            ignored.setdefault(keyword, item.block.line)
        elif keyword not in known:
            elsewhere = keyword in MODEL_WORDS or keyword in STEP_WORDS
            what = f"is not supported {where}" if elsewhere else "is not supported, and it may change the answer"
            raise item.block.error(what)
    return ignored
