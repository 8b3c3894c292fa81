# SPDX-License-Identifier: BSD-3-Clause
"""Jacobians of many cells at once, their determinants, and gradients in space."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.crew import shared

_AT_ONCE = 1 << 12  # cells, a megabyte of their Jacobians: half the time of all at once
_SHARED_CELLS = 100_000  # from which threads share determinants: ten milliseconds of one thread
_SINGULAR = 1e-14  # of the largest entry to the power of the size: a determinant that is rounding


def jacobians(points: Array, reference: Array) -> Array:
    """``dx/dX`` of cells, (m, q, d, d).

    Parameters
    ----------
    points : (m, k, d) the nodes of the cells, length
    reference : (q, k, d) gradients of the shape functions at points of the reference cell
    """
    (cells, nodes, d), count = points.shape, len(reference)
    along = points.transpose(2, 0, 1).reshape(-1, nodes) @ reference.transpose(1, 0, 2).reshape(nodes, -1)
    return along.reshape(d, cells, count, d).transpose(1, 2, 0, 3)


def places(points: Array, values: Array) -> Array:
    """Places of points in cells, or what else shape functions interpolate, (m, q, d).

    Parameters
    ----------
    points : (m, k, d) the nodes of the cells, length
    values : (q, k) shape functions at points of the reference cell

    Examples
    --------
    >>> places(np.array([[[0.0, 1.0], [4.0, 3.0]]]), np.array([[0.5, 0.5], [0.0, 1.0]])).tolist()
    [[[2.0, 2.0], [4.0, 3.0]]]
    """
    cells, nodes, d = points.shape
    found = points.transpose(2, 0, 1).reshape(-1, nodes) @ values.T
    return np.ascontiguousarray(found.reshape(d, cells, len(values)).transpose(1, 2, 0))


def determinants(matrices: Array) -> Array:
    """Determinants (...) of many small matrices, (..., 2, 2) or (..., 3, 3).

    Examples
    --------
    >>> determinants(np.array([[[2.0, 1.0], [0.0, 3.0]]])), determinants(2.0 * np.eye(3))
    (array([6.]), array(8.))
    """
    rows = np.moveaxis(matrices, (-2, -1), (0, 1))
    return np.asarray(sum(a * b for a, b in zip(rows[0], _cofactors(rows, 0), strict=True)))


def cell_determinants(points: Array, cells: IntArray, reference: Array) -> Array:
    """Determinants of the Jacobians of cells, (m, q), so many cells at a time that they stay in the cache.

    Parameters
    ----------
    points : (n, d) all nodes, length
    cells : (m, k) their nodes
    reference : (q, k, d) gradients of the shape functions at points of the reference cell

    Examples
    --------
    >>> triangle = np.array([[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]])
    >>> cell_determinants(np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 2.0]]), np.array([[0, 1, 2]]), triangle).tolist()
    [[6.0]]
    """
    found = np.empty((len(cells), len(reference)))

    def some(first: int) -> None:
        own = slice(first, first + _AT_ONCE)
        found[own] = determinants(jacobians(points[cells[own]], reference))

    shared([partial(some, first) for first in range(0, len(cells), _AT_ONCE)], worth=len(cells) > _SHARED_CELLS)
    return found


def gradients_in_space(matrices: Array, reference: Array) -> Array:
    """Gradients of shape functions in space, ``grad N = (dx/dX)^-T grad_X N``, (m, q, k, d).

    Parameters
    ----------
    matrices : (m, q, d, d) Jacobians
    reference : (q, k, d) gradients at those points of the reference cell

    Examples
    --------
    >>> gradients_in_space(np.array([[[[2.0, 1.0], [0.0, 4.0]]]]), np.array([[[1.0, 0.0], [0.0, 1.0]]])).tolist()
    [[[[0.5, -0.125], [0.0, 0.25]]]]
    """
    cofactors, determinant = _adjugates(matrices)
    found = np.empty((*matrices.shape[:2], *reference.shape[1:]))
    for i, column in enumerate(cofactors):
        found[..., i] = sum((part / determinant)[..., None] * reference[..., j] for j, part in enumerate(column))
    return found


def solved(matrices: Array, right: Array) -> Array:
    """Solutions (n, d) of many small systems; shortest least squares of those that are singular.

    Parameters
    ----------
    matrices : (n, d, d), d = 2 or 3
    right : (n, d)

    Examples
    --------
    >>> solved(np.array([[[2.0, 1.0], [0.0, 4.0]], [[1.0, 1.0], [1.0, 1.0]]]), np.ones((2, 2))).round(12).tolist()
    [[0.375, 0.25], [0.5, 0.5]]
    """
    cofactors, determinant = _adjugates(matrices)
    largest = np.abs(matrices).max(axis=(1, 2), initial=0.0)
    singular = np.abs(determinant) <= _SINGULAR * largest ** matrices.shape[-1]
    divisor = np.where(singular, 1.0, determinant)
    columns = zip(*cofactors, strict=True)
    found = np.column_stack(
        [sum(part * b for part, b in zip(column, right.T, strict=True)) / divisor for column in columns]
    )
    found[singular] = np.einsum("nij,nj->ni", np.linalg.pinv(matrices[singular]), right[singular])
    return found


def _adjugates(matrices: Array) -> tuple[list[Sequence[Array]], Array]:
    """Cofactors of matrices, row by row, and their determinants."""
    rows = np.moveaxis(matrices, (-2, -1), (0, 1))
    cofactors = [_cofactors(rows, i) for i in range(len(rows))]
    return cofactors, np.asarray(sum(a * b for a, b in zip(rows[0], cofactors[0], strict=True)))


def _cofactors(rows: Array, i: int) -> Sequence[Array]:
    """Cofactors of row i of matrices (d, d, ...); d = 2 or 3."""
    if len(rows) == 2:
        return (rows[1, 1], -rows[1, 0]) if i == 0 else (-rows[0, 1], rows[0, 0])
    return tuple(np.cross(rows[(i + 1) % 3], rows[(i + 2) % 3], axis=0))
