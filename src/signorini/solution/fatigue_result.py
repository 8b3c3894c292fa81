# SPDX-License-Identifier: BSD-3-Clause
"""What a fatigue criterion says at places of the bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, IntArray
from signorini.model.fatigue import Fatigue
from signorini.short import Short


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
    def worst(self) -> int:
        """The place with the largest parameter."""
        return int(self.parameter.argmax())

    @property
    def planes(self) -> bool:
        """Whether the criterion knows critical planes."""
        return bool(np.isfinite(self.plane).any())

    @property
    def lives(self) -> bool:
        """Whether lives are known."""
        return not bool(np.isnan(self.life).any())
