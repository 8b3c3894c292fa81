# SPDX-License-Identifier: BSD-3-Clause
"""From a deck to a model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from signorini.checks import text
from signorini.deck.error import DeckError
from signorini.deck.inp.build import Built, element_card, located_error, read_deck
from signorini.deck.inp.card import Card
from signorini.deck.meshes import deck_mesh
from signorini.deck.scan import line_of
from signorini.deck.syntax import parse
from signorini.deck.tables import FIELDS, check_keys, deck_bodies, deck_materials, deck_parts
from signorini.errors import InputError, Where
from signorini.model.model import Model
from signorini.model.prints import Prints
from signorini.sources import Reach

_KEYS = ("title", "kind", "thickness", "units", "mesh", "material", "body", *FIELDS)


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck:
    """A model and the file that it was read from.

    Attributes
    ----------
    model : the model
    path : of the file, as the user spelled it
    lines : line of every key and table, from 1, by its path
    unused_materials : names of materials that no body is made of
    prints : what a deck of keywords asks for; None for other decks
    notes : how the model differs from what the deck asks for, and what was left out
    """

    model: Model
    path: Path
    lines: Mapping[Where, int]
    unused_materials: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    prints: Prints | None = None

    def locate(self, error: InputError) -> DeckError:
        """An error that is found after reading with the line of the deck that caused it."""
        return _located(error, self.path, self.lines)


@dataclass(frozen=True, kw_only=True, eq=False)
class KeywordDeck(Deck):
    """A deck of keywords.

    Attributes
    ----------
    places : keyword of every part of the model, by its path
    reach : files that it may include
    """

    places: Mapping[Where, Card]
    reach: Reach

    def locate(self, error: InputError) -> DeckError:
        """An error that is found after reading with file and line of the keyword that caused it."""
        return located_error(error, self.places, self.path, lambda cell: element_card(self.path, self.reach, cell))


def read(
    path: str | Path, *, small_strain: bool = False, deck_increments: bool = False, allow: Iterable[str | Path] = ()
) -> Model:
    """Read a deck.

    Parameters
    ----------
    path : a TOML file, or an Abaqus or CalculiX deck (``.inp``); files that it names are relative to it
    small_strain : solve an ``.inp`` deck that asks for large displacements (NLGEOM) with small ones
    deck_increments : follow the increments of an ``.inp`` deck instead of the package's rule
    allow : folders in which files that the deck names may be, besides those near it (:class:`signorini.sources.Reach`)

    Raises
    ------
    DeckError
        An :class:`InputError` that begins with file and line: ``deck.toml:12: contact[0].friction: ...``.
    """
    return load(path, small_strain=small_strain, deck_increments=deck_increments, allow=allow).model


def load(
    path: str | Path, *, small_strain: bool = False, deck_increments: bool = False, allow: Iterable[str | Path] = ()
) -> Deck:
    """Read a deck and keep its lines, so that errors found later can be told with theirs.

    Parameters
    ----------
    path, small_strain, deck_increments, allow : as :func:`read` has them
    """
    path = Path(path)
    reach = Reach.of(path, allow)
    if path.suffix.lower() == ".inp":
        built = read_deck(path, reach, small_strain=small_strain, deck_increments=deck_increments)
        return _keywords(built, path, reach)
    data, lines = parse(path)
    try:
        return _deck(data, path, lines, reach)
    except DeckError:
        raise
    except InputError as error:
        raise _located(error, path, lines) from error


def _keywords(built: Built, path: Path, reach: Reach) -> KeywordDeck:
    return KeywordDeck(
        model=built.model,
        path=path,
        lines={},
        unused_materials=built.unused_materials,
        notes=built.notes,
        prints=built.prints,
        places=built.places,
        reach=reach,
    )


def _deck(data: Mapping[str, Any], path: Path, lines: Mapping[Where, int], reach: Reach) -> Deck:
    check_keys(data, (), known=_KEYS)
    for key in ("title", "units"):
        if not isinstance(data.get(key, ""), str):
            raise InputError(f"is {data[key]!r}; expected text", where=(key,))
        if data.get(key):
            text(data[key], (key,))
    if "mesh" not in data:
        raise InputError("there is no mesh; expected [mesh] with a generator or a file")
    materials = deck_materials(data)
    bodies = deck_bodies(data, materials)
    mesh = deck_mesh(data["mesh"], reach)
    parts: dict[str, Any] = deck_parts(data, reach, mesh)
    parts |= {key: data[key] for key in ("title", "kind", "thickness", "units") if key in data}
    model = Model(mesh, bodies=bodies, **parts)
    named = {entry["material"] for entry in data["body"]}
    unused = tuple(name for name in materials if name not in named)
    return Deck(model=model, path=path, lines=MappingProxyType(dict(lines)), unused_materials=unused)


def _located(error: InputError, path: Path, lines: Mapping[Where, int]) -> DeckError:
    return DeckError(error.message, path=path, where=error.where, line=line_of(lines, error.where))
