# SPDX-License-Identifier: BSD-3-Clause
"""What goes with bonds in one model: on exact paths, in increments, or not at all, and then refused by name."""

from __future__ import annotations

import numpy as np

from signorini.arrays import BoolArray
from signorini.errors import InputError
from signorini.interface.interface import Interface
from signorini.model.model import Model


def in_increments(model: Model) -> str | None:
    """Why bonds of a model are followed in increments, in words; None where they are on exact paths."""
    for found, words in (
        (model.yields, "a body yields"),
        (model.slides, "sides of another contact slide far"),
        (model.wears, "another contact wears"),
    ):
        if found:
            return words
    if any(contact.closure is not None for contact in model.contacts):
        return "another contact has a closure"
    for contact in model.contacts:
        rubs = contact.friction not in (0.0, "stick", "tied")
        if not contact.law.straight or ((model.dimension == 3 or model.twists) and rubs and not contact.facets):
            return f"friction of '{contact.label}' turns between events, it has neither facets nor straight branches"
    return None


def refuse_beside_bonds(model: Model) -> None:
    """Refuse what bonds do not go with.

    Raises
    ------
    InputError
        Fatigue, steps that change contacts, or whose path is to be exact where it cannot be.
    """
    if model.fatigue:
        first = next(i for i, contact in enumerate(model.contacts) if contact.cohesion is not None)
        raise InputError("is given, but fatigue is asked for; expected none", where=("contact", first, "cohesion"))
    why = in_increments(model)
    for i, step in enumerate(model.steps):
        for key in ("friction", "active", "inactive"):
            if getattr(step, key):
                raise InputError(
                    "changes contacts of a model with bonds; expected contacts as they are", where=("step", i, key)
                )
        if step.path == "exact" and why is not None:
            words = f'is "exact", but bonds are followed in increments where {why}'
            raise InputError(f"{words}; expected none", where=("step", i, "path"))


def refuse_held(model: Model, interface: Interface, held: BoolArray) -> None:
    """Refuse bonds of pairs whose both sides supports move.

    Parameters
    ----------
    model, interface : bodies and pairs
    held : (n,) pairs that supports hold on both sides

    Raises
    ------
    InputError
        With the contact of the first, and its node.
    """
    assert interface.cohesion is not None
    found = np.flatnonzero(held & (interface.cohesion.most > 0.0))
    if len(found):
        number = model.mesh.labels[interface.node[found[0]]]
        words = f"bonds node {number}, whose both sides supports hold; expected one side there free to move"
        raise InputError(words, where=("contact", int(interface.contact[found[0]]), "cohesion"))
