# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs the law of contact is asked of: those that a step can close, and those that steps before it could."""

from __future__ import annotations

import numpy as np

from signorini.arrays import BoolArray
from signorini.engine.examine import Examined
from signorini.fem.rigid import free_motions
from signorini.interface.reach import candidates
from signorini.interface.sliding import slides
from signorini.solution.scale import Loading, data_scale

_NEEDED = 0.5  # of the loads: pairs chosen for these leave room for bodies that give twice as much
_AHEAD = 2.0  # of the loads of a step that reaches farther than any before: growing loads seldom need pairs anew


def candidate_pairs(examined: Examined, loading: Loading, before: BoolArray | None = None) -> BoolArray:
    """(n,) Pairs that can touch; all where those alone would not hold a body, and in the plane where one
    yields or a side wears.

    They depend on the past and on the step alone, so that a history that is cut and goes on has the same.

    Parameters
    ----------
    examined : the model under the supports of the step
    loading : the most that was imposed up to the end of the step
    before : (n,) those of the steps before it, which stay and are given back where they are enough
    """
    # flow moves bodies farther than loads compress them, and far sliding what is opposite what
    if (examined.model.yields and examined.space.dimension == 2) or slides(examined.model):
        return np.ones(len(examined.interface), np.bool_)
    if examined.model.wears and examined.space.dimension == 2:  # what is worn lets others touch
        return np.ones(len(examined.interface), np.bool_)
    if before is None:
        found = _reached(examined, loading)
    else:
        needed = _reached(examined, loading.times(_NEEDED))
        found = before if (before | ~needed).all() else before | _reached(examined, loading.times(_AHEAD))
    holding = examined.interface.B[examined.interface.rows(found)]
    if free_motions(examined.motions, examined.constraints, holding).shape[1]:
        return np.ones_like(found)
    return found


def _reached(examined: Examined, loading: Loading) -> BoolArray:
    """(n,) Pairs that what is imposed can close; where nothing is, those that touch."""
    scale = data_scale(examined.space, examined.model, loading, examined.interface)
    if examined.space.dimension == 3:
        return candidates(examined.interface, scale.imposed, scale.squeezed)
    return candidates(examined.interface, scale.length if scale.loaded or scale.imposed else 0.0)
