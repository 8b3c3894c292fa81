# SPDX-License-Identifier: BSD-3-Clause
"""What a fatigue criterion says at places of the bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray, elsewhere, in_blocks, stored
from signorini.model.fatigue import Fatigue
from signorini.short import Short

PER_PLACE = ("body", "node", "points", "parameter", "amplitude", "stress", "plane", "life")
"""What of a `FatigueResult` has a row for every place."""


@elsewhere(*PER_PLACE)
@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FatigueResult(Short):
    """A fatigue criterion at p places.

    Attributes
    ----------
    request : the criterion, where and over which steps
    steps : that were looked at, by name
    moments : of the history, between which it is linear on exact paths
    exact : whether the paths of the steps are
    body : (p,) name of the body of every place
    node : (p,) index of the node, from 0; -1 at points that are none
    points : (p, d) undeformed coordinates on the surface, above critical distances, length
    parameter : (p,) see the criterion for its units
    amplitude, stress : (p,) its two terms, see `FatigueCriterion.terms`
    plane : (p, 3) unit normal of the critical plane; NaN of criteria that know none
    life : (p,) cycles to failure, infinite where nothing fails; NaN without constants
    """

    request: Fatigue
    steps: tuple[str, ...]
    moments: int
    exact: bool
    body: NDArray[np.str_]
    node: IntArray
    points: Array
    parameter: Array
    amplitude: Array
    stress: Array
    plane: Array
    life: Array

    @property
    def name(self) -> str:
        """Of the criterion."""
        return self.request.criterion.name

    @property
    def count(self) -> int:
        """Of places."""
        return int(stored(self, "parameter").shape[0])

    @property
    def worst(self) -> int:
        """The place with the largest parameter, of equal ones the first."""
        ends = [(first + k, rows[k]) for first, rows in in_blocks(stored(self, "parameter")) for k in _most(rows)]
        return ends[int(np.argmax([value for _, value in ends]))][0]

    @property
    def planes(self) -> bool:
        """Whether the criterion knows critical planes."""
        return any(bool(np.isfinite(rows).any()) for _, rows in in_blocks(stored(self, "plane")))

    @property
    def lives(self) -> bool:
        """Whether lives are known."""
        return not any(bool(np.isnan(rows).any()) for _, rows in in_blocks(stored(self, "life")))

    @property
    def at_worst(self) -> FatigueResult:
        """At the place with the largest parameter alone."""
        return self.among(np.array([self.worst]))

    def among(self, places: IntArray) -> FatigueResult:
        """At some of the places.

        Parameters
        ----------
        places : (k,) their numbers
        """
        return replace(self, **{name: stored(self, name)[places] for name in PER_PLACE})


def _most(values: Array) -> list[int]:
    """The first of the largest of some values, if there are any."""
    return [int(values.argmax())] if len(values) else []
