# SPDX-License-Identifier: BSD-3-Clause
"""What the sides of a contact have lost by wear, as a result."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array, BoolArray, IntArray
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ContactWear(Short):
    """What the sides of one contact have lost by wear since the beginning.

    Attributes
    ----------
    depth : (n,) of the nonmortar side at the nodes of the pairs, length
    mortar_depth : (n,) of the mortar side as the pairs see it, length
    node : (m,) nodes at the corners of both sides, the nonmortar one first
    points : (m, d) undeformed coordinates
    depths : (m,) there, length
    on_mortar : (m,) which of them are on the mortar side
    volume : worn, of the nonmortar and the mortar side; in the plane of the thickness
    distance : (n,) slid where pairs are closed, either way, length
    cycles : steps that wear, and cycles of those that repeat
    mesh_moves : how often the mesh has moved with what is worn, and bodies were condensed again
    """

    depth: Array
    mortar_depth: Array
    node: IntArray
    points: Array
    depths: Array
    on_mortar: BoolArray
    volume: tuple[float, float]
    distance: Array
    cycles: int
    mesh_moves: int = 0

    @property
    def deepest(self) -> tuple[float, float]:
        """The largest depth of the nonmortar and the mortar side."""
        sides = (self.depths[self.on_mortar == mortar] for mortar in (False, True))
        one, other = (float(side.max(initial=0.0)) for side in sides)
        return one, other
