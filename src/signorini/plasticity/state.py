# SPDX-License-Identifier: BSD-3-Clause
"""What points of the bodies remember of plastic flow."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PlasticState(Short):
    """Plastic strain and hardening at the p quadrature points of the bodies that yield, and what they do to the bodies.

    Attributes
    ----------
    strain : (p, 4) xx, yy, zz, xy, in space (p, 6) with yz and xz; shear strains twice the tensor's; no volume strain
    equivalent : (p,) equivalent plastic strain ``int sqrt(2/3 deps_p : deps_p)``
    back : (p, M, 4 or 6) back stresses, force per area, tensors without pressure
    forces : (dofs,) ``sum_q w B^T D eps_p``: internal forces are ``K u`` less these
    dissipation : plastic work since the beginning, what back stresses and hardening store included
    stored : of it in back stresses: flow in reverse can give it back
    """

    strain: Array
    equivalent: Array
    back: Array
    forces: Array
    dissipation: float = 0.0
    stored: float = 0.0

    def light(self) -> PlasticState:
        """The energies alone: a history may have thousands of states."""
        none = np.zeros(0)
        return replace(self, strain=none, equivalent=none, back=none, forces=none)


def no_flow(points: int, components: int, backs: int, dofs: int) -> PlasticState:
    """Nothing has flowed yet.

    Parameters
    ----------
    points : quadrature points of the bodies that yield
    components : of a strain, 4 or 6
    backs : back stresses of a point
    dofs : displacements
    """
    return PlasticState(
        strain=np.zeros((points, components)),
        equivalent=np.zeros(points),
        back=np.zeros((points, backs, components)),
        forces=np.zeros(dofs),
    )
