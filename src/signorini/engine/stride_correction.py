# SPDX-License-Identifier: BSD-3-Clause
"""What a cycle of sides that slide far would rub on sides that are worn further: Newton's step of a block of cycles.

Along a stride the distance slid is that of the drive, and the normal forces p of the pairs that touch follow the gaps
linearly, ``dp = - A(s)^-1 dg(s)``. With W what pairs wear at the corners of the sides, S what they see of depths there,
and D depth over volume, a cycle of strides s rubs off x volume, and sides worn by N such cycles change that by

    dx = - sum_s W(s) slid(s) A(s)^-1 S(s) D N dx.
"""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array
from signorini.engine.gross_sliding import Gone
from signorini.engine.recurring_strides import Track, closed_of
from signorini.engine.sliding_cycles import StridesCycle
from signorini.engine.wear_paths import FollowedCycle


def corrected(cycle: FollowedCycle, worn: Array, count: int) -> Array:
    """(m,) Volume that every one of N cycles rubs off, on sides that all of them have worn.

    Parameters
    ----------
    cycle : as it was followed
    worn : (m,) volume that has been rubbed off the sides that it was followed on since the first of them
    count : N
    """
    assert isinstance(cycle, StridesCycle)
    volume, sides = cycle.rubbing.volume, cycle.strides[0][0].sides
    change = -sum((_of_depths(*stride) for stride in cycle.strides), np.zeros((len(volume), len(volume))))
    change = change * sides.depth(np.ones(len(volume)))
    found = np.linalg.solve(np.eye(len(volume)) - count * change, volume - change @ worn)
    return np.asarray(np.maximum(found, 0.0))


def _of_depths(track: Track, gone: Gone) -> Array:
    """(m, m) By how much less volume a stride rubs off over depths of the sides; 0 where its pairs do not slip."""
    closed = closed_of(gone.pairs)
    stiff = track.stiffness(gone.pairs, closed) if (track.friction[closed] > 0.0).all() else None
    if stiff is None:
        return np.zeros((len(track.sides), len(track.sides)))
    rubs = track.wearing(gone.distance, track.friction * gone.distance)[closed]
    return np.asarray(track.wears[:, closed] @ (rubs[:, None] * (stiff @ track.seen[closed])))
