# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of rigid obstacles, with their exact distances and normals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from signorini.arrays import Array, frozen
from signorini.checks import number, vector
from signorini.errors import InputError, spell_point
from signorini.model.revolved import Cone, Cylinder, Torus
from signorini.model.triangulated import Surface
from signorini.short import Short


@dataclass(frozen=True)
class Plane:
    """A rigid plane (in 2D a line) that bodies cannot enter.

    Parameters
    ----------
    point : any point of it, length
    normal : pointing from the obstacle towards the body; any size but zero

    Examples
    --------
    >>> Plane(point=(0, 0), normal=(0, 2)).nearest([[1.0, 0.5]])
    (array([0.5]), array([[0., 1.]]))
    """

    point: tuple[float, ...]
    normal: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", vector(self.point, ("point",)))
        normal = vector(self.normal, ("normal",), dimension=len(self.point))
        size = math.hypot(*normal)
        if size == 0.0:
            raise InputError("is zero; expected a direction", where=("normal",))
        object.__setattr__(self, "normal", tuple(part / size for part in normal))

    def __str__(self) -> str:
        return f"a plane through {spell_point(self.point)}, normal {spell_point(self.normal)}"

    @property
    def dimension(self) -> int:
        """Of the space that it lies in."""
        return len(self.point)

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, d), positive outside the obstacle, and its outward normals there (n, d)."""
        normals = np.tile(self.normal, (len(points), 1))
        return (np.asarray(points) - self.point) @ np.array(self.normal), normals


@dataclass(frozen=True)
class Circle:
    """A rigid circle (in 3D a sphere), solid or a hole in a solid.

    Parameters
    ----------
    centre : length
    radius : length, > 0
    inside : the bodies are inside: the obstacle is the wall of a round hole

    Examples
    --------
    >>> Circle(centre=(0, 2), radius=2).nearest([[0.0, -0.5]])
    (array([0.5]), array([[ 0., -1.]]))
    """

    centre: tuple[float, ...]
    radius: float
    inside: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", vector(self.centre, ("centre",)))
        object.__setattr__(self, "radius", number(self.radius, ("radius",), above=0.0))
        if not isinstance(self.inside, bool):
            raise InputError(f"is {self.inside!r}; expected true or false", where=("inside",))

    def __str__(self) -> str:
        hole = "a round hole" if self.inside else "a circle" if self.dimension == 2 else "a sphere"
        return f"{hole} of radius {self.radius:.5g} about {spell_point(self.centre)}"

    @property
    def dimension(self) -> int:
        """Of the space that it lies in."""
        return len(self.centre)

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, d), positive outside the obstacle, and its outward normals there (n, d)."""
        arm = np.asarray(points) - self.centre
        length = np.linalg.norm(arm, axis=1)
        first = np.eye(self.dimension)[0]  # the centre itself has no nearest point: any direction will do
        outward = np.where(length[:, None] > 0.0, arm / np.maximum(length, 1e-300)[:, None], first)
        sign = -1.0 if self.inside else 1.0
        return sign * (length - self.radius), sign * outward + 0.0


