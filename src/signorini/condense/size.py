# SPDX-License-Identifier: BSD-3-Clause
"""How much memory the condensed interface will take, before anything is factorised."""

from __future__ import annotations

import numpy as np

from signorini.arrays import BoolArray
from signorini.interface.active import FreeBodies
from signorini.interface.interface import Interface
from signorini.linalg.plan import analyse
from signorini.linalg.registry import takes_borders
from signorini.linalg.system import checked_system

_GENEROUS = 300.0, 1.0, 60.0, 4.0 / 3.0  # entries of the factor: at most 300 z in the plane, 60 z^(4/3) in space
_SQUARE = 4, 6  # dense matrices of the size of the contact dofs, and of that of the pairs' rows, held at once


def condensing_bytes(bodies: FreeBodies, interface: Interface, *, candidates: BoolArray, plenty: float) -> float:
    """Bytes at the worst time of :func:`signorini.condense.condensed.condense` and of the law on its result.

    Parameters
    ----------
    bodies : as they are
    interface : the pairs
    candidates : (n,) pairs that may touch
    plenty : bytes; where a generous bound stays below, it is returned and the pattern of K is not analysed
    """
    K, B, nodes, points = bodies[:4]
    chosen = interface.rows(candidates | interface.tied)
    dofs = np.unique(np.concatenate([B[np.flatnonzero(chosen)].indices, bodies.kept]))
    dense = _SQUARE[1] * int(np.count_nonzero(chosen)) ** 2
    if interface.directions == 2 or interface.tied.any() or not takes_borders("auto"):
        dense += _SQUARE[0] * len(dofs) ** 2  # where contact nodes are kept; else nothing is dense but pairs
    factor, power = _GENEROUS[:2] if interface.directions == 2 else _GENEROUS[2:]
    bound = 8.0 * (factor * K.shape[0] ** power + dense)
    return bound if bound <= plenty else analyse(checked_system(K, dofs, nodes, points)).peak_bytes + 8.0 * dense
