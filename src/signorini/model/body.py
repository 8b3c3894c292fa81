# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and what they are made of."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.checks import number, text
from signorini.errors import InputError


@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elasticity, ``sigma = lambda tr(eps) I + 2 G eps``.

    Parameters
    ----------
    E : Young's modulus, force per area, > 0
    nu : Poisson's ratio, -1 < nu < 0.5

    Examples
    --------
    >>> round(Elastic(E=210e3, nu=0.3).shear_modulus)
    80769
    """

    E: float
    nu: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "E", number(self.E, ("E",), above=0.0))
        object.__setattr__(self, "nu", number(self.nu, ("nu",), above=-1.0, below=0.5))

    @property
    def shear_modulus(self) -> float:
        """``G = E / (2 (1 + nu))``, force per area."""
        return self.E / (2.0 * (1.0 + self.nu))


@dataclass(frozen=True)
class Body:
    """A named part of the mesh and its material.

    Parameters
    ----------
    name : body of the mesh (physical group, or what the generator calls it)
    material : what it is made of
    """

    name: str
    material: Elastic

    def __post_init__(self) -> None:
        text(self.name, ("name",))
        if not isinstance(self.material, Elastic):
            raise InputError(f"is {self.material!r}; expected an Elastic material", where=("material",))