@dataclass(frozen=True, repr=False)
class Profile(Short):
    """A rigid surface whose section is a line of straight pieces, sharp or rounded at its corners; plane.

    Parameters
    ----------
    points : (n, 2) its corners in order, length; the bodies are on the left of the way from the first to the last
    fillet : radius that rounds every corner, length; 0: sharp
    closed : the last point is joined to the first

    Raises
    ------
    InputError
        If two points coincide, the way turns back on itself, or a fillet does not fit between two corners.

    Examples
    --------
    A punch with rounded edges above the bodies (they are on the left of the way from right to left):

    >>> punch = Profile([(2, 5), (2, 1), (-2, 1), (-2, 5)], fillet=0.5)
    >>> distance, normal = punch.nearest([[0.0, 0.75], [2.0, 1.0]])
    >>> print(distance.round(6), normal[0] + 0.0)
    [0.25     0.207107] [ 0. -1.]
    """

    dimension: ClassVar[int] = 2
    """Of the space that it lies in."""

    points: tuple[tuple[float, float], ...]
    fillet: float = 0.0
    closed: bool = False

    def __post_init__(self) -> None:
        if isinstance(self.points, str) or not hasattr(self.points, "__len__") or len(self.points) < 2:
            raise InputError(f"is {self.points!r}; expected two points or more", where=("points",))
        points = tuple(vector(point, ("points", i), dimension=2) for i, point in enumerate(self.points))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "fillet", number(self.fillet, ("fillet",), least=0.0))
        if not isinstance(self.closed, bool):
            raise InputError(f"is {self.closed!r}; expected true or false", where=("closed",))
        self._check(self._corners)

    def __str__(self) -> str:
        ends = f"from {spell_point(self.points[0])} to {spell_point(self.points[-1])}"
        return f"a {'closed ' if self.closed else ''}profile of {len(self.points)} points {ends}"

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, 2), positive outside the obstacle, and its outward normals there (n, 2)."""
        x = np.asarray(points, float)
        distance, normals = self._to_lines(x)
        if len(self._arcs[0]):
            other, turned = self._to_arcs(x)
            nearer = np.abs(other) < np.abs(distance)
            distance, normals = np.where(nearer, other, distance), np.where(nearer[:, None], turned, normals)
        return distance, normals + 0.0

    @cached_property
    def _corners(self) -> tuple[Array, Array, Array, Array]:
        """Points with the first again if closed, unit tangents, normals (to the left), and turns at inner corners."""
        points = frozen([*self.points, self.points[0]] if self.closed else self.points)
        along = np.diff(points, axis=0)
        length = np.linalg.norm(along, axis=1, keepdims=True)
        tangents = np.divide(along, length, out=np.zeros_like(along), where=length > 0)
        normals = np.column_stack([-tangents[:, 1], tangents[:, 0]])
        following = np.roll(tangents, -1, axis=0)
        turns = np.arctan2(np.sum(normals * following, axis=1), np.sum(tangents * following, axis=1))
        return points, tangents, normals, turns if self.closed else turns[:-1]

    def _check(self, corners: tuple[Array, Array, Array, Array]) -> None:
        points, tangents, _, turns = corners
        if not tangents.any(axis=1).all():
            i = int(np.nonzero(~tangents.any(axis=1))[0][0])
            raise InputError(f"is the same as the next, {tuple(points[i])}", where=("points", i))
        if (np.abs(turns) > math.pi - 1e-6).any():
            i = int(np.argmax(np.abs(turns))) + 1
            raise InputError("is where the way turns back on itself", where=("points", i % len(self.points)))
        start, end = self._cuts
        length = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if (start + end > length * (1 + 1e-12)).any():
            i = int(np.argmax(start + end - length))
            raise InputError(
                f"is {self.fillet:g}; between points {i + 1} and {i + 2}, {length[i]:g} apart, its arcs need "
                f"{start[i] + end[i]:g}",
                where=("fillet",),
            )

    @property
    def _cuts(self) -> tuple[Array, Array]:
        """How much of every straight piece its arcs take at the start and at the end."""
        turns = self._corners[3]
        cut = self.fillet * np.tan(np.abs(turns) / 2.0)
        if self.closed:
            return np.roll(cut, 1), cut
        return np.append(0.0, cut), np.append(cut, 0.0)

    @cached_property
    def _arcs(self) -> tuple[Array, Array, Array, Array]:
        """Of fillets: centres, middle directions, cosines of half the angle, signs (1: bulging towards the bodies)."""
        points, tangents, normals, turns = self._corners
        round_ = np.nonzero((np.abs(turns) > 1e-12) & (self.fillet > 0.0))[0]
        sign = -np.sign(turns[round_])
        touch = points[round_ + 1] - self._cuts[1][round_, None] * tangents[round_]
        centre = touch - (sign * self.fillet)[:, None] * normals[round_]
        middle = normals[round_] + normals[(round_ + 1) % len(normals)]
        middle *= (sign / np.linalg.norm(middle, axis=1))[:, None]
        return centre, middle, np.cos(turns[round_] / 2.0), sign

    def _to_lines(self, x: Array) -> tuple[Array, Array]:
        """Distance and normal of the nearest straight piece, its ends included."""
        points, tangents, normals, turns = self._corners
        start, end = self._cuts
        length = np.linalg.norm(np.diff(points, axis=0), axis=1)
        arm = x[:, None] - points[:-1]
        along = np.einsum("nmi,mi->nm", arm, tangents)
        foot = np.clip(along, start, length - end)
        beside = np.einsum("nmi,mi->nm", arm, normals)
        best = np.argmin(np.hypot(beside, along - foot), axis=1)
        rows = np.arange(len(x))
        beside, past = beside[rows, best], (along - foot)[rows, best]
        distance = np.hypot(beside, past)
        at_start = past < 0.0
        corner = np.where(at_start, best - 1, best)
        inner = np.ones(len(x), bool) if self.closed else (corner >= 0) & (corner < len(turns))
        turn = np.where(inner, turns[corner % len(turns)] if len(turns) else 0.0, 0.0)
        # nearest to a corner: outside where it bulges, inside where it is hollow; elsewhere the side decides
        sign = np.where((past != 0.0) & (np.abs(turn) > 1e-12), -np.sign(turn), np.where(beside >= 0.0, 1.0, -1.0))
        away = beside[:, None] * normals[best] + past[:, None] * tangents[best]
        exact = (past == 0.0) | (distance == 0.0)
        safe = np.where(distance > 0.0, distance, 1.0)
        return sign * distance, np.where(exact[:, None], normals[best], (sign / safe)[:, None] * away)

    def _to_arcs(self, x: Array) -> tuple[Array, Array]:
        """Distance and normal of the nearest fillet; infinite beside all of them."""
        centre, middle, half, sign = self._arcs
        arm = x[:, None] - centre
        length = np.linalg.norm(arm, axis=-1)
        direction = arm / np.where(length > 0.0, length, 1.0)[..., None]
        within = np.einsum("nmi,mi->nm", direction, middle) >= half
        distance = np.where(within, sign * (length - self.fillet), np.inf)
        best = np.argmin(np.abs(distance), axis=1)
        rows = np.arange(len(x))
        return distance[rows, best], sign[best, None] * direction[rows, best]


Sphere = Circle
"""In space a circle is a sphere."""

Obstacle = Plane | Circle | Profile | Cylinder | Cone | Torus | Surface
