# SPDX-License-Identifier: BSD-3-Clause
"""Stresses recovered from patches of cells, and how far those of the cells are from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from signorini.accuracy._fits import add_work, cells_at_corners, fit, wider_patches
from signorini.arrays import Array, IntArray, among
from signorini.crew import by_ranges, shared
from signorini.fem.elasticity import elasticity
from signorini.fem.jacobian import determinants, jacobians, places
from signorini.fem.kinematics import groups, large, of_each
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

_SHARED_CORNERS = 2000
"""Corners from which threads share what is fitted around them: ten milliseconds of one thread."""

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


class StressRecovery:
    """Recovered stresses of bodies on one mesh, of as many displacements as there are: patches are found once.

    Around a corner of a body a polynomial of the degree of the displacements fits the stresses at the best points of
    the cells there, by least squares, those of corners at the skin on the next layer of cells too; inside a cell those
    of its corners are blended by its linear shape functions.

    Parameters
    ----------
    space, model : of the bodies

    References
    ----------
    Zienkiewicz, Zhu (1992), Int. J. Numer. Methods Eng. 33, 1331; blended: Blacker, Belytschko (1994), ibid. 37, 517.

    Examples
    --------
    >>> import signorini as sg
    >>> from signorini.fem.space import make_space
    >>> model = sg.Model(sg.rectangle(nx=2), bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0))])
    >>> space = make_space(model.mesh)
    >>> stretched = DeformedBodies.of(space, model, 0.5 * model.mesh.points)
    >>> error = StressRecovery(space, model).error(stretched)
    >>> round(error.norm_square, 9), round(error.relative, 6)
    (0.5, 0.0)
    """

    def __init__(self, space: Space, model: Model) -> None:
        self._model = model
        self._groups = list(groups(space, model))
        self._owners = [[(int(i), group.body == i) for i in np.unique(group.body)] for group in self._groups]
        parts: list[list[_Cells]] = [[] for _ in model.bodies]
        for group, owners in zip(self._groups, self._owners, strict=True):
            for i, own in owners:
                parts[i].append(_Cells(block=group.block, index=group.index[own], space=space))
        self._bodies = [_Patches.of(space, own) for own in parts]

    def error(self, deformed: DeformedBodies) -> StressError:
        """What stresses of the cells are away from smoother ones, which polynomials around every corner have fitted.

        Parameters
        ----------
        deformed : these bodies with their displacements
        """
        model = self._model
        stresses: list[list[Array]] = [[] for _ in model.bodies]
        for owners, stress in zip(self._owners, of_each(self._groups, deformed.stress), strict=True):
            for i, own in owners:
                stresses[i].append(np.ascontiguousarray(stress if len(owners) == 1 else stress[own]))
        squares, total, nodal = np.zeros(model.mesh.number_of_cells), 0.0, []
        for body, patches, own_stresses in zip(model.bodies, self._bodies, stresses, strict=True):
            kind = "3d" if own_stresses[0].shape[2] == _IN_SPACE else "plane strain"
            compliance = np.asarray(np.linalg.inv(elasticity(body.material, kind)), float)
            fitted = patches.fitted(own_stresses)
            works = [
                partial(part.work, rows, stress, fitted, compliance, model)
                for part, rows, stress in zip(patches.parts, patches.corners, own_stresses, strict=True)
            ]
            for part, work in zip(patches.parts, shared(works, large(self._groups)), strict=True):
                squares[part.numbers] = work[:, 0]
                total += float(work[:, 1].sum())
            nodal.append((patches.nodes, fitted[2][:, 0]))
        return StressError(squares=squares, norm_square=total, nodal=tuple(nodal))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Cells:
    """Cells of one body and family."""

    block: Block
    index: IntArray
    space: Space

    @cached_property
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

    def at(self, functions: Array) -> Array:
        """(m, q, d) Places of points of the cells, of shape functions (q, k) there."""
        return places(self.space.mesh.points[self.nodes], functions)

    def work(
        self, rows: IntArray, stress: Array, fitted: tuple[Array, Array, Array], compliance: Array, model: Model
    ) -> Array:
        """``int s : C^-1 : s`` of every cell, (m, 2): of recovered stresses less those of the cell, and of these.

        Parameters
        ----------
        rows : (m, a) of the corners among those that are fitted
        stress : (m, p, 4 or 6) at the best points
        fitted : centres, sizes and coefficients of the corners
        compliance : strains of unit stresses
        model : tells the thickness
        """
        family, degree = self.block.family, _DEGREES[self.order]
        linear = shapes_in_cells(family.rstrip("0123456789"), degree)[0]
        at, volumes = self._quadrature(model, degree)
        own = linear @ self.block.to_nodes[: linear.shape[1]]
        found = np.zeros((len(self.index), 2))
        add_work((rows, stress, volumes), (np.ascontiguousarray(linear), own), at, fitted, compliance, found)
        return found

    def _quadrature(self, model: Model, degree: int) -> tuple[Array, Array]:
        """Places (m, q, d) and volumes (m, q) of quadrature points."""
        values, slopes, weights = shapes_in_cells(self.block.family, degree)
        nodes, at = self.space.mesh.points[self.nodes], self.at(values)
        sizes = np.abs(determinants(jacobians(nodes, slopes)))
        return at, np.ascontiguousarray(weights * sizes * measure(model, at, self.numbers))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Patches:
    """Which cells of a body are around its corners.

    Attributes
    ----------
    parts : of its cells, numbered part after part
    nodes : (n,) that are corners
    corners : (m, a) of every part, their places among these
    around : where the cells of every corner begin (n + 1,), and these
    points : where the best points of every cell begin (m + 1,), and their places (p, d)
    centres, sizes : (n, d) and (n,) of the patches, length
    monomials : of the polynomials
    """

    parts: Sequence[_Cells]
    nodes: IntArray
    corners: Sequence[IntArray]
    around: tuple[IntArray, IntArray]
    points: tuple[IntArray, Array]
    centres: Array
    sizes: Array
    monomials: int

    @staticmethod
    def of(space: Space, parts: Sequence[_Cells]) -> _Patches:
        """Of the cells of a body."""
        count, d = len(space.mesh.points), space.dimension
        held = among([part.corners for part in parts], count)
        nodes, number = np.flatnonzero(held), np.cumsum(held) - 1
        corners = [np.ascontiguousarray(number[part.corners], np.int64) for part in parts]
        flat = np.concatenate([own.ravel() for own in corners])
        monomials = _count(d, max(part.order for part in parts))
        cells, points = (
            _starts(parts, [width(part) for part in parts])
            for width in (lambda part: part.corners.shape[1], lambda part: len(part.block.stress_values))
        )
        touching = cells_at_corners((cells, flat), len(nodes))
        around, narrow = touching, among(_skin(space, parts), count)[nodes]
        narrow |= _samples(around, points) < _POINTS * monomials
        for _ in range(_LAYERS):
            if not narrow.any():
                break
            around = wider_patches((cells, flat), touching, around, narrow)
            narrow &= _samples(around, points) < _POINTS * monomials
        spans = np.concatenate([_spans(space.mesh.points, part.corners) for part in parts])
        sizes = np.bincount(flat, np.repeat(spans, np.diff(cells))) / np.diff(touching[0])
        at = np.concatenate([part.at(part.block.stress_values).reshape(-1, d) for part in parts])
        return _Patches(
            parts=parts,
            nodes=nodes,
            corners=corners,
            around=around,
            points=(points, at),
            centres=space.mesh.points[nodes],
            sizes=sizes,
            monomials=monomials,
        )

    def fitted(self, stresses: Sequence[Array]) -> tuple[Array, Array, Array]:
        """Centres, sizes and coefficients (n, monomials, 4 or 6) of polynomials of ``(x - centre) / size``.

        Parameters
        ----------
        stresses : (m, p, 4 or 6) of every part at its best points
        """
        values = np.concatenate([stress.reshape(-1, stress.shape[2]) for stress in stresses])
        found = np.empty((len(self.nodes), self.monomials, values.shape[1]))
        (starts, cells), points = self.around, (*self.points, values)

        def some(low: int, high: int) -> None:
            patches = starts[low : high + 1], cells
            fit(patches, points, self.centres[low:high], self.sizes[low:high], _REGULAR, found[low:high])

        by_ranges(some, len(found), worth=len(found) > _SHARED_CORNERS)
        return self.centres, self.sizes, found


def _starts(parts: Sequence[_Cells], widths: Sequence[int]) -> IntArray:
    """(m + 1,) Where what every cell of some parts has as many of begins."""
    each = np.repeat(widths, [len(part.index) for part in parts])
    return np.concatenate([[0], np.cumsum(each)])


def _samples(patches: tuple[IntArray, IntArray], points: IntArray) -> IntArray:
    """(n,) Points of patches."""
    starts, cells = patches
    return np.asarray(np.add.reduceat(np.diff(points)[cells], starts[:-1]))


def _spans(points: Array, corners: IntArray) -> Array:
    """(m,) Diagonals of the boxes around cells, length."""
    at = [points[own] for own in corners.T]
    return np.asarray(np.linalg.norm(np.maximum.reduce(at) - np.minimum.reduce(at), axis=1))


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
