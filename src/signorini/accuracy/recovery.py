# SPDX-License-Identifier: BSD-3-Clause
"""Stresses recovered from patches of cells, and how far those of the cells are from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.accuracy._fits import add_points, add_work
from signorini.arrays import Array, IntArray, among, selection
from signorini.fem.elasticity import elasticity
from signorini.fem.jacobian import determinants, jacobians
from signorini.fem.kinematics import groups
from signorini.fem.measure import measure
from signorini.fem.space import Block, Space, shapes_in_cells
from signorini.fem.stress import DeformedBodies
from signorini.meshing.facets import facet_corners, unshared
from signorini.model.mesh import CORNERS
from signorini.model.model import Model

_POINTS = 1.5
"""Sampling points that a patch has for every coefficient of its polynomial, at least: fewer cannot smooth anything."""

_DEGREES = {1: 2, 2: 4}
"""Of polynomials that quadratures of the square of a difference integrate, by the order of the cells."""

_IN_SPACE = 6
"""Components of a stress, where a displacement has three."""

_LAYERS = 3
"""Of cells around a corner that a patch takes more, at most: strips of one cell have no more to offer."""

_REGULAR = 1e-12
"""Of the trace of a patch's normal equations: what is added where points lie on a line or in a plane."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StressError:
    """Difference of recovered stresses and those of the cells, in energy.

    Attributes
    ----------
    squares : (m,) ``int (s* - s) : C^-1 : (s* - s)`` of every cell, work
    norm_square : the same of the recovered stress over all bodies, work
    nodal : of every body the corners of its cells (k,), and recovered stresses there, (k, 4 or 6) force per area
    """

    squares: Array
    norm_square: float
    nodal: tuple[tuple[IntArray, Array], ...]

    @property
    def relative(self) -> float:
        """Of the energy norm: ``sqrt(sum of squares / norm square)``."""
        return float(np.sqrt(self.squares.sum() / self.norm_square)) if self.norm_square > 0.0 else 0.0


def stress_error(deformed: DeformedBodies) -> StressError:
    """What stresses of the cells are away from smoother ones, which polynomials around every corner have fitted.

    Around a corner of a body a polynomial of the degree of the displacements fits the stresses at the best points of
    the cells there, by least squares, those of corners at the skin on the next layer of cells too; inside a cell those
    of its corners are blended by its linear shape functions.

    Parameters
    ----------
    deformed : bodies with their displacements

    References
    ----------
    Zienkiewicz, Zhu (1992), Int. J. Numer. Methods Eng. 33, 1331; blended: Blacker, Belytschko (1994), ibid. 37, 517.
    """
    space, model = deformed.space, deformed.model
    parts: list[list[_Cells]] = [[] for _ in model.bodies]
    for group in groups(space, model):
        stress = deformed.stress(group)
        for i in np.unique(group.body):
            own = group.body == i
            parts[i].append(_Cells(block=group.block, index=group.index[own], stress=stress[own]))
    squares, total, nodal = np.zeros(model.mesh.number_of_cells), 0.0, []
    for body, own_parts in zip(model.bodies, parts, strict=True):
        kind = "3d" if own_parts[0].stress.shape[2] == _IN_SPACE else "plane strain"
        compliance = np.asarray(np.linalg.inv(elasticity(body.material, kind)), float)
        fitted = _fitted(space, own_parts)
        for part in own_parts:
            work = part.work(fitted, compliance, model, space)
            squares[part.numbers] = work[:, 0]
            total += float(work[:, 1].sum())
        nodes = np.flatnonzero(among([part.corners for part in own_parts], len(space.mesh.points)))
        nodal.append((nodes, fitted.coefficients[nodes, 0]))
    return StressError(squares=squares, norm_square=total, nodal=tuple(nodal))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Cells:
    """Cells of one body and family, and their stresses at the points where these are best, (m, p, 4 or 6)."""

    block: Block
    index: IntArray
    stress: Array

    @property
    def nodes(self) -> IntArray:
        """(m, k)."""
        return self.block.cells[self.index]

    @property
    def corners(self) -> IntArray:
        """(m, a)."""
        return self.nodes[:, : CORNERS[self.block.family]]

    @property
    def numbers(self) -> IntArray:
        """(m,) Among all cells."""
        return self.block.first + self.index

    @property
    def order(self) -> int:
        """Of the shape functions: 1 or 2."""
        return 1 if self.nodes.shape[1] == CORNERS[self.block.family] else 2

    def work(self, fitted: _Fitted, compliance: Array, model: Model, space: Space) -> Array:
        """``int s : C^-1 : s`` of every cell, (m, 2): of recovered stresses less those of the cell, and of these."""
        family, degree = self.block.family, _DEGREES[self.order]
        values, slopes, weights = shapes_in_cells(family, degree)
        linear = shapes_in_cells(family.rstrip("0123456789"), degree)[0]
        nodes = space.mesh.points[self.nodes]
        at = values @ nodes
        volumes = weights * np.abs(determinants(jacobians(nodes, slopes))) * measure(model, at, self.numbers)
        own = linear @ self.block.to_nodes[: linear.shape[1]]
        found = np.zeros((len(self.index), 2))
        stress, sizes = np.ascontiguousarray(self.stress), np.ascontiguousarray(volumes)
        fits = fitted.centres, fitted.sizes, fitted.coefficients
        cells = np.ascontiguousarray(self.corners), stress, sizes
        add_work(cells, (np.ascontiguousarray(linear), own), at, fits, compliance, found)
        return found


