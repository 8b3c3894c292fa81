# SPDX-License-Identifier: BSD-3-Clause
"""A problem with what is known about it."""

from __future__ import annotations

from dataclasses import dataclass, field

from signorini.arrays import Array
from signorini.lcp.residual import Matrix


@dataclass(frozen=True, kw_only=True)
class PosedLCP:
    """``0 <= z  _|_  w = M z + q >= 0`` with its source, its class and, where known, its answer.

    Attributes
    ----------
    name : short and unique in the bank
    source : where it stands in the literature, or how it was made
    M, q : the data
    answer : (n,) a solution, or None where none is known or none exists
    unique : whether the answer is the only one
    solvable : whether a solution exists
    covering : (n,) the vector that Lemke's method needs here, or None
    traits : words out of "P", "positive definite", "monotone", "symmetric", "Z", "contact", "game",
        "copositive plus"
    """

    name: str
    source: str
    M: Matrix
    q: Array
    answer: Array | None = None
    unique: bool = False
    solvable: bool = True
    covering: Array | None = None
    traits: frozenset[str] = field(default_factory=frozenset)

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return len(self.q)
