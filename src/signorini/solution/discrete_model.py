# SPDX-License-Identifier: BSD-3-Clause
"""The discrete problem that every state is measured on: bodies, supports, pairs and the sizes of the data."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.fem.rigid_motions import RigidMotions
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.plasticity.bodies import YieldingBodies
from signorini.solution.scale import Scale


@dataclass(frozen=True, kw_only=True, eq=False)
class DiscreteModel:
    """Equilibrium ``K u = f + B^T r`` under supports, with the law of contact on gaps, slips and forces of n pairs.

    Attributes
    ----------
    K : (dofs, dofs) stiffness of bodies and elastic foundations, supports not applied
    constraints : what supports hold and prescribe
    interface : the pairs, with their B and their law
    rigid : motions of all parts
    scale : sizes of forces and lengths
    absent : (n,) pairs whose contact is switched off: the law of contact is not asked of them
    yielding : the points of the bodies that yield; None: none does
    """

    K: sp.csr_array
    constraints: Constraints
    interface: Interface
    rigid: RigidMotions
    scale: Scale
    absent: BoolArray
    yielding: YieldingBodies | None = None

    def pushed(self, forces: Array) -> Array:
        """(dofs,) Nodal forces ``B^T r`` of the forces (d, n) of the pairs, where vectors of all displacements are."""
        return self.constraints.spread(*self.interface.pushes(forces))
