# SPDX-License-Identifier: BSD-3-Clause
"""Whether a solution is the only one: what is proved, and the others that were found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from signorini.short import Short
from signorini.solution.results import ContactResult


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class WellPosedness(Short):
    """Uniqueness of a frictional contact problem.

    Attributes
    ----------
    friction : the largest coefficient; infinite where pairs stick or adhere
    bound : a coefficient below which every load and history has one solution, or None where none is known
    verdict : "unique" (proved, for every load), "one" (proved, for this load), "several" or "not decided"
    words : the same in a sentence
    others : the contacts in other equilibria at the same loads, from the same slips; each certified
    """

    friction: float
    bound: float | None
    verdict: Literal["unique", "one", "several", "not decided"]
    words: str
    others: tuple[tuple[ContactResult, ...], ...] = ()
