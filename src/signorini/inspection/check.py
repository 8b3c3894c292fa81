# SPDX-License-Identifier: BSD-3-Clause
"""What ``signorini check`` says, of a model in Python."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from signorini.deck import Deck
from signorini.engine.examine import examine
from signorini.inspection.data import deck_data
from signorini.inspection.text import all_notes, deck_text
from signorini.model.model import Model
from signorini.short import Short


@dataclass(frozen=True, kw_only=True, repr=False)
class ModelCheck(Short):
    """A model as it was understood; printing it gives everything in words.

    Attributes
    ----------
    notes : what looks wrong though it can be solved; empty where nothing does
    data : bodies, supports, loads, contacts and steps as plain data, see ``signorini check --json``
    words : lines of text
    """

    notes: tuple[str, ...]
    data: Mapping[str, Any] = field(repr=False)
    words: tuple[str, ...] = field(repr=False)

    def __str__(self) -> str:
        return "\n".join(self.words)


def check(model: Model) -> ModelCheck:
    """Say what would be solved and what looks wrong, without solving anything.

    Raises
    ------
    InputError
        If the model is wrong, as :func:`signorini.solve` does.

    Examples
    --------
    >>> import signorini as sg
    >>> block = sg.rectangle(width=2.0, nx=2)
    >>> model = sg.Model(block, bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.0))],
    ...                  supports=[sg.Support("left", u=(0, None))], loads=[sg.Load("top", pressure=3.0)],
    ...                  contacts=[sg.Contact("bottom", sg.Plane(point=(0, -0.5), normal=(0, 1)))])
    >>> for note in sg.check(model).notes:
    ...     print(note[:68])
    contact 'bottom' is open everywhere at the start, by at least 0.5
    contact 'bottom' starts far open: by 25% of the model's size
    body 'block' can move along y: only contact can hold that
    """
    deck = Deck(model=model, path=Path("model"), lines={})
    examined = examine(model)
    notes = all_notes(deck, examined)
    return ModelCheck(notes=tuple(notes), data=deck_data(deck, examined, notes), words=tuple(deck_text(deck, examined)))
