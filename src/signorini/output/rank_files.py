# SPDX-License-Identifier: BSD-3-Clause
"""Files of bodies that ranks write: each recovers the stresses of its share of the cells, the first one the index."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from signorini.arrays import Array, BoolArray, IntArray, among, places_among, stored
from signorini.distributed.kept_rows import RowsKept, rows_of_all
from signorini.distributed.mesh_rows import at_hand
from signorini.distributed.ranks import Team, ranks_with
from signorini.distributed.shares import FieldShare, shares
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.by_rows import portions
from signorini.output.dataclasses_json import AnyArray
from signorini.output.fatigue_csv import fatigue_arrays, points_of
from signorini.output.fields import BodyFields, Fields, State
from signorini.output.vtu import FIELDS, grid_of, write_grid
from signorini.solution.fatigue_result import FatigueResult
from signorini.solution.history import History
from signorini.solution.nodal_forces import NodalForces
from signorini.solution.results import Instant

if TYPE_CHECKING:
    import meshio

_KINDS = {"f": "Float", "i": "Int", "u": "UInt"}  # what VTK calls kinds of numbers, before their bits


class JudgedRows(NamedTuple):
    """What a criterion of fatigue says at k places.

    Attributes
    ----------
    body, node : (k,) names of bodies, and nodes of the mesh
    values : (k,) of each of the point arrays
    """

    body: NDArray[np.str_]
    node: IntArray
    values: list[Array]


Of = Literal["nodes", "cells"]
"""Of what values are asked for."""

Arrays = Mapping[str, list[tuple[str, str, int]]]
"""What files hold, "points" and "cells": name, type and components of every array."""


class OwnShare:
    """The share of a rank, which recovers its fields in one state after the other.

    Attributes
    ----------
    nodes : (m,) of the mesh, ascending
    state : whose displacements and forces are known at these

    Parameters
    ----------
    share : its cells
    """

    def __init__(self, share: FieldShare) -> None:
        part, mine = share
        self._model = part.strained()
        self._fields, self._numbers, self.nodes = Fields(self._model), part.numbers, part.nodes
        by_family = self._model.mesh.by_family
        written = by_family(np.where(mine, part.body, -1))
        families = list(zip(by_family(part.body), written, strict=True))
        self._kept = [
            own[body == i] == i for i in range(len(part.bodies)) for body, own in families if (body == i).any()
        ]
        cells_of = zip(part.cells.values(), written, strict=True)
        nodes = np.flatnonzero(among((cells[own >= 0] for cells, own in cells_of), len(part.nodes)))
        self._own = {  # of the mesh, and of the share
            "nodes": (part.nodes[nodes], nodes),
            "cells": (part.cell_numbers[mine], np.flatnonzero(mine)),
        }
        self.state: State
        self._further: dict[str, Array] = {}

    def fields(self) -> BodyFields:
        """Own cells in the state, with what criteria of fatigue say of it."""
        fields = replace(self._fields.at(self.state, strained=True), further=self._further).among(self._kept)
        self._further = {}
        return replace(fields, body=tuple(self._numbers[body] for body in fields.body))

    def hear_of_fatigue(self, arrays: Sequence[str], rows: JudgedRows) -> None:
        """Know some of the values of point arrays of the state, which are NaN otherwise.

        Parameters
        ----------
        arrays, rows : their names, and what is known
        """
        bodies = self._fields.stresses(self.state)
        here, place = places_among(rows.node, self.nodes)
        at = points_of(bodies, rows.body[here], place)
        own = at >= 0
        for name, values in zip(arrays, rows.values, strict=True):
            found = self._further.setdefault(name, np.full(sum(len(body.nodes) for body in bodies), np.nan))
            found[at[own]] = values[here][own]

    def values(self, of: Of, what: str, numbers: IntArray) -> tuple[BoolArray, Array] | None:
        """Which of some cells of the mesh are own ones, or nodes are of such, and values there; None where none is.

        Parameters
        ----------
        of, what, numbers : see :class:`signorini.output.by_rows.FieldsByRows`
        """
        own, at = self._own[of]
        here, place = places_among(numbers, own)
        find = self._fields.at_nodes if of == "nodes" else self._fields.in_cells
        return (here, find(self.state, what, at[place])) if here.any() else None


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
        self._told: State | None = None
        with at_hand(model.mesh):
            team.everywhere(_hold, self._number, pieces=self._kept(shares(model, owner, team.size)))

    def _kept(self, made: Iterator[FieldShare]) -> Iterator[FieldShare]:
        for share in made:
            self._nodes.append(share.part.nodes)
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

    def write(
        self, state: State, folder: Path, name: str, *, compress: bool = False, results: Sequence[FatigueResult] = ()
    ) -> None:
        """Write a state: every rank its file, and when all are there the first one the index.

        Parameters
        ----------
        state : with its displacement
        folder, name : for the files, and of the index in it
        compress : whether files are to be half as large, which takes several times as long
        results : what criteria of fatigue say, which files hold too

        Raises
        ------
        OSError
            If a rank cannot write its file.
        """
        self._tell(state)
        for number, result in enumerate(results, start=1):
            self._tell_fatigue(fatigue_arrays(number, result), result)
        *files, _ = self.files(name)
        (folder / files[0]).parent.mkdir(exist_ok=True)
        paths = iter([str((folder / file).resolve()) for file in files])
        asked = (next(paths) if writes else None for writes in self._writing)
        found = self._team.everywhere(_write, self._number, compress, pieces=asked)
        for error in found:
            if isinstance(error, OSError):
                raise error
        index = folder / name
        sources = [Path(file).relative_to(Path(name).parent).as_posix() for file in files]
        with atomic_write(index) as aside:
            aside.write_text(indexed(next(arrays for arrays in found if arrays), sources) + "\n", encoding="utf-8")

    def at_nodes(self, state: State, what: str, nodes: IntArray) -> Array:
        """Values at some nodes, see :class:`signorini.output.by_rows.FieldsByRows`.

        Parameters
        ----------
        state, what, nodes : as there
        """
        return self._values(state, "nodes", what, nodes)

    def in_cells(self, state: State, what: str, cells: IntArray) -> Array:
        """Values in some cells, see :class:`signorini.output.by_rows.FieldsByRows`.

        Parameters
        ----------
        state, what, cells : as there
        """
        return self._values(state, "cells", what, cells)

    def _values(self, state: State, of: Of, what: str, numbers: IntArray) -> Array:
        """Values of ranks that have them; nodes between their cells have the same from each, up to rounding."""
        self._tell(state)
        found = [each for each in self._team.everywhere(_values, self._number, of, what, numbers) if each]
        result = np.zeros((len(numbers), *found[0][1].shape[1:]))
        for here, values in found:
            result[here] = values
        return result

    def _tell_fatigue(self, arrays: Mapping[str, str], result: FatigueResult) -> None:
        """Have ranks know point arrays of a criterion, some places at a time."""
        for some in portions(result.count):
            body, node = (stored(result, name)[some] for name in ("body", "node"))
            rows = JudgedRows(body, node, [stored(result, name)[some] for name in arrays.values()])
            self._team.everywhere(_hear_of_fatigue, self._number, list(arrays), rows)

    def _tell(self, state: State) -> None:
        """Have ranks know a state at the nodes of their shares, unless it is the last one that they were told."""
        if self._told is state:
            return
        self._told, u = state, stored(state, "displacement")
        kept = isinstance(u, RowsKept)  # then ranks have it of each other
        parts = (
            _part_of(state, None if kept else u[nodes], nodes) if writes else None
            for nodes, writes in zip(self._nodes, self._writing, strict=True)
        )
        self._team.everywhere(_hear, self._number, u.place if kept else None, pieces=parts)


def fields_on_ranks(history: History) -> FieldsOnRanks | None:
    """The bodies of a history that several ranks have solved; None where one process writes one file."""
    ranks = ranks_with(history.model.mesh)
    return None if ranks is None else FieldsOnRanks(ranks[0], history.model, ranks[1])


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


def _hear(team: Team, state: Instant | None, number: int, moved: tuple[int, IntArray] | None) -> None:
    """Know a state at the nodes of the share.

    Where ranks keep displacements of all nodes, ``moved`` says where, see `rows_of_all`.
    """
    own: OwnShare | None = team.held.get(number)
    nodes = np.zeros(0, dtype=np.int64) if own is None else own.nodes
    u = None if moved is None else rows_of_all(team, *moved, nodes)
    if own is not None and state is not None:
        own.state = state if u is None else replace(state, displacement=u)


def _hear_of_fatigue(team: Team, number: int, arrays: Sequence[str], rows: JudgedRows) -> None:
    """Know values of point arrays, see `OwnShare.hear_of_fatigue`."""
    own: OwnShare | None = team.held.get(number)
    if own is not None:
        own.hear_of_fatigue(arrays, rows)


def _values(team: Team, number: int, of: Of, what: str, numbers: IntArray) -> tuple[BoolArray, Array] | None:
    """Values of own nodes or cells among some, see `OwnShare.values`."""
    own: OwnShare | None = team.held.get(number)
    return None if own is None else own.values(of, what, numbers)


def _write(team: Team, path: str | None, number: int, compress: bool) -> Arrays | OSError | None:
    """Write own cells, and say what arrays the file holds, or why it cannot be written."""
    own: OwnShare | None = team.held.get(number)
    if path is None or own is None:
        return None
    grid = grid_of(own.fields())
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
