# SPDX-License-Identifier: BSD-3-Clause
"""B12: the flat punch on a body that yields, with every family of cells that may yield, from above and from below."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from signorini.engine.solve import solve
from signorini.gallery.footings import footing
from signorini.gallery.yielding import SHEAR_STRENGTH
from signorini.model.body import Formulation
from signorini.model.model import Model
from signorini.reference.plasticity import punch_limit
from signorini.verify.check import Check, checks_of
from signorini.verify.limit_loads import limit_load

_EXACT = punch_limit(SHEAR_STRENGTH)
_FIRST_PRESSURE = 1.04  # of the exact limit: none of the meshes carries it
_WITHIN = 0.02  # of the exact limit
_DEPTH = 0.08  # to which the punch is driven, of its half-width


@dataclass(frozen=True)
class Punched:
    """A mesh under the punch.

    Attributes
    ----------
    cells : see `footing`
    edge : size of the cells at the edge of the punch, over its half-width
    formulation : of the cells
    rough : whether the punch holds the surface sideways
    """

    cells: str
    edge: float
    formulation: Formulation | None = None
    rough: bool = False

    def __str__(self) -> str:
        """The mesh in words."""
        named = f"{self.cells}, {self.formulation}" if self.formulation else self.cells
        return f"{'rough' if self.rough else 'smooth'}, {named}, {self.edge:g} of half of it at its edge"

    def model(self, pressure: float = 0.0, *, depth: float = 0.0) -> Model:
        """The body under a mean pressure, or with the punch driven to a depth."""
        return footing(
            pressure, edge=self.edge, cells=self.cells, formulation=self.formulation, depth=depth, rough=self.rough
        )

    def limit(self) -> tuple[float, float]:
        """Mean pressures beyond which flow is proved, and that is carried."""
        return limit_load(partial(self.model), _FIRST_PRESSURE * _EXACT)


IN_THE_PLANE = (
    Punched("quad", 0.03),
    Punched("quad", 0.05, "incompatible"),
    Punched("quad8", 0.1),
    Punched("quad9", 0.12),
    Punched("triangle6", 0.15),
)
"""Meshes under a smooth punch in plane strain."""
ROUGH_IN_THE_PLANE = (
    Punched("quad", 0.01, rough=True),
    Punched("quad", 0.03, "incompatible", rough=True),
    Punched("quad8", 0.04, rough=True),
    Punched("quad9", 0.08, rough=True),
    Punched("triangle6", 0.15, rough=True),
)
"""Meshes under a rough punch, about whose edge strains are as large twice as far."""
IN_SPACE = (
    Punched("hexahedron", 0.02),
    Punched("hexahedron", 0.04, "incompatible"),
    Punched("hexahedron and wedge", 0.01),
    Punched("hexahedron20", 0.06),
    Punched("hexahedron27", 0.1),
    Punched("tetra10", 0.15),
    Punched("wedge15", 0.05),
)
"""A layer of solids; the smaller the cells at the edge, the nearer a limit is to the exact one, in first order."""


def flat_punch() -> Iterator[Check]:
    """A smooth punch, in the plane."""
    yield from _punches(IN_THE_PLANE)


def rough_flat_punch() -> Iterator[Check]:
    """A punch that holds the surface sideways: what flows reaches twice as deep."""
    yield from _punches(ROUGH_IN_THE_PLANE)


def flat_punch_in_space() -> Iterator[Check]:
    """A smooth punch on a layer of solids."""
    yield from _punches(IN_SPACE)


def _punches(meshes: tuple[Punched, ...]) -> Iterator[Check]:
    """The limit load of the mesh from above, a load below it that is carried, and in the plane the punch driven far."""
    for mesh in meshes:
        above, below = mesh.limit()
        rows = [
            ("mean pressure beyond which flow is proved", above, _EXACT, _WITHIN),
            ("mean pressure that is carried", below, _EXACT, _WITHIN),
        ]
        if mesh not in IN_SPACE:
            driven = -solve(mesh.model(depth=_DEPTH)).last.reactions["punch"][1]
            rows.append((f"mean pressure at depth {_DEPTH:g}", driven, _EXACT, _WITHIN))
        yield from checks_of(f"B12 flat punch, {mesh}", *rows, source="Prandtl (1920): (2 + pi) k")
