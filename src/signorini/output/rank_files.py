# SPDX-License-Identifier: BSD-3-Clause
"""Files of bodies that ranks write: each recovers the stresses of its share of the cells, the first one the index."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from signorini.arrays import Array, IntArray, stored
from signorini.distributed.kept_rows import RowsKept, rows_of_all
from signorini.distributed.mesh_rows import at_hand
from signorini.distributed.ranks import Team, several_ranks
from signorini.distributed.shares import FieldShare, shares
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.dataclasses_json import AnyArray
from signorini.output.fields import BodyFields, Fields, State
from signorini.output.vtu import FIELDS, grid_of, write_grid
from signorini.solution.history import History
from signorini.solution.nodal_forces import NodalForces
from signorini.solution.results import Instant

if TYPE_CHECKING:
    import meshio

_KINDS = {"f": "Float", "i": "Int", "u": "UInt"}  # what VTK calls kinds of numbers, before their bits

Arrays = Mapping[str, list[tuple[str, str, int]]]
"""What files hold, "points" and "cells": name, type and components of every array."""


class OwnShare:
    """The share of a rank, which recovers its fields in one state after the other.

    Attributes
    ----------
    nodes : (m,) of the mesh, ascending

    Parameters
    ----------
    share : its cells
    """

    def __init__(self, share: FieldShare) -> None:
        self._model = share.model(loads=share.loads, node_numbers=share.node_numbers)
        self._fields, self._numbers, self.nodes = Fields(self._model), share.numbers, share.nodes
        by_family = self._model.mesh.by_family
        written = by_family(np.where(share.own, share.body, -1))
        families = list(zip(by_family(share.body), written, strict=True))
        self._kept = [
            own[body == i] == i for i in range(len(share.bodies)) for body, own in families if (body == i).any()
        ]

    def at(self, state: State) -> BodyFields:
        """Own cells in a state that knows displacements and forces at the nodes of the share."""
        fields = self._fields.at(state, strained=True).among(self._kept)
        return replace(fields, body=tuple(self._numbers[body] for body in fields.body))


class FieldsOnRanks:
    """Bodies whose fields ranks recover and write, each those of its own cells.

    Parameters
    ----------
    team : the ranks
    model : of the bodies
    owner : (n,) rank of every node; a cell is of the rank of its first one
    """

    def __init__(self, team: Team, model: Model, owner: IntArray) -> None:
        self._team, self._number = team, team.kept(self)
        self._nodes: list[IntArray] = []
        self._writing: list[bool] = []
        with at_hand(model.mesh):
            team.everywhere(_hold, self._number, pieces=self._kept(shares(model, owner, team.size)))

    def _kept(self, made: Iterator[FieldShare]) -> Iterator[FieldShare]:
        for share in made:
            self._nodes.append(share.nodes)
            self._writing.append(bool(share.own.any()))
            yield share

    def files(self, name: str) -> list[str]:
        """Files of a state: ``fields/solution_rank0.vtu``, ..., ``solution.pvtu``, the index of the others.

        Parameters
        ----------
        name : of the index, in the folder that the names start in
        """
        path = Path(name)
        folder = path.parent if path.parent.name == FIELDS else path.parent / FIELDS
        ranks = (rank for rank, writes in enumerate(self._writing) if writes)
        return [*((folder / f"{path.stem}_rank{rank}.vtu").as_posix() for rank in ranks), name]

    def write(self, state: State, folder: Path, name: str, *, compress: bool = False) -> None:
        """Write a state: every rank its file, and when all are there the first one the index.

        Parameters
        ----------
        state : with its displacement
        folder, name : for the files, and of the index in it
        compress : whether files are to be half as large, which takes several times as long

        Raises
        ------
        OSError
            If a rank cannot write its file.
        """
        *files, _ = self.files(name)
        (folder / files[0]).parent.mkdir(exist_ok=True)
        paths, u = iter([str((folder / file).resolve()) for file in files]), stored(state, "displacement")
        kept = isinstance(u, RowsKept)  # then ranks have it of each other
        asked = (
            (_part_of(state, None if kept else u[nodes], nodes), next(paths)) if writes else None
            for nodes, writes in self._asked()
        )
        found = self._team.everywhere(_write, self._number, u.place if kept else None, compress, pieces=asked)
        for error in found:
            if isinstance(error, OSError):
                raise error
        index = folder / name
        sources = [Path(file).relative_to(Path(name).parent).as_posix() for file in files]
        with atomic_write(index) as aside:
            aside.write_text(indexed(next(arrays for arrays in found if arrays), sources) + "\n", encoding="utf-8")

    def _asked(self) -> Iterator[tuple[IntArray, bool]]:
        return zip(self._nodes, self._writing, strict=True)


def fields_on_ranks(history: History) -> FieldsOnRanks | None:
    """The bodies of a history that several ranks have solved; None where one process writes one file.

    Such are fatigue, which the first rank looks for in the stresses of all nodes, and cyclic sectors, whose averages
    take in cells of the other side.
    """
    team, model = several_ranks(), history.model
    owner = None if team is None else team.owners.get(model.mesh)
    if team is None or owner is None or model.fatigue or model.cyclic_symmetries:
        return None
    return FieldsOnRanks(team, model, owner)


def _part_of(state: State, u: Array | None, nodes: IntArray) -> Instant:
    """What a rank needs of a state at its nodes, which ascend, with their displacements where it has not got them."""
    forces = state.nodal_forces
    if forces is not None:
        here = np.isin(forces.node, nodes)
        forces = NodalForces(
            node=np.searchsorted(nodes, forces.node[here]), reaction=forces.reaction[here], contact=forces.contact[here]
        )
    return Instant(
        load_factor=state.load_factor,
        what="share",
        contacts=(),
        work=np.nan,
        displacement=u,
        factors=dict(state.factors),
        nodal_forces=forces,
    )


def _hold(team: Team, share: FieldShare, number: int) -> None:
    """Keep a share that has cells of its own."""
    if share.own.any():
        team.held[number] = OwnShare(share)


def _write(
    team: Team, asked: tuple[Instant, str] | None, number: int, moved: tuple[int, IntArray] | None, compress: bool
) -> Arrays | OSError | None:
    """Write own cells, and say what arrays the file holds, or why it cannot be written.

    Where ranks keep displacements of all nodes, ``moved`` says where, see `rows_of_all`.
    """
    own: OwnShare | None = team.held.get(number)
    nodes = np.zeros(0, dtype=np.int64) if own is None else own.nodes
    u = None if moved is None else rows_of_all(team, *moved, nodes)
    if asked is None or own is None:
        return None
    state, path = asked
    grid = grid_of(own.at(state if u is None else replace(state, displacement=u)))
    try:
        write_grid(grid, Path(path), compress=compress)
    except OSError as error:  # of a full disk the first rank tells, and the run goes on
        return error
    return arrays_of(grid)


def arrays_of(grid: meshio.Mesh) -> Arrays:
    """Names, types and components of the arrays of a grid, see `Arrays`."""

    def said(name: str, values: AnyArray) -> tuple[str, str, int]:
        kind = f"{_KINDS[values.dtype.kind]}{8 * values.dtype.itemsize}"
        return name, kind, values.shape[1] if values.ndim > 1 else 1

    return {
        "points": [said(name, values) for name, values in grid.point_data.items()],
        "cells": [said(name, blocks[0]) for name, blocks in grid.cell_data.items()],
    }


def indexed(arrays: Arrays, files: list[str]) -> str:
    """A PVTU document of files that hold the same arrays.

    Parameters
    ----------
    arrays : of each of them
    files : where they are, seen from the index

    Examples
    --------
    >>> print(indexed({"points": [("node", "Int64", 1)], "cells": []}, ["fields/solution_rank0.vtu"]))
    <VTKFile type="PUnstructuredGrid" version="0.1">
      <PUnstructuredGrid GhostLevel="0">
        <PPoints>
          <PDataArray type="Float64" Name="Points" NumberOfComponents="3" />
        </PPoints>
        <PPointData>
          <PDataArray type="Int64" Name="node" NumberOfComponents="1" />
        </PPointData>
        <PCellData />
        <Piece Source="fields/solution_rank0.vtu" />
      </PUnstructuredGrid>
    </VTKFile>
    """
    root = ElementTree.Element("VTKFile", type="PUnstructuredGrid", version="0.1")
    grid = ElementTree.SubElement(root, "PUnstructuredGrid", GhostLevel="0")
    parts: dict[str, Any] = {"PPoints": [("Points", "Float64", 3)], "PPointData": arrays["points"]}
    for part, held in (parts | {"PCellData": arrays["cells"]}).items():
        within = ElementTree.SubElement(grid, part)
        for name, kind, components in held:
            ElementTree.SubElement(
                within, "PDataArray", {"type": kind, "Name": name, "NumberOfComponents": str(components)}
            )
    for file in files:
        ElementTree.SubElement(grid, "Piece", Source=file)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")
