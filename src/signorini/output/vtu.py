# SPDX-License-Identifier: BSD-3-Clause
"""Fields for ParaView (``.vtu``): the bodies and the contact surfaces, both on the undeformed mesh."""

from __future__ import annotations

import binascii
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from signorini.arrays import Array, IntArray, padded
from signorini.meshio_fixes import complete_meshio
from signorini.model.model import Model
from signorini.output.atomic_write import atomic_write
from signorini.output.dataclasses_json import AnyArray
from signorini.output.fields import BodyFields
from signorini.plasticity.fields import PlasticFields
from signorini.solution.results import ContactResult
from signorini.solution.surface import arc_length, contact_faces, contact_lines, status_codes

if TYPE_CHECKING:
    import meshio

FIELDS = "fields"
"""The folder of the files that are no ends of steps, and of those of single ranks."""

_PART = 3 << 18  # bytes that are written at a time, a multiple of 3: base64 needs no padding between two of them
_LETTERS = {"f": "Float", "i": "Int", "u": "UInt"}  # of kinds of numbers, in the words of VTK
_SURFACE_CELLS = {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}


def write_bodies(fields: BodyFields, path: Path, *, compress: bool = False) -> None:
    """Write displacements, stresses, strains and forces of the bodies in one state.

    Point arrays: ``displacement`` (3 components, length), ``stress`` (xx, yy, zz, xy, yz, xz, force per area, tension
    positive; axisymmetric: x is the radius, y the axis, zz the hoop stress), ``von_mises``, ``principal_stress`` (the
    largest first), ``strain`` (the tensor: shear strains are half of those that engineers count), ``reaction`` (of
    supports and foundations, force), ``contact_force`` (of contacts on both sides, force; neither where bodies turn)
    and ``node`` (number in the mesh or deck). Cell arrays: ``body`` (0, 1, ... in the order of the model), ``stress``
    and ``strain`` (means of the integration points of a cell, not averaged with its neighbours'). Where bodies yield,
    points and cells (their means) have ``peeq``, the equivalent plastic strain, ``plastic_strain`` (the tensor) and
    ``back_stress`` (the sum of all). Where sides wear, points have ``worn_depth`` (length).

    Parameters
    ----------
    fields : of the bodies
    path : of the file
    compress : whether the file is to be half as large, which takes several times as long
    """
    write_grid(grid_of(fields), path, compress=compress)


def grid_of(fields: BodyFields) -> meshio.Mesh:
    """What :func:`write_bodies` writes.

    Parameters
    ----------
    fields : of the bodies
    """
    import meshio

    complete_meshio()
    rare = {"strain": fields.strain, "worn_depth": fields.depth}
    forces = {"reaction": fields.reaction, "contact_force": fields.contact_force}
    tensors = fields.tensors_in_cells
    return meshio.Mesh(
        padded(fields.points, 3),
        list(zip(fields.families, fields.cells, strict=True)),
        point_data={
            "displacement": padded(fields.displacement, 3),
            "stress": fields.stress,
            "von_mises": fields.von_mises,
            "principal_stress": fields.principal_stress,
            "node": fields.node,
            **({} if fields.plastic is None else _plastic(fields.plastic)),
            **{name: values for name, values in rare.items() if values is not None},
            **{name: padded(values, 3) for name, values in forces.items() if values is not None},
            **fields.further,
        },
        cell_data={
            "body": list(fields.body),
            **({"stress": [t[:, :6] for t in tensors], "strain": [t[:, 6:] for t in tensors]} if tensors else {}),
            **_by_name(fields.in_cells),
        },
    )


def _plastic(fields: PlasticFields) -> dict[str, Array]:
    """Arrays of plastic fields by name."""
    return {"peeq": fields.equivalent, "plastic_strain": fields.strain, "back_stress": fields.back}


def _by_name(blocks: Sequence[PlasticFields]) -> dict[str, list[Array]]:
    """Arrays of the cells by name, one a block; none where there is no block."""
    found: dict[str, list[Array]] = {}
    for block in blocks:
        for name, values in _plastic(block).items():
            found.setdefault(name, []).append(values)
    return found


def write_surfaces(model: Model, contacts: Sequence[ContactResult], path: Path) -> None:
    """Write the nonmortar sides of all contacts of a model in one state: faces in space, lines in the plane.

    Point arrays: ``pressure``, ``traction`` (friction on the nonmortar body, a vector), ``slip`` (accumulated, a
    vector), ``gap``, ``area``, ``normal``, ``force`` (on the nonmortar body at the node, a vector), ``sliding``
    (distance slid in the step), ``slip_amplitude`` (half the range of the slip in the last cycle),
    ``dissipation_per_area`` (of the step), ``status`` (0 open, 1 stick, 2 slip), ``node``; in the plane ``arc_length``;
    ``worn_depth`` where any side wears, ``damage`` where any is bonded. About an axis vectors have the hoop behind
    radius and axis. Cell array: ``contact`` (0, 1, ... in the order of the model). Cells are those whose ends or
    corners all carry pairs, and points where a contact has none.

    Parameters
    ----------
    model : with contacts
    contacts : all of them in one state, in the order of the model
    path : of the file
    """
    import meshio

    start = np.cumsum([0, *(len(contact.node) for contact in contacts)])
    blocks, owner = [], []
    for i, contact in enumerate(contacts):
        for cells in _surface_cells(model, contact):
            blocks.append((_SURFACE_CELLS[cells.shape[1]], start[i] + cells))
            owner.append(np.full(len(cells), i))
    every = [_surface_arrays(model, contact) for contact in contacts]
    for name, values in {
        "worn_depth": [_worn(contact) for contact in contacts],
        "damage": [c.damage for c in contacts],
    }.items():
        if any(each is not None for each in values):
            for arrays, each in zip(every, values, strict=True):
                arrays[name] = np.zeros(len(arrays["gap"])) if each is None else each
    data = {name: np.concatenate([arrays[name] for arrays in every]) for name in every[0]}
    grid = meshio.Mesh(data.pop("points"), blocks, point_data=data, cell_data={"contact": owner})
    write_grid(grid, path)


