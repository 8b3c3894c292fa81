# SPDX-License-Identifier: BSD-3-Clause
"""Tables that a deck asks for, as CalculiX prints them (``.dat``)."""

from __future__ import annotations

import math
from collections.abc import Container, Iterator
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray, distinct, padded, stored
from signorini.model.model import Model
from signorini.model.outputs import Part
from signorini.model.prints import Prints, Table
from signorini.output.atomic_write import atomic_write
from signorini.output.by_rows import FieldsByRows, portions
from signorini.output.ccx_contact import slave_energies, slave_values
from signorini.solution.history import History
from signorini.solution.results import ContactResult, StepResult

_TENSOR_ORDER = [0, 1, 2, 3, 5, 4]  # xx, yy, zz, xy, xz, yz of xx, yy, zz, xy, yz, xz
_CELL_HEADS = {
    "S": "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) ",
    "E": "strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) ",
    "PEEQ": "equivalent plastic strain (elem, integ.pnt.,pe)",
    "PE": "plastic strains (elem, integ.pnt.,pexx,peyy,pezz,pexy,pexz,peyz) ",
}
"""As CalculiX prints them, which leaves no blank behind the third; the fourth is not one of its own."""
_FORCES = {"CF": "surface force", "CFN": "normal surface force", "CFS": "shear surface force"}


def write_dat(history: History, fields: FieldsByRows, prints: Prints, path: Path) -> None:
    """Write the tables of all steps; nodes and elements bear their numbers in the deck.

    Values of elements are at the quadrature points of this package, not of CalculiX; those of contact are at the nodes
    of the slave surfaces, as CalculiX has them for node-to-surface contact, see :mod:`signorini.output.ccx_contact`.
    Nodes of rotation have the rotation of their rigid body as displacement and its moment as force.

    Parameters
    ----------
    history : of a deck's model
    fields : of the model
    prints : tables that the deck asks for, and the time at the end of every step
    path : of the file
    """
    with atomic_write(path) as aside, aside.open("w", encoding="utf-8", newline="\n") as file:
        for number, step in enumerate(history.steps):
            own = [table for table in prints.tables if table.step == number]
            if own:
                file.write(f"\n{'':24s}S T E P {number + 1:7d}\n\n\n{'':32s}INCREMENT {step.increments:5d}\n\n")
            for table in own:
                lines = _lines(history.model, fields, step, table, fortran(prints.times[number]))
                file.writelines(f"{line}\n" for line in lines)


def fortran(value: float) -> str:
    """A number as Fortran's E14.7 has it.

    >>> fortran(20.0), fortran(-0.75)
    (' 0.2000000E+02', '-0.7500000E+00')
    """
    if value == 0.0:
        return " 0.0000000E+00"
    exponent = math.floor(math.log10(abs(value))) + 1
    digits = round(abs(value) / 10.0 ** (exponent - 7))
    if digits == 10**7:
        digits, exponent = 10**6, exponent + 1
    return f"{'-' if value < 0.0 else ' '}0.{digits:07d}E{exponent:+03d}"


def _lines(model: Model, fields: FieldsByRows, step: StepResult, table: Table, time: str) -> Iterator[str]:
    end = f"for set {table.place} and time {time}"
    for quantity in table.quantities:
        if table.of == "nodes":
            yield from _nodes(model, step, table, quantity, end)
        elif table.of == "cells":
            if quantity in ("S", "E") or step.plastic is not None:
                yield from ("", f" {_CELL_HEADS[quantity]}{end}", "")
                yield from _rows_of_cells(model, fields, step, quantity, table.members)
        elif quantity in _FORCES:
            yield from _forces(step.contacts[int(table.members[0])], quantity, f"{table.place} and time {time}")
        else:
            yield from _contacts(model, step, table, quantity, time)


def _nodes(model: Model, step: StepResult, table: Table, quantity: str, end: str) -> Iterator[str]:
    values = stored(step, "displacement" if quantity == "U" else "external")
    shown, total = table.totals != "only" or quantity == "U", np.zeros(3)
    if shown:
        yield from ("", f" {'displacements (vx,vy,vz)' if quantity == 'U' else 'forces (fx,fy,fz)'} {end}", "")
    for some in portions(len(table.members)):
        members = table.members[some]
        rows = padded(values[members], 3)
        total = np.vstack([total, rows]).sum(axis=0)  # row by row, however many are added at a time
        axes = {row - int(some[0]): own for row, own in table.axes.items() if some[0] <= row <= some[-1]}
        for row, own in axes.items():
            rows[row, : len(own)] = own @ rows[row, : len(own)]
        turned = np.flatnonzero(np.isin(members, list(table.rotations)))
        for row in turned.tolist():
            body = step.rigid_bodies[table.rotations[int(members[row])]]
            rows[row] = _about(body.rotation if quantity == "U" else body.moment, twists=model.twists)
        if shown:
            yield from _rows(model.mesh.labels_of(members), rows, axes)
    if table.totals != "no" and quantity == "RF":
        yield from _single(f" total force (fx,fy,fz) {end}", total)


