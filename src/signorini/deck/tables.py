# SPDX-License-Identifier: BSD-3-Clause
"""From tables of a deck to the model's own classes, with the checks that all tables share."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeVar

from signorini.checks import choice, text
from signorini.errors import InputError, Where, one_of
from signorini.law.friction import LAWS, FrictionLaw
from signorini.model.body import Body
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.contact import Contact
from signorini.model.links import Equation, RigidBody
from signorini.model.material import Elastic, Material, Orthotropic
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Circle, Obstacle, Plane, Profile, Sphere
from signorini.model.plastic import Plastic
from signorini.model.revolved import Cone, Cylinder, Torus
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.model.triangulated import Surface
from signorini.model.varying import Along
from signorini.model.wear import Wear
from signorini.sources import Reach

Made = TypeVar("Made")

OBSTACLES = {
    "plane": Plane,
    "circle": Circle,
    "profile": Profile,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "cone": Cone,
    "torus": Torus,
    "surface": Surface,
}
"""Rigid shapes by their keys."""

_SIDES = ("nonmortar", "mortar")
_CONTACT_KEYS = (
    "name",
    "between",
    *_SIDES,
    *OBSTACLES,
    *(key for key in inspect.signature(Contact).parameters if key not in ("name", *_SIDES)),
)
_OBSTACLE_KEYS = ("name", *OBSTACLES, "u", "rotation", "force", "moment", "point")


def table(value: Any, where: Where) -> dict[str, Any]:
    """A table, or what was found instead."""
    if not isinstance(value, dict):
        raise InputError(f"is {value!r}; expected a table", where=where)
    return value


def tables(data: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    """The entries of an array of tables, none if the key is not there."""
    value = data.get(key, [])
    if isinstance(value, dict):
        raise InputError(f"is a single table; expected [[{key}]], in double brackets, for each", where=(key,))
    if not isinstance(value, list):
        raise InputError(f"is {value!r}; expected [[{key}]] tables", where=(key,))
    return [table(entry, (key, i)) for i, entry in enumerate(value)]


def check_keys(data: Mapping[str, Any], where: Where, *, known: Collection[str], needed: Collection[str] = ()) -> None:
    """Refuse keys that are not known (the nearest known one is named) and tables that lack one.

    Parameters
    ----------
    data : a table
    where : its path in the deck
    known, needed : keys that it may have, and those that it must

    Examples
    --------
    >>> check_keys({"nx": 2, "hight": 1.0}, ("mesh",), known=["nx", "ny", "height"])
    Traceback (most recent call last):
    signorini.errors.InputError: mesh.hight: unknown key; did you mean 'height'? Known: nx, ny, height
    """
    for key in data:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"; did you mean '{near[0]}'?" if near else "."
            raise InputError(f"unknown key{hint} Known: {', '.join(known)}", where=(*where, key))
    for key in needed:
        if key not in data:
            raise InputError(f"has no '{key}'; expected it", where=where)


def make(kind: Callable[..., Made], data: Mapping[str, Any], where: Where) -> Made:
    """Call a constructor with the keys of a table: its parameters are the known keys, those without default needed.

    Parameters
    ----------
    kind : the constructor
    data : the table
    where : its path in the deck

    Raises
    ------
    InputError
        What :func:`check_keys` or the constructor finds wrong, with the path from the top of the deck.
    """
    parameters = inspect.signature(kind).parameters
    needed = [name for name, parameter in parameters.items() if parameter.default is parameter.empty]
    check_keys(data, where, known=list(parameters), needed=needed)
    if "name" in data:
        text(data["name"], (*where, "name"))
    try:
        return kind(**data)
    except InputError as error:
        raise error.inside(*where) from error


def deck_materials(data: Mapping[str, Any]) -> dict[str, Material]:
    """``[material.NAME]`` by name; with ``E1`` orthotropic."""
    found: dict[str, Material] = {}
    for name, entry in table(data.get("material", {}), ("material",)).items():
        given = table(entry, ("material", name))
        where = ("material", name)
        kind: Callable[..., Material] = Orthotropic if "E1" in given else Elastic
        if "plastic" in given and kind is Elastic:
            inside: Where = (*where, "plastic")
            given = given | {"plastic": make(Plastic, table(given["plastic"], inside), inside)}
        found[name] = make(kind, given, where)
    return found


def deck_bodies(data: Mapping[str, Any], materials: Mapping[str, Material]) -> list[Body]:
    """``[[body]]``, each with the material that it names."""
    bodies = []
    for i, entry in enumerate(tables(data, "body")):
        where: Where = ("body", i)
        check_keys(entry, where, known=["name", "material", "formulation", "thickness"], needed=["name", "material"])
        name = text(entry["material"], (*where, "material"))
        if name not in materials:
            raise InputError(one_of(name, materials, "material"), where=(*where, "material"))
        bodies.append(make(Body, entry | {"material": materials[name]}, where))
    return bodies


FIELDS = {
    "body": "bodies",
    "support": "supports",
    "foundation": "foundations",
    "load": "loads",
    "contact": "contacts",
    "obstacle": "obstacles",
    "rigid_body": "rigid_bodies",
    "equation": "equations",
    "step": "steps",
}
"""Arrays of tables, and the fields of the model that they give."""


def deck_parts(data: Mapping[str, Any], reach: Reach, mesh: Mesh) -> dict[str, list[Any]]:
    """Supports, loads, contacts, steps: fields of the model, without bodies, those that the deck has.

    Parameters
    ----------
    data : the whole deck
    reach : files that it may name
    mesh : its mesh, whose boundaries may be rigid shapes
    """
    kinds: dict[str, Callable[..., Any]] = {
        "support": Support,
        "foundation": Foundation,
        "load": Load,
        "rigid_body": RigidBody,
        "equation": Equation,
        "step": Step,
    }
    parts: dict[str, list[Any]] = {}
    for key, field in FIELDS.items():
        if key == "body":
            continue  # their materials are checked before a mesh is read
        for i, entry in enumerate(tables(data, key)):
            where: Where = (key, i)
            if key in kinds:
                if key in ("support", "load"):
                    _refuse_place(entry.get("on", ""), where)
                made = make(kinds[key], entry, where)
            else:
                made = (_contact if key == "contact" else _obstacle)(entry, where, reach, mesh)
            parts.setdefault(field, []).append(made)
    return parts


def _refuse_place(on: Any, where: Where) -> None:
    if not isinstance(on, str | list):
        raise InputError(f"is {on!r}; expected a name, or the coordinates of a node", where=(*where, "on"))


def _friction(entry: dict[str, Any], where: Where) -> Along | FrictionLaw:
    """``{ x = [...], mu = [...] }``, or ``{ law = "NAME", ... }`` with what the law needs."""
    if "law" in entry:
        name = choice(entry["law"], LAWS, (*where, "law"), "law of friction")
        return make(LAWS[name], {key: value for key, value in entry.items() if key != "law"}, where)
    axes = [key for key in entry if key != "mu"]
    if "mu" not in entry or len(axes) != 1:
        raise InputError(
            f"has {', '.join(entry) or 'nothing'}; expected one coordinate and mu, as in x, mu", where=where
        )
    return make(Along, {"axis": axes[0], "at": entry[axes[0]], "values": entry["mu"]}, where)


def _shape(key: str, value: Any, where: Where, reach: Reach, mesh: Mesh) -> Obstacle:
    """A rigid shape; profiles and surfaces may be in a file, or be a boundary of the deck's mesh."""
    entry = {"file": value} if key == "surface" and isinstance(value, str) else table(value, where)
    if key not in ("profile", "surface") or not {"file", "boundary"} & set(entry):
        return make(OBSTACLES[key], entry, where)
    from signorini.meshing.profile import mesh_profile, read_profile  # brings meshio with it
    from signorini.meshing.surface import mesh_surface, read_surface

    check_keys(entry, where, known=["file", "boundary", "flip", *(["fillet"] if key == "profile" else [])])
    given = dict(entry)
    name = text(given["boundary"], (*where, "boundary")) if "boundary" in given else ""
    if not isinstance(given.get("flip", False), bool):
        raise InputError(f"is {given['flip']!r}; expected true or false", where=(*where, "flip"))
    try:
        if "file" in given:
            file = reach.file(text(given.pop("file"), ("file",)), ("file",))
            return (read_profile if key == "profile" else read_surface)(file, **given)
        del given["boundary"]
        _refuse_body(mesh, name)
        return (mesh_profile if key == "profile" else mesh_surface)(mesh, name, **given)
    except InputError as error:
        inner = [part for part in error.where if part in entry]
        raise InputError(error.message, where=(*where, *inner[:1])) from error


