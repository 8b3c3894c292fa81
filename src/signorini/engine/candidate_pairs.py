# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs the law of contact is asked of: those that a step can close, and those that steps before it could."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, BoolArray, distinct
from signorini.engine.examine import Examined
from signorini.fem.rigid import free_motions
from signorini.interface.interface import Interface
from signorini.solution.scale import Loading, data_scale
from signorini.sparse_rows import chosen_rows

_NEEDED = 0.5  # of the loads: pairs chosen for these leave room for bodies that give twice as much
_AHEAD = 2.0  # of the loads of a step that reaches farther than any before: growing loads seldom need pairs anew

# of force / (E thickness): in Hertz contact the gap that closes at the edge of contact is 0.64 of it
_REACH = 3.0
# of the approach of a bed of springs: in Hertz contact on something rigid the same gap is 0.45 of it, in a quarter of a
# model 0.72, and a single node that touches stands for all of its area
_ROOM = 4.0


def candidate_pairs(
    examined: Examined, loading: Loading, before: BoolArray | None = None, *, held: bool = False
) -> BoolArray:
    """(n,) Pairs that can touch; all where those alone would not hold a body, and in the plane where one
    yields or a side wears.

    They depend on the past and on the step alone, so that a history that is cut and goes on has the same.

    Parameters
    ----------
    examined : the model under the supports of the step
    loading : the most that was imposed up to the end of the step
    before : (n,) those of the steps before it, which stay and are given back where they are enough
    held : whether those hold the bodies, because they were found under the same supports
    """
    # flow moves bodies farther than loads compress them, and far sliding what is opposite what
    if (examined.model.yields and examined.space.dimension == 2) or examined.model.slides:
        return np.ones(len(examined.interface), np.bool_)
    if examined.model.wears and examined.space.dimension == 2:  # what is worn lets others touch
        return np.ones(len(examined.interface), np.bool_)
    if before is None:
        found = _reached(examined, loading)
    else:
        needed = _reached(examined, loading.times(_NEEDED))
        found = before if (before | ~needed).all() else before | _reached(examined, loading.times(_AHEAD))
    if found is before and held:
        return found
    seen = chosen_rows(examined.interface.felt(examined.rigid), examined.interface.rows(found))
    if free_motions(examined.resisted, seen).shape[1]:
        return np.ones_like(found)
    return found


def _reached(examined: Examined, loading: Loading) -> BoolArray:
    """(n,) Pairs that what is imposed can close; where nothing is, those that touch."""
    scale = data_scale(examined.space, examined.model, loading, examined.interface)
    if examined.space.dimension == 3:
        return _near(examined.interface, scale.imposed, scale.squeezed)
    return _near(examined.interface, scale.length if scale.loaded or scale.imposed else 0.0)


def _near(interface: Interface, length: float, squeezed: float = 0.0) -> BoolArray:
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
    for contact in distinct(interface.contact):
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
