# SPDX-License-Identifier: BSD-3-Clause
"""Lines of the verification table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import SupportsFloat

import numpy as np

from signorini.arrays import Array

Row = tuple[str, SupportsFloat, SupportsFloat, float] | tuple[str, SupportsFloat, SupportsFloat, float, str]
"""Of :func:`checks_of`."""


@dataclass(frozen=True, kw_only=True)
class Check:
    """A computed value, what it should be, and how far it may be off.

    Attributes
    ----------
    case, quantity : in words
    computed, reference : in the units of the case
    tolerance : of the error, relative where the reference is not 0
    source : of the reference
    least : the reference is a lower bound: more is no error

    Examples
    --------
    >>> Check(case="P1", quantity="pressure", computed=1.01, reference=1.0, tolerance=0.02, source="exact").passed
    True
    """

    case: str
    quantity: str
    computed: float
    reference: float
    tolerance: float
    source: str
    least: bool = False

    @property
    def error(self) -> float:
        """Relative to the reference, absolute where that is 0."""
        if self.least and self.computed > self.reference:
            return 0.0
        return abs(self.computed - self.reference) / (abs(self.reference) or 1.0)

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance (not a number: no)."""
        return bool(self.error <= self.tolerance)

    def row(self) -> dict[str, str | float | bool]:
        """As written to JSON."""
        names = ("case", "quantity", "computed", "reference", "error", "tolerance", "source", "passed")
        return {name: getattr(self, name) for name in names} | {"at_least": self.least}


def checks_of(case: str, *rows: Row, source: str = "", least: bool = False) -> Iterator[Check]:
    """Checks of one case.

    Parameters
    ----------
    case : in words
    rows : quantity, computed, reference, tolerance; and the source where it is not that of all
    source : of the references
    least : references are lower bounds

    Examples
    --------
    >>> rows = (("pressure", 1.25, 1.0, 0.02), ("gap", 0.0, 0.0, 1e-9))
    >>> [check.error for check in checks_of("P1", *rows, source="exact")]
    [0.25, 0.0]
    """
    for quantity, computed, reference, tolerance, *own in rows:
        yield Check(
            case=case,
            quantity=quantity,
            computed=float(computed),
            reference=float(reference),
            tolerance=tolerance,
            source=own[0] if own else source,
            least=least,
        )


def farthest(values: Array, exact: float) -> float:
    """The value that is farthest from what all of them should be."""
    return float(values[np.abs(values - exact).argmax()])
