# SPDX-License-Identifier: BSD-3-Clause
"""The JSON schema of a TOML deck, made from the classes that its tables become: their parameters, types and docstrings.

An editor that knows it completes keys and marks what is none. It allows what the deck itself may still refuse: names
that are not in the mesh, numbers out of range, keys that exclude each other.
"""

from __future__ import annotations

import inspect
import re
import types
import typing
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any, Literal

from signorini.deck.load import ACCURACY_KEYS, KEYS
from signorini.deck.meshes import FILE_KEYS, GENERATORS
from signorini.deck.tables import CONTACT_KEYS, KINDS, OBSTACLE_KEYS, OBSTACLES
from signorini.fatigue.criteria import CRITERIA
from signorini.law.closure import Closure
from signorini.law.cohesion import Cohesion
from signorini.model.accuracy import Accuracy
from signorini.model.body import Body
from signorini.model.bolt import Bolt
from signorini.model.conditions import Load
from signorini.model.contact import Contact
from signorini.model.fatigue import Fatigue
from signorini.model.material import Elastic, Orthotropic
from signorini.model.model import Model
from signorini.model.modes import ModesRequest
from signorini.model.plastic import Plastic
from signorini.model.rigid import Rigid
from signorini.model.varying import Along, ArcLength, Formula, NodeValues, Scattered
from signorini.model.wear import Wear
from signorini.settings import SolverSettings

Schema = dict[str, Any]

_NUMBER: Schema = {"type": "number"}
_TABLE: Schema = {"type": "object"}
_LIST: Schema = {"type": "array"}
_TEXT: Schema = {"type": "string"}
_FREE: Schema = {"const": "free"}
_PLAIN: Mapping[Any, Schema] = {float: _NUMBER, int: {"type": "integer"}, str: _TEXT, bool: {"type": "boolean"}}
_SAID = ("description", "default")
_VARIES = (Along, ArcLength, NodeValues, Scattered)

_INNER: Mapping[str, tuple[Callable[..., Any], ...]] = {
    "wear": (Wear,),
    "closure": (Closure, Closure.exponential),
    "cohesion": (Cohesion, Cohesion.by_energy),
}
"""Tables inside that of a contact, and what they become."""

FILED = {"profile": ("file", "boundary", "flip"), "surface": ("file", "boundary", "flip")}
"""Rigid shapes that a file or the mesh of the deck may have, and the keys that say so."""

OWN_WORDS = {
    "mesh.file": "a mesh that meshio reads, a universal file .unv, or a geometry of Gmsh .geo, relative to the deck",
    "mesh.generator": "a generator of meshes; its parameters are the other keys",
    "mesh.name": "of one of several meshes: names become name.boundary",
    "contact.between": "two boundaries in place of nonmortar and mortar; the coarser one becomes the nonmortar side",
    "obstacle.name": "what contacts, steps and results call it",
    "load.nodal_forces": "a force for each node of a node set, ascending; or file and column, with nodes of its own",
    "solve.accuracy": "relative error that the mesh is refined to; 'estimate': errors are estimated on it as it is",
    "bolt.plane": "body, point and normal: the section is the facets of the body in a plane of nodes",
    "bolt.halves": "two boundaries that face each other: the section is between them",
    "body.material": "name of a table [material.NAME] of the deck",
    "profile.file": "a mesh of lines, of any format that mesh takes; the deck's own without it",
    "profile.boundary": "name of its lines in that mesh",
    "profile.flip": "turns the side on which the bodies are",
    "surface.file": "a mesh of faces, of any format that mesh takes, STL too; the deck's own without it",
    "surface.boundary": "name of its faces in that mesh",
    "surface.flip": "turns the side on which the bodies are",
    "fatigue.criterion.name": "the criterion",
    "material.plastic": "the yield law of a material, elastic without it",
    "mesh": "where the mesh comes from: a file or a generator; [[mesh]]: several, joined",
    "material": "[material.NAME]: what bodies are made of",
    "body": "a body of the mesh and its material",
    "support": "a boundary, a node set, a rigid body or an obstacle that is held, moves as prescribed, or is driven",
    "foundation": "springs under a boundary",
    "load": "forces, pressures, gravity, rotation, temperature",
    "contact": "two sides that may touch, or one and a rigid obstacle, and the law between them",
    "obstacle": "a rigid shape that moves, held by supports, pushed by loads, or free",
    "rigid_body": "a body, or a side, that moves as one",
    "equation": "a linear equation between displacements",
    "cyclic_symmetry": "the two sides of a sector of a disc",
    "bolt": "a section that is tightened, locked or released",
    "fatigue": "a criterion of fatigue and the body that it judges",
    "step": "a part of the load history: what the loads go to, and how it is followed",
    "modes": "natural frequencies of the bodies as the last step leaves them",
    "solve": "an accuracy that the mesh is refined to",
    "solver": "limits of the methods; none changes an answer",
}
"""What keys mean that are parameters of no class, and what tables hold."""


