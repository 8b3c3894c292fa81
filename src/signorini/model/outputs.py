# SPDX-License-Identifier: BSD-3-Clause
"""Outputs of a history whose derivatives can be asked for, in the user's words; no numerics.

>>> pressure("hertz").peak, force("hertz", along=(0, 1)).after(1.5)
(peak pressure of 'hertz', force on 'hertz' along (0, 1) at load factor 1.5)
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, Self

from signorini.checks import number
from signorini.errors import InputError

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
"""Of a stress, as columns of `BodyStress.stress`."""

Field = Literal["pressure", "traction", "gap", "motion"]
Part = Literal["all", "pressure", "friction"]


@dataclass(frozen=True)
class Output(ABC):
    """A number that a history answers.

    Parameters
    ----------
    load_factor : where it is asked for, k at the end of step k; None at the end of the history
    """

    load_factor: float | None = None

    @property
    @abstractmethod
    def words(self) -> str:
        """What it is."""

    def after(self, load_factor: float) -> Self:
        """This output at a load factor: the end of a step, of a straight part of its loads, or a time asked for."""
        return replace(self, load_factor=number(load_factor, ("load_factor",), least=0.0))

    def __repr__(self) -> str:
        return self.words if self.load_factor is None else f"{self.words} at load factor {self.load_factor:g}"


@dataclass(frozen=True, repr=False)
class AtNode(Output):
    """A field of a contact at one of its nodes; ``axis`` of the tangents, 0 or 1, where the field runs along them."""

    field: Field = "pressure"
    contact: str = ""
    node: int = 0
    axis: int = 0

    @property
    def words(self) -> str:
        """What it is."""
        return f"{self.field} of '{self.contact}' at node {self.node}"


@dataclass(frozen=True, repr=False)
class Peak(Output):
    """The largest pressure of a contact."""

    contact: str = ""

    @property
    def words(self) -> str:
        """What it is."""
        return f"peak pressure of '{self.contact}'"


@dataclass(frozen=True, repr=False)
class Mean(Output):
    """The mean of the pressure over the nonmortar side of a contact, or with weights, one for each of its nodes."""

    contact: str = ""
    weights: tuple[float, ...] = ()

    @property
    def words(self) -> str:
        """What it is."""
        return f"{'weighted ' if self.weights else ''}mean pressure of '{self.contact}'"


@dataclass(frozen=True, repr=False)
class Resultant(Output):
    """The force of a contact on the nonmortar body along a direction."""

    contact: str = ""
    along: tuple[float, ...] = ()
    of: Part = "all"

    @property
    def words(self) -> str:
        """What it is."""
        part = "" if self.of == "all" else f" of the {self.of}"
        return f"force{part} on '{self.contact}' along ({', '.join(f'{part:g}' for part in self.along)})"


@dataclass(frozen=True, repr=False)
class Moment(Output):
    """The moment of a contact on the nonmortar body about a point; in space about an axis through it."""

    contact: str = ""
    about: tuple[float, ...] = ()
    axis: int = 2
    of: Part = "all"

    @property
    def words(self) -> str:
        """What it is."""
        return f"moment on '{self.contact}' about ({', '.join(f'{part:g}' for part in self.about)})"


@dataclass(frozen=True, repr=False)
class HalfWidth(Output):
    """Half the width of a contact as its pressure says: that of Hertz' whose second moment is the same; smooth."""

    contact: str = ""
    about: tuple[float, ...] = ()

    @property
    def words(self) -> str:
        """What it is."""
        return f"half-width of '{self.contact}'"


@dataclass(frozen=True, repr=False)
class Dissipation(Output):
    """The work that friction has taken since the beginning; of one contact, or of all where none is named."""

    contact: str = ""

    @property
    def words(self) -> str:
        """What it is."""
        return f"dissipation of '{self.contact}'" if self.contact else "dissipation"


@dataclass(frozen=True, repr=False)
class Displacement(Output):
    """The displacement of a node along a direction."""

    node: int = 0
    along: tuple[float, ...] = ()

    @property
    def words(self) -> str:
        """What it is."""
        return f"displacement of node {self.node} along ({', '.join(f'{part:g}' for part in self.along)})"


@dataclass(frozen=True, repr=False)
class Stress(Output):
    """A component of the stress of a body at a node of it, as `Solution.stress` gives it."""

    body: str = ""
    node: int = 0
    component: str = "xx"

    @property
    def words(self) -> str:
        """What it is."""
        return f"stress {self.component} of '{self.body}' at node {self.node}"


