# SPDX-License-Identifier: BSD-3-Clause
"""Materials, bodies, supports, loads, contacts and steps: from tables of a deck to the model's own classes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from signorini.checks import text
from signorini.deck.table import check_keys, make, table, tables
from signorini.errors import InputError, Where, one_of
from signorini.model.body import Body
from signorini.model.conditions import Foundation, Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic, Material, Orthotropic
from signorini.model.obstacle import Circle, Obstacle, Plane, Profile, Sphere
from signorini.model.revolved import Cone, Cylinder, Torus
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.model.varying import Along

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
)
_OBSTACLES = {
    "plane": Plane,
    "circle": Circle,
    "profile": Profile,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "cone": Cone,
    "torus": Torus,
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
        check_keys(entry, where, known=["name", "material", "formulation"], needed=["name", "material"])
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


def deck_steps(data: Mapping[str, Any]) -> list[Step]:
    """``[[step]]``."""
    return [make(Step, entry, ("step", i)) for i, entry in enumerate(tables(data, "step"))]


def deck_contacts(data: Mapping[str, Any], folder: Path) -> list[Contact]:
    """``[[contact]]``, each with a ``mortar`` boundary or a rigid obstacle; its file is relative to the folder."""
    return [_contact(entry, ("contact", i), folder) for i, entry in enumerate(tables(data, "contact"))]


def _along(entry: dict[str, Any], where: Where) -> Along:
    """``{ x = [...], mu = [...] }``."""
    axes = [key for key in entry if key != "mu"]
    if "mu" not in entry or len(axes) != 1:
        raise InputError(
            f"has {', '.join(entry) or 'nothing'}; expected one coordinate and mu, as in x, mu", where=where
        )
    return make(Along, {"axis": axes[0], "at": entry[axes[0]], "values": entry["mu"]}, where)


def deck_obstacles(data: Mapping[str, Any], folder: Path) -> list[Rigid]:
    """``[[obstacle]]``, each with a shape; its file is relative to the folder."""
    return [_obstacle(entry, ("obstacle", i), folder) for i, entry in enumerate(tables(data, "obstacle"))]


def _shape(key: str, value: Any, where: Where, folder: Path) -> Obstacle:
    """A plane, a circle or a profile; a profile may be the boundary of a mesh in a file."""
    entry = table(value, where)
    if key != "profile" or "file" not in entry:
        return make(_OBSTACLES[key], entry, where)
    from signorini.fem.profile import mesh_profile  # brings scikit-fem with it
    from signorini.fem.read import read_mesh  # and this every format of meshio

    check_keys(entry, where, known=["file", "boundary", "fillet"], needed=["file", "boundary"])
    try:
        mesh = read_mesh(folder / text(entry["file"], ("file",)))
        return mesh_profile(mesh, text(entry["boundary"], ("boundary",)), fillet=entry.get("fillet", 0.0))
    except InputError as error:
        raise InputError(error.message, where=(*where, "boundary" if "boundary" in error.where else "file")) from error


def _obstacle(entry: dict[str, Any], where: Where, folder: Path) -> Rigid:
    check_keys(entry, where, known=_OBSTACLE_KEYS, needed=["name"])
    given = dict(entry)
    shapes = [key for key in _OBSTACLES if key in given]
    if len(shapes) != 1:
        raise InputError(f"has {len(shapes)} shapes; expected one of {', '.join(_OBSTACLES)}", where=where)
    key = shapes[0]
    given["shape"] = _shape(key, given.pop(key), (*where, key), folder)
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


def _contact(entry: dict[str, Any], where: Where, folder: Path) -> Contact:
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
        given["mortar"] = _shape(key, given.pop(key), (*where, key), folder)
    return make(Contact, given, where)
