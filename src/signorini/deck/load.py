# SPDX-License-Identifier: BSD-3-Clause
"""From a deck to a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from signorini.deck.error import DeckError
from signorini.deck.meshes import deck_mesh
from signorini.deck.parts import (
    deck_bodies,
    deck_contacts,
    deck_loads,
    deck_materials,
    deck_obstacles,
    deck_steps,
    deck_supports,
)
from signorini.deck.scan import line_of
from signorini.deck.syntax import parse
from signorini.deck.table import check_keys
from signorini.errors import InputError, Where
from signorini.model.model import Model

_KEYS = (
    "title",
    "kind",
    "thickness",
    "units",
    "mesh",
    "material",
    "body",
    "support",
    "load",
    "contact",
    "obstacle",
    "step",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck:
    """A model and the file that it was read from.

    Attributes
    ----------
    model : the model
    path : of the file, as the user spelled it
    lines : line of every key and table, from 1, by its path
    unused_materials : names of materials that no body is made of
    """

    model: Model
    path: Path
    lines: Mapping[Where, int]
    unused_materials: tuple[str, ...] = ()

    def locate(self, error: InputError) -> DeckError:
        """The same error with the line of the deck that caused it; for what is found after reading."""
        return _located(error, self.path, self.lines)


def read(path: str | Path) -> Model:
    """Read a deck.

    Parameters
    ----------
    path : a TOML file; mesh files that it names are relative to it

    Raises
    ------
    DeckError
        An :class:`InputError` that begins with file and line: ``deck.toml:12: contact[0].friction: ...``.
    """
    return load(path).model


def load(path: str | Path) -> Deck:
    """Read a deck and keep its lines, so that errors found later can be told with theirs; see :func:`read`."""
    path = Path(path)
    if path.suffix.lower() == ".inp":
        raise DeckError("Abaqus and CalculiX decks are not supported yet; expected a TOML deck", path=path)
    data, lines = parse(path)
    try:
        return _deck(data, path, lines)
    except DeckError:
        raise
    except InputError as error:
        raise _located(error, path, lines) from error


def _deck(data: Mapping[str, Any], path: Path, lines: Mapping[Where, int]) -> Deck:
    check_keys(data, (), known=_KEYS)
    for key in ("title", "units"):
        if not isinstance(data.get(key, ""), str):
            raise InputError(f"is {data[key]!r}; expected text", where=(key,))
    if "mesh" not in data:
        raise InputError("there is no mesh; expected [mesh] with a generator or a file")
    materials = deck_materials(data)
    bodies = deck_bodies(data, materials)
    parts: dict[str, Any] = {
        "supports": deck_supports(data),
        "loads": deck_loads(data),
        "contacts": deck_contacts(data),
        "obstacles": deck_obstacles(data),
    }
    if "step" in data:
        parts["steps"] = deck_steps(data)
    parts |= {key: data[key] for key in ("title", "kind", "thickness", "units") if key in data}
    model = Model(deck_mesh(data["mesh"], path.parent), bodies=bodies, **parts)
    named = {entry["material"] for entry in data["body"]}
    unused = tuple(name for name in materials if name not in named)
    return Deck(model=model, path=path, lines=MappingProxyType(dict(lines)), unused_materials=unused)


def _located(error: InputError, path: Path, lines: Mapping[Where, int]) -> DeckError:
    return DeckError(error.message, path=path, where=error.where, line=line_of(lines, error.where))
