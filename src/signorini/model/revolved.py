# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles in space that are round about an axis, with their exact distances and normals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from signorini.arrays import Array
from signorini.checks import number, vector
from signorini.errors import InputError, spell_point

_TIP = 1e-12  # of the farthest point: that near to the apex of a cone a point is at it


@dataclass(frozen=True)
class _Revolved:
    """A surface round about an axis; its meridian is a curve in (distance from the axis, place along it).

    Parameters
    ----------
    point : of the axis, length
    axis : direction of the axis; any size but zero
    """

    dimension: ClassVar[int] = 3
    """Of the space that it lies in."""

    point: tuple[float, ...]
    axis: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", vector(self.point, ("point",), dimension=3))
        axis = vector(self.axis, ("axis",), dimension=3)
        size = math.hypot(*axis)
        if size == 0.0:
            raise InputError("is zero; expected a direction", where=("axis",))
        object.__setattr__(self, "axis", tuple(part / size for part in axis))

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Signed distance of points (n, 3), positive outside the obstacle, and its outward normals there (n, 3)."""
        axis = np.array(self.axis)
        arm = np.asarray(points, dtype=np.float64) - self.point
        z = arm @ axis
        radial = arm - z[:, None] * axis
        rho = np.linalg.norm(radial, axis=1)
        aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])  # on the axis any direction across it will do
        away = np.where(rho[:, None] > 0.0, radial / np.maximum(rho, 1e-300)[:, None], aside / np.linalg.norm(aside))
        distance, outward, along = self._meridian(rho, z)
        return distance, outward[:, None] * away + along[:, None] * axis + 0.0

    def _meridian(self, rho: Array, z: Array) -> tuple[Array, Array, Array]:
        """Signed distance, and the normal's parts away from the axis and along it."""
        raise NotImplementedError


@dataclass(frozen=True)
class Cylinder(_Revolved):
    """A rigid round cylinder without ends, solid or a bore.

    Parameters
    ----------
    point, axis : of the axis
    radius : length, > 0
    inside : the bodies are inside: the obstacle is the wall of a bore

    Examples
    --------
    >>> Cylinder(point=(0, 0, 0), axis=(0, 0, 1), radius=2).nearest([[3.0, 0.0, 7.0]])
    (array([1.]), array([[1., 0., 0.]]))
    """

    radius: float
    inside: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "radius", number(self.radius, ("radius",), above=0.0))

    def __str__(self) -> str:
        return f"a {'bore' if self.inside else 'cylinder'} of radius {self.radius:.5g} about {_axis(self)}"

    def _meridian(self, rho: Array, z: Array) -> tuple[Array, Array, Array]:
        sign = -1.0 if self.inside else 1.0
        return sign * (rho - self.radius), np.full_like(rho, sign), np.zeros_like(z)


@dataclass(frozen=True)
class Cone(_Revolved):
    """A rigid round cone without end, with a sharp apex, solid or a conical hole.

    Parameters
    ----------
    point : the apex, length
    axis : from the apex into the cone
    angle : between axis and surface, radians, 0 < angle < pi / 2
    inside : the bodies are inside: the obstacle is the wall of a conical hole

    Examples
    --------
    >>> Cone(point=(0, 0, 0), axis=(0, 0, 1), angle=np.pi / 4).nearest([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0]])
    (array([1., 0.]), array([[ 0.,  0., -1.],
           [ 0.,  0., -1.]]))
    """

    angle: float
    inside: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "angle", number(self.angle, ("angle",), above=0.0, below=0.5 * math.pi))

    def __str__(self) -> str:
        hole = "a conical hole" if self.inside else "a cone"
        return f"{hole} of half-angle {self.angle:.5g} from its apex on {_axis(self)}"

    def _meridian(self, rho: Array, z: Array) -> tuple[Array, Array, Array]:
        sine, cosine = math.sin(self.angle), math.cos(self.angle)
        behind = rho * sine + z * cosine < 0.0  # nearest to the apex
        far = np.hypot(rho, z)
        unit = np.where(far > 0.0, far, 1.0)
        distance = np.where(behind, far, rho * cosine - z * sine)
        outward, along = np.where(behind, rho / unit, cosine), np.where(behind, z / unit, -sine)
        tip = far <= _TIP * far.max(initial=0.0)  # no side of the apex is before another
        outward, along = np.where(tip, 0.0, outward), np.where(tip, -1.0, along)
        sign = -1.0 if self.inside else 1.0
        return sign * distance, sign * outward, sign * along


@dataclass(frozen=True)
class Torus(_Revolved):
    """A rigid torus, solid or a hollow ring.

    Parameters
    ----------
    point, axis : of the axis; the point is the centre
    radius : of the circle that the tube follows, length, > 0
    tube : radius of the tube, length, 0 < tube <= radius
    inside : the bodies are inside the tube

    Examples
    --------
    >>> Torus(point=(0, 0, 0), axis=(0, 0, 1), radius=2, tube=0.5).nearest([[0.0, 2.0, 1.0]])
    (array([0.5]), array([[0., 0., 1.]]))
    """

    radius: float
    tube: float
    inside: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "radius", number(self.radius, ("radius",), above=0.0))
        object.__setattr__(self, "tube", number(self.tube, ("tube",), above=0.0))
        if self.tube > self.radius:
            raise InputError(f"is {self.tube:g}; expected no more than the radius, {self.radius:g}", where=("tube",))

    def __str__(self) -> str:
        ring = "a hollow ring" if self.inside else "a torus"
        return f"{ring} of radii {self.radius:.5g} and {self.tube:.5g} about {_axis(self)}"

    def _meridian(self, rho: Array, z: Array) -> tuple[Array, Array, Array]:
        far = np.hypot(rho - self.radius, z)
        unit = np.where(far > 0.0, far, 1.0)
        outward = np.where(far > 0.0, (rho - self.radius) / unit, 1.0)
        sign = -1.0 if self.inside else 1.0
        return sign * (far - self.tube), sign * outward, sign * z / unit


def _axis(shape: _Revolved) -> str:
    return f"the axis through {spell_point(shape.point)} along {spell_point(shape.axis)}"
