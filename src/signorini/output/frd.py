# SPDX-License-Identifier: BSD-3-Clause
"""Results as CalculiX writes them (``.frd``, text), for cgx, PrePoMax and converters such as ccx2paraview."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from signorini._version import __version__
from signorini.arrays import Array, BoolArray, IntArray, among, padded, places_among, stored
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.by_rows import FieldsByRows, portions
from signorini.output.ccx_contact import slave_values
from signorini.solution.history import History
from signorini.solution.results import StepResult

# family: number of the element type, nodes of it that are written
_TYPES = {
    **{"triangle": (7, 3), "triangle6": (8, 6), "quad": (9, 4), "quad8": (10, 8), "quad9": (10, 8)},
    **{"hexahedron": (1, 8), "wedge": (2, 6), "tetra": (3, 4), "tetra10": (6, 10)},
    **{"hexahedron20": (4, 20), "hexahedron27": (4, 20), "wedge15": (5, 15)},
}
# in .frd the upright edges come before those of the top
_UPRIGHT = {20: [*range(12), *range(16, 20), *range(12, 16)], 15: [*range(9), *range(12, 15), *range(9, 12)]}
_TENSOR = (("SXX", 1, 1), ("SYY", 2, 2), ("SZZ", 3, 3), ("SXY", 1, 2), ("SYZ", 2, 3), ("SZX", 3, 1))
_MIN_NUMBER = 1e-99  # smaller ones are written as 0: exponents of three digits would not leave room for a sign
_CONTACT = ("COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2")


def write_frd(history: History, fields: FieldsByRows, path: Path, times: Sequence[float] = ()) -> None:
    """Write the end of every step: DISP, FORC, STRESS (averaged at nodes), CONTACT on the nonmortar nodes.

    Where bodies yield, also PE, which is what CalculiX calls the equivalent plastic strain.

    Nodes and elements keep their numbers in the mesh or deck.

    Parameters
    ----------
    history : with a step at least
    fields : of its model
    path : of the file
    times : (steps,) at the end of every step; without them its number

    Raises
    ------
    InputError
        If nothing was solved.
    """
    _ = history.last
    with atomic_write(path) as aside, aside.open("w", encoding="ascii", errors="replace", newline="\n") as file:
        for lines in _document(history, fields, times or range(1, len(history.steps) + 1)):
            file.write(lines)


def _document(history: History, fields: FieldsByRows, times: Sequence[float]) -> Iterator[str]:
    model = history.model
    mesh = model.mesh
    rows = (mesh.nodes_of_cells(family, some) for family, (count, _) in mesh.shapes.items() for some in portions(count))
    used = among(rows, mesh.number_of_nodes)
    count_used = int(used.sum())
    yield f"    1C{model.title[:66]}\n    1UPGM               signorini\n"
    yield f"    1UVERSION           Version {__version__}\n"
    for number, body in enumerate(model.bodies, start=1):
        yield f"    1UMAT{number:5d}{body.name[:60]}\n"
    yield f"    2C                  {count_used:12d}                                     1\n"
    yield from _records(mesh, used, lambda nodes: padded(mesh.places_of(nodes), 3))
    yield " -3\n"
    yield f"    3C                  {mesh.number_of_cells:12d}                                     1\n"
    yield from _elements(model)
    yield " -3\n"
    count = 0
    for number, step in enumerate(history.steps, start=1):
        for name, parts, values in _blocks(model, fields, step):
            count += 1
            yield f"    1PSTEP{count:26d}{number:12d}{number:12d}\n"
            time = float(times[number - 1])
            yield f"  100CL{100 + number:5d}{time:12.5E}{count_used:12d}{'':20s}0{number:5d}{'':10s} 1\n"
            yield f" -4  {name:8s}{len(parts):5d}    1\n" + "".join(parts)
            yield from _records(mesh, used, values)
            yield " -3\n"
    yield " 9999\n"


def _elements(model: Model) -> Iterator[str]:
    mesh, owner = model.mesh, model.body_of_cells() + 1
    first = 0
    for family, (count, _) in mesh.shapes.items():
        kind, width = _TYPES[family]
        for rows in portions(count):
            cells = mesh.nodes_of_cells(family, rows)[:, _UPRIGHT.get(width, slice(width))]
            nodes = mesh.labels_of(cells.ravel()).reshape(-1, cells.shape[1]).tolist()
            labels, bodies = mesh.cell_labels_of(first + rows).tolist(), owner[first + rows].tolist()
            lines = []
            for label, body, cell in zip(labels, bodies, nodes, strict=True):
                lines.append(f" -1{label:10d}{kind:5d}    0{body:5d}\n")
                words = [f"{node:10d}" for node in cell]
                lines += [f" -2{''.join(words[start : start + 10])}\n" for start in range(0, len(words), 10)]
            yield "".join(lines)
        first += count


def _blocks(
    model: Model, fields: FieldsByRows, step: StepResult
) -> Iterator[tuple[str, list[str], Callable[[IntArray], Array]]]:
    """Name, component lines and what gives values (k, c) at some nodes (k,) of every field."""
    yield "DISP", _vector("D"), lambda nodes: padded(stored(step, "displacement")[nodes], 3)
    yield "FORC", _vector("F"), lambda nodes: padded(stored(step, "external")[nodes], 3)
    tensor = [f" -5  {name:8s}    1    4{i:5d}{j:5d}\n" for name, i, j in _TENSOR]
    yield "STRESS", tensor, lambda nodes: fields.at_nodes(step, "S", nodes)
    if step.plastic is not None:
        yield "PE", [" -5  PE          1    1    0    0\n"], lambda nodes: fields.at_nodes(step, "PEEQ", nodes)
    if step.contacts:
        pairs = [
            (result.node, slave_values(contact, result))
            for contact, result in zip(model.contacts, step.contacts, strict=True)
        ]
        names = [f" -5  {name:8s}    1    1    0    0\n" for name in _CONTACT]
        yield "CONTACT", names, lambda nodes: _of_pairs(pairs, nodes)


def _of_pairs(pairs: Sequence[tuple[IntArray, Array]], nodes: IntArray) -> Array:
    """(k, 6) Values of contacts at some nodes, ascending, of which the last one has a node; zeros elsewhere."""
    values = np.zeros((len(nodes), 6))
    for own, found in pairs:
        here, place = places_among(own, nodes)
        values[place] = found[here]
    return values


def _vector(letter: str) -> list[str]:
    parts = [f" -5  {letter}{i:<7d}    1    2{i:5d}    0\n" for i in (1, 2, 3)]
    return [*parts, " -5  ALL         1    2    0    0    1ALL\n"]


def _records(mesh: Mesh, used: BoolArray, values_at: Callable[[IntArray], Array]) -> Iterator[str]:
    """One line a node of cells, so many at a time."""
    for some in portions(len(used)):
        nodes = some[used[some]]
        values = values_at(nodes)
        line = " -1%10d" + "%12.5E" * values.shape[1]
        rows: Sequence[Sequence[float]] = np.where(np.abs(values) < _MIN_NUMBER, 0.0, values).tolist()
        labels = mesh.labels_of(nodes).tolist()
        yield "".join(line % (label, *row) + "\n" for label, row in zip(labels, rows, strict=True))
