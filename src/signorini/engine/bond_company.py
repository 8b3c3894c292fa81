# SPDX-License-Identifier: BSD-3-Clause
"""What does not go with bonds in one model: refused by name."""

from __future__ import annotations

import numpy as np

from signorini.arrays import BoolArray
from signorini.errors import InputError
from signorini.interface.interface import Interface
from signorini.model.model import Model

_ITERATED = (
    "needs the condensed interface, and this model is solved by iteration, because its factor does not fit or because "
    "it was asked for; expected a smaller model, or none that is bonded"
)


def refuse_beside_bonds(model: Model) -> None:
    """Refuse what bonds, which are followed on exact paths alone, do not go with.

    Raises
    ------
    InputError
        Bodies that yield, contacts that wear, slide far or close by a law, smooth cones of friction in space, steps
        that change contacts or that say no exact path is wanted.
    """
    first = next(i for i, contact in enumerate(model.contacts) if contact.cohesion is not None)
    for found, words in (
        (model.yields, "a body yields; expected elastic bodies"),
        (model.wears, "a contact wears; expected none that does"),
        (model.slides, "sides slide far; expected sides that stay opposite each other"),
        (
            any(contact.closure is not None for contact in model.contacts),
            "another contact has a closure; expected none",
        ),
        (bool(model.fatigue), "fatigue is asked for; expected none"),
    ):
        if found:
            raise InputError(f"is given, but {words}", where=("contact", first, "cohesion"))
    for i, contact in enumerate(model.contacts):
        rubs = contact.friction not in (0.0, "stick", "tied")
        if not contact.law.straight or ((model.dimension == 3 or model.twists) and rubs and not contact.facets):
            words = "turns between events, and bonds are followed exactly; expected facets, or straight branches"
            raise InputError(words, where=("contact", i, "friction"))
    for i, step in enumerate(model.steps):
        for key in ("friction", "active", "inactive"):
            if getattr(step, key):
                raise InputError(
                    "changes contacts of a model with bonds; expected contacts as they are", where=("step", i, key)
                )
        if step.increments == "auto":
            raise InputError(
                'is "auto", but bonds are followed exactly; expected a number or none', where=("step", i, "increments")
            )


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


def refuse_iterated(model: Model) -> None:
    """Refuse bonds where contact is solved on the bodies as they are.

    Raises
    ------
    InputError
        With the first contact that is bonded.
    """
    first = next(i for i, contact in enumerate(model.contacts) if contact.cohesion is not None)
    raise InputError(_ITERATED, where=("contact", first, "cohesion"))
