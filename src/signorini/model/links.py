# SPDX-License-Identifier: BSD-3-Clause
"""What couples displacements without an element: linear equations, and nodes that move as one rigid body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from signorini.checks import choice, number, text, vector, whole
from signorini.errors import InputError

AXES = ("x", "y", "z")
TURNS = {2: ("rotation",), 3: ("rotation x", "rotation y", "rotation z")}
"""How the rotations of a rigid body are called, behind x and y (and z); by the dimension of space."""

_LETTERS = {"r": "x", "t": "z"}  # of axisymmetric models

Term = tuple[str | int | tuple[float, ...], str, float]


@dataclass(frozen=True)
class Equation:
    """A linear equation between displacements: ``sum_k c_k u_k = 0``.

    It is solved for the displacement of its first term, which is no unknown any more; where a support holds that, for
    another. Equations may share displacements and follow from one another.

    Parameters
    ----------
    terms : of place, direction and coefficient c. A place is a node set, a boundary, the coordinates of a node, its
        number, or a rigid body. A direction is "x", "y" or "z" ("r" for "x" in axisymmetric models, "t" for "z" along
        the hoop), of a rigid body also "rotation", in space "rotation x", "rotation y" or "rotation z". Places of n
        nodes make n equations: their nodes go together in ascending order, and single nodes are in all of them
    name : what messages call it

    Examples
    --------
    Two edges with the same vertical displacement:

    >>> Equation([("left", "y", 1.0), ("right", "y", -1.0)]).terms[1]
    ('right', 'y', -1.0)
    """

    terms: Sequence[Term]
    name: str = ""

    def __post_init__(self) -> None:
        if isinstance(self.terms, str) or not isinstance(self.terms, Sequence) or not len(self.terms):
            raise InputError(f"is {self.terms!r}; expected a list of terms", where=("terms",))
        terms = tuple(_term(term, ("terms", k)) for k, term in enumerate(self.terms))
        object.__setattr__(self, "terms", terms)


@dataclass(frozen=True)
class RigidBody:
    """Nodes that move as one: ``u(x) = u + theta x (x - point)`` with a small rotation theta.

    Its displacement u and its rotation are unknowns. Supports and loads whose place is its name hold and load them:
    they have an entry for every direction, then one for the rotation (counterclockwise, radians, moment), in space
    three. In axisymmetric models only the motion along the axis is left, with twist also the rotation about it; the
    others are held.

    Parameters
    ----------
    name : what supports, loads, equations and results call it
    on : a boundary, a node set or a body: the nodes that it consists of
    point : about which it rotates and where forces act, length

    Examples
    --------
    >>> RigidBody("head", on="top", point=(0.0, 1.0)).label
    'head'
    """

    name: str
    on: str
    point: tuple[float, ...]

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        text(self.on, ("on",))
        object.__setattr__(self, "point", vector(self.point, ("point",)))

    @property
    def label(self) -> str:
        """The name in results."""
        return self.name


@dataclass(frozen=True)
class CyclicSymmetry:
    """A sector that repeats around an axis: ``u(R x) = R u(x)`` with R the rotation by ``2 pi / sectors``.

    Loads, supports and contacts are those of one sector, and every other has the same. Displacements are those of one
    sector too, and no sector moves otherwise than its neighbour.

    Parameters
    ----------
    first, second : boundaries or node sets between a sector and its neighbours, whose nodes rotate onto each other, one
        way or the other
    sectors : how many make the whole, >= 2
    point : that the axis goes through, length; the origin by default
    axis : along which it goes, in space; z by default

    Examples
    --------
    >>> CyclicSymmetry("start", "end", sectors=12).axis
    (0.0, 0.0, 1.0)
    """

    first: str
    second: str
    sectors: int
    point: tuple[float, ...] = ()
    axis: tuple[float, ...] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        text(self.first, ("first",))
        text(self.second, ("second",))
        whole(self.sectors, ("sectors",), least=2)
        object.__setattr__(self, "point", vector(self.point, ("point",)))
        object.__setattr__(self, "axis", vector(self.axis, ("axis",), dimension=3))
        if not any(self.axis):
            raise InputError("is zero; expected a direction", where=("axis",))


def directions(dimension: int) -> tuple[str, ...]:
    """Of a rigid body: how its displacements and rotations are called, in order.

    >>> directions(2)
    ('x', 'y', 'rotation')
    """
    return (*AXES[:dimension], *TURNS[dimension])


def _term(term: Any, where: tuple[str | int, ...]) -> Term:
    if isinstance(term, str) or not isinstance(term, Sequence) or len(term) != 3:
        raise InputError(f"is {term!r}; expected a place, a direction and a coefficient", where=where)
    on, axis, coefficient = term
    if isinstance(on, bool) or not isinstance(on, str | int):
        on = vector(on, (*where, 0))
    elif isinstance(on, str):
        text(on, (*where, 0))
    axis = choice(_LETTERS.get(axis, axis), (*AXES, *TURNS[2], *TURNS[3]), (*where, 1), "direction")
    value = number(coefficient, (*where, 2))
    if value == 0.0:
        raise InputError("is 0; expected another coefficient, or no such term", where=(*where, 2))
    return on, axis, value
