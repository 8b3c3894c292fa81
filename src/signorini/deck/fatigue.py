# SPDX-License-Identifier: BSD-3-Clause
"""Tables ``[[fatigue]]``, of a deck or of a file of their own beside any deck."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from signorini.checks import choice
from signorini.deck.deck import Deck, located_error
from signorini.deck.keys import make, tables
from signorini.deck.syntax import parse
from signorini.errors import InputError, Where
from signorini.fatigue.criteria import CRITERIA
from signorini.model.fatigue import Fatigue
from signorini.model.model import Model


def deck_fatigue(entry: dict[str, Any], where: Where) -> Fatigue:
    """A request whose criterion is ``"NAME"`` or ``{ name = "NAME", ... }`` with its constants."""
    given, inside = dict(entry), (*where, "criterion")
    if "criterion" in given:
        value = given["criterion"]
        constants = dict(value) if isinstance(value, dict) else {"name": value}
        name = choice(constants.pop("name", ""), CRITERIA, inside, "fatigue criterion")
        given["criterion"] = make(CRITERIA[name], constants, inside)
    return make(Fatigue, given, where)


def asking_for(deck: Deck, path: Path) -> Deck:
    """A deck that asks for the tables ``[[fatigue]]`` of another file, see :func:`model_asking_for`."""
    return replace(deck, model=model_asking_for(deck.model, path))


def model_asking_for(model: Model, path: Path) -> Model:
    """A model that asks for the tables ``[[fatigue]]`` of a file; all else in that file is left alone.

    Raises
    ------
    DeckError
        With file and line.
    """
    data, lines = parse(path)
    try:
        found = [deck_fatigue(entry, ("fatigue", i)) for i, entry in enumerate(tables(data, "fatigue"))]
        if not found:
            raise InputError("there is none; expected [[fatigue]] tables", where=("fatigue",))
        return replace(model, fatigue=found)
    except InputError as error:
        raise located_error(error, path, lines) from error
