# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at places of the bodies over a part of the load history."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array, IntArray
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StressHistory(Short):
    """Stresses and strains at p places and t moments; on an exact path they are linear from one moment to the next.

    Attributes
    ----------
    points : (p, d) undeformed coordinates, length; of a mean over a line its beginning
    bodies : name of the body of every place
    node : (p,) index of the node, from 0; -1 at points that are none
    load_factor : (t,) step k goes from k - 1 to k
    stress : (p, t, 6) force per area: xx, yy, zz, xy, yz, xz, tension positive; of axisymmetric bodies radial, axial,
        hoop and their shear
    strain : (p, t, 6) of the tensor, elastic and plastic, without what temperature expands
    gradient : (p, t, 6) derivatives of the stress into the body along the normal, force per area and length; (0, t, 6)
        where places are not all on boundaries, or a normal leaves its body at the end of a side
    exact : whether the paths of its steps are: otherwise stresses between moments are not known to be linear
    """

    points: Array
    bodies: tuple[str, ...]
    node: IntArray
    load_factor: Array
    stress: Array
    strain: Array
    gradient: Array
    exact: bool
