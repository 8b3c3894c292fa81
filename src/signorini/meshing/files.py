# SPDX-License-Identifier: BSD-3-Clause
"""Mesh files, opened so that they do no more than be read: who sends a mesh runs nothing and reaches nothing."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import meshio
import numpy as np

from signorini.errors import InputError, brief
from signorini.hdf5 import check_hdf5
from signorini.meshing.geo import SUFFIX as GEOMETRY
from signorini.meshing.geo import mesh_geometry
from signorini.meshing.unv import SUFFIX as UNV
from signorini.meshing.unv import read_unv
from signorini.meshio_fixes import read_meshio
from signorini.model.mesh import NODES_PER_CELL
from signorini.sources import check_file

_NODES_PER_CELL = NODES_PER_CELL | {"vertex": 1, "line": 2, "line3": 3}
_XML = (".vtu", ".xdmf", ".xmf", ".xml", ".svg")
_HDF5 = (".med", ".h5m", ".cgns", ".hmf")
_INCLUDE = re.compile(rb"(?im)^\*[* ]*I\**N\**C\**L\**U\**D\**E")  # meshio takes all asterisks out


def open_mesh(path: Path) -> meshio.Mesh:
    """What a mesh file holds, with its groups by name; points are rows of finite numbers, cells have nodes that exist.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, or leads to other files.
    """
    check_file(path)
    suffix = path.suffix.lower()
    if suffix == UNV:
        found = read_unv(path)
    elif suffix == GEOMETRY:
        with tempfile.TemporaryDirectory() as folder:
            mesh_geometry(path, Path(folder, "mesh.msh"))
            found = read_meshio(Path(folder, "mesh.msh"))
    else:
        _check_references(path, suffix)
        found = read_meshio(path)
    _check(found, path)
    _name_families(found)
    return found


def _check_references(path: Path, suffix: str) -> None:
    """Refuse what leads to other files, and entities of XML."""
    if suffix == ".inp" and _INCLUDE.search(path.read_bytes()):
        raise InputError(f"'{path}' includes another file; expected a mesh in one, or the whole deck as an .inp")
    if suffix in _HDF5:
        check_hdf5(path)
    if suffix in _XML and b"<!ENTITY" in path.read_bytes().replace(b"\0", b""):
        raise InputError(f"'{path}' defines entities of XML; expected none")
    if suffix in (".xdmf", ".xmf"):
        for item in _data_items(path):
            name = (item.text or "").strip().partition(":")[0]
            if item.get("Format") == "Binary" or (item.get("Format") == "HDF" and Path(name).name != name):
                raise InputError(f"'{path}' names the file '{name[:80]}'; expected an HDF5 file beside it")
            if item.get("Format") == "HDF":
                check_file(path.parent / name)
                check_hdf5(path.parent / name)


def _data_items(path: Path) -> Iterator[ElementTree.Element]:
    try:
        yield from ElementTree.parse(path).iter("DataItem")
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(f"'{path}' is no XML that can be read: {brief(error)}") from error


def _check(found: meshio.Mesh, path: Path) -> None:
    """Refuse points that are no points and cells of nodes that are not there: readers take any number."""
    points = np.asarray(found.points)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or points.dtype.kind not in "fiu":
        raise InputError(f"'{path}' holds no points; expected rows of two or three coordinates")
    for block in found.cells:
        nodes = np.asarray(block.data)
        wide = _NODES_PER_CELL.get(block.type, nodes.shape[-1])
        if nodes.ndim != 2 or nodes.dtype.kind not in "iu" or nodes.shape[1] != wide:
            raise InputError(f"'{path}' holds cells of the kind '{block.type}' that are no rows of nodes")
        if nodes.size and not 0 <= int(nodes.min()) <= int(nodes.max()) < len(points):
            wrong = int(nodes.min()) if nodes.min() < 0 else int(nodes.max())
            raise InputError(f"'{path}' holds a cell of node {wrong + 1}, but {len(points)} nodes")


def _name_families(found: meshio.Mesh) -> None:
    """Give a mesh from a MED file the sets that its families mean, which meshio leaves as numbers; others stay.

    A family is what has the same groups: its number stands at every cell (or point), its groups in a table beside it.
    """

    def named(key: str, data: dict[str, Any]) -> Iterator[tuple[str, list[int]]]:
        names = getattr(found, key, {}) if key in data else {}
        for name in sorted({name for groups in names.values() for name in groups}):
            yield name, [tag for tag, groups in names.items() if name in groups]

    for name, own in named("cell_tags", found.cell_data):
        found.cell_sets[name] = [np.flatnonzero(np.isin(block, own)) for block in found.cell_data["cell_tags"]]
    for name, own in named("point_tags", found.point_data):
        found.point_sets[name] = np.flatnonzero(np.isin(found.point_data["point_tags"], own))
