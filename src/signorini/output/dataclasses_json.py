# SPDX-License-Identifier: BSD-3-Clause
"""Frozen data as plain text and arrays apart, and back, exactly."""

from __future__ import annotations

import hashlib
import importlib
import json
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from signorini.arrays import ArrayElsewhere, frozen, in_blocks, stored
from signorini.errors import InputError
from signorini.law.friction import LAWS

AnyArray = np.ndarray[Any, Any]

_HOMES = (
    "signorini.attempt",
    "signorini.fatigue.criteria",
    "signorini.law.closure",
    "signorini.law.cohesion",
    "signorini.model.accuracy",
    "signorini.model.body",
    "signorini.model.bolt",
    "signorini.model.conditions",
    "signorini.model.contact",
    "signorini.model.fatigue",
    "signorini.model.links",
    "signorini.model.obstacle",
    "signorini.model.rigid",
    "signorini.model.mesh",
    "signorini.model.model",
    "signorini.model.outputs",
    "signorini.model.plastic",
    "signorini.model.stage",
    "signorini.model.step",
    "signorini.model.varying",
    "signorini.model.wear",
    "signorini.plasticity.measure",
    "signorini.plasticity.state",
    "signorini.solution.accuracy",
    "signorini.solution.bolt_result",
    "signorini.solution.certificate",
    "signorini.solution.checkpoint",
    "signorini.solution.contact_wear",
    "signorini.solution.fatigue_result",
    "signorini.solution.history",
    "signorini.solution.obstacle_result",
    "signorini.solution.results",
    "signorini.solution.scale",
    "signorini.solution.state",
    "signorini.solution.wear_state",
)
_FORMER_NAMES = {"Attempt": "MethodRun"}  # of classes: files that were written before are read
_MARK = "$"
_DIGEST_SIZE = 16  # bytes: enough to find damage; who forges a file makes the digests anew
_MAX_INLINE = 32  # entries: smaller arrays stay in the text


@cache
def _kinds() -> Mapping[str, type]:
    """Classes that files may hold, by name: the frozen data of models and solutions, and nothing else."""
    found = {}
    for home in _HOMES:
        for name, kind in vars(importlib.import_module(home)).items():
            if isinstance(kind, type) and is_dataclass(kind) and kind.__module__.startswith("signorini."):
                found[name] = kind
    return MappingProxyType(found)


def _kind(name: str) -> type | None:
    """A class that files may hold, by name: those, and laws of friction that somebody entered."""
    return {kind.__name__: kind for kind in LAWS.values()}.get(name) or _kinds().get(name)


def to_plain(value: Any, path: str, keep: Callable[[str, Any, str], str]) -> Any:
    """Plain data that JSON can hold; larger arrays go to ``keep`` with a path and a digest, and it says where they are.

    Parameters
    ----------
    value : numbers, texts, arrays, here or elsewhere, lists, tables and classes of this package, nested
    path : of the value, as ``"steps/0"``

    Examples
    --------
    >>> from_plain(to_plain({"a": (1, None), "b": np.ones(2)}, "", str), len)
    {'a': (1, None), 'b': array([1., 1.])}
    """
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray | ArrayElsewhere):
        told = {_MARK: "array", "dtype": value.dtype.str}
        if isinstance(value, np.ndarray) and value.size <= _MAX_INLINE:
            return told | {"shape": list(value.shape), "of": value.ravel().tolist()}
        key = digest(value)
        return told | {"digest": key, "path": keep(path, value, key)}
    if isinstance(value, list | tuple | frozenset):
        members = sorted(value) if isinstance(value, frozenset) else value
        parts = [to_plain(part, f"{path}/{i}", keep) for i, part in enumerate(members)]
        return parts if isinstance(value, list) else {_MARK: type(value).__name__, "of": parts}
    if isinstance(value, Mapping):
        kind = "table" if isinstance(value, dict) else "proxy"
        pairs = [[key, to_plain(part, f"{path}/{_safe(key)}", keep)] for key, part in value.items()]
        return {_MARK: kind, "of": pairs}
    name = type(value).__name__
    if _kind(name) is not type(value):
        raise InputError(f"'{path}' is {value!r}, which a file cannot hold; expected numbers or a table")
    own = {
        field.name: to_plain(stored(value, field.name), f"{path}/{field.name}", keep)
        for field in fields(cast(Any, value))
    }
    return {_MARK: "class", "name": name, "of": own}


