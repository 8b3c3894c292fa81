# SPDX-License-Identifier: BSD-3-Clause
"""How accurate an answer has to be, and what a finer mesh may cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast, get_args

from signorini.checks import number, whole
from signorini.errors import InputError, one_of
from signorini.model.obstacle import Obstacle
from signorini.model.output_words import EXAMPLES, output_of
from signorini.model.outputs import Output

AccurateIn = Literal["pressure", "traction", "energy"]
"""What is to be accurate: pressures of the contacts, their pressures and frictions, or stresses in the bodies."""


@dataclass(frozen=True)
class Accuracy:
    """An accuracy instead of a mesh: bodies are meshed finer, where it counts, until it is met.

    Parameters
    ----------
    error : relative, > 0; 0.01 is one per cent
    of : "pressure": of all contacts, root of the mean square; "traction": of their friction too; "energy": of the
        stresses in all bodies, in the norm of energy; or an output, ``signorini.pressure("c").peak`` or the words that
        it prints, "peak pressure": of its own size. Its nodes are those of the mesh to begin with
    nodes : most nodes of a mesh that is tried
    memory : most bytes that the process is expected to take with it; None: as many as are free
    seconds : of the clock after which no finer mesh is begun; None: no matter how many
    shapes : boundary to the shape that it stands for and that new nodes go onto: one of those of obstacles; "spline"
        through its nodes, in the plane; "straight", as the mesh has it. Of others a circle, a sphere or a cylinder is
        found where nodes lie on one
    geometry : file that the mesh was made of, ``.geo``, ``.step`` or ``.brep``: new nodes of boundaries without a shape
        go onto its curves and faces, by Gmsh

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
    of: AccurateIn | Output | str = "pressure"
    nodes: int = 200_000
    memory: float | None = None
    seconds: float | None = None
    shapes: Mapping[str, Obstacle | Literal["spline", "straight"]] = field(default_factory=dict)
    geometry: str | Path | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "error", number(self.error, ("error",), above=0.0))
        object.__setattr__(self, "of", _kind(self.of))
        object.__setattr__(self, "nodes", whole(self.nodes, ("nodes",), least=1))
        for name in ("memory", "seconds"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, number(getattr(self, name), (name,), above=0.0))
        if self.geometry is not None:
            object.__setattr__(self, "geometry", str(self.geometry))
        if not isinstance(self.shapes, Mapping):
            raise InputError(f"is {self.shapes!r}; expected boundaries and their shapes", where=("shapes",))
        for name, shape in self.shapes.items():
            if not isinstance(shape, Obstacle) and shape not in ("spline", "straight"):
                words = "a shape, 'spline' or 'straight'"
                raise InputError(f"is {shape!r}; expected {words}", where=("shapes", str(name)))


def _kind(of: object) -> AccurateIn | Output:
    """A norm, or an output by its words."""
    for known in get_args(AccurateIn):
        if of == known:
            return cast(AccurateIn, known)
    if isinstance(of, Output):
        return of
    try:
        return output_of(str(of))
    except InputError as error:
        known = (*get_args(AccurateIn), *EXAMPLES)
        raise InputError(one_of(str(of), known, "kind of accuracy"), where=("of",)) from error


Asked = float | Accuracy | Literal["estimate"]
"""Of a solution: a relative error of the pressures, more of it, or an estimate on the mesh as it is."""
