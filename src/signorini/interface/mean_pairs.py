# SPDX-License-Identifier: BSD-3-Clause
"""Pairs of bodies on the way from one place to another: through them gaps change by as much as they do.

With B and B' of the pairs at both ends, u the motion and g the gaps, a discrete gradient of the gap is

    B* u = dg,    B*_n = (B_n + B'_n) / 2 + t s / |s|,    s = (B_s + B'_s) u / 2,

which tilts the normals along the way s by t, of second order in u where the gap is a smooth function of it with the
gradient B_n. So a pair that stays closed does no work on the way, whatever its force.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.interface.interface import Interface
from signorini.interface.sliding import facing

_STEEPEST_TILT = 0.05  # of a normal along the way: gaps at the ends of sides with corners jump, and have no gradient


@dataclass(frozen=True, kw_only=True, eq=False)
class MeanPairs:
    """Pairs on the way from one place to another.

    Attributes
    ----------
    interface : with what they are in the mean, other data of the end
    rest : (d n, dofs) rows of B from the mean without its tilt to the end
    """

    interface: Interface
    rest: sp.csr_array

    @staticmethod
    def between(one: Interface, two: Interface, moved: Array, opened: Array, *, least: float) -> MeanPairs:
        """The mean of pairs that face something at both ends; others are those of the end.

        Parameters
        ----------
        one, two : pairs at the ends
        moved : (dofs,) displacement on the way
        opened : (n,) what gaps grow by on it, length; NaN where that is not known
        least : length; a pair that slides less has no direction, and its normals are not tilted
        """
        n, d = len(two), two.directions
        both = facing(one) & facing(two)
        share = np.tile(np.where(both, 0.5, 1.0), d)
        B, moments = (
            sp.diags_array(1.0 - share) @ first + sp.diags_array(share) @ last
            for first, last in ((one.B, two.B), (one.moments, two.moments))
        )
        way = (B @ moved).reshape(d, n)
        length = np.linalg.norm(way[1:], axis=0)
        tilts = both & ~np.isnan(opened) & (length > least)
        slope = np.divide(opened - way[0], length, out=np.zeros(n), where=tilts).clip(-_STEEPEST_TILT, _STEEPEST_TILT)
        along = slope * np.divide(way[1:], length, out=np.zeros((d - 1, n)), where=tilts)
        none, one_by_one = sp.csr_array(((d - 1) * n, n)), sp.eye_array((d - 1) * n)
        to_normals = sp.hstack([sp.eye_array(n), *(sp.diags_array(part) for part in along)])
        tilted = sp.csr_array(sp.vstack([to_normals, sp.hstack([none, one_by_one])]))
        return MeanPairs(
            interface=replace(two, B=sp.csr_array(tilted @ B), moments=tilted @ moments), rest=sp.csr_array(two.B - B)
        )