def tuple_of(parts: list[Any]) -> Any:
    """A tuple whose members :func:`to_plain` has made plain one by one.

    >>> from_plain(tuple_of([1, 2]), len)
    (1, 2)
    """
    return {_MARK: "tuple", "of": parts}


def from_plain(plain: Any, get: Callable[[str], AnyArray]) -> Any:
    """The value that :func:`to_plain` was given; nothing is computed anew, so that every number is the same.

    Raises
    ------
    InputError
        If it names a class that this version does not have, with fields that this one lacks, or without one that has no
        default; if an array is not what was written.
    """
    if isinstance(plain, list):
        return [from_plain(part, get) for part in plain]
    if not isinstance(plain, dict):
        return plain
    mark = plain[_MARK]
    if mark == "array":
        kind = np.dtype(plain["dtype"])
        if "path" in plain:
            array = frozen(get(plain["path"]), kind)
            if digest(array) != plain["digest"]:
                raise InputError(f"is damaged: '{plain['path']}' is not what was written")
            return array
        return frozen(np.array(plain["of"], kind).reshape(plain["shape"]), kind)
    if mark in ("tuple", "frozenset"):
        return {"tuple": tuple, "frozenset": frozenset}[mark](from_plain(part, get) for part in plain["of"])
    if mark in ("table", "proxy"):
        pairs = {key: from_plain(part, get) for key, part in plain["of"]}
        return pairs if mark == "table" else MappingProxyType(pairs)
    name = str(plain["name"])
    made_of = _kind(_FORMER_NAMES.get(name, name))
    expected = {field.name: field.default for field in fields(made_of)} if made_of is not None else {}
    newer = {key: default for key, default in expected.items() if key not in plain["of"]}
    if made_of is None or len(newer) + len(plain["of"]) != len(expected) or MISSING in newer.values():
        raise InputError(f"holds a {name} as another version of signorini has it; expected this version's")
    made: Any = object.__new__(made_of)
    for key, default in newer.items():
        object.__setattr__(made, key, default)
    for key, part in plain["of"].items():
        object.__setattr__(made, key, from_plain(part, get))
    return made


def digest(array: AnyArray | ArrayElsewhere) -> str:
    """Letters that two arrays share only if type, shape and every bit are the same.

    >>> digest(np.zeros(2)) == digest(np.zeros((2, 1)))
    False
    """
    found = hashlib.blake2b(f"{array.dtype.str}{array.shape}".encode(), digest_size=_DIGEST_SIZE)
    for _, rows in in_blocks(array):
        found.update(np.ascontiguousarray(rows).tobytes())
    return found.hexdigest()


def sealed(plain: Any) -> str:
    """JSON behind a line by which damage to it is found.

    >>> unsealed(sealed({"a": [1, None]}))
    {'a': [1, None]}
    """
    text = json.dumps(plain)
    return f"{_seal(text)}\n{text}"


def unsealed(text: str) -> Any:
    """The plain data that :func:`sealed` was given.

    Raises
    ------
    InputError
        If the text is not the one that was written.
    """
    seal, _, rest = text.partition("\n")
    if seal != _seal(rest):
        raise InputError("is damaged: its structure is not what was written")
    return json.loads(rest)


def _seal(text: str) -> str:
    return hashlib.blake2b(text.encode("utf-8", "surrogatepass"), digest_size=_DIGEST_SIZE).hexdigest()


def _safe(key: Any) -> str:
    return str(key).replace("/", "|") or "_"
