# SPDX-License-Identifier: BSD-3-Clause
"""Tables that a deck asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from signorini.arrays import Array, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """Tables of one place at the end of one step.

    Attributes
    ----------
    step : index of the step, from 0
    of : what has the values
    place : name of the set; of contact forces the two surfaces
    members : indices of nodes, cells or contacts
    quantities : as decks spell them, in capitals: "U", "RF"; "S", "E", "PEEQ", "PE"; "CDIS", "CSTR", "CELS", "CF",
        "CFN", "CFS"
    totals : "no", "yes": the sum too, "only"
    rotations : nodes that stand for the rotation of a rigid body, with its name
    axes : of nodes: index of a member to the unit vectors (d, d) that its components are along, where not x, y, z
    """

    step: int
    of: Literal["nodes", "cells", "contacts"]
    place: str
    members: IntArray
    quantities: tuple[str, ...]
    totals: Literal["no", "yes", "only"] = "no"
    rotations: Mapping[int, str] = field(default_factory=dict)
    axes: Mapping[int, Array] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, eq=False)
class Prints:
    """All that a deck asks for.

    Attributes
    ----------
    tables : in the order in which they are printed
    times : (steps,) total time at the end of every step
    """

    tables: tuple[Table, ...]
    times: tuple[float, ...]
