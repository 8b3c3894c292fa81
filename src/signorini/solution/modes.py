# SPDX-License-Identifier: BSD-3-Clause
"""Natural modes, with their certificate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class NaturalModes(Short):
    """The lowest natural modes, ``K v = omega^2 M v`` under supports, equations, ties and the state of the joints.

    Attributes
    ----------
    joint : of :data:`signorini.model.modes.JOINTS`
    squares : (k,) omega^2, ascending, angle^2 per time^2; 0 for rigid motions
    shapes : (k, nodes, d) displacements, mass-normalised: ``v M v = 1``; of a sector over one, and complex where a wave
        goes around the ring: sector s moves by ``real(exp(2 pi i h s / N) v)``, turned
    forces : (k, nodes, d) ``M v``: the nodal forces of a mode, by which displacements are projected on it
    residuals : (k,) ``|K v - omega^2 M v|`` in the norm of ``(K + s M)^-1``, of that of ``K v + s M v``: some exact
        omega^2 + s is as near, relatively
    orthogonality : the largest ``|v_i M v_j|``, i other than j
    parting : how far pairs move on each other that the joint holds rigidly, of the largest displacement of a shape
    missed : modes below the last one that are not among them, by the inertia of ``K - sigma M``; None: not counted
    """

    joint: str
    squares: Array
    shapes: Array
    forces: Array
    residuals: Array
    orthogonality: float
    parting: float
    missed: int | None

    def __len__(self) -> int:
        return len(self.squares)

    @property
    def frequencies(self) -> Array:
        """(k,) Cycles per time: Hz, where time is in seconds."""
        return np.asarray(np.sqrt(self.squares) / (2.0 * np.pi))

    @property
    def effective_masses(self) -> Array:
        """(k, d) Mass that moves with each mode along the axes, ``(sum M v)^2``; of all modes that of the bodies."""
        return np.asarray(np.abs(self.forces.sum(axis=1)) ** 2)
