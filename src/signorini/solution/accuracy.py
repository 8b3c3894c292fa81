# SPDX-License-Identifier: BSD-3-Clause
"""How far an answer is from that of a mesh without end, as far as that can be estimated."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array
from signorini.model.accuracy import Accuracy
from signorini.short import Short


@dataclass(frozen=True, kw_only=True)
class MeshLevel:
    """A mesh on the way to an accuracy, and what its answer was estimated to lack.

    Attributes
    ----------
    nodes, pairs : of the mesh, and pairs that touch at the end of the step where most do
    pressure, traction, energy : relative errors, see `AccuracyResult`
    seconds : of solving and of the estimate
    value, output : of an output that was asked for, and its relative error
    """

    nodes: int
    pairs: int
    pressure: float
    traction: float
    energy: float
    seconds: float
    value: float | None = None
    output: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class AccuracyResult(Short):
    """Estimated errors of a solution at the ends of its steps.

    Attributes
    ----------
    pressure : of the pressures of all contacts, ``(int (p - p*)^2 dA / int p^2 dA)^(1/2)``, over the step where its
        denominator is largest; p* from stresses recovered inside the bodies, and from the mesh before where that is
        farther away
    traction : the same with friction, over the pressures
    energy : of the stresses in the norm of energy
    cells : (m,) share of every cell of the square of the last, for pictures; they add up to 1
    levels : meshes that were tried, the last one that of the solution
    asked : what was asked for; None for an estimate alone
    reason : why it was not met; empty where it was
    notes : how the mesh was made anew: cells that were cut, shapes that boundaries follow
    value, output : of an output that was asked for, and its relative error
    """

    pressure: float
    traction: float
    energy: float
    cells: Array
    levels: tuple[MeshLevel, ...]
    asked: Accuracy | None = None
    reason: str = ""
    notes: tuple[str, ...] = ()
    value: float | None = None
    output: float | None = None

    @property
    def met(self) -> bool:
        """Whether what was asked for was reached."""
        return self.asked is not None and not self.reason