@dataclass(frozen=True, kw_only=True, eq=False)
class _Fitted:
    """Polynomials around the corners of a body.

    Attributes
    ----------
    centres : (n, d) places of all nodes, length
    sizes : (n,) of the patches, length
    coefficients : (n, monomials, 4 or 6) of ``(x - centre) / size``
    """

    centres: Array
    sizes: Array
    coefficients: Array


def _fitted(space: Space, parts: Sequence[_Cells]) -> _Fitted:
    """Least squares on the patches of all corners of a body."""
    points, order = space.mesh.points, max(part.order for part in parts)
    patches, sizes = _patches(space, parts, order)
    monomials, components = _count(points.shape[1], order), parts[0].stress.shape[2]
    normal = np.zeros((len(points), monomials, monomials))
    right = np.zeros((len(points), monomials, components))
    first = 0
    for part in parts:
        own = sp.csr_array(patches[:, first : first + len(part.index)])
        first += len(part.index)
        at = np.einsum("pk,mki->mpi", part.block.stress_values, points[part.nodes])
        around = own.indptr.astype(np.int64), own.indices.astype(np.int64)
        add_points(around, at, np.ascontiguousarray(part.stress), points, sizes, normal, right)
    trace = np.trace(normal, axis1=1, axis2=2)[:, None, None]
    normal += np.where(trace > 0.0, _REGULAR * trace, 1.0) * np.eye(monomials)
    return _Fitted(centres=points, sizes=sizes, coefficients=np.asarray(np.linalg.solve(normal, right), float))


def _patches(space: Space, parts: Sequence[_Cells], order: int) -> tuple[sp.csr_array, Array]:
    """(nodes, cells of the body) Which cells are around a corner, and how far they reach, (nodes,) length."""
    count, points = len(space.mesh.points), space.mesh.points
    first = np.cumsum([0, *(len(part.index) for part in parts)])
    rows = np.concatenate([part.corners.ravel() for part in parts])
    of_parts = [
        np.repeat(start + np.arange(len(p.index)), p.corners.shape[1]) for p, start in zip(parts, first, strict=False)
    ]
    touching = sp.csr_array((np.ones(len(rows)), (rows, np.concatenate(of_parts))), shape=(count, first[-1]))
    samples = np.concatenate([np.full(len(part.index), part.stress.shape[1]) for part in parts])
    needed, there = _POINTS * _count(points.shape[1], order), touching.sum(axis=1) > 0
    narrow = there & ((touching @ samples < needed) | among(_skin(space, parts), count))
    patches, around = touching, touching.T
    for _ in range(_LAYERS):
        if not narrow.any():
            break
        wider = selection(np.flatnonzero(narrow), count)
        patches = sp.csr_array(
            sp.diags_array(1.0 * ~narrow) @ patches + wider.T @ (wider @ touching @ around @ patches)
        )
        narrow &= patches.astype(bool) @ samples < needed
    patches.eliminate_zeros()
    corners = [points[part.corners] for part in parts]
    spans = np.concatenate([np.linalg.norm(np.ptp(own, axis=1), axis=1) for own in corners])
    sizes = np.ones(count)
    sizes[there] = ((touching @ spans) / np.maximum(touching.sum(axis=1), 1.0))[there]
    return patches, sizes


def _skin(space: Space, parts: Sequence[_Cells]) -> list[IntArray]:
    """Corners of facets with one cell of the body alone."""
    inside, d = among([part.numbers for part in parts], space.mesh.number_of_cells), space.dimension
    found = []
    for facets in space.facets.values():
        own = np.flatnonzero(inside[facets.cell])
        alone = own[unshared(facets.key[own])]
        found.append(facets.nodes[alone][:, : facet_corners(d, facets.nodes.shape[1])])
    return found


def _count(dimension: int, order: int) -> int:
    """Monomials up to a degree, 1 or 2."""
    return 1 + dimension + (dimension * (dimension + 1) // 2 if order == 2 else 0)
