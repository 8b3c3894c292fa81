# SPDX-License-Identifier: BSD-3-Clause
"""A model with the file that it was read from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from signorini.deck.error import DeckError
from signorini.deck.syntax import line_of
from signorini.errors import InputError, Where
from signorini.model.accuracy import Asked
from signorini.model.model import Model
from signorini.model.modes import ModesRequest
from signorini.model.prints import Prints
from signorini.settings import SolverSettings


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck:
    """A model and the file that it was read from.

    Attributes
    ----------
    model : the model
    path : of the file, as the user spelled it
    lines : line of every key and table, from 1, by its path
    unused_materials : names of materials that no body is made of
    settings : limits of the methods, of the table ``[solver]``
    accuracy : of the table ``[solve]``: what :func:`signorini.solve` is asked for; None: nothing
    modes : natural modes that it asks for; None: none
    prints : what a deck of keywords asks for; None for other decks
    notes : how the model differs from what the deck asks for, and what was left out
    """

    model: Model
    path: Path
    lines: Mapping[Where, int]
    unused_materials: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    prints: Prints | None = None
    settings: SolverSettings = field(default_factory=SolverSettings)
    accuracy: Asked | None = None
    modes: ModesRequest | None = None

    def locate(self, error: InputError) -> DeckError:
        """An error that is found after reading with the line of the deck that caused it."""
        return located_error(error, self.path, self.lines)


def located_error(error: InputError, path: Path, lines: Mapping[Where, int]) -> DeckError:
    """An error with the line of the key that it names, or of the nearest one around it.

    Parameters
    ----------
    error : whose path is that of a key
    path : of the deck
    lines : line of every key and table, by its path
    """
    return DeckError(error.message, path=path, where=error.where, line=line_of(lines, error.where))
