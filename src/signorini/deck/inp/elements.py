# SPDX-License-Identifier: BSD-3-Clause
"""Element types of Abaqus and CalculiX: what they are here, or why they are not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

from signorini.deck.error import DeckError
from signorini.deck.inp.card import Card
from signorini.model.mesh import CORNERS, NODES_PER_CELL
from signorini.model.model import Kind

_PLANES = {"CPE": "plane strain", "CPS": "plane stress", "CAX": "axisymmetric"}
_PLANE = {"3": "triangle", "4": "quad", "6": "triangle6", "8": "quad8"}
_SOLID = {"4": "tetra", "6": "wedge", "8": "hexahedron", "10": "tetra10", "15": "wedge15", "20": "hexahedron20"}
_LINES = {"line": 2, "line3": 3}  # to their nodes
_SHAPES = {  # of trusses, beams, membranes and shells, which meshers write for edges and faces of bodies
    **dict.fromkeys(("T2D2", "T3D2", "B21", "B31"), "line"),
    **dict.fromkeys(("T2D3", "T3D3", "B22", "B32"), "line3"),
    **{f"{word}{nodes}": family for word in ("S", "M3D") for nodes, family in _PLANE.items()},
}
_FULLY = "reduced integration is not used: all elements are integrated fully"
_VARIANTS = {
    "": "",
    "R": _FULLY,
    "I": "",
    "IH": "",
    "H": "",
    "M": "modified formulation is not used: it is an ordinary quadratic element",
    "MH": "modified formulation is not used: it is an ordinary quadratic element",
    "RH": _FULLY,
    "T": "temperatures of coupled elements are not unknowns here",
}
# faces S1, S2, ... by their corners, from 0
_FACES = {
    "triangle": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "tetra": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "hexahedron": ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
# edges of quadratic solids in the order of the nodes on them
_EDGES = {
    "tetra10": ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
    "wedge15": ((0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5), (0, 3), (1, 4), (2, 5)),
    "hexahedron20": (
        *((0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (5, 6), (6, 7), (4, 7)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
}


@dataclass(frozen=True, kw_only=True)
class ElementType:
    """An element type of a deck as cells of a model.

    Attributes
    ----------
    name : in the deck, in capitals
    family : of cells, as "quad8", or of lines; the order of its nodes is that of decks
    kind : of the model, as "plane strain"; None of lines and shells, of which there is no model
    incompatible : with incompatible modes
    note : how it differs from what the deck asks for, empty if it does not
    """

    name: str
    family: str
    kind: Kind | None
    incompatible: bool = False
    note: str = ""

    @property
    def nodes(self) -> int:
        """Number of nodes of an element."""
        return _LINES.get(self.family) or NODES_PER_CELL[self.family]

    @property
    def dimension(self) -> int:
        """1 for lines, 2 for faces and plane models, 3 for solids."""
        return 1 if self.family in _LINES else 3 if self.kind == "3d" else 2

    @property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Places of the nodes of every face S1, S2, ...: corners; in space the middles of its edges follow."""
        linear = self.family.rstrip("0123456789")
        faces = _FACES[linear]
        if self.family not in _EDGES:
            return faces
        middle = {frozenset(edge): CORNERS[self.family] + k for k, edge in enumerate(_EDGES[self.family])}
        return tuple(
            (*face, *(middle[frozenset((face[i], face[(i + 1) % len(face)]))] for i in range(len(face))))
            for face in faces
        )


def element_type(card: Card) -> ElementType:
    """The type of an ``*ELEMENT`` keyword.

    Raises
    ------
    DeckError
        For types that this version does not have.
    """
    name = card.value("TYPE", "an element type").upper()
    if name.rstrip("R") in _SHAPES:
        return ElementType(name=name, family=_SHAPES[name.rstrip("R")], kind=None)
    solid = name.startswith("C3D")
    size = name[3:].rstrip("RIHMT")
    variant = name[3 + len(size) :]
    family = (_SOLID if solid else _PLANE).get(size)
    if (solid or name[:3] in _PLANES) and family is not None and variant in _VARIANTS:
        if variant.startswith("I") and family not in ("quad", "hexahedron"):
            raise card.error(f"TYPE={name} is not supported; incompatible modes are for 4 nodes, in space 8")
        note = f"{name}: {_VARIANTS[variant]}" if _VARIANTS[variant] else ""
        if family == "wedge15":
            note = note or f"{name}: integrated with 21 points, where CalculiX and Abaqus take 9"
        kind = cast(Kind, "3d" if solid else _PLANES[name[:3]])
        return ElementType(name=name, family=family, kind=kind, incompatible=variant.startswith("I"), note=note)
    raise unknown_type(card)


def unknown_type(card: Card) -> DeckError:
    """The error of an ``*ELEMENT`` keyword whose elements no model has."""
    return card.error(
        f"TYPE={card.get('TYPE')} is not supported; expected CPE, CPS or CAX with 3, 4, 6 or 8 nodes, or C3D with 4, "
        "6, 8, 10, 15 or 20 (variants R, I, H, M)"
    )
