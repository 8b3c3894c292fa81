# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs can touch at all under the loads at hand: an estimate, to be checked afterwards."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.interface.interface import Interface

# of force / (E thickness): in Hertz contact the gap that closes at the edge of contact is 0.64 of it
_REACH = 3.0
# of the approach of a bed of springs: in Hertz contact on something rigid the same gap is 0.45 of it, in a quarter of a
# model 0.72, and a single node that touches stands for all of its area
_ROOM = 4.0


def candidates(interface: Interface, length: float, squeezed: float = 0.0) -> BoolArray:
    """Pairs of each contact whose initial gap exceeds the smallest by no more than the bodies can give, (n,).

    Parameters
    ----------
    interface : all pairs
    length : what loads, moving supports and overlaps displace, see :class:`signorini.solution.scale.Scale`; in space
        what is imposed
    squeezed : in space, loads over the smallest modulus, area; they close what they would on a bed of springs as deep
        as the contact is wide, ``loads = E int (closed - gap) dA / sqrt(A)``

    Notes
    -----
    Slender or tilting bodies may reach farther: whoever leaves pairs out looks at their gaps afterwards. Leaving out
    what is far away also keeps gaps that are large beside the displacements out of the equations.

    References
    ----------
    Johnson (1985), Contact Mechanics, section 4.2(c), 4.3.
    """
    inside = np.ones(len(interface), bool)
    for contact in np.unique(interface.contact):
        own = np.nonzero(interface.contact == contact)[0]
        gap: Array = interface.gap[own] - max(float(interface.gap[own].min()), 0.0)
        inside[own] = gap <= max(_REACH * length, _ROOM * _closed(gap, interface.area[own], squeezed))
    return inside


def _closed(gap: Array, area: Array, squeezed: float) -> float:
    """The approach of a bed of springs on gaps (n,) of areas (n,), length; 0 under no load."""
    if squeezed == 0.0:
        return 0.0
    order = np.argsort(gap)
    gap, area = np.maximum(gap[order], 0.0), area[order]
    wide = np.cumsum(area)
    approach = (squeezed * np.sqrt(wide) + np.cumsum(gap * area)) / wide
    last = int(np.argmax(approach <= np.append(gap[1:], np.inf)))  # touches all up to here, and no further one
    return float(approach[last])
