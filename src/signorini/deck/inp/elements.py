# SPDX-License-Identifier: BSD-3-Clause
"""Element types of Abaqus and CalculiX: what they are here, or why they are not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

from signorini.deck.inp.block import Block
from signorini.model.model import Kind

_PLANES = {"CPE": "plane strain", "CPS": "plane stress", "CAX": "axisymmetric"}
_FAMILIES = {"3": "triangle", "4": "quad", "6": "triangle6", "8": "quad8"}
_SOLIDS = ("C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20")
_VARIANTS = {
    "": "",
    "R": "reduced integration is not used: all elements are integrated fully",
    "I": "",
    "IH": "",
    "H": "",
    "M": "modified formulation is not used: it is an ordinary quadratic triangle",
    "RH": "reduced integration is not used: all elements are integrated fully",
    "T": "temperatures of coupled elements are not unknowns here",
}


@dataclass(frozen=True, kw_only=True)
class ElementType:
    """What an element type is here.

    Attributes
    ----------
    family : of cells, as "quad8"
    kind : of the model, as "plane strain"
    incompatible : with incompatible modes
    note : how it differs from what the deck asks for, empty if it does not
    """

    family: str
    kind: Kind
    incompatible: bool = False
    note: str = ""

    @property
    def nodes(self) -> int:
        """Of an element."""
        return {"triangle": 3, "quad": 4, "triangle6": 6, "quad8": 8}[self.family]

    @property
    def corners(self) -> int:
        """Of an element, and its edges: edge k goes from corner k to corner k + 1."""
        return 3 if self.family.startswith("triangle") else 4


def element_type(block: Block) -> ElementType:
    """The type of an ``*ELEMENT`` keyword.

    Raises
    ------
    DeckError
        For types that this version does not have.
    """
    name = block.value("TYPE", "an element type").upper()
    prefix, size, variant = name[:3], name[3:4], name[4:]
    if prefix in _PLANES and size in _FAMILIES and variant in _VARIANTS:
        note = f"{name}: {_VARIANTS[variant]}" if _VARIANTS[variant] else ""
        if variant.startswith("I") and size != "4":
            raise block.error(f"TYPE={name} is not supported; incompatible modes are for 4 nodes")
        incompatible = variant.startswith("I")
        return ElementType(
            family=_FAMILIES[size], kind=cast(Kind, _PLANES[prefix]), incompatible=incompatible, note=note
        )
    if name.startswith(_SOLIDS):
        raise block.error(f"TYPE={name} is three-dimensional, which this version does not have")
    raise block.error(
        f"TYPE={name} is not supported; expected CPE, CPS or CAX with 3, 4, 6 or 8 nodes (variants R, I, H, M)"
    )
