# SPDX-License-Identifier: BSD-3-Clause
"""The mesh of a deck: from a generator or a file, one or several joined."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

from signorini.checks import choice, text, vector
from signorini.deck.keys import check_keys, table, tables
from signorini.errors import InputError, Where
from signorini.meshing.cut import cut
from signorini.meshing.halves import section as section_between
from signorini.meshing.plane import annulus, half_disk, quarter_disk, rectangle
from signorini.meshing.solid import box
from signorini.model.mesh import Mesh, join
from signorini.sources import Reach

GENERATORS: Mapping[str, Callable[..., Mesh]] = {
    "rectangle": rectangle,
    "quarter_disk": quarter_disk,
    "half_disk": half_disk,
    "annulus": annulus,
    "box": box,
}

FILE_KEYS = ("file", "name")
"""Of a mesh that is read."""


def deck_mesh(value: Any, reach: Reach) -> Mesh:
    """The mesh of ``[mesh]``, or of all ``[[mesh]]`` joined: names become "name.boundary".

    Parameters
    ----------
    value : what the deck has under ``mesh``
    reach : of the deck: files that it may name
    """
    if not isinstance(value, list):
        return _one(table(value, ("mesh",)), ("mesh",), reach)
    parts: dict[str, Mesh] = {}
    for i, entry in enumerate(value):
        where = ("mesh", i)
        data = dict(table(entry, where))
        if "name" not in data:
            raise InputError("has no 'name'; expected one, since there are several meshes", where=where)
        name = text(data.pop("name"), (*where, "name"))
        if name in parts:
            raise InputError(f"another mesh is called '{name}' too; expected a name of its own", where=(*where, "name"))
        parts[name] = _one(data, where, reach)
    if not parts:
        raise InputError("there is none; expected a generator or a file", where=("mesh",))
    return join(parts)


def cut_for_bolts(mesh: Mesh, data: Mapping[str, Any]) -> Mesh:
    """The mesh, cut along the sections of the bolts of a deck; what is no boundary is left to the bolt to tell.

    Parameters
    ----------
    mesh : of the deck
    data : the whole deck
    """
    for i, entry in enumerate(tables(data, "bolt")):
        where: Where = ("bolt", i)
        section = entry.get("section")
        given = [key for key in ("plane", "halves") if key in entry]
        if len(given) == 2:
            raise InputError("has both plane and halves; expected one of them", where=where)
        if not isinstance(section, str) or not (given or section in mesh.boundaries):
            continue
        own: Where = (*where, given[0] if given else "section")
        try:
            if "halves" in given:
                mesh = section_between(mesh, section, *_halves(entry["halves"], own))
            elif "plane" in given:
                plane, keys = table(entry["plane"], own), ["body", "point", "normal"]
                check_keys(plane, own, known=keys, needed=keys)
                mesh = cut(mesh, section, **plane)
            else:
                mesh = cut(mesh, section)
        except InputError as error:
            raise InputError(error.message, where=error.where if error.where[:1] == ("bolt",) else own) from error
    return mesh


def _halves(value: Any, where: Where) -> tuple[str, str]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"is {value!r}; expected two boundaries", where=where)
    below, above = (text(name, (*where, k)) for k, name in enumerate(value))
    return below, above


def _one(data: dict[str, Any], where: Where, reach: Reach) -> Mesh:
    sources = [key for key in ("generator", "file") if key in data]
    if len(sources) != 1:
        found = "both 'generator' and 'file'" if sources else "neither 'generator' nor 'file'"
        raise InputError(f"has {found}; expected one of them", where=where)
    try:
        return _from_file(data, reach) if sources == ["file"] else _generated(data)
    except InputError as error:
        inner = error.where[1:] if error.where[:1] == ("mesh",) else error.where
        raise InputError(error.message, where=where + inner) from error


def _from_file(data: Mapping[str, Any], reach: Reach) -> Mesh:
    from signorini.meshing.read import read_mesh  # brings every format of meshio with it

    check_keys(data, ("mesh",), known=FILE_KEYS)
    name = text(data["file"], ("mesh", "file"))
    try:
        return read_mesh(reach.file(name))
    except InputError as error:
        raise InputError(error.message, where=("mesh", "file")) from error


def _generated(data: Mapping[str, Any]) -> Mesh:
    given = dict(data)
    generator = GENERATORS[choice(given.pop("generator"), GENERATORS, ("mesh", "generator"), "generator")]
    parameters = inspect.signature(generator).parameters
    needed = [name for name, parameter in parameters.items() if parameter.default is parameter.empty]
    check_keys(given, ("mesh",), known=list(parameters), needed=needed)
    for name in given:
        if parameters[name].annotation == "tuple[float, float]":
            vector(given[name], ("mesh", name), dimension=2)
    return generator(**given)
