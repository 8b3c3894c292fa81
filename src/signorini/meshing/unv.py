# SPDX-License-Identifier: BSD-3-Clause
"""I-DEAS universal files (``.unv``), which Salome, Gmsh and others write and meshio does not read."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import meshio
import numpy as np

from signorini.errors import InputError, brief

SUFFIX = ".unv"
_NODES, _ELEMENTS, _GROUPS = (781, 2411), (2412,), (2429, 2430, 2432, 2435, 2452, 2467, 2477)
_NODE, _ELEMENT = 7, 8  # kinds of members of groups
_BEAMS = (11, 21, 22, 24)
# finite element descriptors: plane stress, plane strain, axisymmetric and shells are plane cells alike
_KINDS = {
    **dict.fromkeys((11, 21), "line"),
    **dict.fromkeys((22, 24), "line3"),
    **dict.fromkeys((41, 51, 81, 91), "triangle"),
    **dict.fromkeys((42, 52, 82, 92), "triangle6"),
    **dict.fromkeys((44, 54, 84, 94), "quad"),
    **dict.fromkeys((45, 55, 85, 95), "quad8"),
    **{111: "tetra", 118: "tetra10", 112: "wedge", 113: "wedge15", 115: "hexahedron", 116: "hexahedron20"},
}
# in the file middle nodes come between the corners that they are between: where node k of meshio stands
_ORDER = {
    "line3": (0, 2, 1),
    "triangle6": (0, 2, 4, 1, 3, 5),
    "quad8": (0, 2, 4, 6, 1, 3, 5, 7),
    "tetra10": (0, 2, 4, 9, 1, 3, 5, 6, 7, 8),
    "wedge15": (0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8),
    "hexahedron20": (0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11),
}


def read_unv(path: Path) -> meshio.Mesh:
    """Nodes, elements and groups; nodes in the order of the file, with their numbers.

    Raises
    ------
    InputError
        For an element that is no cell of this package, or a file that ends too early.
    """
    numbers: list[int] = []
    points: list[list[float]] = []
    cells: dict[str, list[list[int]]] = defaultdict(list)
    place: dict[int, tuple[str, int]] = {}
    groups: list[tuple[str, list[int]]] = []
    try:
        for kind, lines in _datasets(path):
            if kind in _NODES:
                numbers += [int(line.split()[0]) for line in lines[::2]]
                points += [[float(word.replace("D", "E")) for word in line.split()] for line in lines[1::2]]
            elif kind in _ELEMENTS:
                _elements(lines, cells, place, path)
            elif kind in _GROUPS:
                groups += _groups(lines)
        return _mesh(numbers, points, cells, place, groups)
    except (ValueError, IndexError, KeyError, StopIteration, RuntimeError) as error:  # RuntimeError: a generator's end
        raise InputError(
            f"'{path}' is no universal file that can be read: {brief(error)}", where=("mesh", "file")
        ) from error


def _datasets(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Number and lines of every data set; they stand between lines of -1."""
    inside: list[str] | None = None
    for line in path.read_text(errors="replace").splitlines():
        if line.strip() == "-1":
            if inside:
                yield int(inside[0]), inside[1:]
            inside = [] if inside is None else None
        elif inside is not None:
            inside.append(line)


def _elements(
    lines: list[str], cells: dict[str, list[list[int]]], place: dict[int, tuple[str, int]], path: Path
) -> None:
    rows = iter(lines)
    for line in rows:
        label, descriptor, *_, count = (int(word) for word in line.split())
        if descriptor in _BEAMS:
            next(rows)  # orientation and sections
        nodes: list[int] = []
        while len(nodes) < count:
            nodes += [int(word) for word in next(rows).split()]
        if descriptor not in _KINDS:
            raise InputError(
                f"'{path}' holds element {label} of the kind {descriptor}, which this version does not have"
            )
        kind = _KINDS[descriptor] if count != 2 else "line"
        place[label] = kind, len(cells[kind])
        cells[kind].append([nodes[k] for k in _ORDER.get(kind, range(count))])


def _groups(lines: list[str]) -> Iterator[tuple[str, list[int]]]:
    """Name of each group, and kind and number of its members by turns."""
    rows = iter(lines)
    for line in rows:
        count, name = int(line.split()[-1]), next(rows).strip()
        words: list[int] = []
        while len(words) < 4 * count:
            words += [int(word) for word in next(rows).split()]
        yield name, [word for k, word in enumerate(words) if k % 4 < 2]


def _mesh(
    numbers: list[int],
    points: list[list[float]],
    cells: dict[str, list[list[int]]],
    place: dict[int, tuple[str, int]],
    groups: list[tuple[str, list[int]]],
) -> meshio.Mesh:
    index = {number: k for k, number in enumerate(numbers)}
    blocks = [(kind, np.array([[index[node] for node in row] for row in rows])) for kind, rows in cells.items()]
    point_sets, cell_sets = {}, {}
    for name, members in groups:
        pairs = list(zip(members[::2], members[1::2], strict=True))
        own = [index[number] for kind, number in pairs if kind == _NODE]
        if own:
            point_sets[name] = np.array(own)
        found = [place[number] for kind, number in pairs if kind == _ELEMENT]
        if found:
            cell_sets[name] = [np.array([k for kind, k in found if kind == block], np.int64) for block in cells]
    return meshio.Mesh(
        np.array(points), blocks, point_sets=point_sets, cell_sets=cell_sets, point_data={"number": np.array(numbers)}
    )
