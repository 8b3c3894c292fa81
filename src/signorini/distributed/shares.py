# SPDX-License-Identifier: BSD-3-Clause
"""Whose fields a rank writes: every cell is of one rank, which is sent those beside its own as well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.distributed.pieces import PartOfBodies
from signorini.fem.cyclic import cyclic_sides
from signorini.fem.stress import space_of
from signorini.fem.thermal import given_temperature
from signorini.model.conditions import Load
from signorini.model.links import CyclicSymmetry
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class StrainedPart(PartOfBodies):
    """Some cells of a mesh, with all that their stresses depend on beside displacements.

    Attributes
    ----------
    cell_numbers : (k,) of the cells in the mesh, ascending
    numbers : (bodies of the part,) of the bodies in the model
    node_numbers : (m,) what results call the nodes
    loads : temperatures at the nodes, (m,)
    symmetries, sides : of sectors, and by name the nodes of their sides, counted in the part: those that have both
    extent : (d,) of the whole mesh, length
    """

    cell_numbers: IntArray
    numbers: IntArray
    node_numbers: IntArray
    loads: tuple[Load, ...]
    symmetries: tuple[CyclicSymmetry, ...]
    sides: Mapping[str, IntArray]
    extent: Array

    def strained(self) -> Model:
        """A model of these cells, with temperatures and symmetries."""
        of_mesh = {"node_numbers": self.node_numbers, "nodes": self.sides}
        model = self.model(of_mesh, loads=self.loads, cyclic_symmetries=self.symmetries)
        vars(model.mesh)["extent"] = self.extent  # nodes of two sides are as near to each other as in the whole mesh
        return model


class FieldShare(NamedTuple):
    """Cells that a rank writes, and those beside them, which averages at their nodes need.

    Attributes
    ----------
    part : all of them
    own : (k,) cells that the rank writes
    """

    part: StrainedPart
    own: BoolArray


class PartsOfModel:
    """Parts of a model, each of some cells; the mesh is asked for once.

    Parameters
    ----------
    model : of the bodies
    """

    def __init__(self, model: Model) -> None:
        self.model, self.cells = model, model.mesh.cells
        self._points, self._labels, self._bodies = model.mesh.points, model.mesh.labels, model.body_of_cells()
        heated = (load for load in model.loads if load.temperature is not None)
        self._heats = {load: given_temperature(load, self._points) for load in heated}

    @cached_property
    def _sides(self) -> list[tuple[IntArray, IntArray]]:
        """Nodes of both sides of every symmetry, each beside that which it is turned to."""
        count = len(self.model.cyclic_symmetries)
        space = space_of(self.model) if count else None
        return [cyclic_sides(space, self.model, j)[1:] for j in range(count) if space is not None]

    def none(self) -> BoolArray:
        """(n,) Nodes, none of which is chosen."""
        return np.zeros(len(self._points), dtype=np.bool_)

    def around(self, nodes: BoolArray) -> list[BoolArray]:
        """Of every family (m,) cells that averages at some nodes need, those of the sectors beside among them.

        Parameters
        ----------
        nodes : (n,) whether it is one of them
        """
        asked, known = nodes.copy(), -1
        while known != (known := int(asked.sum())):
            for first, second in self._sides:
                either = asked[first] | asked[second]
                asked[first[either]] = asked[second[either]] = True
        return [np.asarray(asked[cells].any(axis=1)) for cells in self.cells.values()]

    def of(self, chosen: Sequence[BoolArray]) -> StrainedPart:
        """Some of the cells.

        Parameters
        ----------
        chosen : of every family (m,) whether a cell is in it
        """
        model, touched = self.model, self.none()
        for here, cells in zip(chosen, self.cells.values(), strict=True):
            touched[cells[here]] = True
        nodes, place, numbered = np.flatnonzero(touched), np.cumsum(touched) - 1, np.flatnonzero(np.concatenate(chosen))
        numbers, body = np.unique(self._bodies[numbered], return_inverse=True)
        names = {model.bodies[i].name for i in numbers}
        symmetries: list[CyclicSymmetry] = []
        sides: dict[str, IntArray] = {}
        for j, (symmetry, ends) in enumerate(zip(model.cyclic_symmetries, self._sides, strict=True)):
            both = touched[ends[0]] & touched[ends[1]]
            if both.any():
                names_of_sides = f"first side {j}", f"second side {j}"
                symmetries.append(replace(symmetry, first=names_of_sides[0], second=names_of_sides[1]))
                sides |= {name: place[nodes[both]] for name, nodes in zip(names_of_sides, ends, strict=True)}
        return StrainedPart(
            nodes=nodes,
            points=self._points[nodes],
            cells={
                family: place[cells[here]]
                for (family, cells), here in zip(self.cells.items(), chosen, strict=True)
                if here.any()
            },
            bodies=[model.bodies[i] for i in numbers],
            body=body,
            kind=model.kind,
            thickness=model.thickness,
            cell_numbers=numbered,
            numbers=numbers,
            node_numbers=self._labels[nodes],
            loads=tuple(replace(load, temperature=at[nodes]) for load, at in self._heats.items() if load.on in names),
            symmetries=tuple(symmetries),
            sides=sides,
            extent=model.mesh.extent,
        )


def shares(model: Model, owner: IntArray, ranks: int) -> Iterator[FieldShare]:
    """The shares of all ranks, one after the other.

    Parameters
    ----------
    model : of the bodies
    owner : (n,) rank of every node
    ranks : how many there are
    """
    parts = PartsOfModel(model)
    for rank in range(ranks):
        mine = [owner[cells[:, 0]] == rank for cells in parts.cells.values()]
        touched = parts.none()
        for own, cells in zip(mine, parts.cells.values(), strict=True):
            touched[cells[own]] = True
        here = parts.around(touched)
        own = np.concatenate([own[near] for own, near in zip(mine, here, strict=True)])
        yield FieldShare(parts.of(here), own)
