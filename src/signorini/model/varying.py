# SPDX-License-Identifier: BSD-3-Clause
"""Data that vary along a coordinate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.checks import choice, vector
from signorini.errors import InputError

_AXES = {"x": 0, "r": 0, "y": 1, "z": 1}


@dataclass(frozen=True)
class Along:
    """Values at places on a coordinate axis: linear in between, constant beyond the first and the last.

    Parameters
    ----------
    axis : "x" or "y"; of axisymmetric bodies "r" or "z"
    at : (n,) increasing coordinates, length
    values : (n,)

    Examples
    --------
    >>> Along("x", at=(0, 2), values=(0.1, 0.3))(np.array([[1.0, 5.0], [4.0, 5.0]]))
    array([0.2, 0.3])
    """

    axis: str
    at: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        choice(self.axis, tuple(_AXES), ("axis",), "axis")
        object.__setattr__(self, "at", vector(self.at, ("at",)))
        object.__setattr__(self, "values", vector(self.values, ("values",), dimension=len(self.at)))
        if not self.at or (np.diff(self.at) <= 0).any():
            raise InputError(f"is {self.at}; expected increasing coordinates", where=("at",))

    def __call__(self, points: Array) -> Array:
        """At points (k, d), (k,)."""
        return np.interp(np.asarray(points)[:, _AXES[self.axis]], self.at, self.values)
