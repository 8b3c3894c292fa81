# SPDX-License-Identifier: BSD-3-Clause
"""Bodies: parts of the mesh, of one material each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from signorini.checks import choice, text
from signorini.errors import InputError
from signorini.model.material import Elastic, Material, Orthotropic


@dataclass(frozen=True)
class Body:
    """A named part of the mesh and its material.

    Parameters
    ----------
    name : body of the mesh (physical group, or what the generator calls it)
    material : what it is made of
    formulation : of its linear quadrilaterals: "standard", or "incompatible" with two modes more a cell, so that thin
        bodies bend and incompressible ones deform as they should

    Examples
    --------
    >>> Body("beam", Elastic(E=1.0, nu=0.3), formulation="incompatible").formulation
    'incompatible'
    """

    name: str
    material: Material
    formulation: Literal["standard", "incompatible"] = "standard"

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        if not isinstance(self.material, Elastic | Orthotropic):
            raise InputError(f"is {self.material!r}; expected an Elastic or Orthotropic material", where=("material",))
        choice(self.formulation, ("standard", "incompatible"), ("formulation",), "formulation")