def _refuse_body(mesh: Mesh, name: str) -> None:
    """A rigid surface of the deck's own mesh bounds no body."""
    if name in mesh.boundaries and not mesh.bounds_nothing(name):
        raise InputError(
            f"'{name}' bounds a body; expected a boundary of no body, or mortar = '{name}'", where=("boundary",)
        )


def _obstacle(entry: dict[str, Any], where: Where, reach: Reach, mesh: Mesh) -> Rigid:
    check_keys(entry, where, known=_OBSTACLE_KEYS, needed=["name"])
    given = dict(entry)
    shapes = [key for key in OBSTACLES if key in given]
    if len(shapes) != 1:
        raise InputError(f"has {len(shapes)} shapes; expected one of {', '.join(OBSTACLES)}", where=where)
    key = shapes[0]
    given["shape"] = _shape(key, given.pop(key), (*where, key), reach, mesh)
    return make(Rigid, given, where)


def _sided(entry: dict[str, Any], where: Where) -> dict[str, Any]:
    """The table of a contact with its sides by name: of those "between" which it is, the coarser one is nonmortar."""
    if "between" not in entry:
        return dict(entry)
    named = [key for key in (*_SIDES, *OBSTACLES) if key in entry]
    both = entry["between"]
    if named or not isinstance(both, list) or len(both) != 2:
        found = f"goes with no '{named[0]}'" if named else f"is {both!r}"
        raise InputError(
            f'{found}; expected two boundaries, as in ["a", "b"], and no other side', where=(*where, "between")
        )
    sides = [text(side, (*where, "between", i)) for i, side in enumerate(both)]
    rest = {key: value for key, value in entry.items() if key != "between"}
    return {"side": "coarser", **rest, "nonmortar": sides[0], "mortar": sides[1]}


def _contact(entry: dict[str, Any], where: Where, reach: Reach, mesh: Mesh) -> Contact:
    check_keys(entry, where, known=_CONTACT_KEYS, needed=[] if "between" in entry else ["nonmortar"])
    given = _sided(entry, where)
    if isinstance(given.get("friction"), dict):
        given["friction"] = _friction(given["friction"], (*where, "friction"))
    if "wear" in given:
        given["wear"] = make(Wear, table(given["wear"], (*where, "wear")), (*where, "wear"))
    sides = [key for key in ("mortar", *OBSTACLES) if key in given]
    if len(sides) != 1:
        found = "both " + " and ".join(f"'{key}'" for key in sides) if sides else "no other side"
        raise InputError(f"has {found}; expected one of mortar, {', '.join(OBSTACLES)}", where=where)
    key = sides[0]
    if key == "mortar":
        text(given["mortar"], (*where, "mortar"))
    else:
        given["mortar"] = _shape(key, given.pop(key), (*where, key), reach, mesh)
    return make(Contact, given, where)
