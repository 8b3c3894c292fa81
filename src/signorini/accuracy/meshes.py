# SPDX-License-Identifier: BSD-3-Clause
"""A model on finer and finer meshes: as many cells as an accuracy is expected to need, where errors are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from signorini.accuracy.curves import curves_of
from signorini.accuracy.kept_nodes import KeptNodes
from signorini.accuracy.node_values import CarriedValues, has_node_values
from signorini.accuracy.rest_of_skin import with_rest, without_rest
from signorini.accuracy.sector_sides import sector_twins
from signorini.arrays import Array, BoolArray, IntArray
from signorini.errors import InputError
from signorini.fem.jacobian import determinants
from signorini.meshing.simplices import Curve, Simplices, corner_numbers
from signorini.model.accuracy import Accuracy
from signorini.model.links import Equation, Term
from signorini.model.mesh import CORNERS, NODES_PER_CELL, Mesh
from signorini.model.model import Model

SHARE = 0.7
"""Of the squares of the errors of all cells: those that have it are refined (Doerfler)."""

_FALL = 1.5
"""Power of its size with which the square of the error of a cell is expected to fall: between 3, of quadratic cells in
the plane where stresses are smooth, and 1.5 at the end of a contact, where they grow as the root of the distance."""

_FALL_TOGETHER = 2.0
"""The same for all cells together, as they have fallen in the plane where ten pairs touch or more: 1.6 and more."""

_ALL_EDGES = {3: 1, 4: 3}
"""How many times a simplex of as many corners is refined until all its edges are halved, about."""

_CELLS_MORE = 4
"""Cells more for each that is refined: it becomes two to four, and neighbours are bisected too."""


@dataclass(frozen=True, kw_only=True)
class Growth:
    """How many times the cells of a mesh the next one has.

    Attributes
    ----------
    least, most : > 1
    share : of the errors, that is enough: with fewer cells than most where they are expected to fall to it
    """

    least: float
    most: float
    share: float = 0.0


class RefinedMeshes:
    """A model on finer and finer meshes.

    Parameters
    ----------
    model : on the mesh to begin with
    request : whose shapes new nodes go onto

    Attributes
    ----------
    notes : how the mesh is made anew
    simplices : of the mesh as it is
    """

    def __init__(self, model: Model, request: Accuracy) -> None:
        self._kept = KeptNodes(model)
        model = self._kept.model
        mesh, d = model.mesh if request.geometry is None else with_rest(model.mesh), model.dimension
        self._model, self._curves = model, _curves(mesh, request)
        cut = [family for family in mesh.cells if CORNERS[family] != d + 1]
        self._order = 1 if not cut and is_linear(model) else 2
        self.notes = tuple(f"'{name}' follows {curve}" for name, curve in self._curves.items())
        if cut:
            kind = "triangles" if d == 2 else "tetrahedra"
            self.notes += (
                f"{' and '.join(cut)} cells are cut into quadratic {kind}, which are halved where they lack",
            )
        self.simplices = Simplices.of(mesh)
        if model.cyclic_symmetries:
            self.simplices = replace(self.simplices, twins=sector_twins(model, self.simplices))
        self._equations = [_on_corners(equation, i, mesh) for i, equation in enumerate(model.equations)]
        self._values = CarriedValues(model, self.simplices) if has_node_values(model) else None

    def first(self) -> Model:
        """On the simplices of the mesh that was given."""
        return self._posed(self.simplices, self._values)

    def next(self, weights: Array, growth: Growth) -> Model:
        """On simplices refined where errors are.

        Parameters
        ----------
        weights : (m,) squares of the errors of the cells, or what these count for
        growth : of the number of cells
        """
        self.simplices = grown(self.simplices, weights, growth, self._curves)
        if self._values is not None:
            self._values.refine(self.simplices)
        return self._posed(self.simplices, self._values)

    def halved(self, cells: BoolArray) -> Model:
        """On simplices of which some are halved, with all their edges; parents and origins go on from the same mesh.

        Parameters
        ----------
        cells : (m,) which
        """
        finer = halved(self.simplices, cells, self._curves)
        if self._values is not None:
            self._values.refine(finer)
        self.simplices = _since(self.simplices, finer)
        return self._posed(self.simplices, self._values)

    def _posed(self, simplices: Simplices, values: CarriedValues | None) -> Model:
        mesh = self._kept.on(without_rest(simplices.mesh(self._order, self._curves)))
        model = replace(self._model, mesh=mesh) if values is None else values.on(mesh)
        bodies = [
            replace(body, formulation=None) if body.formulation == "incompatible" else body for body in model.bodies
        ]
        return replace(model, bodies=bodies, equations=self._equations)


def grown(simplices: Simplices, squares: Array, growth: Growth, curves: dict[str, Curve]) -> Simplices:
    """Simplices refined again and again where errors are, as they are expected to fall, until they are enough.

    Parents and origins are those since the simplices that are given.

    Parameters
    ----------
    simplices : to begin with
    squares : (m,) of the errors of the cells
    growth : of the number of cells
    curves : true shapes of boundaries
    """
    least, most = (times * len(simplices.cells) for times in (growth.least, growth.most))
    found, sizes, left, together = _unrefined(simplices), _sizes(simplices), squares, squares
    enough = growth.share**2 * float(squares.sum())
    while len(found.cells) < least or (len(found.cells) < most and float(together.sum()) > enough):
        room = int((most - len(found.cells)) / _CELLS_MORE) + 1
        finer = found.refined(marked(left)[:room], curves)
        smaller = _sizes(finer)
        fall = smaller / sizes[finer.origin]
        left, together = left[finer.origin] * fall**_FALL, together[finer.origin] * fall**_FALL_TOGETHER
        found, sizes = _since(found, finer), smaller
    return found


def halved(simplices: Simplices, cells: BoolArray, curves: dict[str, Curve]) -> Simplices:
    """Simplices of which some are halved until all their edges are, about; parents and origins as of `grown`.

    Parameters
    ----------
    simplices : to begin with
    cells : (m,) which
    curves : true shapes of boundaries
    """
    found = _unrefined(simplices)
    for _ in range(_ALL_EDGES[simplices.cells.shape[1]]):
        found = _since(found, found.refined(np.flatnonzero(cells[found.origin]), curves))
    return found


def _unrefined(simplices: Simplices) -> Simplices:
    """With parents and origins that begin with these simplices."""
    corners, cells = np.arange(len(simplices.points)), np.arange(len(simplices.cells))
    return replace(simplices, parents=np.column_stack([corners, corners]), origin=cells)


def _since(found: Simplices, finer: Simplices) -> Simplices:
    """Simplices that others were refined to, with parents and origins that begin where those of these do."""
    parents = np.vstack([found.parents, finer.parents[len(found.parents) :]])
    return replace(finer, parents=parents, origin=found.origin[finer.origin])


def _on_corners(equation: Equation, i: int, mesh: Mesh) -> Equation:
    """Equation i with the numbers that nodes have on refined meshes, where corners come first."""
    corner, terms = corner_numbers(mesh), list[Term]()
    for k, (on, axis, factor) in enumerate(equation.terms):
        if isinstance(on, int):
            own = corner[mesh.labels == on]
            if not len(own) or own[0] < 0:
                words = f"is node {on}; expected a corner of some cell, or a node of none, where the mesh is refined"
                raise InputError(words, where=("equation", i, "terms", k, 0))
            on = int(own[0]) + 1
        terms.append((on, axis, factor))
    return replace(equation, terms=terms)


def _curves(mesh: Mesh, request: Accuracy) -> dict[str, Curve]:
    """Of boundaries: those of the geometry, where there is one, and those that are given or found."""
    if request.geometry is None:
        return curves_of(mesh, request.shapes)
    from signorini.accuracy.gmsh_geometry import GmshGeometry  # not before a geometry is given

    given = {name: shape for name, shape in curves_of(mesh, request.shapes).items() if name in request.shapes}
    return given | GmshGeometry(Path(request.geometry)).curves(mesh, request.shapes)


def marked(squares: Array) -> IntArray:
    """The fewest cells that have `SHARE` of the squares."""
    order = np.argsort(-squares, kind="stable")
    return order[: int(np.searchsorted(np.cumsum(squares[order]), SHARE * squares.sum())) + 1]


def is_linear(model: Model) -> bool:
    """Whether all cells are."""
    return all(CORNERS[family] == NODES_PER_CELL[family] for family in model.mesh.cells)


def _sizes(simplices: Simplices) -> Array:
    """(m,) Areas or volumes of simplices, but for a factor."""
    corners = simplices.points[simplices.cells]
    return np.asarray(np.abs(determinants(corners[:, 1:] - corners[:, :1])))
