# SPDX-License-Identifier: BSD-3-Clause
"""From a model to a deck: a TOML file and its mesh beside it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from signorini.deck.tables import FIELDS, OBSTACLES
from signorini.deck.varying import spelled
from signorini.fatigue.criteria import FatigueCriterion
from signorini.law.closure import Closure
from signorini.law.cohesion import Cohesion
from signorini.law.friction import FrictionLaw
from signorini.model.kind import WITHOUT_THICKNESS
from signorini.model.material import Material
from signorini.model.model import Model
from signorini.model.modes import ModesRequest
from signorini.model.varying import Along
from signorini.model.wear import Wear

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_SHAPES = {kind: key for key, kind in reversed(OBSTACLES.items())}  # a sphere is a circle
_FREE = ("u", "force", "rotation")  # where None means free and is said


def write_deck(model: Model, path: Path, modes: ModesRequest | None = None) -> list[Path]:
    """Write a deck that is read as the same model, and the mesh that it names.

    Parameters
    ----------
    model : the model
    path : of the TOML file; the mesh is written as ``.vtu`` under the same name
    modes : that the deck asks for; None: none

    Returns
    -------
    The two files

    Raises
    ------
    InputError
        If the model holds a function, which a deck cannot say.
    """
    from signorini.meshing.write import write_mesh  # brings meshio with it

    mesh = path.with_suffix(".vtu")
    write_mesh(model.mesh, mesh)
    asked = "" if modes is None else "\n".join(("", "[modes]", *_entries(_given(modes)), ""))
    path.write_text(toml_text(model, mesh.name) + asked, encoding="utf-8")
    return [path, mesh]


def toml_text(model: Model, mesh: str) -> str:
    """A deck as text.

    Parameters
    ----------
    mesh : the mesh file's name

    Examples
    --------
    >>> from signorini.gallery.cylinder import zhu_cylinder
    >>> print(*toml_text(zhu_cylinder(), "disk.vtu").splitlines()[:7], sep="\\n")
    title = "Elastic cylinder on a rigid foundation"
    kind = "plane strain"
    <BLANKLINE>
    [mesh]
    file = "disk.vtu"
    <BLANKLINE>
    [material."material 1"]
    """
    return "\n".join(_lines(model, mesh)) + "\n"


def _lines(model: Model, mesh: str) -> Iterator[str]:
    top = {key: getattr(model, key) for key in ("title", "kind", "thickness", "units")}
    if model.kind in WITHOUT_THICKNESS:
        del top["thickness"]
    defaults = {field.name: field.default for field in fields(model)}
    yield from (f"{key} = {_value(value)}" for key, value in top.items() if value != defaults[key] or key == "kind")
    yield from ("", "[mesh]", f"file = {_value(mesh)}")
    materials: dict[Any, str] = {}
    for body in model.bodies:
        if body.material not in materials:
            materials[body.material] = f"material {len(materials) + 1}"
            yield from _material(f"material.{_key(materials[body.material])}", body.material)
    for key, field in FIELDS.items():
        for member in getattr(model, field):
            given = _given(member)
            if key == "body":
                given["material"] = materials[member.material]
                if member == replace(member, formulation=None).in_kind(model.kind, model.mesh.families(member.name)):
                    del given["formulation"]
            yield from ("", f"[[{key}]]", *_entries(given))


def _material(name: str, material: Material) -> Iterator[str]:
    given = _given(material)
    plastic = given.pop("plastic", None)
    yield from ("", f"[{name}]", *_entries(given))
    if plastic is not None:
        yield from ("", f"[{name}.plastic]", *_entries(_given(plastic)))


def _given(part: Any) -> dict[str, Any]:
    """The fields of a part that differ from their defaults; a rigid shape goes under its own key."""
    found = {}
    for field in fields(part):
        value = getattr(part, field.name)
        default = field.default_factory() if field.default_factory is not MISSING else field.default
        if type(value) in _SHAPES:
            found[_SHAPES[type(value)]] = _given(value)
        elif isinstance(value, np.ndarray) or (value is not default and value != default):
            found[field.name] = value
    return found


def _entries(table: Mapping[str, Any]) -> Iterator[str]:
    for key, value in table.items():
        if value is not None or key in _FREE:
            if key == "friction" and isinstance(value, Along):
                value = {value.axis: value.at, "mu": value.values}
            yield f"{_key(key)} = {_value(value)}"


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _value(key)


def _value(value: Any) -> str:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if value is None:
        return '"free"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, FrictionLaw | Closure | Cohesion | FatigueCriterion):
        value = value.table
    if isinstance(value, Wear):
        value = _given(value)
    value = spelled(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(part)}" for key, part in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(part) for part in value) + "]"
    return repr(value)
