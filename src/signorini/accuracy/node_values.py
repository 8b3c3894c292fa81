# SPDX-License-Identifier: BSD-3-Clause
"""What a model says node by node, carried to finer meshes: as it varies between the nodes that it was given at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.space import shape_functions
from signorini.meshing.facets import HEXAHEDRON
from signorini.meshing.simplices import Simplices, edge_corners
from signorini.meshing.tetrahedra import cone_simplices
from signorini.model.mesh import CORNERS, Mesh
from signorini.model.model import Model
from signorini.model.varying import NodeValues

_VANISHES = 1e-12  # of the largest shape function: rounding where one vanishes


def has_node_values(model: Model) -> bool:
    """Whether a model says anything node by node."""
    return any(isinstance(part, np.ndarray | NodeValues) for value in _varying(model) for part in _parts(value))


class CarriedValues:
    """Values at the nodes of a mesh, on simplices that its cells are cut into and that are refined.

    Parameters
    ----------
    model : on the mesh to begin with
    simplices : of that
    """

    def __init__(self, model: Model, simplices: Simplices) -> None:
        self._model, self._simplices = model, simplices
        mesh = model.mesh
        cells, places, first = [], [], 0
        for family, own in mesh.cells.items():
            owner, nodes = cone_simplices(family, own[:, : CORNERS[family]])
            corner = np.argmax(own[owner][:, None, : CORNERS[family]] == nodes[:, :, None], axis=2)
            cells.append(first + owner)
            places.append(_reference_corners(family)[corner])
            first += len(own)
        self._cell, self._place = np.concatenate(cells), np.concatenate(places)

    def refine(self, simplices: Simplices) -> None:
        """Go on with simplices that those before were refined to."""
        before = self._simplices
        shares = _shares(simplices, len(before.points))
        corners = before.cells[simplices.origin]
        rows = np.repeat(simplices.cells, corners.shape[1], axis=1)
        inside = np.asarray(shares[rows.ravel(), np.tile(corners, corners.shape[1]).ravel()])
        inside = inside.reshape(len(corners), corners.shape[1], -1)
        self._place = np.einsum("mij,mjd->mid", inside, self._place[simplices.origin])
        self._cell, self._simplices = self._cell[simplices.origin], simplices

    def on(self, mesh: Mesh) -> Model:
        """The model on a mesh of the simplices.

        Parameters
        ----------
        mesh : linear or quadratic
        """
        matrix, model = self._matrix(mesh), self._model
        known = self._model.mesh
        loads = [
            replace(load, **{key: _carried(getattr(load, key), matrix, known, mesh) for key in _LOADS})
            for load in model.loads
        ]
        supports = [replace(one, u=_carried(one.u, matrix, known, mesh)) for one in model.supports]
        contacts = [
            replace(one, **{key: _carried(getattr(one, key), matrix, known, mesh) for key in _SIDES})
            for one in model.contacts
        ]
        steps = [
            replace(
                step,
                interference={name: _carried(part, matrix, known, mesh) for name, part in step.interference.items()},
            )
            for step in model.steps
        ]
        return replace(model, mesh=mesh, loads=loads, supports=supports, contacts=contacts, steps=steps)

    def _matrix(self, mesh: Mesh) -> sp.csr_array:
        """(nodes, nodes of the mesh to begin with) Shape functions of the cells that nodes lie in."""
        (cells,) = mesh.cells.values()
        ends = edge_corners(self._place.shape[1])
        places = np.concatenate([self._place, self._place[:, ends].mean(axis=2)], axis=1)[:, : cells.shape[1]]
        nodes, first = np.unique(cells.ravel(), return_index=True)
        owner, at = self._cell[first // cells.shape[1]], places.reshape(-1, places.shape[2])[first]
        found, begin = sp.csr_array((len(mesh.points), len(self._model.mesh.points))), 0
        for family, own in self._model.mesh.cells.items():
            inside = (owner >= begin) & (owner < begin + len(own))
            values = shape_functions(family, at[inside].T)[0]
            values[np.abs(values) < _VANISHES] = 0.0
            rows = np.repeat(nodes[inside], own.shape[1])
            entries = (values.ravel(), (rows, own[owner[inside] - begin].ravel()))
            found = found + sp.csr_array(entries, shape=found.shape)
            begin += len(own)
        found.eliminate_zeros()
        return found


_LOADS = ("temperature", "pressure", "traction")
_SIDES = ("gap", "interference")


def _shares(simplices: Simplices, before: int) -> sp.csr_array:
    """(corners, corners before) By which corners lie between those that there were."""
    ends, count = simplices.parents, len(simplices.parents)
    old = np.arange(before)
    found = sp.csr_array((np.ones(before), (old, old)), shape=(count, before))
    halved = np.arange(before, count)
    step = sp.csr_array(
        (np.full(2 * len(halved), 0.5), (np.tile(halved, 2), ends[halved].T.ravel())), shape=(count,) * 2
    )
    left = step
    while left.nnz:  # as many times as edges of edges were halved
        found = found + left @ sp.csr_array((np.ones(before), (old, old)), shape=(count, before))
        left = left @ step
    return sp.csr_array(found)


def _carried(value: Any, matrix: sp.csr_array, before: Mesh, after: Mesh) -> Any:
    """A value, or several, at the nodes of another mesh; what is not given node by node stays.

    Parameters
    ----------
    value : as the model has it
    matrix : from nodes to nodes
    before, after : their meshes
    """
    if isinstance(value, tuple):
        return tuple(_carried(part, matrix, before, after) for part in value)
    if isinstance(value, np.ndarray):
        return matrix @ value
    if not isinstance(value, NodeValues):
        return value
    if value.nodes is None:
        return NodeValues(matrix @ value.values)
    order = np.argsort(before.labels)
    own = order[np.searchsorted(before.labels[order], value.nodes)]
    given, there = np.zeros(len(before.points)), np.zeros(len(before.points))
    given[own], there[own] = value.values, 1.0
    known = np.flatnonzero((abs(matrix) @ (1.0 - there) == 0.0) & (abs(matrix).sum(axis=1) > 0.0))
    return NodeValues((matrix @ given)[known], nodes=after.labels[known])


def _reference_corners(family: str) -> Array:
    """(k, d) Reference coordinates of the corners of a family."""
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    cube = np.array(HEXAHEDRON[:8]) / 2.0
    if family.startswith("wedge"):
        return np.concatenate([np.column_stack([triangle, np.full(3, height)]) for height in (0.0, 1.0)])
    if family.startswith("tetra"):
        return np.concatenate([np.zeros((1, 3)), np.eye(3)])
    return triangle if family.startswith("triangle") else cube[:4, :2] if family.startswith("quad") else cube


def _varying(model: Model) -> Iterator[Any]:
    """All that may be given node by node."""
    for load in model.loads:
        yield from (getattr(load, key) for key in _LOADS)
    for support in model.supports:
        yield support.u
    for contact in model.contacts:
        yield from (getattr(contact, key) for key in _SIDES)
    for step in model.steps:
        yield from step.interference.values()


def _parts(value: Any) -> Iterator[Any]:
    """A value, or the components of one."""
    yield from value if isinstance(value, tuple) else (value,)