def deck_schema() -> Schema:
    """The schema, draft 7, of a whole deck."""
    own: dict[str, Schema] = {key: _array(_table([kind], key)) for key, kind in KINDS.items()}
    bolt = _table(
        [Bolt], "bolt", replaced={"plane": _TABLE | _own("bolt", "plane"), "halves": _LIST | _own("bolt", "halves")}
    )
    constants = _table(
        CRITERIA.values(),
        "fatigue.criterion",
        needed=("name",),
        replaced={"name": {"enum": list(CRITERIA)} | _own("fatigue.criterion", "name")},
    )
    criterion = _either([{"enum": list(CRITERIA)}, constants]) | {
        "description": "by name, or a table with its constants"
    }
    forces = _either([_LIST, _TABLE]) | _own("load", "nodal_forces")
    own["load"] = _array(_table([Load], "load", needed=(), replaced={"nodal_forces": forces}))
    own["bolt"], own["fatigue"] = _array(bolt), _array(_table([Fatigue], "fatigue", replaced={"criterion": criterion}))
    own["mesh"] = {"anyOf": [_mesh(), _array(_mesh())]}
    own["material"] = {"type": "object", "additionalProperties": _material()}
    own["body"] = _array(
        _table([Body], "body", needed=("name", "material"), replaced={"material": _TEXT | _own("body", "material")})
    )
    own["contact"] = _array(_contact())
    own["obstacle"] = _array(_table([Rigid], "obstacle", OBSTACLE_KEYS, needed=("name",), replaced=_shapes()))
    asked = _either([_NUMBER, {"const": "estimate"}]) | _own("solve", "accuracy")
    accuracy = {"accuracy": asked}
    own["solve"] = _table([Accuracy], "solve", (*accuracy, *ACCURACY_KEYS), needed=("accuracy",), replaced=accuracy)
    own["solver"], own["modes"] = _table([SolverSettings], "solver"), _table([ModesRequest], "modes")
    single = _table([Model], "", ("title", "kind", "thickness", "units"), needed=())["properties"]
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "a deck of signorini",
        "type": "object",
        "additionalProperties": False,
        "required": ["mesh", "body"],
        "properties": {key: {**single, **own}[key] | _own("", key) for key in KEYS},
    }


def meanings() -> dict[str, tuple[str, str]]:
    """Key of a deck with its path, as ``contact.friction``, to its meaning and its default in words."""
    found: dict[str, tuple[str, str]] = {}

    def walk(schema: Schema, path: tuple[str, ...]) -> None:
        for part in (schema, *schema.get("anyOf", ())):
            for key, inner in part.get("properties", {}).items():
                if "description" in inner:
                    default = inner.get("default", "")
                    found.setdefault(".".join((*path, key)), (inner["description"], str(default)))
                walk(inner, (*path, key))
            for inner in (part.get("items"), part.get("additionalProperties")):
                if isinstance(inner, dict):
                    walk(inner, path)

    walk(deck_schema(), ())
    return found


def _array(items: Schema) -> Schema:
    return {"type": "array", "items": items}


def _table(
    kinds: Iterable[Callable[..., Any]],
    path: str,
    keys: Collection[str] = (),
    needed: Collection[str] | None = None,
    replaced: Mapping[str, Schema] | None = None,
) -> Schema:
    """A table that becomes one of some classes.

    Parameters
    ----------
    kinds : the classes
    path : of the table in a deck
    keys : that the table may have; the parameters of the classes where none are given
    needed : that it must have; those without a default where None
    replaced : keys that a deck says otherwise than a class
    """
    properties: dict[str, Schema] = {}
    musts: list[set[str]] = []
    for kind in kinds:
        parameters = inspect.signature(kind).parameters
        properties |= {name: _key(kind, name, parameter) for name, parameter in parameters.items()}
        musts.append({name for name, parameter in parameters.items() if parameter.default is parameter.empty})
    properties |= {key: _own(path, key) for key in keys if key not in properties} | dict(replaced or {})
    properties = {key: properties[key] for key in (keys or properties)}
    required = set.intersection(*musts) if needed is None else set(needed)
    schema: Schema = {"type": "object", "additionalProperties": False, "properties": properties}
    return schema | ({"required": sorted(required)} if required else {})


def _own(path: str, key: str) -> Schema:
    words = OWN_WORDS.get(f"{path}.{key}" if path else key)
    return {"description": words} if words else {}


def _key(kind: Callable[..., Any], name: str, parameter: inspect.Parameter) -> Schema:
    """A parameter of a class as a key: its type, what its docstring says, and its default."""
    told = (base.__doc__ for base in (inspect.getmro(kind) if inspect.isclass(kind) else (kind,)))
    words = next((said[name] for said in map(_parameter_words, filter(None, told)) if name in said), "")
    found = dict(_typed(_hint(kind, name)))
    if words:
        found["description"] = words
    if isinstance(parameter.default, str | int | float | bool):
        found["default"] = parameter.default
    return found


