# SPDX-License-Identifier: BSD-3-Clause
"""Bolts: a section through a body that is drawn together, by a force or by a length, and held there."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.checks import number, text
from signorini.errors import InputError


@dataclass(frozen=True)
class Bolt:
    """A section through a body that is drawn together.

    Both halves of the section stay opposite each other; along its mean normal they overlap by the shortening, as if
    the bolt were that much too short. Steps scale the force, or the shortening, by the name of the bolt, like a load's.
    A bolt with a force is locked by ``hold=[name]`` of a step: its shortening stays from there on, and its force
    follows what else is loaded; ``release=[name]`` makes it what the force says again, over that step.

    Parameters
    ----------
    section : name of a section, where :func:`signorini.cut` has cut the mesh; in decks that is done
    force : in the bolt at factor 1, tension > 0; of plane bodies for their thickness, of axisymmetric ones all around
    shortening : in its place, length at factor 1
    name : what steps and results call it; the section by default

    Examples
    --------
    >>> Bolt("shank", force=12e3).label
    'shank'
    """

    section: str
    force: float | None = None
    shortening: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        text(self.section, ("section",))
        if (self.force is None) == (self.shortening is None):
            found = "neither" if self.force is None else "both"
            raise InputError(f"has {found} of force and shortening; expected one of them")
        for key in ("force", "shortening"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, number(getattr(self, key), (key,)))
                if getattr(self, key) == 0.0:
                    raise InputError("is 0, which tightens nothing; expected another number", where=(key,))

    @property
    def label(self) -> str:
        """The name in steps and results."""
        return self.name or self.section
