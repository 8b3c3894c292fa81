# SPDX-License-Identifier: BSD-3-Clause
"""Names that steps and results use: one for each part of a model."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Protocol

from signorini.errors import InputError
from signorini.model.conditions import Support


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
