# SPDX-License-Identifier: BSD-3-Clause
"""What the sides of contacts have lost by wear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.interface.worn_sides import WornSides
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class WearState(Short):
    """Worn depths at the m corners of the sides that wear, in the order of `interface.worn_sides.WornSides`.

    Attributes
    ----------
    depth : (m,) length
    volume : (m,) worn volume there
    distance : (n,) slid by every pair where it is closed, either way
    loose : (m,) volume that has been rubbed off there and that the depth does not know yet
    taken : (m,) depth by which the nodes of the mesh have moved there
    energy : elastic energy that was set free with what is worn: forces of the pairs times what they give way
    cycles : worn so far
    moves : how often the mesh has moved
    """

    depth: Array
    volume: Array
    distance: Array
    loose: Array
    taken: Array
    energy: float = 0.0
    cycles: int = 0
    moves: int = 0

    @property
    def beyond(self) -> Array:
        """(m,) Depth that gaps know and the mesh does not."""
        return self.depth - self.taken


def unworn(sides: WornSides) -> WearState:
    """Nothing is worn yet."""
    depth, pairs = np.zeros(len(sides)), np.zeros(len(sides.by_energy))
    return WearState(depth=depth, volume=depth, distance=pairs, loose=depth, taken=depth)
