# SPDX-License-Identifier: BSD-3-Clause
"""A checked matrix with its interface, the graph of its nodes, and what is left of it: common to all back ends."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from signorini.arrays import Array, BoolArray, Int32Array, IntArray
from signorini.crew import by_ranges
from signorini.errors import InputError
from signorini.linalg._graph import Graph, Rows, both_ways, quotient_rows

SHARED_ENTRIES = 1_000_000
"""Entries of a matrix from which threads share the graph of its nodes: ten milliseconds of one thread."""


@dataclass(frozen=True, kw_only=True)
class System:
    """A symmetric matrix in rows, and what is known about its unknowns.

    Attributes
    ----------
    rows : of K
    interface : (m,) unknowns that are never eliminated
    inside : (n,) whether an unknown is eliminated
    nodes : (n,) the node of every unknown
    points : (k, d) where the nodes are, or None
    """

    rows: Rows
    interface: IntArray
    inside: BoolArray
    nodes: IntArray
    points: Array | None = None

    @property
    def n(self) -> int:
        """Unknowns in all."""
        return len(self.rows.indptr) - 1

    @property
    def m(self) -> int:
        """Unknowns on the interface."""
        return len(self.interface)

    @property
    def matrix(self) -> sparse.csr_array:
        """K, sharing its memory with this object."""
        indptr, indices, data = self.rows
        return sparse.csr_array((data, indices, indptr), shape=(self.n, self.n))


@dataclass(frozen=True, kw_only=True)
class WithSchur:
    """Factors that hold their condensed stiffness.

    Attributes
    ----------
    n, m : unknowns in all, and on the interface
    condensed : (m, m) S, read-only
    """

    n: int
    m: int
    condensed: Array = field(repr=False)

    def schur(self) -> Array:
        """Give S, (m, m), read-only."""
        return self.condensed

    def parted(self) -> tuple[Array, Self]:
        """S, which may be overwritten, and these factors without it."""
        S, rest = self.condensed, replace(self, condensed=np.zeros((0, 0)))
        S.flags.writeable = True
        return S, rest


@dataclass(frozen=True, kw_only=True)
class NodeGraph:
    """The unknowns gathered into nodes, those of the interior first; a node may have any number of unknowns.

    A node with unknowns on both sides counts as two.

    Attributes
    ----------
    start : (g + 1,) where the unknowns of every node begin in `member`
    member : (n,) unknowns, node by node, ascending inside a node
    interior : number of nodes that are eliminated: the first ones
    edges : between the nodes, without loops
    points : (g, d) where the nodes are, or None
    """

    start: Int32Array
    member: Int32Array
    interior: int
    edges: Graph
    points: Array | None = None


def checked_system(K: Any, interface: ArrayLike, nodes: ArrayLike | None, points: ArrayLike | None = None) -> System:
    """Check the arguments of `factorise`.

    Raises
    ------
    InputError
        If K is not a square sparse matrix of finite numbers, the interface names an unknown twice or one that does not
        exist, `nodes` has another length than K, or `points` are not finite or not those of the nodes.
    """
    shape = getattr(K, "shape", ())
    if not sparse.issparse(K) or shape != shape[:1] * 2:
        raise InputError(f"K is {type(K).__name__} of shape {shape}; expected a square sparse matrix")
    matrix = K if isinstance(K, sparse.csr_array) else sparse.csr_array(cast(Any, K))
    n = matrix.shape[0]
    if matrix.nnz > np.iinfo(np.int32).max:
        raise InputError(f"K has {matrix.nnz} entries; expected at most 2^31 - 1")
    if not np.isfinite(matrix.data).all():
        raise InputError("K has entries that are not finite")
    if nodes is not None and np.shape(nodes) != (n,):
        raise InputError(f"nodes has shape {np.shape(nodes)}; expected ({n},), the node of every unknown")
    own = np.arange(n) if nodes is None else np.asarray(nodes, dtype=np.int64)
    edge = np.asarray(interface, dtype=np.int64)
    if edge.ndim != 1 or (edge.size and (edge.min() < 0 or edge.max() >= n)):
        raise InputError(f"interface of shape {edge.shape} leaves the range 0 .. {n - 1} of the unknowns")
    inside = np.ones(n, dtype=np.bool_)
    inside[edge] = False
    if n - np.count_nonzero(inside) != len(edge):
        raise InputError("interface names an unknown twice")
    return System(
        rows=Rows(
            matrix.indptr.astype(np.int32, copy=False),
            matrix.indices.astype(np.int32, copy=False),
            matrix.data.astype(np.float64, copy=False),
        ),
        interface=edge,
        inside=inside,
        nodes=own,
        points=None if points is None else _places(points, own),
    )


def _places(points: ArrayLike, nodes: IntArray) -> Array:
    places = np.asarray(points, dtype=np.float64)
    if places.ndim != 2 or not 0 <= nodes.min(initial=0) <= nodes.max(initial=0) < max(1, len(places)):
        raise InputError(f"points has shape {places.shape}; expected (k, d), a row for every node, counted from 0")
    if not np.isfinite(places).all():
        raise InputError("points has entries that are not finite")
    return places


def interface_lift(system: System) -> Array:
    """Give a diagonal, 0 inside, of the size of K_cc: added to K, it makes S positive definite where K_ii is."""
    diagonal = np.abs(system.matrix.diagonal())
    floor = 1e-8 * diagonal.max(initial=0.0) or 1.0
    return np.where(system.inside, 0.0, np.maximum(diagonal, floor))


def as_columns(values: ArrayLike, rows: int) -> Array:
    """Read a vector as one column.

    Raises
    ------
    InputError
        If there are not as many rows.
    """
    array = np.asarray(values, dtype=np.float64)
    if array.ndim not in (1, 2) or len(array) != rows:
        raise InputError(f"got an array of shape {array.shape}; expected ({rows},) or ({rows}, k)")
    return array[:, None] if array.ndim == 1 else array


def like(values: ArrayLike, result: Array) -> Array:
    """Give one column back as a vector where a vector came in."""
    return result[:, 0] if np.ndim(values) == 1 else result


def node_graph(system: System) -> NodeGraph:
    """Gather the unknowns of a node, interior nodes first.

    SciPy's products and sums leave out entries that come to 0: of a pair that rounding alone keeps from it perhaps one.
    """
    key = system.nodes - system.nodes.min(initial=0)
    key = key + (key.max(initial=0) + 1) * ~system.inside
    member = np.argsort(key, kind="stable").astype(np.int32)
    first = np.concatenate([[True], np.diff(key[member]) > 0]) if system.n else np.empty(0, dtype=np.bool_)
    start = np.append(np.flatnonzero(first), system.n).astype(np.int32)
    group = np.empty(system.n, dtype=np.int32)
    group[member] = np.cumsum(first) - 1
    edges = both_ways(_quotient(system.rows.graph, start, member, group))
    interior = int(np.searchsorted(start, system.n - system.m))
    points = None if system.points is None else system.points[system.nodes[member[start[:-1]]]]
    return NodeGraph(start=start, member=member, interior=interior, edges=edges, points=points)


def _quotient(graph: Graph, start: Int32Array, member: Int32Array, group: Int32Array) -> Graph:
    """The graph of groups of vertices, see `quotient_rows`; threads share the groups of a large one."""
    count = len(start) - 1

    def rows(low: int, high: int) -> Graph:
        return quotient_rows(graph, start[low : high + 1], member, group, (low, count))

    parts = by_ranges(rows, count, worth=len(graph.indices) > SHARED_ENTRIES)
    if len(parts) == 1:
        return parts[0]
    counts = np.concatenate([np.diff(part.indptr) for part in parts])
    return Graph(np.append(0, np.cumsum(counts)).astype(np.int32), np.concatenate([part.indices for part in parts]))


def bordered(K: Any, B: sparse.csr_array) -> Any:
    """``[[K, B^T], [B, 0]]``, (n + m, n + m); with the border as its interface it condenses to ``-B K^-1 B^T``.

    Parameters
    ----------
    K : (n, n) sparse array, or a `MatrixElsewhere`
    B : (m, n)

    Examples
    --------
    >>> import numpy as np
    >>> K, B = sparse.csr_array(np.diag([2.0, 4.0])), sparse.csr_array(np.array([[1.0, -1.0]]))
    >>> bordered(K, B).toarray().tolist()
    [[2.0, 0.0, 1.0], [0.0, 4.0, -1.0], [1.0, -1.0, 0.0]]
    """
    if not sparse.issparse(K):  # its rows are elsewhere
        return K.bordered(B)
    none = sparse.csr_array((B.shape[0], B.shape[0]))
    return sparse.csr_array(sparse.block_array([[K, sparse.csr_array(B.T)], [B, none]], format="csr"))
