# SPDX-License-Identifier: BSD-3-Clause
"""Materials, bodies, supports, loads, contacts and steps: from tables of a deck to the model's own classes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from signorini.checks import text
from signorini.deck.table import check_keys, make, table, tables
from signorini.errors import InputError, Where, one_of
from signorini.model.body import Body
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.contact import Contact
from signorini.model.links import Equation, RigidBody
from signorini.model.material import Elastic, Material, Orthotropic
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Circle, Obstacle, Plane, Profile, Sphere
from signorini.model.revolved import Cone, Cylinder, Torus
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.model.triangulated import Surface
from signorini.model.varying import Along
from signorini.sources import Reach

_CONTACT_KEYS = (
    "name",
    "between",
    "nonmortar",
    "mortar",
    "plane",
    "circle",
    "profile",
    "sphere",
    "cylinder",
    "cone",
    "torus",
    "surface",
    "friction",
    "shear_limit",
    "adhesion",
    "gap",
    "interference",
    "normal_compliance",
    "tangential_compliance",
    "coupling",
    "side",
    "search",
    "adjust",
    "friction_axis",
    "facets",
)
_OBSTACLES = {
    "plane": Plane,
    "circle": Circle,
    "profile": Profile,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "cone": Cone,
    "torus": Torus,
    "surface": Surface,
}
_OBSTACLE_KEYS = ("name", *_OBSTACLES, "u", "rotation", "force", "moment", "point")


def deck_materials(data: Mapping[str, Any]) -> dict[str, Material]:
    """``[material.NAME]`` by name; with ``E1`` orthotropic."""
    found: dict[str, Material] = {}
    for name, entry in table(data.get("material", {}), ("material",)).items():
        given = table(entry, ("material", name))
        where = ("material", name)
        found[name] = make(Orthotropic, given, where) if "E1" in given else make(Elastic, given, where)
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


def deck_supports(data: Mapping[str, Any]) -> list[Support]:
    """``[[support]]``."""
    return [_placed(Support, entry, ("support", i)) for i, entry in enumerate(tables(data, "support"))]


def deck_foundations(data: Mapping[str, Any]) -> list[Foundation]:
    """``[[foundation]]``."""
    return [make(Foundation, entry, ("foundation", i)) for i, entry in enumerate(tables(data, "foundation"))]


def deck_loads(data: Mapping[str, Any]) -> list[Load]:
    """``[[load]]``."""
    return [_placed(Load, entry, ("load", i)) for i, entry in enumerate(tables(data, "load"))]


def deck_equations(data: Mapping[str, Any]) -> list[Equation]:
    """``[[equation]]``."""
    return [make(Equation, entry, ("equation", i)) for i, entry in enumerate(tables(data, "equation"))]


def deck_rigid_bodies(data: Mapping[str, Any]) -> list[RigidBody]:
    """``[[rigid_body]]``."""
    return [make(RigidBody, entry, ("rigid_body", i)) for i, entry in enumerate(tables(data, "rigid_body"))]


def deck_steps(data: Mapping[str, Any]) -> list[Step]:
    """``[[step]]``."""
    return [make(Step, entry, ("step", i)) for i, entry in enumerate(tables(data, "step"))]


def deck_contacts(data: Mapping[str, Any], reach: Reach, mesh: Mesh) -> list[Contact]:
    """``[[contact]]``, each with a ``mortar`` boundary or a rigid obstacle; its file is one that the deck may name."""
    return [_contact(entry, ("contact", i), reach, mesh) for i, entry in enumerate(tables(data, "contact"))]


def _along(entry: dict[str, Any], where: Where) -> Along:
    """``{ x = [...], mu = [...] }``."""
    axes = [key for key in entry if key != "mu"]
    if "mu" not in entry or len(axes) != 1:
        raise InputError(
            f"has {', '.join(entry) or 'nothing'}; expected one coordinate and mu, as in x, mu", where=where
        )
    return make(Along, {"axis": axes[0], "at": entry[axes[0]], "values": entry["mu"]}, where)


def deck_obstacles(data: Mapping[str, Any], reach: Reach, mesh: Mesh) -> list[Rigid]:
    """``[[obstacle]]``, each with a shape; its file is one that the deck may name."""
    return [_obstacle(entry, ("obstacle", i), reach, mesh) for i, entry in enumerate(tables(data, "obstacle"))]


def _shape(key: str, value: Any, where: Where, reach: Reach, mesh: Mesh) -> Obstacle:
    """A rigid shape; profiles and surfaces may be in a file, or be a boundary of the deck's mesh."""
    entry = {"file": value} if key == "surface" and isinstance(value, str) else table(value, where)
    if key not in ("profile", "surface") or not {"file", "boundary"} & set(entry):
        return make(_OBSTACLES[key], entry, where)
    from signorini.fem.profile import mesh_profile, read_profile  # brings scikit-fem and meshio with it
    from signorini.fem.surface import mesh_surface, read_surface

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
    shapes = [key for key in _OBSTACLES if key in given]
    if len(shapes) != 1:
        raise InputError(f"has {len(shapes)} shapes; expected one of {', '.join(_OBSTACLES)}", where=where)
    key = shapes[0]
    given["shape"] = _shape(key, given.pop(key), (*where, key), reach, mesh)
    return make(Rigid, given, where)


def _placed(kind: Any, entry: dict[str, Any], where: Where) -> Any:
    on = entry.get("on", "")
    if not isinstance(on, str | list):
        raise InputError(f"is {on!r}; expected a name, or the coordinates of a node", where=(*where, "on"))
    return make(kind, entry, where)


def _sided(entry: dict[str, Any], where: Where) -> dict[str, Any]:
    """The table of a contact with its sides by name: of those "between" which it is, the coarser one is nonmortar."""
    if "between" not in entry:
        return dict(entry)
    named = [key for key in ("nonmortar", "mortar", *_OBSTACLES) if key in entry]
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
        given["friction"] = _along(given["friction"], (*where, "friction"))
    sides = [key for key in ("mortar", *_OBSTACLES) if key in given]
    if len(sides) != 1:
        found = "both " + " and ".join(f"'{key}'" for key in sides) if sides else "no other side"
        raise InputError(f"has {found}; expected one of mortar, {', '.join(_OBSTACLES)}", where=where)
    key = sides[0]
    if key == "mortar":
        text(given["mortar"], (*where, "mortar"))
    else:
        given["mortar"] = _shape(key, given.pop(key), (*where, key), reach, mesh)
    return make(Contact, given, where)
