# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives by the place of every node of numbers that each depend on few nodes: many nodes are moved at once.

Nodes of one colour are moved together: no number lies near two of them, so that its change is that of the one it lies
near (Curtis, Powell, Reid).

References
----------
Curtis, Powell, Reid (1974), On the estimation of sparse Jacobian matrices, IMA Journal of Applied Mathematics 13:117.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, extent
from signorini.fem.space import Space

_STEP = 1e-6  # of the size of the model: how far nodes move
_ALL_STEP = 1e-5  # of a motion of as long as facets: by how much they turn where all nodes move at once
_SUM_TOL = 1e-5  # of what numbers change by together: sums that differ by less are the same up to differences


@dataclass(frozen=True, kw_only=True, eq=False)
class NodeDifferences:
    """Differences by places of nodes.

    Attributes
    ----------
    space : the mesh
    near : (numbers, nodes) which nodes each number depends on
    free : (nodes, d) coordinates that may change: not radii of nodes on the axis
    """

    space: Space
    near: sp.csr_array
    free: BoolArray

    def gradient(self, numbers: Callable[[Space], Array]) -> tuple[IntArray, Array]:
        """Nodes (m,) that any number lies near, and (m, d) of the sum of numbers by their places.

        Parameters
        ----------
        numbers : gives them for nodes at other places
        """
        colours = colours_of(self.near)
        moving = np.flatnonzero(colours >= 0)
        found = np.zeros((len(moving), self.free.shape[1]))
        for colour in range(int(colours.max(initial=-1)) + 1):
            for axis in range(self.free.shape[1]):
                own = np.flatnonzero((colours[moving] == colour) & self.free[moving, axis])
                if len(own):
                    found[own, axis] += self._of(moving[own], axis, numbers)
        return moving, found

    def _of(self, nodes: IntArray, axis: int, numbers: Callable[[Space], Array]) -> Array:
        """(k,) What a motion of nodes of one colour along an axis changes, node by node."""
        step, motion = _STEP * float(extent(self.space.mesh.points).max()), np.zeros((len(nodes), self.free.shape[1]))
        motion[:, axis] = step
        high, low = (numbers(moved_nodes(self.space, nodes, way * motion)) for way in (1.0, -1.0))
        near, owner = sp.coo_array(self.near[:, nodes]), np.full(len(high), -1)
        owner[near.row] = near.col
        own = owner >= 0
        found = np.zeros(len(nodes))
        np.add.at(found, owner[own], (high - low)[own] / (2.0 * step))
        return found


def moved_nodes(space: Space, nodes: IntArray, by: Array) -> Space:
    """Cells of which some nodes are elsewhere.

    Parameters
    ----------
    space, nodes, by : the cells, (k,) nodes, and (k, d) how far away they are
    """
    points: Array = space.mesh.points.copy()
    points[nodes] += by
    return space.at(points, space.displacement)


def adds_up(space: Space, nodes: IntArray, gradient: Array, motion: Array, numbers: Callable[[Space], Array]) -> bool:
    """Whether the sum of numbers changes with a motion of nodes as a gradient says, to both sides of it.

    Parameters
    ----------
    space : the mesh
    nodes : (k,) that move
    gradient : (k, d) of the sum of numbers
    motion : (k, d) as long as facets are
    numbers : their values for nodes at other places
    """
    low, middle, half, high = (
        numbers(moved_nodes(space, nodes, part * _ALL_STEP * motion)) for part in (-1.0, 0.0, 0.5, 1.0)
    )
    upwards, both = (4.0 * half - 3.0 * middle - high) / _ALL_STEP, (high - low) / (2.0 * _ALL_STEP)
    wanted, size = float(np.vdot(gradient, motion)), float(np.abs(both).sum())
    return max(abs(float(found.sum()) - wanted) for found in (upwards, both)) <= _SUM_TOL * size


def colours_of(near: sp.csr_array) -> IntArray:
    """(nodes,) Colours from 0 so that nodes that one number lies near have different ones; -1 where none does.

    Examples
    --------
    >>> colours_of(sp.csr_array(np.array([[1, 1, 0, 0], [0, 1, 1, 0]]))).tolist()
    [0, 1, 0, -1]
    """
    seen = sp.csr_array(near, dtype=np.int64)
    together = sp.csr_array(seen.T @ seen)
    found = np.full(near.shape[1], -1)
    for node in np.flatnonzero(np.diff(together.indptr)):
        taken = found[together.indices[together.indptr[node] : together.indptr[node + 1]]]
        free = np.ones(len(taken) + 1, dtype=np.bool_)
        free[taken[(taken >= 0) & (taken < len(free))]] = False
        found[node] = int(np.argmax(free))
    return found


def within(rows: sp.csr_array, facets: list[IntArray], rings: int) -> sp.csr_array:
    """(numbers, nodes) Nodes that rows name, and those as many facets from there.

    Parameters
    ----------
    rows : (numbers, nodes) nonzero where a number names a node
    facets : arrays (m, k) of nodes of facets or cells
    rings : how many facets farther
    """
    count = rows.shape[1]
    found = sp.csr_array((np.ones(rows.nnz, np.int64), rows.indices, rows.indptr), shape=rows.shape)
    member = [
        sp.csr_array(
            (np.ones(part.size, np.int64), part.ravel(), np.arange(0, part.size + 1, part.shape[1])), (len(part), count)
        )
        for part in facets
    ]
    for _ in range(rings):
        for part in member:
            found = sp.csr_array(found + (found @ part.T) @ part)
            found.data[:] = 1
    return found
