# SPDX-License-Identifier: BSD-3-Clause
"""Values from files: tables with a head, and fields that other programs have written at the nodes of a mesh."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.errors import InputError, brief, one_of
from signorini.meshing.files import open_mesh
from signorini.model.varying import ArcLength, NodeValues, Scattered
from signorini.sources import check_file

_TABLES = (".csv", ".txt", ".tsv")
_PLACES = {("s",): "arc length", ("node",): "node", ("x", "y"): "place", ("x", "y", "z"): "place"}


def read_values(
    path: str | Path, *, column: str = "", start: tuple[float, float] | None = None, dimension: int = 2
) -> ArcLength | NodeValues | Scattered:
    """Values from a table with a head, or a field at the nodes of a mesh.

    A table, ``.csv``, ``.tsv`` or ``.txt``, has the columns ``s`` (arc length), ``node`` (its number) or ``x, y`` and
    in space ``z``, and one of values.

    Parameters
    ----------
    path : a table, or a file of any format that :func:`read_mesh` reads, with data at its points
    column : of the table, or name of the field; by default the only one
    start : where arc length begins, see :class:`signorini.model.varying.ArcLength`
    dimension : of the bodies, 2 or 3

    Raises
    ------
    InputError
        If there are no such values.
    """
    path = Path(path)
    check_file(path)
    if path.suffix.lower() not in _TABLES:
        points, values = _nodal_field(path, column)
        return Scattered(points[:, :dimension], values)
    head, table = _table(path)
    places = [names for names in _PLACES if set(names) <= set(head)]
    if not places:
        raise InputError(f"'{path}' has the columns {', '.join(head)}; expected s, node, or x and y, and one of values")
    names = places[-1]
    rest = [name for name in head if name not in names]
    if (column and column not in rest) or (not column and len(rest) != 1):
        if column:
            raise InputError(f"'{path.name}': {one_of(column, rest, 'column')}", where=("column",))
        raise InputError(
            f"'{path}' has {len(rest)} columns of values, {', '.join(rest) or 'none'}; expected 'column' to name one"
        )
    values = table[:, head.index(column or rest[0])]
    at = table[:, [head.index(name) for name in names]]
    if names == ("node",):
        return NodeValues(values, nodes=_numbers(path, at[:, 0]))
    if names == ("s",):
        if start is None:
            raise InputError("has no 'start'; expected the point near which arc length begins")
        return ArcLength(at=tuple(at[:, 0].tolist()), values=tuple(values.tolist()), start=start)
    if at.shape[1] != dimension:
        raise InputError(f"'{path}' has {at.shape[1]} coordinates; the bodies have {dimension}")
    return Scattered(at, values)


def read_nodal_forces(path: str | Path, *, column: str = "", dimension: int = 2) -> tuple[IntArray, Array]:
    """Numbers of nodes (k,), and a force at each, (k, d).

    Parameters
    ----------
    path : a table with the columns ``node``, ``fx``, ``fy`` and in space ``fz``; or a file of any format that
        :func:`read_mesh` reads, with vectors at its points and their numbers as ``node``, such as ``modes.vtu``
    column : name of the vectors; by default the only ones
    dimension : of the bodies, 2 or 3

    Raises
    ------
    InputError
        If there are no such forces.
    """
    path = Path(path)
    check_file(path)
    axes = ["fx", "fy", "fz"][:dimension]
    if path.suffix.lower() in _TABLES:
        head, table = _table(path)
        if not {"node", *axes} <= set(head):
            raise InputError(f"'{path}' has the columns {', '.join(head)}; expected node, {', '.join(axes)}")
        numbers, forces = table[:, head.index("node")], table[:, [head.index(name) for name in axes]]
    else:
        data = {key: np.asarray(values) for key, values in open_mesh(path).point_data.items()}
        fields = {key: values for key, values in data.items() if values.ndim == 2 and values.shape[1] >= dimension}
        if "node" not in data:
            raise InputError(f"'{path}' has no numbers of nodes at its points, 'node'; expected them beside the forces")
        if not column and len(fields) == 1:
            (column,) = fields
        if column not in fields:
            raise InputError(
                f"'{path.name}': {one_of(column, fields, 'field of vectors at points')}", where=("column",)
            )
        numbers, forces = data["node"], np.asarray(fields[column][:, :dimension], float)
    if not np.isfinite(forces).all():
        raise InputError(f"'{path}' has forces that are not finite; expected numbers")
    return _numbers(path, np.asarray(numbers, float)), forces


def _numbers(path: Path, given: Array) -> IntArray:
    """Numbers of nodes."""
    if (given != np.floor(given)).any():
        raise InputError(f"'{path}' has nodes that are no whole numbers; expected numbers of nodes")
    return given.astype(np.int64)


def _table(path: Path) -> tuple[list[str], Array]:
    """Names of the columns, and the numbers under them."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"'{path}' cannot be read as text: {brief(error)}") from error
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError(f"'{path}' is empty; expected a head and rows of numbers")
    separator = next((mark for mark in (",", ";", "\t") if mark in lines[0]), None)
    rows = list(csv.reader(lines, delimiter=separator)) if separator else [line.split() for line in lines]
    head = [name.strip() for name in rows[0]]
    found = np.full((len(rows) - 1, len(head)), np.nan)
    for i, row in enumerate(rows[1:]):
        if len(row) != len(head):
            raise InputError(
                f"'{path}' has {len(row)} entries in row {i + 1} under {len(head)} names; expected as many"
            )
        try:
            found[i] = [float(part) for part in row]
        except ValueError as error:
            raise InputError(f"'{path}' has no number in row {i + 1}: {brief(error)}") from error
    return head, found


def _nodal_field(path: Path, name: str) -> tuple[Array, Array]:
    """Points of a mesh file and a field there."""
    mesh = open_mesh(path)
    fields = {key: np.asarray(data) for key, data in mesh.point_data.items() if np.asarray(data).ndim == 1}
    if not name and len(fields) == 1:
        (name,) = fields
    if name not in fields:
        raise InputError(f"'{path.name}': {one_of(name, fields, 'field of numbers at points')}", where=("column",))
    return np.asarray(mesh.points, float), np.asarray(fields[name], float)
