# SPDX-License-Identifier: BSD-3-Clause
"""What a study solves again and again: a deck, or a model; sent to other processes as what makes it anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from signorini.deck import Deck, load_deck
from signorini.deck.fatigue import asking_for
from signorini.deck.syntax import parse
from signorini.errors import InputError, Where
from signorini.model.model import Model
from signorini.output.dataclasses_json import AnyArray, from_plain, to_plain
from signorini.study.parameters import Parameter, find_parameter, refused, with_value
from signorini.study.values import Value


@dataclass(frozen=True, kw_only=True)
class DeckFile:
    """A deck as a command line names it.

    Attributes
    ----------
    path : of the deck
    small_strain, deck_increments, allow, include : as of :func:`signorini.read`
    fatigue : a file whose criteria are asked for instead; None: those of the deck
    """

    path: Path
    small_strain: bool = False
    deck_increments: bool = False
    allow: tuple[str, ...] = ()
    include: tuple[str, ...] = ()
    fatigue: Path | None = None

    def read(self, changes: Mapping[Where, Any]) -> Deck:
        """The deck, with other values of some keys."""
        deck = load_deck(
            self.path,
            small_strain=self.small_strain,
            deck_increments=self.deck_increments,
            allow=self.allow,
            include=self.include,
            changes=changes,
        )
        return deck if self.fatigue is None else asking_for(deck, self.fatigue)

    @property
    def data(self) -> dict[str, Any] | None:
        """Tables of a TOML deck; None for a deck of keywords."""
        return None if self.path.suffix.lower() == ".inp" else parse(self.path)[0]


class GivenModel:
    """A model that was made in Python.

    Parameters
    ----------
    model : the model; functions in it cannot go to other processes
    """

    data = None

    def __init__(self, model: Model) -> None:
        self._model = model

    def read(self, changes: Mapping[Where, Any]) -> Deck:
        """The model as if a deck had said it; there are no keys to change."""
        assert not changes, "a model has no keys of a deck"
        return Deck(model=self._model, path=Path(), lines={})

    def __getstate__(self) -> tuple[Any, dict[str, AnyArray]]:
        arrays: dict[str, AnyArray] = {}

        def keep(path: str, array: AnyArray, _: str) -> str:
            arrays[path] = array
            return path

        return to_plain(self._model, "model", keep), arrays

    def __setstate__(self, state: tuple[Any, dict[str, AnyArray]]) -> None:
        plain, arrays = state
        self._model = from_plain(plain, arrays.__getitem__)


@dataclass(frozen=True, kw_only=True)
class Study:
    """A problem and what is varied of it.

    Attributes
    ----------
    source : a deck or a model
    parameters : that vary
    backend : of the factorisation
    results : folder in which every combination gets a result folder; None: none does
    """

    source: DeckFile | GivenModel
    parameters: tuple[Parameter, ...]
    backend: str = "auto"
    results: Path | None = None

    @cached_property
    def base(self) -> Deck:
        """The problem as it was given."""
        return self.source.read({})

    def __getstate__(self) -> dict[str, Any]:
        """Without what was read."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    @classmethod
    def of(
        cls,
        source: DeckFile | GivenModel,
        values: Mapping[str, tuple[Value, ...]],
        backend: str = "auto",
        results: Path | None = None,
    ) -> Study:
        """A study whose keys and values are known to be right, each by itself.

        Parameters
        ----------
        source, backend, results : as of the study
        values : of every key

        Raises
        ------
        InputError
            For a key that is not there, or a value that is refused; the key is named.
        """
        if not values:
            raise InputError("there is no parameter; expected some with their values")
        deck, data = source.read({}), source.data
        found = tuple(find_parameter(key, own, deck, data) for key, own in values.items())
        for number, one in enumerate(found):
            same = [other for other in found[:number] if _same(one, other)]
            if same:
                raise InputError(f"'{one.key}' is what '{same[0].key}' is; expected each parameter once")
        study = cls(source=source, parameters=found, backend=backend, results=results)
        study.__dict__["base"] = deck
        for one in found:
            for value in one.values:
                study.changed({one.key: value})
        return study

    def changed(self, values: Mapping[str, Value]) -> Deck:
        """The problem with other values of some parameters.

        Raises
        ------
        InputError
            If a value is refused.
        """
        chosen = [parameter for parameter in self.parameters if parameter.key in values]
        keys = {parameter.where: values[parameter.key] for parameter in chosen if parameter.where}
        try:
            deck = self.source.read(keys) if keys else self.base
        except InputError as error:
            first = next(parameter for parameter in chosen if parameter.where)
            raise refused(first, values[first.key], error) from error
        model = deck.model
        for parameter in chosen:
            if parameter.kind:
                model = with_value(model, parameter, values[parameter.key])
        return deck if model is deck.model else replace(deck, model=model)


def _same(one: Parameter, other: Parameter) -> bool:
    return (one.kind, one.name, one.where) == (other.kind, other.name, other.where)
