# SPDX-License-Identifier: BSD-3-Clause
"""Bodies: parts of the mesh, of one material each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from signorini.checks import choice, number, text
from signorini.errors import InputError
from signorini.model.material import Elastic, Material, Orthotropic


@dataclass(frozen=True)
class Body:
    """A named part of the mesh and its material.

    Parameters
    ----------
    name : body of the mesh (physical group, or what the generator calls it)
    material : what it is made of
    formulation : of its cells: "standard"; "incompatible": linear quadrilaterals with two modes more a cell, hexahedra
        with three, so that thin bodies bend as they should; "mean dilatation" for nearly incompressible materials
    thickness : out of plane, length, of plane models; None is the model's. Bodies lie on one middle plane, so that
        two touch over the smaller of their thicknesses

    Examples
    --------
    >>> Body("beam", Elastic(E=1.0, nu=0.3), formulation="incompatible").formulation
    'incompatible'
    """

    name: str
    material: Material
    formulation: Literal["standard", "incompatible", "mean dilatation"] = "standard"
    thickness: float | None = None

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        if not isinstance(self.material, Elastic | Orthotropic):
            raise InputError(f"is {self.material!r}; expected an Elastic or Orthotropic material", where=("material",))
        choice(self.formulation, ("standard", "incompatible", "mean dilatation"), ("formulation",), "formulation")
        if self.thickness is not None:
            object.__setattr__(self, "thickness", number(self.thickness, ("thickness",), above=0.0))
