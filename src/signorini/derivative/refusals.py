# SPDX-License-Identifier: BSD-3-Clause
"""Histories that derivatives do not go through, by name."""

from __future__ import annotations

from signorini.engine.tape import Tape
from signorini.errors import InputError
from signorini.model.model import Model

_UNKNOWN = "derivatives do not know"
_CHANGES = "contacts that change from step to step, and supports but for bolts that lock"
_JUMPS = "jumps, and bodies that a load carries while others press"


def refuse_model(model: Model) -> None:
    """Refuse what a model has that derivatives do not know.

    Raises
    ------
    InputError
        By name.
    """
    for words, there in (
        ("bodies that yield", model.yields),
        ("contacts that wear", model.wears),
        ("contacts that slide far", model.slides),
        ("contacts that close by a law", any(contact.closure is not None for contact in model.contacts)),
        ("contacts with bonds", any(contact.cohesion is not None for contact in model.contacts)),
        ("models without contacts", not model.contacts),
    ):
        if there:
            raise InputError(f"{_UNKNOWN} {words}")


def refuse_tape(tape: Tape, model: Model) -> None:
    """Refuse a history that was followed otherwise than exactly or in increments, or from an unknown beginning.

    Raises
    ------
    InputError
        By name.
    """
    refuse_model(model)
    if not tape.whole:
        raise InputError("goes on from a history without a tape; solve that with 'tape=True', too", where=("start",))
    if tape.lost:
        raise InputError(f"{tape.lost}: {_UNKNOWN} {_CHANGES if tape.changed else _JUMPS}")
    if not tape.legs:
        raise InputError("no part of the history was followed; there is nothing to differentiate")
    for leg in tape.legs:
        prepared = leg.prepared
        if prepared.solver.paths is None:
            raise InputError(f"{leg.where}: contact was solved on the bodies as they are; {_UNKNOWN} that")
        if prepared.resting.any():
            raise InputError(f"{leg.where}: {_UNKNOWN} bodies that rest where they were left")
        bolts = {bolt.label for bolt in prepared.model.bolts}
        if any(bolts & set(step.restore) for step in prepared.model.steps):
            raise InputError(f"{_UNKNOWN} locked bolts that a step restores")


def has_sides_by_nodes(why: str, what: str) -> InputError:
    """The refusal of derivatives node by node that have two sides, with what knows both of what is varied together.

    Parameters
    ----------
    why : in words
    what : was asked for
    """
    words = "profile_sides(contact, change) and shape_sides(motion) know both of what is varied together"
    return InputError(f"{why}; {words}", where=(what,))