def _rows_of_cells(
    model: Model, fields: FieldsByRows, step: StepResult, quantity: str, members: IntArray
) -> Iterator[str]:
    """A row for every point of some of the cells, by family and formulation."""
    mesh, cells = model.mesh, distinct(members)
    families = np.searchsorted(np.cumsum([count for count, _ in mesh.shapes.values()]), cells, side="right")
    for k, family in enumerate(mesh.shapes):
        own, ways = cells[families == k], np.array([body.formulation_in(family) for body in model.bodies])
        if (ways != ways[0]).any():
            own = own[np.argsort(ways[model.body_of_cells()[own]], kind="stable")]
        for some in portions(len(own)):
            found = fields.in_cells(step, quantity, own[some])
            if found.shape[-1] == len(_TENSOR_ORDER):
                found = found[..., _TENSOR_ORDER]
            for label, points in zip(mesh.cell_labels_of(own[some]).tolist(), found, strict=True):
                yield from (f"{label:10d}{q:4d} {_spelled(row)}" for q, row in enumerate(points, start=1))


def _contacts(model: Model, step: StepResult, table: Table, quantity: str, time: str) -> Iterator[str]:
    """One table for all contacts."""
    end = f"for all contact elements and time{time}"
    pairs = [(model.contacts[i], step.contacts[i]) for i in table.members.tolist()]
    labels = model.mesh.labels_of(np.concatenate([result.node for _, result in pairs]))
    if quantity == "CELS":
        energies = np.concatenate([slave_energies(*pair) for pair in pairs])
        if table.totals != "only":
            yield from _numbered(f" contact spring energy (slave node,energy) {end}", labels, energies[:, None])
        if table.totals != "no":
            yield from _single(f" total contact spring energy for time {time}", energies.sum(keepdims=True))
        return
    values = np.concatenate([slave_values(*pair) for pair in pairs])
    if quantity == "CDIS":
        head = f" relative contact displacement (slave node,normal,tang1,tang2) {end}"
        yield from _numbered(head, labels, values[:, :3])
    else:
        yield from _numbered(f" contact stress (slave node,press,tang1,tang2) {end}", labels, values[:, 3:])


def _forces(contact: ContactResult, quantity: str, end: str) -> Iterator[str]:
    """Resultants on the slave body."""
    pressure, shear = contact.normal_force, contact.area @ contact.shear
    force = _in_space({"CF": pressure + shear, "CFN": pressure, "CFS": shear}[quantity])
    area = np.where(contact.closed, contact.area, 0.0)
    share = area / max(float(area.sum()), np.finfo(float).tiny)
    middle, outward = share @ contact.points, _in_space(-share @ contact.normals)
    of: dict[str, Part] = {"CF": "all", "CFN": "pressure", "CFS": "friction"}
    about = [_about(contact.moment(origin, of[quantity]), twists=contact.twists) for origin in (0.0 * middle, middle)]
    centre = _in_space(middle)
    normal = float(force @ outward)
    sizes = np.array([area.sum(), normal, np.linalg.norm(force - normal * outward)])
    which = "and moment" if quantity == "CF" else "and its moment"
    yield from ("", "", f" statistics for {end}")
    for head, row in (
        (f"total {_FORCES[quantity]} (fx,fy,fz) {which} about the origin (mx,my,mz)", np.append(force, about[0])),
        ("center of gravity and mean normal", np.append(centre, outward)),
        ("moment about the center of gravity(mx,my,mz)", about[1]),
        ("area,  normal force (+ = tension) and shear force (size)", sizes),
    ):
        yield from ("", f"   {head}", "", f"   {_spelled(row)}")


def _about(turn: float | Array, *, twists: bool) -> Array:
    """(3,) A rotation or moment, in the plane a number about z, of bodies that twist about the axis, y."""
    value = np.atleast_1d(turn)
    return value if len(value) == 3 else value[0] * np.eye(3)[1 if twists else 2]


def _in_space(vector: Array) -> Array:
    """(3,) A vector (d,)."""
    return padded(vector[None], 3)[0]


def _numbered(head: str, labels: IntArray, rows: Array) -> Iterator[str]:
    """A table of rows that begin with a number."""
    yield from ("", head, "")
    yield from _rows(labels, rows)


def _rows(labels: IntArray, rows: Array, local: Container[int] = ()) -> Iterator[str]:
    """Rows that begin with a number, and end in L where they are ``local``: along axes of their own."""
    for i, (label, row) in enumerate(zip(labels.tolist(), rows, strict=True)):
        yield f"{label:10d} {_spelled(row)}{' L' if i in local else ''}"


def _single(head: str, row: Array) -> Iterator[str]:
    """A table of one row without a number."""
    yield from ("", head, "", f"       {_spelled(row)}")


def _spelled(values: Array) -> str:
    return " ".join(f"{value + 0.0:13.6E}" for value in values.tolist())