@dataclass(frozen=True, repr=False)
class WeightedSum(Output):
    """A sum of outputs, each with its factor."""

    parts: tuple[tuple[float, Output], ...] = ()

    @property
    def words(self) -> str:
        """What it is."""
        return " + ".join(f"{factor:g} x {part!r}" for factor, part in self.parts)


@dataclass(frozen=True)
class PressureOutputs:
    """Outputs of the pressure of a contact.

    Parameters
    ----------
    contact : by name
    """

    contact: str

    def __getitem__(self, node: int) -> AtNode:
        """At a node, numbered from 0 as in `ContactResult.node`."""
        return AtNode(field="pressure", contact=self.contact, node=int(node))

    @property
    def peak(self) -> Peak:
        """The largest: at the node that has it."""
        return Peak(contact=self.contact)

    def mean(self, weights: Sequence[float] = ()) -> Mean:
        """The mean over the nonmortar side, or with weights, one a node of it."""
        return Mean(contact=self.contact, weights=tuple(float(weight) for weight in weights))


@dataclass(frozen=True)
class FieldOutputs:
    """Outputs of a field of a contact at its nodes.

    Parameters
    ----------
    field : its name
    contact : by name
    """

    field: Field
    contact: str

    def __getitem__(self, at: int | tuple[int, int]) -> AtNode:
        """At a node, numbered from 0 as in `ContactResult.node`; in space with the number of a tangent, 0 or 1."""
        node, axis = at if isinstance(at, tuple) else (at, 0)
        return AtNode(field=self.field, contact=self.contact, node=int(node), axis=int(axis))


def pressure(contact: str) -> PressureOutputs:
    """Pressure of a contact: ``pressure("c")[node]``, ``.peak``, ``.mean()``."""
    return PressureOutputs(contact)


def traction(contact: str) -> FieldOutputs:
    """Friction of a contact, force per area along the tangent: ``traction("c")[node]``, in space ``[node, axis]``."""
    return FieldOutputs("traction", contact)


def gap(contact: str) -> FieldOutputs:
    """Gap of a contact: ``gap("c")[node]``."""
    return FieldOutputs("gap", contact)


def motion(contact: str) -> FieldOutputs:
    """Tangential motion of a contact since the beginning, nonmortar minus mortar: ``motion("c")[node]``."""
    return FieldOutputs("motion", contact)


def force(contact: str, along: Sequence[float], *, of: Part = "all") -> Resultant:
    """Force of a contact on the nonmortar body along a direction, of any length: the force times the vector."""
    return Resultant(contact=contact, along=_vector(along, "along"), of=of)


def moment(contact: str, about: Sequence[float], *, axis: int = 2, of: Part = "all") -> Moment:
    """Moment of a contact on the nonmortar body about a point.

    Parameters
    ----------
    contact : by name
    about : (d,) the point, length
    axis : in space, 0, 1 or 2
    of : "all", "pressure" or "friction"
    """
    return Moment(contact=contact, about=_vector(about, "about"), axis=axis, of=of)


def halfwidth(contact: str, about: Sequence[float] = ()) -> HalfWidth:
    """Half-width of a contact from the second moment of its pressure.

    Parameters
    ----------
    contact : by name
    about : in the plane, the middle where half of the bodies are modelled; the centre of the pressure if not given.
        Axisymmetric the axis is the middle
    """
    return HalfWidth(contact=contact, about=_vector(about, "about"))


def dissipation(contact: str = "") -> Dissipation:
    """Work that friction has taken since the beginning, of one contact or of all."""
    return Dissipation(contact=contact)


def displacement(at: int, along: Sequence[float]) -> Displacement:
    """Displacement of a node, numbered from 0, along a direction, of any length: the displacement times the vector."""
    return Displacement(node=int(at), along=_vector(along, "along"))


def stress(body: str, at: int, component: str) -> Stress:
    """Component "xx", "yy", "zz", "xy", "yz" or "xz" of the stress of a body at a node, numbered from 0.

    Parameters
    ----------
    body : by name
    at : a node of it
    component : of axisymmetric bodies "xx" is radial, "yy" axial, "zz" hoop
    """
    if component not in COMPONENTS:
        raise InputError(f"is '{component}'; expected one of {', '.join(COMPONENTS)}", where=("component",))
    return Stress(body=body, node=int(at), component=component)


def _vector(given: Sequence[float], where: str) -> tuple[float, ...]:
    return tuple(number(part, (where, i)) for i, part in enumerate(given))
