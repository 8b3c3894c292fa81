# SPDX-License-Identifier: BSD-3-Clause
"""Names that steps and results use: one for each part of a model, and what steps change of parts by their names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Protocol

from signorini.errors import InputError, one_of
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.step import Step


class Labelled(Protocol):
    """A part of a model with a name."""

    @property
    def label(self) -> str:
        """What steps and results call it."""
        ...


def refuse_same_names(parts: dict[str, Sequence[Labelled]]) -> None:
    """Refuse names that two parts share where a step would not know which is meant.

    Parameters
    ----------
    parts : supports with elastic foundations, loads, contacts, obstacles and bolts, each under its key in a deck

    Raises
    ------
    InputError
        With the name.
    """
    for key, own in parts.items():
        twice = [label for label, n in Counter(member.label for member in own).items() if n > 1]
        if twice:
            raise InputError(f"two are called '{twice[0]}'; give each a name of its own", where=(key,))
    loads, held = ({member.label for member in parts[key]} for key in ("load", "support"))
    moving = {part.label for part in parts["support"] if isinstance(part, Support) and part.moves}
    if both := loads & moving:
        raise InputError(f"'{both.pop()}' is a load and a moving support; steps need a name for each", where=("load",))
    for i, obstacle in enumerate(parts["obstacle"]):
        if obstacle.label in loads | held:
            raise InputError(
                f"'{obstacle.label}' is a load or a support too; steps need a name for each",
                where=("obstacle", i, "name"),
            )


def refuse_wrong_changes(i: int, step: Step, contacts: Sequence[Contact], held: Sequence[Labelled]) -> None:
    """Refuse a step that changes a contact or a support that is not there, or as it cannot change.

    Parameters
    ----------
    i : number of the step
    step : with the names
    contacts : of the model
    held : its supports and bolts

    Raises
    ------
    InputError
        With the name.
    """
    known = [contact.label for contact in contacts]
    for key in ("friction", "interference", "active", "inactive"):
        for name in getattr(step, key):
            if name not in known:
                raise InputError(one_of(name, known, "contact"), where=("step", i, key))
            if contacts[known.index(name)].tied:
                raise InputError(f"'{name}' is tied for good; only contacts can change", where=("step", i, key))
    for name, value in step.friction.items():
        contacts[known.index(name)].check_change(value, ("step", i, "friction", name))
    for name, overlap in step.interference.items():
        contact = contacts[known.index(name)]
        if isinstance(overlap, float) and isinstance(contact.interference, float):
            continue
        moved = contact.wear is not None and contact.wear.move_mesh is not None
        if contact.slides or moved:
            words = (
                f"varies over a side {'that slides far' if contact.slides else 'whose mesh moves'}; expected a number"
            )
            raise InputError(words, where=("step", i, "interference", name))
    supports = [part.label for part in held]
    for key in ("release", "hold", "restore"):
        for name in getattr(step, key):
            if name not in supports:
                raise InputError(one_of(name, supports, "support"), where=("step", i, key))
