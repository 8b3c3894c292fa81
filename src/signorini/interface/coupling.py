# SPDX-License-Identifier: BSD-3-Clause
"""How the nodes of one side see the other side: what every way of coupling gives back."""

from __future__ import annotations

from dataclasses import dataclass

import scipy.sparse as sp

from signorini.arrays import Array, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Coupling:
    """Pairs of one contact: the relative position of pair k is ``sum_j relative_kj x_j``, x of all nodes.

    Attributes
    ----------
    nodes : (k,) nonmortar nodes, sorted
    area : (k,) that belongs to them
    relative : (k, nodes of the mesh) sparse; weights of the nonmortar side, which sum to 1, minus those of the mortar
        side, which sum to 1 too (none of a rigid obstacle)
    """

    nodes: IntArray
    area: Array
    relative: sp.csr_array
