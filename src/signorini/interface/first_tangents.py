# SPDX-License-Identifier: BSD-3-Clause
"""First tangents of pairs in space that go on as they were, where a choice by coordinate axes would let them jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.interface.frames import LEAST_SINE
from signorini.interface.interface import Interface

_JUMPED = 0.5  # cosine between first tangents before and after: nodes that move a little turn them by less


def along_first(interface: Interface, first: Array) -> Interface:
    """The interface with its first tangents along given directions (n, 3), which a choice by axes would let jump."""
    normals, old, n = interface.normals, interface.tangents, len(interface)
    one = first - np.einsum("ki,ki->k", first, normals)[:, None] * normals
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    axes = np.stack([one, np.cross(normals, one)], axis=1)
    share = np.einsum("kai,kbi->abk", axes, old)
    turn = sp.block_array(
        [
            [sp.eye_array(n), None, None],
            [None, sp.diags_array(share[0, 0]), sp.diags_array(share[0, 1])],
            [None, sp.diags_array(share[1, 0]), sp.diags_array(share[1, 1])],
        ],
        format="csr",
    )
    return replace(interface, B=sp.csr_array(turn @ interface.B), moments=turn @ interface.moments, tangents=axes)


def without_jumps(interface: Interface, before: Interface) -> Interface:
    """The interface with first tangents of the coordinate axis that they had before nodes moved a little.

    Two axes that normals follow alike, as both in the plane of a flat side, change places by rounding.

    Parameters
    ----------
    interface : where nodes have moved, in the plane or in space
    before : the same pairs where they were
    """
    one, two = interface.tangents[:, 0], before.tangents[:, 0]
    if one.shape != two.shape or before.directions == 2:
        return interface
    jumped = np.einsum("ki,ki->k", one, two) < _JUMPED
    if not jumped.any():
        return interface
    axis = np.eye(3)[np.argmin((before.normals**2).sum(axis=0))]
    across = axis - (before.normals @ axis)[:, None] * before.normals
    had = (np.linalg.norm(across, axis=1) >= LEAST_SINE)[:, None]
    return along_first(interface, np.where(jumped[:, None], np.where(had, axis, two), one))
