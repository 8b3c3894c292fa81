# SPDX-License-Identifier: BSD-3-Clause
"""From a deck to a model."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

from signorini.checks import text
from signorini.deck.changes import changed
from signorini.deck.deck import Deck, located_error
from signorini.deck.error import DeckError
from signorini.deck.inp.build import read_deck
from signorini.deck.keys import check_keys, make, table, tables
from signorini.deck.meshes import cut_for_bolts, deck_mesh
from signorini.deck.nodal_forces import with_nodal_forces
from signorini.deck.syntax import parse
from signorini.deck.tables import FIELDS, OBSTACLES, deck_bodies, deck_materials, deck_parts, deck_shape
from signorini.errors import InputError, Where
from signorini.model.accuracy import Accuracy, Asked
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from signorini.model.modes import ModesRequest
from signorini.settings import SolverSettings
from signorini.sources import Reach

KEYS = ("title", "kind", "thickness", "units", "mesh", "material", "solve", "solver", "modes", *FIELDS)
ACCURACY_KEYS = tuple(field.name for field in fields(Accuracy) if field.name != "error")
"""Of ``[solve]``, beside the accuracy itself."""


def read(
    path: str | Path,
    *,
    small_strain: bool = False,
    deck_increments: bool = False,
    allow: Iterable[str | Path] = (),
    include: Iterable[str | Path] = (),
) -> Model:
    """Read the model of a deck; `load` gives what else it says, limits of the solver (``[solver]``) among it.

    Parameters
    ----------
    path : a TOML file, or an Abaqus or CalculiX deck (``.inp``); files that it names are relative to it
    small_strain : solve an ``.inp`` deck that asks for large displacements (NLGEOM) with small ones
    deck_increments : follow the increments of an ``.inp`` deck instead of the package's rule
    allow : folders in which files that the deck names may be, besides those near it (:class:`signorini.sources.Reach`)
    include : such folders in which relative names are looked for too, where the folder of the deck has no such file

    Raises
    ------
    DeckError
        An :class:`InputError` that begins with file and line: ``deck.toml:12: contact[0].friction: ...``.
    """
    return load_deck(
        path, small_strain=small_strain, deck_increments=deck_increments, allow=allow, include=include
    ).model


def load_deck(
    path: str | Path,
    *,
    small_strain: bool = False,
    deck_increments: bool = False,
    allow: Iterable[str | Path] = (),
    include: Iterable[str | Path] = (),
    changes: Mapping[Where, Any] | None = None,
) -> Deck:
    """Read a deck and keep its lines, so that errors found later can be told with theirs.

    Parameters
    ----------
    path, small_strain, deck_increments, allow, include : as :func:`read` has them
    changes : path of a key to the value that a TOML deck has in place of its own
    """
    path = Path(path)
    reach = Reach.of(path, allow, include)
    if path.suffix.lower() == ".inp":
        return read_deck(path, reach, small_strain=small_strain, deck_increments=deck_increments)
    data, lines = parse(path)
    try:
        return _deck(changed(data, changes) if changes else data, path, lines, reach)
    except DeckError:
        raise
    except InputError as error:
        raise located_error(error, path, lines) from error


def _deck(data: Mapping[str, Any], path: Path, lines: Mapping[Where, int], reach: Reach) -> Deck:
    check_keys(data, (), known=KEYS)
    for key in ("title", "units"):
        if not isinstance(data.get(key, ""), str):
            raise InputError(f"is {data[key]!r}; expected text", where=(key,))
        if data.get(key):
            text(data[key], (key,))
    if "mesh" not in data:
        raise InputError("there is no mesh; expected [mesh] with a generator or a file")
    materials = deck_materials(data)
    bodies = deck_bodies(data, materials)
    mesh = cut_for_bolts(deck_mesh(data["mesh"], reach), data)
    if any(isinstance(entry.get("nodal_forces"), dict) for entry in tables(data, "load")):
        mesh, data = with_nodal_forces(mesh, data, reach)
    parts: dict[str, Any] = deck_parts(data, reach, mesh)
    parts |= {key: data[key] for key in ("title", "kind", "thickness", "units") if key in data}
    model = Model(mesh, bodies=bodies, **parts)
    named = {entry["material"] for entry in data["body"]}
    unused = tuple(name for name in materials if name not in named)
    settings = make(SolverSettings, table(data.get("solver", {}), ("solver",)), ("solver",))
    asked = make(ModesRequest, table(data["modes"], ("modes",)), ("modes",)) if "modes" in data else None
    return Deck(
        model=model,
        path=path,
        lines=MappingProxyType(dict(lines)),
        unused_materials=unused,
        settings=settings,
        accuracy=_accuracy(table(data["solve"], ("solve",)), reach, mesh) if "solve" in data else None,
        modes=asked,
    )


def _accuracy(data: Mapping[str, Any], reach: Reach, mesh: Mesh) -> Asked:
    """What ``[solve]`` asks for: ``accuracy``, an error or "estimate", and what `Accuracy` has beside it."""
    where = ("solve",)
    check_keys(data, where, known=("accuracy", *ACCURACY_KEYS), needed=["accuracy"])
    asked, rest = data["accuracy"], {key: value for key, value in data.items() if key != "accuracy"}
    if asked == "estimate":
        for key in rest:
            raise InputError("belongs to an accuracy; expected none beside 'estimate'", where=(*where, key))
        return "estimate"
    if isinstance(asked, str):
        raise InputError(f"is '{asked}'; expected a relative error > 0, or 'estimate'", where=(*where, "accuracy"))
    if "shapes" in rest:
        shapes = table(rest["shapes"], (*where, "shapes"))
        rest["shapes"] = {name: _shape(value, (*where, "shapes", name), reach, mesh) for name, value in shapes.items()}
    if "geometry" in rest:
        rest["geometry"] = reach.file(text(rest["geometry"], (*where, "geometry")), (*where, "geometry"))
    try:
        return Accuracy(asked, **rest)
    except InputError as error:
        names = ("accuracy",) if error.where == ("error",) else error.where
        raise InputError(error.message, where=(*where, *names)) from error


def _shape(value: Any, where: Where, reach: Reach, mesh: Mesh) -> Any:
    """A word, or a table with one shape of obstacles."""
    if isinstance(value, str):
        return value
    entry = table(value, where)
    if len(entry) != 1 or not entry.keys() <= OBSTACLES.keys():
        words = f"one of {', '.join(OBSTACLES)}, 'spline' or 'straight'"
        raise InputError(f"has {', '.join(entry) or 'nothing'}; expected {words}", where=where)
    ((key, given),) = entry.items()
    return deck_shape(key, given, (*where, key), reach, mesh)
