# SPDX-License-Identifier: BSD-3-Clause
"""The stiffness matrix of linear elasticity, for any Lagrange elements in two and three dimensions.

    K_(a r)(b s) = sum_e int_e  c_risj d_i N_a d_j N_b

The unknown of node a and component r of c is ``c a + r``, which is the numbering of scikit-fem's `ElementVector`.
Geometry and displacement share the shape functions (isoparametric elements); an element whose edges are straight has
its higher nodes on them. SparsityPattern and values are written once, in rows; no list of all element entries ever
exists.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from signorini.arrays import Array, Int32Array
from signorini.cores import number_of_threads
from signorini.crew import Crew
from signorini.errors import InputError
from signorini.fem import _kernels
from signorini.fem._kernels import Cells
from signorini.sparse_rows import rows_of

__all__ = ["Cells", "stiffness"]

SHARED_CELLS = 10_000
"""Elements from which threads share an assembly: tens of milliseconds of one thread."""


def stiffness(
    points: Array, blocks: Cells | Sequence[Cells], law: Array, *, bulk: ArrayLike = (), axisymmetric: bool = False
) -> sparse.csr_array:
    """Assemble the stiffness matrix.

    Elements may be numbered in either orientation; scikit-fem's own meshes mix both.

    Parameters
    ----------
    points : (N, d) coordinates of the nodes, length; axisymmetric: (radius, height)
    blocks : the elements, one block per kind; all share the numbering of the nodes
    law : (n, c, e, c, e) c_risj of the materials, force / length^2, see :func:`signorini.fem.elasticity.law_tensor`
    bulk : (n,) bulk moduli of the materials, force / length^2, for what is projected on pressures
    axisymmetric : with the hoop strain u_r / r; c = 3 where bodies twist

    Returns
    -------
    (c N, c N) csr_array, symmetric, both triangles, sorted int32 indices; nodes without elements have empty rows

    Raises
    ------
    InputError
        If shapes do not fit, a node does not exist, the matrix would have 2^31 entries, or the Jacobian of an element
        vanishes or changes sign inside it; the message names the element.

    Examples
    --------
    One linear triangle of unit legs with lambda = 0, mu = 1/2 stretched along x: the energy is half its area.

    >>> import numpy as np
    >>> from signorini.fem.elasticity import isotropic, law_tensor
    >>> corner = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> gradients = np.array([[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]])
    >>> triangle = Cells(nodes=np.array([[0, 1, 2]]), shape_gradients=gradients, weights=np.array([0.5]))
    >>> K = stiffness(corner, triangle, law_tensor(isotropic(0.0, 0.5)[None, :4, :4]))
    >>> u = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    >>> float(u @ K @ u)
    0.5
    """
    blocks = [blocks] if isinstance(blocks, Cells) else list(blocks)
    points = np.ascontiguousarray(points, dtype=np.float64)
    count, d = points.shape
    nodes = [_nodes(block, points, number) for number, block in enumerate(blocks)]
    sizes = np.concatenate([np.zeros(1, dtype=np.int64), *[np.full(len(c), c.shape[1]) for c in nodes]])
    flat = np.concatenate([c.ravel() for c in nodes]) if nodes else np.empty(0, dtype=np.int32)
    rows, columns = _kernels.node_pattern(np.cumsum(sizes), flat, count)
    twists = axisymmetric and law.shape[1] > d
    c, e = (3, 4) if twists else (d, d + 1 if axisymmetric else d)
    if len(columns) * c * c >= 2**31:
        raise InputError(f"the stiffness matrix would have {len(columns) * c * c} entries; expected fewer than 2^31")
    indptr, indices = _kernels.unknown_pattern(rows, columns, c)
    data = np.zeros(len(indices))
    if law.ndim != 5 or law.shape[1:] != (c, e, c, e):
        raise InputError(f"law has shape {law.shape}; expected (n, {c}, {e}, {c}, {e})")
    entries = np.argwhere((law != 0.0).any(axis=0))
    laws = _kernels.Laws(
        np.column_stack([entries[:, 0] * c + entries[:, 2], entries[:, 1], entries[:, 3]]).astype(np.uint32),
        np.ascontiguousarray(law[:, *entries.T]),
        np.asarray(bulk, dtype=np.float64),
        c,
    )
    pattern = _kernels.SparsityPattern(rows, columns, data)
    threads = number_of_threads() if len(sizes) > SHARED_CELLS else 1
    of = _shares(points, threads)
    made = []
    for number, (block, cells) in enumerate(zip(blocks, nodes, strict=True)):
        at = (len(cells), len(block.weights))
        own = Cells(
            nodes=cells,
            shape_gradients=np.ascontiguousarray(block.shape_gradients, dtype=np.float64),
            weights=np.ascontiguousarray(block.weights, dtype=np.float64),
            material=np.array(np.broadcast_to(block.material, at[0]), dtype=np.int64),
            measure=np.array(np.broadcast_to(block.measure, at), dtype=np.float64, order="C"),
            shape_values=_values(block, number) if axisymmetric else np.empty((0, 0)),
            modes=np.ascontiguousarray(block.modes) if block.modes.size else np.empty((*at, 0, e)),
            pressures=block.pressures if block.pressures.size else np.empty((at[1], 0)),
        )
        made.append(own)
    with Crew(threads) as crew:
        found = crew.each([partial(_add_share, points, made, laws, pattern, of, share) for share in range(threads)])
    bad = [place for place in found if place is not None]
    if bad:
        number, element, wrong = min(bad)
        raise InputError(_complaint(element, number, wrong, points[nodes[number][element]]))
    return rows_of(data, indices, indptr, (count * c, count * c))


def _shares(points: Array, number: int) -> Int32Array:
    """Share the nodes, (N,): slabs across the longest side of the mesh, of about as many nodes each."""
    if number == 1:
        return np.zeros(len(points), np.int32)
    along = points[:, np.ptp(points, axis=0).argmax()] if len(points) else np.zeros(0)
    bounds = np.quantile(along, np.arange(1, number) / number) if len(along) else np.zeros(0)
    return np.searchsorted(bounds, along, side="right").astype(np.int32)


def _add_share(
    points: Array,
    blocks: Sequence[Cells],
    laws: _kernels.Laws,
    pattern: _kernels.SparsityPattern,
    of: Int32Array,
    share: int,
) -> tuple[int, int, int] | None:
    """Add the rows of the nodes of a share, in the order of the elements, however many shares there are.

    Returns
    -------
    The first block with a bad element, its first one, and what is wrong with it
    """
    for number, elements in enumerate(blocks):
        cells = np.arange(len(elements.nodes), dtype=np.int32)
        if of.any():  # not all is one share
            owners = of[elements.nodes]
            cells = cells[(owners.min(axis=1) <= share) & (share <= owners.max(axis=1))]
        element, wrong = _adding(points, elements, laws)(
            points, elements, laws, pattern, _kernels.Share(cells, of, share)
        )
        if wrong:
            return number, element, wrong
    return None


def _adding(points: Array, elements: Cells, laws: _kernels.Laws) -> Callable[..., tuple[int, int]]:
    """The kernel of a block: plane quadrilaterals, of which most plane meshes are, have one of their own."""
    plain = (elements.nodes.shape[1], points.shape[1], laws.components, *elements.modes.shape[2:]) == (4, 2, 2, 0, 2)
    return _kernels.add_quadrilaterals if plain else _kernels.add_block


def _nodes(block: Cells, points: Array, number: int) -> Int32Array:
    """Read the nodes of a block, after a look at its shapes."""
    cells = np.ascontiguousarray(block.nodes, dtype=np.int32)
    expected = (len(block.weights), cells.shape[-1], points.shape[1])
    if cells.ndim != 2 or block.shape_gradients.shape != expected:
        raise InputError(
            f"block {number}: nodes {cells.shape}, shape_gradients {block.shape_gradients.shape} and weights "
            f"{block.weights.shape} do not fit points {points.shape}; expected (M, k), (nq, k, d), (nq,) and (N, d)"
        )
    if cells.size and (cells.min() < 0 or cells.max() >= len(points)):
        raise InputError(f"block {number} names nodes {cells.min()} .. {cells.max()}; there are 0 .. {len(points) - 1}")
    return cells


def _values(block: Cells, number: int) -> Array:
    expected = block.shape_gradients.shape[:2]
    if block.shape_values.shape != expected:
        raise InputError(f"block {number}: an axisymmetric body needs shape_values of shape {expected}")
    return np.ascontiguousarray(block.shape_values, dtype=np.float64)


def _complaint(element: int, block: int, wrong: int, corners: Array) -> str:
    where = f"element {element} of block {block}, around {np.array2string(corners.mean(axis=0), precision=6)}"
    if wrong == 1:
        return f"{where}, is folded or has no volume: its Jacobian vanishes or changes sign"
    return f"{where}, reaches over the axis: expected radii >= 0"
