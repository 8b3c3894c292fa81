# SPDX-License-Identifier: BSD-3-Clause
"""Which fatigue criterion is asked for, where, and over which steps."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from signorini.checks import choice, number, text
from signorini.errors import InputError, Where, one_of
from signorini.fatigue.criteria import FatigueCriterion, Ruiz

AVERAGES = ("point", "line")


@dataclass(frozen=True)
class Fatigue:
    """A fatigue criterion along steps of the history.

    Parameters
    ----------
    criterion : `sg.fatigue.SWT`, `FatemiSocie`, `Crossland`, `DangVan` or `Ruiz`
    where : contacts (both sides), boundaries, node sets, bodies; all contacts if none is named. Of Ruiz contacts: their
        nonmortar sides are looked at
    steps : by name; the last one if none is named. Of a step that repeats, the last cycle
    distance : critical distance L below boundaries, length, along the inward normal; 0 is the surface itself
    average : with a distance, "point": stresses at the depth L / 2; "line": their mean down to 2 L (Taylor)

    Examples
    --------
    >>> from signorini.fatigue import SWT
    >>> Fatigue(SWT(), where="pad", distance=0.05).where
    ('pad',)
    """

    criterion: FatigueCriterion
    where: str | Sequence[str] = ()
    steps: str | Sequence[str] = ()
    distance: float = 0.0
    average: Literal["point", "line"] = "point"

    def __post_init__(self) -> None:
        if not isinstance(self.criterion, FatigueCriterion):
            raise InputError(f"is {self.criterion!r}; expected a fatigue criterion", where=("criterion",))
        for key in ("where", "steps"):
            object.__setattr__(self, key, _names(getattr(self, key), key))
        object.__setattr__(self, "distance", number(self.distance, ("distance",), least=0.0))
        choice(self.average, AVERAGES, ("average",), "average")
        if self.distance and isinstance(self.criterion, Ruiz):
            raise InputError(
                "is given, and Ruiz's parameters are those of the surface; expected 0", where=("distance",)
            )

    def asks(self, contact: str) -> bool:
        """Whether it is about a contact: about all of them where no place is named.

        >>> from signorini.fatigue import Ruiz
        >>> Fatigue(Ruiz()).asks("pad"), Fatigue(Ruiz(), where="bolt").asks("pad")
        (True, False)
        """
        return not self.where or contact in self.where

    def check(self, where: Where, contacts: Collection[str], places: Collection[str], steps: Collection[str]) -> None:
        """Look for what is named.

        Parameters
        ----------
        where : what errors call it
        contacts : names of the contacts
        places : names of boundaries, node sets and bodies
        steps : names of the steps

        Raises
        ------
        InputError
            For an unknown name.
        """
        only_contacts = isinstance(self.criterion, Ruiz)
        known = list(contacts) if only_contacts else [*contacts, *places]
        kind = "contact" if only_contacts else "contact, boundary, node set or body"
        for name in self.where:
            if name not in known:
                raise InputError(one_of(name, known, kind), where=(*where, "where"))
        if not contacts and (only_contacts or not self.where):
            words = "a contact" if only_contacts else "a boundary, a node set or a body"
            raise InputError(f"there is no contact; expected {words}", where=(*where, "where"))
        for name in self.steps:
            if name not in steps:
                raise InputError(one_of(name, steps, "step"), where=(*where, "steps"))


def _names(value: Any, key: str) -> tuple[str, ...]:
    names = (value,) if isinstance(value, str) else value
    if not isinstance(names, Sequence):
        raise InputError(f"is {value!r}; expected a name or a list of them", where=(key,))
    return tuple(text(name, (key,)) for name in names)
