# SPDX-License-Identifier: BSD-3-Clause
"""Tables that a deck asks for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from signorini.arrays import IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """One table at the end of one step.

    Attributes
    ----------
    step : index of the step, from 0
    of : what has the values
    place : name of the set or surfaces
    members : indices of nodes or cells; of a contact its index
    quantities : as decks spell them, in capitals: "U", "RF"; "S"; "CDIS", "CSTR", "CF"
    totals : "no", "yes": the sum of forces too, "only"
    """

    step: int
    of: Literal["nodes", "cells", "contact"]
    place: str
    members: IntArray
    quantities: tuple[str, ...]
    totals: Literal["no", "yes", "only"] = "no"
