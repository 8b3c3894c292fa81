# SPDX-License-Identifier: BSD-3-Clause
"""How accurate an answer has to be, and what a finer mesh may cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from signorini.checks import choice, number, whole
from signorini.errors import InputError
from signorini.model.obstacle import Obstacle

AccurateIn = Literal["pressure", "traction", "energy"]
"""What is to be accurate: pressures of the contacts, their pressures and frictions, or stresses in the bodies."""


@dataclass(frozen=True)
class Accuracy:
    """An accuracy instead of a mesh: bodies are meshed finer, where it counts, until it is met.

    Parameters
    ----------
    error : relative, > 0; 0.01 is one per cent
    of : "pressure": of all contacts, root of the mean square; "traction": of their friction too; "energy": of the
        stresses in all bodies, in the norm of energy
    nodes : most nodes of a mesh that is tried
    seconds : of the clock after which no finer mesh is begun; None: no matter how many
    shapes : boundary to the shape that it stands for and that new nodes go onto: one of those of obstacles; "spline"
        through its nodes, in the plane; "straight", as the mesh has it. Of others a circle, a sphere or a cylinder is
        found where nodes lie on one

    Raises
    ------
    InputError
        For a number out of its range, with its name.

    Examples
    --------
    >>> Accuracy(0.01).of
    'pressure'
    >>> Accuracy(-1)
    Traceback (most recent call last):
    signorini.errors.InputError: error: is -1; expected a number > 0
    """

    error: float
    of: AccurateIn = "pressure"
    nodes: int = 200_000
    seconds: float | None = None
    shapes: Mapping[str, Obstacle | Literal["spline", "straight"]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "error", number(self.error, ("error",), above=0.0))
        choice(self.of, get_args(AccurateIn), ("of",), "kind of accuracy")
        object.__setattr__(self, "nodes", whole(self.nodes, ("nodes",), least=1))
        if self.seconds is not None:
            object.__setattr__(self, "seconds", number(self.seconds, ("seconds",), above=0.0))
        if not isinstance(self.shapes, Mapping):
            raise InputError(f"is {self.shapes!r}; expected boundaries and their shapes", where=("shapes",))
        for name, shape in self.shapes.items():
            if not isinstance(shape, Obstacle) and shape not in ("spline", "straight"):
                words = "a shape, 'spline' or 'straight'"
                raise InputError(f"is {shape!r}; expected {words}", where=("shapes", str(name)))


Asked = float | Accuracy | Literal["estimate"]
"""Of a solution: a relative error of the pressures, more of it, or an estimate on the mesh as it is."""