def write_grid(grid: meshio.Mesh, path: Path, *, compress: bool = False) -> None:
    """Write a grid with its arrays; their lengths as UInt64, for those of more than 4 GB.

    Parameters
    ----------
    grid, path : what is written, and the file
    compress : whether it is to be half as large, which takes several times as long
    """
    with atomic_write(path) as aside:
        if compress:
            grid.write(aside, file_format="vtu", compression="zlib", header_type="UInt64")
        else:
            write_uncompressed(grid, aside)


def write_uncompressed(grid: meshio.Mesh, path: Path) -> None:
    """Write a grid with its arrays as meshio does, in a third of the time; lengths as UInt64, for more than 4 GB.

    Parameters
    ----------
    grid, path : what is written, and the file

    Examples
    --------
    >>> import meshio, tempfile
    >>> grid = meshio.Mesh(np.eye(3), [("triangle", [[0, 1, 2]])], point_data={"x": np.arange(3.0)})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_uncompressed(grid, Path(folder, "a.vtu"))
    ...     meshio.read(Path(folder, "a.vtu")).point_data["x"].tolist()
    [0.0, 1.0, 2.0]
    """
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    sizes = f'NumberOfPoints="{len(grid.points)}" NumberOfCells="{sum(len(block.data) for block in grid.cells)}"'
    with path.open("wb") as file:
        file.write(b'<?xml version="1.0"?>\n')
        file.write(f'<VTKFile type="UnstructuredGrid" version="0.1" byte_order="{order}"'.encode())
        file.write(f' header_type="UInt64">\n<UnstructuredGrid>\n<Piece {sizes}>\n'.encode())
        _write_arrays(file, "Points", {"Points": grid.points})
        _write_arrays(file, "Cells", _cells(grid))
        _write_arrays(file, "PointData", grid.point_data)
        _write_arrays(file, "CellData", {name: np.concatenate(parts) for name, parts in grid.cell_data.items()})
        file.write(b"</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def _cells(grid: meshio.Mesh) -> dict[str, AnyArray]:
    """The nodes of all cells, where those of each end, and what kind each is."""
    from meshio._vtk_common import meshio_to_vtk_order, meshio_to_vtk_type

    nodes, sizes, kinds = [], [], []
    for block in grid.cells:
        order = meshio_to_vtk_order(block.type)
        nodes.append((block.data if order is None else block.data[:, order]).ravel())
        sizes.append(np.full(len(block.data), block.data.shape[1]))
        kinds.append(np.full(len(block.data), meshio_to_vtk_type[block.type]))
    offsets = np.cumsum(np.concatenate(sizes))
    return {"connectivity": np.concatenate(nodes), "offsets": offsets, "types": np.concatenate(kinds)}


def _write_arrays(file: IO[bytes], title: str, arrays: Mapping[str, AnyArray]) -> None:
    """Write arrays by name as one element of the file; none where there is no array."""
    if not arrays:
        return
    file.write(f"<{title}>\n".encode())
    for name, values in arrays.items():
        kind = f"{_LETTERS[values.dtype.kind]}{8 * values.dtype.itemsize}"
        width = "" if values.ndim == 1 else f' NumberOfComponents="{values.shape[1]}"'
        file.write(f'<DataArray type="{kind}" Name={quoteattr(name)}{width} format="binary">\n'.encode())
        for part in _parts(values):
            file.write(binascii.b2a_base64(part, newline=False))
        file.write(b"\n</DataArray>\n")
    file.write(f"</{title}>\n".encode())


def _parts(values: AnyArray) -> Iterator[bytes | memoryview]:
    """The bytes of an array behind their number, some at a time."""
    data = np.ascontiguousarray(values).reshape(-1).view(np.uint8)
    number = np.uint64(len(data)).tobytes()
    first = _PART - len(number)
    yield number + data[:first].tobytes()
    for begin in range(first, len(data), _PART):
        yield data[begin : begin + _PART].data


def _surface_cells(model: Model, contact: ContactResult) -> list[IntArray]:
    """Faces, lines or points of a contact, as indices into its nodes."""
    found = contact_faces(model, contact) if model.dimension == 3 else (contact_lines(model, contact),)
    cells = [part for part in found if len(part)]
    return cells or [np.arange(len(contact.node))[:, None]]


def _surface_arrays(model: Model, contact: ContactResult) -> dict[str, AnyArray]:
    """Arrays of one contact by name, vectors with three components."""
    arrays: dict[str, AnyArray] = {
        "points": padded(contact.points, 3),
        "pressure": contact.pressure,
        "traction": padded(contact.shear, 3),
        "slip": padded(contact.along_tangents(contact.slip), 3),
        "gap": contact.gap,
        "area": contact.area,
        "normal": padded(contact.normals, 3),
        "force": padded(contact.forces, 3),
        "sliding": contact.sliding,
        "slip_amplitude": 0.5 * contact.slip_range,
        "dissipation_per_area": contact.worn,
        "status": status_codes(contact),
        "node": model.mesh.labels[contact.node],
    }
    return arrays if model.dimension == 3 else {**arrays, "arc_length": arc_length(model, contact)}


def _worn(contact: ContactResult) -> Array | None:
    """(n,) Depth that the nonmortar side has lost; None where it does not wear."""
    return None if contact.wear is None else contact.wear.depth
