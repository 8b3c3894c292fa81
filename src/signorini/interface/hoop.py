# SPDX-License-Identifier: BSD-3-Clause
"""What goes around the axis where bodies of revolution touch: directions, and rows of the sliding."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.interface.coupling import Coupling, along


def with_hoop(normals: Array, axes: Array) -> tuple[Array, Array]:
    """Normals (k, 3) and tangents (k, 2, 3) of bodies that twist: second tangents, and third components, go round.

    Parameters
    ----------
    normals, axes : (k, 2) and (k, 1, 2) of the meridian

    Examples
    --------
    >>> with_hoop(np.array([[0.0, 1.0]]), np.array([[[1.0, 0.0]]]))[1].tolist()
    [[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]
    """
    first = np.pad(axes, ((0, 0), (0, 0), (0, 1)))
    hoop = np.broadcast_to(np.eye(3)[2], first.shape)
    return np.pad(normals, ((0, 0), (0, 1))), np.concatenate([first, hoop], axis=1)


def hoop_rows(coupling: Coupling, own: IntArray, radii: Array) -> sp.csr_array:
    """(k, nodes) Weights of the sliding around the axis, times the area of the pairs.

    Those of the gap, but that across a gap the mortar side moves as it would at the radius of the nonmortar one: a
    rotation of all bodies moves no pair, and the torques on both sides are in balance.

    Parameters
    ----------
    coupling : of the pairs
    own : nodes of the nonmortar side
    radii : (nodes,) of all nodes, length
    """
    rows = along(coupling.forces, coupling.normals)
    mine = np.zeros(len(radii))
    mine[own] = 1.0
    here, there = rows @ (mine * radii), -(rows @ ((1.0 - mine) * radii))
    lever = np.divide(here, there, out=np.ones_like(here), where=there > 0.0)
    opposite = sp.diags_array(lever) @ rows @ sp.diags_array(1.0 - mine)
    return sp.csr_array(rows @ sp.diags_array(mine) + opposite)
