# SPDX-License-Identifier: BSD-3-Clause
"""What a study may vary, and a model with another value of it.

Names are those of sensitivities, ``friction.CONTACT``, ``load.NAME``, ``E.BODY``; of a TOML deck every key besides.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from signorini.deck import Deck
from signorini.deck.changes import place_of
from signorini.derivative.modulus_pairs import with_material
from signorini.derivative.parameters import KINDS
from signorini.errors import InputError, Where, one_of, spell
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.study.values import Value

LOADS = ("load", "support")
_PREPARED = ("friction", "interference", *LOADS)  # kinds that leave the matrix as it is
_OF_CONTACTS = ("friction", "adhesion", "shear_limit", "interference")


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A parameter of a study with its values.

    Attributes
    ----------
    key : as the user spells it
    values : that it takes, different ones
    kind, name : of a parameter that sensitivities know; of loads and supports values are factors
    where : otherwise its path in a TOML deck
    """

    key: str
    values: tuple[Value, ...]
    kind: str = ""
    name: str = ""
    where: Where = ()

    @property
    def shares(self) -> bool:
        """Whether one preparation of the model serves all values."""
        return self.kind in _PREPARED and all(_is_number(value) for value in self.values)


def find_parameter(key: str, values: Sequence[Value], deck: Deck, data: Mapping[str, Any] | None) -> Parameter:
    """The parameter that a key names.

    Parameters
    ----------
    key, values : as the user has given them
    deck : as it was read
    data : tables of a TOML deck; None: there are none, and only what sensitivities know can be named

    Raises
    ------
    InputError
        If there is no such parameter, or no value.
    """
    different = tuple(dict.fromkeys(values))
    if not different:
        raise InputError(f"'{key}' has no value; expected some")
    kind, _, name = key.partition(".")
    if kind in KINDS:
        known = _names(deck.model, kind)
        if name in known:
            return Parameter(key=key, values=different, kind=kind, name=name)
        if data is None or kind not in data:
            raise InputError(f"'{key}': {one_of(name, known, f'{kind} of the model')}")
    first = re.split(r"[.\[]", key)[0]
    if data is not None and "." in key and first not in data:
        raise InputError(f"'{key}': {one_of(first, {*KINDS, *data}, 'kind of parameter, or key of the deck')}")
    if data is None:
        spelling = "KIND.NAME, as in friction.CONTACT, load.NAME or E.BODY"
        raise InputError(f"{one_of(kind, KINDS, 'kind of parameter')}; '{key}' is none, expected {spelling}")
    return _of_deck(key, different, place_of(data, key), deck.model)


def with_value(model: Model, parameter: Parameter, value: Value) -> Model:
    """The model with a value of a parameter that sensitivities know.

    Parameters
    ----------
    model : as it is
    parameter, value : of it

    Raises
    ------
    InputError
        If it cannot have that value; the key is named.
    """
    kind, name = parameter.kind, parameter.name
    try:
        if kind in LOADS:
            return _with_factor(model, name, _number(value))
        if kind in _OF_CONTACTS:
            changed: dict[str, Any] = {kind: value}
            contacts = [replace(own, **changed) if own.label == name else own for own in model.contacts]
            return replace(model, contacts=contacts)
        body = [part.name for part in model.bodies].index(name)
        return with_material(model, body, **{kind: _number(value)})
    except InputError as error:
        raise refused(parameter, value, error) from error


def refused(parameter: Parameter, value: Value, error: InputError) -> InputError:
    """What a reader says of a value, with the key that has brought it.

    Parameters
    ----------
    parameter, value : as they were given
    error : of the reader
    """
    at = f" {spell(error.where)}" if error.where else ""
    return InputError(f"{parameter.key} = {value}:{at} {error.message}")


def _of_deck(key: str, values: tuple[Value, ...], where: Where, model: Model) -> Parameter:
    """A key of a deck; friction and interference of a contact, where these are numbers, by their names."""
    found = Parameter(key=key, values=values, where=where)
    if len(where) == 3 and where[0] == "contact" and where[2] in ("friction", "interference"):
        contact, kind = model.contacts[int(where[1])], str(where[2])
        by_name = Parameter(key=key, values=values, kind=kind, name=contact.label)
        if _is_number(getattr(contact, kind)) and by_name.shares and not contact.tied:
            return by_name
    return found


def _names(model: Model, kind: str) -> list[str]:
    """What a kind of parameter may be called."""
    driven = [obstacle.label for obstacle in model.obstacles if obstacle.acts]
    if kind in _OF_CONTACTS:
        return [contact.label for contact in model.contacts if not contact.tied]
    if kind == "load":
        return [*(load.label for load in model.loads), *(bolt.label for bolt in model.bolts), *driven]
    if kind == "support":
        return [*(support.label for support in model.supports if support.moves), *driven]
    return [body.name for body in model.bodies if isinstance(body.material, Elastic)]


def _with_factor(model: Model, name: str, factor: float) -> Model:
    """The model with a load or a moving support that is so many times as large, in all steps."""
    steps = []
    for step in model.steps:
        scale = dict(dict.fromkeys(model.scaled_names, 1.0) if step.scale is None else step.scale)
        given = scale.get(name)
        if given is not None:
            scale[name] = factor * given if isinstance(given, int | float) else tuple(factor * part for part in given)
        steps.append(replace(step, scale=scale))
    return replace(model, steps=steps)


def _number(value: Value) -> float:
    if not _is_number(value):
        raise InputError(f"is {value!r}; expected a number")
    return float(value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
