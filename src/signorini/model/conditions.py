# SPDX-License-Identifier: BSD-3-Clause
"""What holds and what loads the bodies: supports, elastic foundations and loads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from signorini.arrays import Array, frozen
from signorini.checks import choice, components, number, text, vector
from signorini.errors import InputError, Where
from signorini.model.varying import ArcLength, NodeValues, Varying, varying
from signorini.short import Short

Place = str | tuple[float, ...]

BODY_LOADS = ("body_force", "gravity", "centrifugal", "temperature")
_LOAD_KINDS = ("force", "nodal_forces", "traction", "pressure", "bearing", *BODY_LOADS, "torque")


@dataclass(frozen=True)
class Support:
    """Prescribed displacement components on a boundary, a node set or the node at a point.

    Parameters
    ----------
    on : name of a boundary or node set, or the coordinates of a node
    u : one entry per direction, length: a number prescribes it (times the step's factor), None leaves it free; what
        varies prescribes it node by node, see :class:`signorini.model.varying.Formula`
    name : what results and steps call it; the place by default

    Examples
    --------
    >>> Support("axis", u=(0, None)).label
    'axis'
    """

    on: Place
    u: tuple[Varying | None, ...]
    name: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "on", _place(self.on))
        object.__setattr__(self, "u", _directions(self.u, ("u",), free=True))
        if all(part is None for part in self.u):
            raise InputError("leaves every component free; expected at least one number", where=("u",))

    @property
    def label(self) -> str:
        """The name in results: given, or made from the place."""
        return self.name or spell_place(self.on)

    @property
    def moves(self) -> bool:
        """Whether any prescribed value differs from zero."""
        return any(part is not None and part != 0.0 for part in self.u)


@dataclass(frozen=True)
class Foundation:
    """Springs on a boundary, fixed at their other end: traction ``-k_n (u.n) n - k_t (u.t) t`` on the body.

    Parameters
    ----------
    on : name of a boundary
    normal_stiffness, tangential_stiffness : k_n, k_t, pressure per length, >= 0, not both 0; they pull too
    name : what results call it; the place by default

    Examples
    --------
    >>> Foundation("base", normal_stiffness=50.0).label
    'base'
    """

    on: str
    normal_stiffness: float = 0.0
    tangential_stiffness: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        text(self.on, ("on",))
        for key in ("normal_stiffness", "tangential_stiffness"):
            object.__setattr__(self, key, number(getattr(self, key), (key,), least=0.0))
        if self.normal_stiffness == 0.0 == self.tangential_stiffness:
            raise InputError("has no stiffness; expected normal_stiffness or tangential_stiffness > 0")

    @property
    def label(self) -> str:
        """The name in results."""
        return self.name or self.on


Temperature = float | Array | Callable[[Array], Array]


@dataclass(frozen=True, eq=False, repr=False)
class Load(Short):
    """A load on a boundary, a node set, a point or a body; exactly one of the kinds.

    Parameters
    ----------
    on : name of a boundary (force, traction, pressure), node set or coordinates (force, nodal_forces), or body
        (all others)
    force : total force; a component None (in a deck "free") is left alone
    nodal_forces : (k, d) force of each of the k nodes of a node set, in ascending order
    traction : force per area: a number or what varies for every direction, or a function of points (k, d) that gives
        (k, d)
    pressure : force per area, positive when it pushes on the body; a number or what varies
    bearing : total force of a pin or ball in a hole, on a boundary: a pressure that goes with the cosine between the
        force and the way into the body, where it pushes
    torque : total moment about the axis of bodies that twist, by forces along the hoop that grow with the radius
    body_force : force per volume
    gravity : acceleration; times the density of the material
    centrifugal : angular velocity, angle per time, >= 0: ``density omega^2 r`` away from the axis. A step's factor
        scales the force, not the velocity
    centre : point that the axis of rotation goes through, length; the origin by default. Not of axisymmetric bodies,
        which rotate about their axis
    axis : along which it goes, in space; z by default
    temperature : above the one without thermal strain: a number, one value per node of the mesh, or a function of
        coordinates (n, 2) that gives (n,)
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
    traction: tuple[Varying, ...] | Callable[[Array], Array] | None = None
    pressure: Varying | None = None
    bearing: tuple[float, ...] | None = None
    torque: float | None = None
    body_force: tuple[float, ...] | None = None
    gravity: tuple[float, ...] | None = None
    centrifugal: float | None = None
    centre: tuple[float, ...] | None = None
    axis: tuple[float, ...] | None = None
    temperature: Temperature | None = None
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
        if self.traction is not None and not callable(self.traction):
            object.__setattr__(self, "traction", _directions(self.traction, ("traction",), free=False))
        for key in ("bearing", "body_force", "gravity", "centre", "axis"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, vector(getattr(self, key), (key,)))
        if self.pressure is not None:
            object.__setattr__(self, "pressure", varying(self.pressure, ("pressure",)))
        if self.torque is not None:
            object.__setattr__(self, "torque", number(self.torque, ("torque",)))
        if self.bearing is not None and not any(self.bearing):
            raise InputError("is zero; expected a force", where=("bearing",))
        if self.centrifugal is not None:
            object.__setattr__(self, "centrifugal", number(self.centrifugal, ("centrifugal",), least=0.0))
        elif self.centre is not None or self.axis is not None:
            key = "axis" if self.centre is None else "centre"
            raise InputError("goes with a centrifugal load only", where=(key,))
        if self.axis is not None and not any(self.axis):
            raise InputError("is zero; expected a direction", where=("axis",))
        if isinstance(self.temperature, str):
            object.__setattr__(self, "temperature", varying(self.temperature, ("temperature",)))
        elif self.temperature is not None and not callable(self.temperature):
            object.__setattr__(self, "temperature", _field(self.temperature))

    @property
    def kind(self) -> str:
        """Which of the kinds it is, by the name of its parameter."""
        return next(kind for kind in _LOAD_KINDS if getattr(self, kind) is not None)

    @property
    def label(self) -> str:
        """The name in steps: given, or made from the place."""
        return self.name or spell_place(self.on)


def spell_place(on: Place) -> str:
    """A place as a name: itself, or ``point(0, 8)``."""
    return on if isinstance(on, str) else f"point({', '.join(f'{x:g}' for x in on)})"


def _directions(value: Any, where: Where, *, free: bool) -> tuple[Varying | None, ...]:
    """One entry a direction: a number, what varies, or None where that leaves it free."""
    if isinstance(value, str) or not isinstance(value, Sequence) or not any(_varies(part) for part in value):
        return components(value, where, free=free)
    plain = components([0.0 if _varies(part) else part for part in value], where, free=free)
    return tuple(varying(part, (*where, i)) if _varies(part) else plain[i] for i, part in enumerate(value))


def _varies(part: Any) -> bool:
    """Whether a component is no number and does not leave its direction free."""
    if isinstance(part, str):
        return part != "free"
    array = isinstance(part, np.ndarray) and part.ndim > 0
    return array or isinstance(part, NodeValues | ArcLength) or callable(part)


def _field(values: Any) -> float | Array:
    """One temperature, or one a node."""
    if not hasattr(values, "__len__"):
        return number(values, ("temperature",))
    return frozen(vector(values, ("temperature",)))


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
