# SPDX-License-Identifier: BSD-3-Clause
"""Whose fields a rank writes: every cell is of one rank, which is sent those beside its own as well."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import BoolArray, IntArray
from signorini.distributed.pieces import PartOfBodies
from signorini.fem.thermal import given_temperature
from signorini.model.conditions import Load
from signorini.model.model import Model


@dataclass(frozen=True, kw_only=True, eq=False)
class FieldShare(PartOfBodies):
    """Cells that a rank writes, and those beside them, which averages at their nodes need.

    Attributes
    ----------
    own : (k,) cells that the rank writes
    cell_numbers : (k,) of the cells in the mesh, ascending
    numbers : (bodies of the part,) of the bodies in the model
    node_numbers : (m,) what results call the nodes
    loads : temperatures at the nodes, (m,)
    """

    own: BoolArray
    cell_numbers: IntArray
    numbers: IntArray
    node_numbers: IntArray
    loads: tuple[Load, ...]


def shares(model: Model, owner: IntArray, ranks: int) -> Iterator[FieldShare]:
    """The shares of all ranks, one after the other.

    Parameters
    ----------
    model : of the bodies
    owner : (n,) rank of every node
    ranks : how many there are
    """
    mesh = model.mesh
    bodies = mesh.by_family(model.body_of_cells())
    heats = {load: given_temperature(load, mesh.points) for load in model.loads if load.temperature is not None}
    for rank in range(ranks):
        mine = [owner[cells[:, 0]] == rank for cells in mesh.cells.values()]
        touched = np.zeros(len(mesh.points), dtype=np.bool_)
        for own, cells in zip(mine, mesh.cells.values(), strict=True):
            touched[cells[own]] = True
        here = [touched[cells].any(axis=1) for cells in mesh.cells.values()]
        for near, cells in zip(here, mesh.cells.values(), strict=True):
            touched[cells[near]] = True
        nodes, place = np.flatnonzero(touched), np.cumsum(touched) - 1
        numbers, body = np.unique(
            np.concatenate([of[near] for of, near in zip(bodies, here, strict=True)]), return_inverse=True
        )
        names = {model.bodies[i].name for i in numbers}
        yield FieldShare(
            nodes=nodes,
            points=mesh.points[nodes],
            cells={
                family: place[cells[near]]
                for (family, cells), near in zip(mesh.cells.items(), here, strict=True)
                if near.any()
            },
            bodies=[model.bodies[i] for i in numbers],
            body=body,
            kind=model.kind,
            thickness=model.thickness,
            own=np.concatenate([own[near] for own, near in zip(mine, here, strict=True)]),
            cell_numbers=np.flatnonzero(np.concatenate(here)),
            numbers=numbers,
            node_numbers=mesh.labels[nodes],
            loads=tuple(replace(load, temperature=at[nodes]) for load, at in heats.items() if load.on in names),
        )