def _hint(kind: Callable[..., Any], name: str) -> Any:
    hints = typing.get_type_hints(kind.__init__ if inspect.isclass(kind) else inspect.unwrap(kind))
    return hints.get(name, Any)


def _typed(hint: Any) -> Schema:
    """What TOML may hold where a class takes a type; nothing is said where it may be anything."""
    origin, parts = typing.get_origin(hint), typing.get_args(hint)
    if hint is Any:
        return {}
    if hint in _PLAIN:
        return _PLAIN[hint]
    if origin is Literal:
        return {"enum": list(parts)}
    if origin in (typing.Union, types.UnionType):
        return _either([_typed(part) for part in parts if part is not type(None)])
    if hint is Formula:
        return _TEXT
    if origin is tuple:
        free = type(None) in typing.get_args(parts[0])
        inside = _either([_typed(parts[0]), *([_FREE] if free else [])])
        return _array(inside) if parts[-1] is Ellipsis else _LIST
    if inspect.isclass(origin) and issubclass(origin, Mapping):
        return _TABLE
    if hint in _VARIES or inspect.isclass(hint):
        return _TABLE if "ndarray" not in str(hint) else _LIST
    if inspect.isclass(origin) and issubclass(origin, Iterable):
        return _LIST
    return {}


def _either(schemas: Iterable[Schema]) -> Schema:
    """One of several; of alike ones each once, and nothing where one of them is nothing."""
    different: list[Schema] = []
    for schema in schemas:
        for part in schema.get("anyOf", [schema]):
            if part not in different:
                different.append(part)
    if {} in different:
        return {}
    return different[0] if len(different) == 1 else {"anyOf": different}


def _parameter_words(docstring: str) -> dict[str, str]:
    """Parameter to what a docstring says of it, in one line without marks."""
    docstring = inspect.cleandoc(docstring)
    block = re.search(r"^(?:Parameters|Attributes)\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", docstring, re.MULTILINE | re.DOTALL)
    found: dict[str, str] = {}
    for entry in re.split(r"\n(?=\S)", block[1].strip()) if block else ():
        names, _, words = entry.partition(" : ")
        plain = re.sub(r":\w+:`([^`]*)`", r"\1", " ".join(words.split())).replace("``", "").replace("`", "")
        found |= {name.strip(): plain for name in names.split(",")}
    return found


def _mesh() -> Schema:
    given = [_table([made], "mesh", needed=())["properties"] for made in GENERATORS.values()]
    properties = {key: value for one in given for key, value in one.items()}
    own = {key: _TEXT | _own("mesh", key) for key in FILE_KEYS}
    own["generator"] = {"enum": list(GENERATORS)} | _own("mesh", "generator")
    # generators mean different things by one name: a key may be what any of them takes
    shared = {key: _merged([one[key] for one in given if key in one]) for key in properties}
    return {"type": "object", "additionalProperties": False, "properties": shared | own}


def _merged(schemas: list[Schema]) -> Schema:
    """A key that several take: any of their types, and what the first says of it."""
    types_alone = [{key: part for key, part in one.items() if key not in _SAID} for one in schemas]
    return _either(types_alone) | {key: part for key, part in schemas[0].items() if key in _SAID}


def _material() -> Schema:
    elastic = _table(
        [Elastic], "material", replaced={"plastic": _table([Plastic], "material.plastic") | _own("material", "plastic")}
    )
    return {"anyOf": [elastic, _table([Orthotropic], "material")]}


def _shapes() -> dict[str, Schema]:
    """Rigid shapes, each a table, of which two may stand in files."""
    found = {}
    for key, shape in OBSTACLES.items():
        words = (inspect.getdoc(shape) or "").split("\n\n")[0]
        made, kinds = _table([shape], key), [_TEXT] if key == "surface" else []
        if key in FILED:
            made = made | {
                "properties": made["properties"] | {name: _own(key, name) for name in FILED[key]},
                "required": [],
            }
        found[key] = _either([made, *kinds]) | {"description": " ".join(words.replace("`", "").split())}
    return found


def _contact() -> Schema:
    words = _parameter_words(inspect.getdoc(Contact) or "")
    inner = {key: _either([_table([kind], key) for kind in kinds]) for key, kinds in _INNER.items()}
    replaced = _shapes() | {
        "mortar": _TEXT,
        "between": {"type": "array", "items": _TEXT, "minItems": 2, "maxItems": 2} | _own("contact", "between"),
        "friction": {"anyOf": [_NUMBER, {"enum": ["stick", "tied"]}, _TABLE, _array(_NUMBER)], "default": 0.0},
        **inner,
    }
    said = {key: {"description": words[key]} for key in ("mortar", "friction", *_INNER)}
    replaced = {key: schema | said.get(key, {}) for key, schema in replaced.items()}
    return _table([Contact], "contact", CONTACT_KEYS, needed=(), replaced=replaced)
