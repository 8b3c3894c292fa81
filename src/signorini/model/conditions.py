# SPDX-License-Identifier: BSD-3-Clause
"""What holds and what loads the bodies: supports and loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from signorini.arrays import Array, frozen
from signorini.checks import choice, components, number, text, vector
from signorini.errors import InputError

Place = str | tuple[float, ...]

_LOAD_KINDS = ("force", "nodal_forces", "traction", "pressure", "body_force")


@dataclass(frozen=True)
class Support:
    """Prescribed displacement components on a boundary, a node set or the node at a point.

    Parameters
    ----------
    on : name of a boundary or node set, or the coordinates of a node
    u : one entry per direction, length: a number prescribes it (times the step's factor), None leaves it free
    name : what results and steps call it; the place by default

    Examples
    --------
    >>> Support("axis", u=(0, None)).label
    'axis'
    """

    on: Place
    u: tuple[float | None, ...]
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "on", _place(self.on))
        object.__setattr__(self, "u", components(self.u, ("u",)))
        if all(part is None for part in self.u):
            raise InputError("leaves every component free; expected at least one number", where=("u",))

    @property
    def label(self) -> str:
        """The name in results: given, or made from the place."""
        return self.name or spell_place(self.on)

    @property
    def moves(self) -> bool:
        """Whether any prescribed value differs from zero."""
        return any(part for part in self.u)


@dataclass(frozen=True, eq=False)
class Load:
    """A load on a boundary, a node set, a point or a body; exactly one of the kinds.

    Parameters
    ----------
    on : name of a boundary (force, traction, pressure), node set or coordinates (force, nodal_forces), or body
        (body_force)
    force : total force; a component None (in a deck "free") is left alone
    nodal_forces : (k, d) force of each of the k nodes of a node set, in ascending order
    traction : force per area
    pressure : force per area, positive when it pushes on the body
    body_force : force per volume
    spread : how a total force acts on a boundary. "traction": uniform traction. "displacement": the boundary moves
        rigidly in every direction whose component is given, and the force is the resultant
    name : what steps call it; the place by default

    Examples
    --------
    >>> Load("cut", force=(0.0, -78.0)).kind
    'force'
    """

    on: Place
    force: tuple[float | None, ...] | None = None
    nodal_forces: Array | None = None
    traction: tuple[float, ...] | None = None
    pressure: float | None = None
    body_force: tuple[float, ...] | None = None
    spread: Literal["traction", "displacement"] = "traction"
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "on", _place(self.on))
        given = [kind for kind in _LOAD_KINDS if getattr(self, kind) is not None]
        if len(given) != 1:
            found = " and ".join(given) if given else "none of them"
            raise InputError(f"has {found}; expected exactly one of {', '.join(_LOAD_KINDS)}")
        choice(self.spread, ("traction", "displacement"), ("spread",), "spread")
        if self.spread == "displacement" and self.force is None:
            raise InputError("is 'displacement'; that goes with a total force only", where=("spread",))
        if self.force is not None:
            object.__setattr__(self, "force", components(self.force, ("force",)))
        if self.nodal_forces is not None:
            object.__setattr__(self, "nodal_forces", _rows(self.nodal_forces))
        if self.traction is not None:
            object.__setattr__(self, "traction", vector(self.traction, ("traction",)))
        if self.body_force is not None:
            object.__setattr__(self, "body_force", vector(self.body_force, ("body_force",)))
        if self.pressure is not None:
            object.__setattr__(self, "pressure", number(self.pressure, ("pressure",)))

    @property
    def kind(self) -> str:
        """Which of force, nodal_forces, traction, pressure, body_force it is."""
        return next(kind for kind in _LOAD_KINDS if getattr(self, kind) is not None)

    @property
    def label(self) -> str:
        """The name in steps: given, or made from the place."""
        return self.name or spell_place(self.on)


def spell_place(on: Place) -> str:
    """A place as a name: itself, or ``point(0, 8)``."""
    return on if isinstance(on, str) else f"point({', '.join(f'{x:g}' for x in on)})"


def _rows(values: Any) -> Array:
    try:
        rows = frozen(values)
    except (TypeError, ValueError):
        rows = frozen([])
    if rows.ndim != 2 or not len(rows) or not np.isfinite(rows).all():
        raise InputError("is no table of finite numbers; expected one force a node", where=("nodal_forces",))
    return rows


def _place(on: Place) -> Place:
    return text(on, ("on",)) if isinstance(on, str) else vector(on, ("on",))
