# SPDX-License-Identifier: BSD-3-Clause
"""Rigid obstacles that move: driven, or free under a force and a moment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from signorini.checks import components, number, text, vector
from signorini.errors import InputError
from signorini.model.obstacle import Circle, Obstacle, Profile
from signorini.model.triangulated import Surface


@dataclass(frozen=True)
class Rigid:
    """A rigid obstacle with a motion of its own: a translation and a small rotation about a point.

    What is prescribed, and force and moment, are multiplied by the factor that steps give its name.

    Parameters
    ----------
    name : what contacts, steps and results call it
    shape : its surface
    u : displacement of the point, one entry per direction, length: a number prescribes it, None leaves it free
    rotation : radians, counterclockwise; None leaves it free; in space about x, y and z, or one 0 or None for all three
    force : on it in every free direction, None or 0 elsewhere
    moment : on it about the point, counterclockwise, where the rotation is free; in space about x, y and z
    point : about which it rotates, length; by default a circle's centre, a plane's point, the middle of the points of a
        profile or a surface

    Raises
    ------
    InputError
        If a force or moment acts on what is prescribed.

    Examples
    --------
    >>> punch = Rigid("punch", Circle((0, 3), 2), u=(0, None), force=(None, -10))
    >>> punch.about, punch.acts
    ((0.0, 3.0), True)
    >>> Rigid("ball", Circle((0, 0, 3), 2), rotation=(0, 0, None), moment=(0, 0, 5)).moments
    (0.0, 0.0, 5.0)
    """

    name: str
    shape: Obstacle
    u: tuple[float | None, ...] = ()
    rotation: float | tuple[float | None, ...] | Literal["free"] | None = 0.0
    force: tuple[float | None, ...] | None = None
    moment: float | tuple[float | None, ...] = 0.0
    point: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        if not isinstance(self.shape, Obstacle):
            raise InputError(f"is {self.shape!r}; expected a Plane, Circle, Profile or another shape", where=("shape",))
        d = self.shape.dimension
        object.__setattr__(self, "u", components(self.u or (0.0,) * d, ("u",), dimension=d))
        object.__setattr__(self, "rotation", self._turning(self.rotation, "rotation"))
        if self.force is not None:
            object.__setattr__(self, "force", components(self.force, ("force",), dimension=d))
        object.__setattr__(self, "moment", self._turning(self.moment, "moment"))
        if self.point is not None:
            object.__setattr__(self, "point", vector(self.point, ("point",), dimension=d))
        if any(part and held is not None for part, held in zip(self.force or (), self.u, strict=False)):
            raise InputError(
                f"is {self.force} where u is {self.u}: a force acts in a prescribed direction; expected None there, or "
                'None (in a deck "free") in u',
                where=("force",),
            )
        if any(part and held is not None for part, held in zip(self.moments, self.rotations, strict=True)):
            raise InputError(
                'acts on a prescribed rotation; expected rotation None (in a deck "free")', where=("moment",)
            )

    def _turning(self, value: Any, key: str) -> float | tuple[float | None, ...] | None:
        """A rotation or moment: in the plane a number, in space three or one that is 0 or free."""
        if value is None or (isinstance(value, str) and value == "free"):
            if key == "moment":
                raise InputError(f"is {value!r}; expected a number", where=(key,))
            return None
        if self.shape.dimension == 2 or not (isinstance(value, Sequence | np.ndarray) or number(value, (key,))):
            return number(value, (key,))
        return components(value, (key,), dimension=3)

    @property
    def label(self) -> str:
        """The name in results and steps."""
        return self.name

    @property
    def about(self) -> tuple[float, ...]:
        """The point about which it rotates."""
        if self.point is not None:
            return self.point
        if isinstance(self.shape, Circle):
            return self.shape.centre
        if isinstance(self.shape, Profile | Surface):
            return tuple(float(x) for x in np.mean(self.shape.points, axis=0))
        return self.shape.point

    @property
    def rotations(self) -> tuple[float | None, ...]:
        """The prescribed rotations, radians, None where it is free: one in the plane, three in space."""
        every = 1 if self.shape.dimension == 2 else 3
        if self.rotation is None or isinstance(self.rotation, str):
            return (None,) * every
        return self.rotation if isinstance(self.rotation, tuple) else (self.rotation,) * every

    @property
    def moments(self) -> tuple[float, ...]:
        """On it about its point: one in the plane, three in space."""
        every = 1 if self.shape.dimension == 2 else 3
        given = self.moment if isinstance(self.moment, tuple) else (self.moment,) * every
        return tuple(part or 0.0 for part in given)

    @property
    def acts(self) -> bool:
        """Whether it is moved or loaded, so that steps can scale it."""
        return any(part for part in (*self.u, *self.rotations, *(self.force or ()), *self.moments))
