# SPDX-License-Identifier: BSD-3-Clause
"""From tables of a deck to the model's own classes, with the checks that all tables share."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

from signorini.checks import choice, text
from signorini.deck.fatigue import deck_fatigue
from signorini.deck.keys import check_keys, make, table, tables
from signorini.deck.varying import deck_value, deck_values
from signorini.errors import InputError, Where, one_of
from signorini.law.closure import Closure
from signorini.law.cohesion import Cohesion
from signorini.law.friction import LAWS, FrictionLaw
from signorini.model.body import Body
from signorini.model.bolt import Bolt
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.contact import Contact
from signorini.model.links import CyclicSymmetry, Equation, RigidBody
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
CONTACT_KEYS = (
    "name",
    "between",
    *_SIDES,
    *OBSTACLES,
    *(key for key in inspect.signature(Contact).parameters if key not in ("name", *_SIDES)),
)
_VARYING = ("pressure", "temperature", "gap", "interference")
OBSTACLE_KEYS = ("name", *OBSTACLES, "u", "rotation", "force", "moment", "point")


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
    "cyclic_symmetry": "cyclic_symmetries",
    "bolt": "bolts",
    "fatigue": "fatigue",
    "step": "steps",
}
"""Arrays of tables, and the fields of the model that they give."""

KINDS: Mapping[str, Callable[..., Any]] = {
    "support": Support,
    "foundation": Foundation,
    "load": Load,
    "rigid_body": RigidBody,
    "equation": Equation,
    "cyclic_symmetry": CyclicSymmetry,
    "bolt": Bolt,
    "step": Step,
}
"""Arrays of tables whose keys are the parameters of a class."""


def deck_parts(data: Mapping[str, Any], reach: Reach, mesh: Mesh) -> dict[str, list[Any]]:
    """Supports, loads, contacts, steps: fields of the model, without bodies, those that the deck has.

    Parameters
    ----------
    data : the whole deck
    reach : files that it may name
    mesh : its mesh, whose boundaries may be rigid shapes
    """
    parts: dict[str, list[Any]] = {}
    for key, field in FIELDS.items():
        if key == "body":
            continue  # their materials are checked before a mesh is read
        for i, entry in enumerate(tables(data, key)):
            where: Where = (key, i)
            if key in KINDS:
                if key in ("support", "load"):
                    _refuse_place(entry.get("on", ""), where)
                    entry = _varied(entry, where, reach, mesh.points.shape[1])
                if key == "bolt":
                    made_of = ("plane", "halves")  # the mesh has that section
                    entry = {own: value for own, value in entry.items() if own not in made_of}
                if key == "step" and isinstance(entry.get("interference"), dict):
                    entry = entry | {"interference": _overlaps(entry["interference"], where, reach, mesh)}
                made = make(KINDS[key], entry, where)
            elif key == "fatigue":
                made = deck_fatigue(entry, where)
            else:
                made = (_contact if key == "contact" else _obstacle)(entry, where, reach, mesh)
            parts.setdefault(field, []).append(made)
    return parts


def _varied(entry: dict[str, Any], where: Where, reach: Reach, dimension: int) -> dict[str, Any]:
    """The table of a support, a load or a contact with what varies in it as the model takes it."""
    single = {
        key: deck_value(entry[key], (*where, key), reach, dimension)
        for key in _VARYING
        if isinstance(entry.get(key), dict)
    }
    several = {
        key: deck_values(entry[key], (*where, key), reach, dimension)
        for key in ("u", "traction")
        if isinstance(entry.get(key), list) and any(isinstance(part, dict | list) for part in entry[key])
    }
    return entry | single | several


def _overlaps(entry: dict[str, Any], where: Where, reach: Reach, mesh: Mesh) -> dict[str, Any]:
    """Interferences of a step by contact, with what varies as the model takes it."""
    d = mesh.points.shape[1]
    return {name: deck_value(value, (*where, "interference", name), reach, d) for name, value in entry.items()}


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


def _closure(entry: dict[str, Any], where: Where) -> Closure:
    """``{ points = [...] }``, or ``{ clearance = ..., pressure = ... }`` of the exponential law."""
    exponential = {"clearance", "pressure", "tolerance"} & set(entry)
    return make(Closure.exponential if exponential else Closure, entry, where)


def deck_shape(key: str, value: Any, where: Where, reach: Reach, mesh: Mesh) -> Obstacle:
    """A rigid shape; profiles and surfaces may be in a file, or be a boundary of the deck's mesh.

    Parameters
    ----------
    key, value : its name and what it is made of
    where : its path in the deck
    reach : where files may be
    mesh : of the deck
    """
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
    check_keys(entry, where, known=OBSTACLE_KEYS, needed=["name"])
    given = dict(entry)
    shapes = [key for key in OBSTACLES if key in given]
    if len(shapes) != 1:
        raise InputError(f"has {len(shapes)} shapes; expected one of {', '.join(OBSTACLES)}", where=where)
    key = shapes[0]
    given["shape"] = deck_shape(key, given.pop(key), (*where, key), reach, mesh)
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
    check_keys(entry, where, known=CONTACT_KEYS, needed=[] if "between" in entry else ["nonmortar"])
    given = _sided(entry, where)
    if isinstance(given.get("friction"), dict):
        given["friction"] = _friction(given["friction"], (*where, "friction"))
    if "wear" in given:
        given["wear"] = make(Wear, table(given["wear"], (*where, "wear")), (*where, "wear"))
    if "closure" in given:
        inside: Where = (*where, "closure")
        given["closure"] = _closure(table(given["closure"], inside), inside)
    if "cohesion" in given:
        bond: Where = (*where, "cohesion")
        entry = table(given["cohesion"], bond)
        given["cohesion"] = make(Cohesion.by_energy if "energy" in entry else Cohesion, entry, bond)
    given = _varied(given, where, reach, mesh.points.shape[1])
    sides = [key for key in ("mortar", *OBSTACLES) if key in given]
    if len(sides) != 1:
        found = "both " + " and ".join(f"'{key}'" for key in sides) if sides else "no other side"
        raise InputError(f"has {found}; expected one of mortar, {', '.join(OBSTACLES)}", where=where)
    key = sides[0]
    if key == "mortar":
        if isinstance(given["mortar"], dict):
            shapes = "a rigid shape stands in its place, as plane = { ... }"
            raise InputError(
                f"is a table; expected the name of a boundary or obstacle; {shapes}", where=(*where, "mortar")
            )
        text(given["mortar"], (*where, "mortar"))
    else:
        given["mortar"] = deck_shape(key, given.pop(key), (*where, key), reach, mesh)
    return make(Contact, given, where)
