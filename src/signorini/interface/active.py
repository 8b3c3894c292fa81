# SPDX-License-Identifier: BSD-3-Clause
"""Which pairs the law is asked of, once supports hold what they hold."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.interface import Interface
from signorini.sparse_rows import scaled_rows

_HELD_TOL = 1e-12  # of the size of a row of B: below it supports hold what the row sees


class FreeBodies(NamedTuple):
    """The bodies and their pairs in terms of the free displacements.

    Attributes
    ----------
    K : (z, z) stiffness, force per length; of bodies on ranks a `signorini.linalg.elsewhere.MatrixElsewhere`
    B : (d n, z) relative displacements of the pairs
    nodes : (z,) node of each free displacement
    points : (nodes, d) where the nodes are, length
    kept : free displacements that any pairs may see, now or later: of sides that slide far; empty where none does
    """

    K: sp.csr_array
    B: sp.csr_array
    nodes: IntArray
    points: Array
    kept: IntArray = np.empty(0, np.int64)


class ActivePairs(NamedTuple):
    """Pairs by what the bodies leave them to do.

    Attributes
    ----------
    B : (d n, z) relative displacements, without what supports hold
    moves : (d n,) rows that see anything
    held : (n,) pairs that cannot move along their normal, because supports hold them
    active : (n,) those that the law is asked of: candidates that can, and are not tied
    """

    B: sp.csr_array
    moves: BoolArray
    held: BoolArray
    active: BoolArray


def active_pairs(B: sp.csr_array, interface: Interface, candidates: BoolArray) -> ActivePairs:
    """Tell pairs that move from those that are held.

    Parameters
    ----------
    B : (d n, z) relative displacements of the pairs in terms of the free displacements
    interface : the pairs
    candidates : (n,) pairs that may touch
    """
    row = np.repeat(np.arange(B.shape[0]), np.diff(B.indptr))
    moves = np.sqrt(np.bincount(row, B.data**2, minlength=B.shape[0])) > _HELD_TOL
    seen = scaled_rows(B, moves.astype(np.float64))
    seen.eliminate_zeros()
    held = ~moves[: len(interface)] & (interface.normal_compliance == 0.0)
    return ActivePairs(seen, moves, held, candidates & ~held & ~interface.tied)


def with_supple(felt: Array, interface: Interface, pairs: IntArray) -> Array:
    """Stiffness that pairs feel, (a,) force per length: where supports hold both sides the interface alone gives way.

    Parameters
    ----------
    felt : (a,) stiffness of the bodies at the pairs, 0 where they are held
    interface : gives the compliance
    pairs : (a,) numbers of the pairs
    """
    area, compliance = interface.area[pairs], interface.normal_compliance[pairs]
    own = np.divide(area, compliance, out=np.zeros(len(pairs)), where=compliance > 0.0)
    return np.where(felt == 0.0, own, felt)
