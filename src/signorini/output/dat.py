# SPDX-License-Identifier: BSD-3-Clause
"""Tables that a deck asks for, as CalculiX prints them (``.dat``)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from pathlib import Path

import numpy as np

from signorini.arrays import Array, IntArray, padded
from signorini.fem.space import make_space
from signorini.fem.stress import point_stresses
from signorini.model.model import Model
from signorini.model.prints import Table
from signorini.output.replacing import replacing
from signorini.solution.history import History
from signorini.solution.results import StepResult


def write_dat(history: History, tables: Sequence[Table], path: Path) -> None:
    """Write the tables of all finished steps; nodes and elements bear their numbers in the deck.

    Values of elements are at the quadrature points of this package, not of CalculiX.
    """
    with replacing(path) as aside, aside.open("w", encoding="utf-8", newline="\n") as file:
        for number, step in enumerate(history.steps):
            own = [table for table in tables if table.step == number]
            if own:
                file.write(f"\n{'':24s}S T E P {number + 1:7d}\n\n")
            for table in own:
                file.writelines(f"{line}\n" for line in _lines(history.model, step, table, number + 1))


def _lines(model: Model, step: StepResult, table: Table, time: float) -> Iterator[str]:
    end = f"for set {table.place} and time {time:14.7E}"
    for quantity in table.quantities:
        if table.of == "nodes":
            yield from _nodes(model, step, table, quantity, end)
        elif table.of == "cells":
            head = " stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)"
            yield from ("", f"{head} {end}", "")
            yield from _stresses(model, step, set(table.members.tolist()))
        else:
            yield from _contact(model, step, table, quantity, time)


def _nodes(model: Model, step: StepResult, table: Table, quantity: str, end: str) -> Iterator[str]:
    values = step.displacement if quantity == "U" else step.external
    rows = padded(values[table.members], 3)
    if table.totals != "only" or quantity == "U":
        yield from ("", f" {'displacements (vx,vy,vz)' if quantity == 'U' else 'forces (fx,fy,fz)'} {end}", "")
        yield from _numbered(model.mesh.labels[table.members], rows)
    if table.totals != "no" and quantity == "RF":
        yield from ("", f" total force (fx,fy,fz) {end}", "", f"      {_spelled(rows.sum(axis=0))}")


def _stresses(model: Model, step: StepResult, cells: Set[int]) -> Iterator[str]:
    order = [0, 1, 2, 3, 5, 4]
    labels = model.mesh.cell_labels
    space = make_space(model.mesh, axisymmetric=model.axisymmetric)
    for index, stress in point_stresses(space, model, step.displacement, step.factors):
        for cell, points in zip(index.tolist(), stress[..., order], strict=True):
            if cell in cells:
                yield from (f"{labels[cell]:10d}{q:4d} {_spelled(values)}" for q, values in enumerate(points, start=1))


def _contact(model: Model, step: StepResult, table: Table, quantity: str, time: float) -> Iterator[str]:
    contact = step.contacts[int(table.members[0])]
    sides = table.place
    if quantity == "CF":
        turn = np.atleast_1d(contact.moment(np.zeros(model.dimension)))
        total = np.concatenate([padded(contact.forces, 3).sum(axis=0), np.zeros(3 - len(turn)), turn])
        yield from ("", f" statistics for {sides} and time {time:14.7E}", "")
        yield from ("   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)", "")
        yield f"   {_spelled(total)}"
        return
    if quantity == "CDIS":
        head = "relative contact displacement (slave node,normal,tang1,tang2)"
        columns = (contact.gap, padded(contact.slip, 2))
    else:
        head = "contact stress (slave node,press,tang1,tang2)"
        columns = (contact.pressure, padded(contact.traction, 2))
    yield from ("", f" {head} for {sides} and time {time:14.7E}", "")
    yield from _numbered(model.mesh.labels[contact.node], np.column_stack(columns))


def _numbered(labels: IntArray, rows: Array) -> Iterator[str]:
    for label, row in zip(labels.tolist(), rows, strict=True):
        yield f"{label:10d} {_spelled(row)}"


def _spelled(values: Array) -> str:
    return " ".join(f"{value + 0.0:13.6E}" for value in values.tolist())
