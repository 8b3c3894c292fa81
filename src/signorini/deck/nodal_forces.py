# SPDX-License-Identifier: BSD-3-Clause
"""Nodal forces of a file as a load of a deck: of a mode, or of another program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from signorini.arrays import distinct
from signorini.checks import text
from signorini.deck.keys import check_keys, tables
from signorini.errors import InputError, Where
from signorini.model.mesh import Mesh
from signorini.sources import Reach


def with_nodal_forces(mesh: Mesh, data: Mapping[str, Any], reach: Reach) -> tuple[Mesh, dict[str, Any]]:
    """The mesh with a node set for every load of a deck whose forces are in a file, and the deck with these forces.

    Parameters
    ----------
    mesh : of the deck
    data : the whole deck
    reach : files that it may name

    Raises
    ------
    InputError
        If the file has no such forces, or nodes that the mesh lacks.
    """
    loads, sets = [], dict(mesh.nodes)
    for i, entry in enumerate(tables(data, "load")):
        given, where = entry.get("nodal_forces"), ("load", i, "nodal_forces")
        if not isinstance(given, dict):
            loads.append(entry)
            continue
        if "on" in entry:
            raise InputError("goes with no nodal_forces of a file, which has its nodes", where=("load", i, "on"))
        name = text(entry.get("name"), ("load", i, "name"))
        if name in sets or name in mesh.boundaries:
            raise InputError(f"there is a place called '{name}'; expected another name", where=("load", i, "name"))
        sets[name], forces = _of_file(mesh, given, where, reach)
        loads.append({**entry, "on": name, "nodal_forces": forces})
    return replace(mesh, nodes=sets), {**data, "load": loads}


def _of_file(mesh: Mesh, given: dict[str, Any], where: Where, reach: Reach) -> tuple[Any, Any]:
    """Nodes that bear something, ascending, and their forces."""
    from signorini.meshing.values import read_nodal_forces  # brings meshio with it

    check_keys(given, where, known=["file", "column"], needed=["file"])
    try:
        path = reach.file(text(given["file"], ("file",)), ("file",))
        numbers, forces = read_nodal_forces(path, column=given.get("column", ""), dimension=mesh.points.shape[1])
    except InputError as error:
        raise error.inside(*where) from error
    bearing = forces.any(axis=1)
    numbers, forces = numbers[bearing], forces[bearing]
    lost = numbers[~np.isin(numbers, mesh.labels)]
    if len(lost):
        raise InputError(f"has node {lost[0]}, which the mesh has not; expected forces of its nodes", where=where)
    if not len(numbers) or len(distinct(numbers)) < len(numbers):
        words = "has a node twice" if len(numbers) else "has no force at all"
        raise InputError(f"{words}; expected one force for each of the nodes", where=where)
    order = np.argsort(mesh.labels)
    nodes = order[np.searchsorted(mesh.labels[order], numbers)]
    ascending = np.argsort(nodes)
    return nodes[ascending], forces[ascending]
