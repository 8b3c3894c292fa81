# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs can touch at all under the loads at hand: an estimate, to be checked afterwards."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.interface.interface import Interface

# of force / (E thickness): in Hertz contact the gap that closes at the edge of contact is 0.64 of it
_REACH = 3.0


def candidates(interface: Interface, length: float) -> BoolArray:
    """Pairs of each contact whose initial gap exceeds the smallest by no more than the bodies can give, (n,).

    Parameters
    ----------
    length : what the loads and moving supports displace, see :class:`signorini.solution.scale.Scale`

    Notes
    -----
    Slender or tilting bodies may reach farther: whoever leaves pairs out looks at their gaps afterwards. Leaving out
    what is far away also keeps gaps that are large beside the displacements out of the equations.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 4.2(c).
    """
    inside = np.ones(len(interface), bool)
    for contact in np.unique(interface.contact):
        own = np.nonzero(interface.contact == contact)[0]
        gap: Array = interface.gap[own]
        inside[own] = gap <= max(gap.min(), 0.0) + _REACH * length
    return inside
