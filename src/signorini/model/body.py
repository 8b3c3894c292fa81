# SPDX-License-Identifier: BSD-3-Clause
"""Bodies: parts of the mesh, of one material each."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from signorini.arrays import IntArray
from signorini.checks import choice, number, text
from signorini.errors import InputError, Where
from signorini.model.material import Elastic, Material, Orthotropic
from signorini.model.mesh import Mesh

Formulation = Literal["standard", "incompatible", "mean dilatation"]
"""Of cells."""

_LINEAR = {"triangle", "quad", "tetra", "hexahedron", "wedge"}
_BRICKS = {"quad", "hexahedron"}  # which have internal modes
_SIMPLICES = {"triangle", "tetra"}
_MOST_WEDGES = (
    0.1  # of the cells of a body: limit loads are up to 4 % higher then, and bodies of wedges alone have none
)


def locking_families(families: Mapping[str, int]) -> set[str]:
    """Linear families that cannot keep the volume of a body with a mean dilatation either.

    Triangles and tetrahedra, and wedges unless there are a few among hexahedra, as meshers put them around an axis.

    Parameters
    ----------
    families : of the cells of the body, and how many there are of each

    Examples
    --------
    >>> locking_families({"hexahedron": 90, "wedge": 10}), locking_families({"hexahedron": 10, "wedge": 20})
    (set(), {'wedge'})
    """
    found = _SIMPLICES & families.keys()
    if families.get("wedge", 0) > _MOST_WEDGES * sum(families.values()):
        found.add("wedge")
    return found


@dataclass(frozen=True)
class Body:
    """A named part of the mesh and its material.

    Parameters
    ----------
    name : body of the mesh (physical group, or what the generator calls it)
    material : what it is made of
    formulation : of its cells: "standard"; "incompatible": linear quadrilaterals with two modes more a cell, hexahedra
        with three, so that thin bodies bend as they should; "mean dilatation" for nearly incompressible materials, and
        for those that yield, whose flow keeps the volume. None is "standard"; where the material yields the model
        chooses, see `in_kind`
    thickness : out of plane, length, of plane models; None is the model's. Bodies lie on one middle plane, so that
        two touch over the smaller of their thicknesses

    Examples
    --------
    >>> Body("beam", Elastic(E=1.0, nu=0.3), formulation="incompatible").formulation
    'incompatible'
    >>> Body("beam", Elastic(E=1.0, nu=0.3)).formulation
    'standard'
    """

    name: str
    material: Material
    formulation: Formulation | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        if not isinstance(self.material, Elastic | Orthotropic):
            raise InputError(f"is {self.material!r}; expected an Elastic or Orthotropic material", where=("material",))
        if self.formulation is None and not self.material.yields:
            object.__setattr__(self, "formulation", "standard")
        if self.formulation is not None:
            choice(self.formulation, get_args(Formulation), ("formulation",), "formulation")
        if self.thickness is not None:
            object.__setattr__(self, "thickness", number(self.thickness, ("thickness",), above=0.0))

    def in_kind(self, kind: str, families: Collection[str] = ()) -> Body:
        """The body with the formulation that it has in a kind of model.

        Flow keeps the volume, so that a body that yields has a mean dilatation where none is named; in plane stress its
        thickness gives way, and it is standard, as are quadratic wedges, which have no mean dilatation and do not lock.

        Parameters
        ----------
        kind : of the model
        families : of the cells of the body
        """
        if self.formulation is not None:
            return self
        standard = kind == "plane stress" or "wedge15" in families
        return replace(self, formulation="standard" if standard else "mean dilatation")

    def formulation_in(self, family: str) -> Formulation:
        """The formulation of its cells of a family: those that have no internal modes are standard.

        Parameters
        ----------
        family : of cells
        """
        if self.formulation is None or (self.formulation == "incompatible" and family not in _BRICKS):
            return "standard"
        return self.formulation

    def check_flow(self, where: Where, kind: str, families: Mapping[str, int]) -> None:
        """Refuse what a body that yields cannot be.

        Parameters
        ----------
        where : path of the body in the model
        kind : of the model
        families : of its cells, and how many there are of each

        Raises
        ------
        InputError
            Where its cells would lock: flow keeps the volume, and cells that cannot do so without becoming rigid have
            too high a limit load, or none. In plane stress the thickness gives way.
        """
        found, where_cells = " and ".join(sorted(families)), (*where, "formulation")
        if kind == "plane stress":
            return
        if locking_families(families) or (self.formulation == "incompatible" and "wedge" in families):
            few = "; with 'mean dilatation' a tenth of the cells wedges at most" if "hexahedron" in families else ""
            raise InputError(
                f"'{self.name}' yields: its cells ({found}) would lock where it flows. Expected quadrilaterals, "
                f"hexahedra or quadratic cells{few}",
                where=where_cells,
            )
        if self.formulation == "standard" and _LINEAR & families.keys():
            raise InputError(
                f"is 'standard', but '{self.name}' yields: its cells ({found}) would lock where it flows. Expected "
                "'mean dilatation'",
                where=where_cells,
            )
        if self.formulation == "mean dilatation" and "wedge15" in families:
            raise InputError(
                f"'{self.name}' yields and has wedge15 cells, which have no mean dilatation; expected 'standard'",
                where=where_cells,
            )


def refuse_other_owners(mesh: Mesh, count: IntArray) -> None:
    """Refuse cells that do not belong to exactly one body.

    Parameters
    ----------
    mesh : of the cells
    count : (m,) of the bodies that every cell belongs to

    Raises
    ------
    InputError
        For the first such cell.
    """
    if (count == 1).all():
        return
    cell = int(np.nonzero(count != 1)[0][0])
    names = [name for name, cells in mesh.bodies.items() if cell in cells]
    if count[cell]:
        words = f"belongs to several bodies: {', '.join(names)}"
    else:
        of = f"it is in {' and '.join(names)}" if names else "it is in no named part of the mesh"
        words = f"belongs to no body ({of}); give it a body and a material"
    raise InputError(f"{mesh.cell_name(cell)} {words}", where=("body",), cell=cell)
