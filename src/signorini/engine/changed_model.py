# SPDX-License-Identifier: BSD-3-Clause
"""A model with other friction, interferences or sizes of its loads, on the same bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.checks import number
from signorini.errors import InputError, one_of
from signorini.interface.interface import Interface, under_laws
from signorini.model.conditions import Load, Temperature
from signorini.model.contact import Contact
from signorini.model.model import Model


def changed_model(
    model: Model,
    *,
    friction: Mapping[str, float] | None,
    interference: Mapping[str, float] | None,
    loads: Mapping[str, float] | None,
) -> tuple[Model, dict[str, float]]:
    """The model, but for the sizes of its loads, of which stresses need only temperatures; and those sizes, checked.

    Parameters
    ----------
    model : as it was
    friction : contact to Coulomb's coefficient
    interference : contact to its overlap beyond the geometry, length
    loads : load or moving support to what its value is multiplied by

    Raises
    ------
    InputError
        For an unknown name or a wrong value.
    """
    labels = [contact.label for contact in model.contacts]
    _refuse_unknown(friction, labels, "contact", "friction")
    _refuse_unknown(interference, labels, "contact", "interference")
    _refuse_unknown(loads, model.scaled_names, "load or moving support", "loads")
    contacts = [_changed_contact(contact, friction or {}, interference or {}) for contact in model.contacts]
    factors = {name: number(value, ("loads", name)) for name, value in (loads or {}).items()}
    hot = [replace(load, temperature=_times(load, factors)) for load in model.loads]
    return replace(model, contacts=contacts, loads=hot), factors


def changed_interface(interface: Interface, before: Model, after: Model) -> Interface:
    """The pairs of a model with the friction and the interferences of the changed one.

    Parameters
    ----------
    interface, before : as they were
    after : changed
    """
    contacts = zip(after.contacts, before.contacts, strict=True)
    overlap = np.array([new.constant_interference - old.constant_interference for new, old in contacts])
    laws = under_laws(interface, after, [contact.law for contact in after.contacts])
    return replace(laws, gap=interface.gap - overlap[interface.contact])


def scaled(given: Mapping[str, Array], factor: Mapping[str, float]) -> dict[str, Array]:
    """Loads or prescribed displacements times their factors, 1 where there is none.

    Parameters
    ----------
    given, factor : by name

    Examples
    --------
    >>> scaled({"push": np.array([2.0]), "pull": np.array([1.0])}, {"push": 3.0})
    {'push': array([6.]), 'pull': array([1.])}
    """
    return {name: factor.get(name, 1.0) * values for name, values in given.items()}


def _changed_contact(contact: Contact, friction: Mapping[str, float], interference: Mapping[str, float]) -> Contact:
    """A contact with another friction or interference where its name is given."""
    name = contact.label
    for key, given in (("friction", friction), ("interference", interference)):
        if contact.tied and name in given:
            raise InputError("is tied for good; only contacts can change", where=(key, name))
    if name not in friction and name not in interference:
        return contact
    if name in interference:
        contact.check_pressed(("interference", name))
    return replace(
        contact,
        friction=friction.get(name, contact.friction),
        interference=interference.get(name, contact.interference),
    )


def _times(load: Load, factors: Mapping[str, float]) -> Temperature | None:
    """The temperature of a load times its factor; stresses refer to it, other loads are in the nodal forces."""
    given, factor = load.temperature, factors.get(load.label, 1.0)
    if given is None or factor == 1.0:
        return given
    if callable(given):
        return lambda points: factor * given(points)
    return factor * given


def _refuse_unknown(given: Iterable[str] | None, known: Iterable[str], what: str, key: str) -> None:
    for name in given or ():
        if name not in known:
            raise InputError(one_of(name, known, what), where=(key,))
