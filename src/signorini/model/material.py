# SPDX-License-Identifier: BSD-3-Clause
"""What bodies are made of: linear elastic, isotropic or orthotropic; isotropic ones may yield."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.checks import number
from signorini.errors import InputError
from signorini.model.plastic import Plastic


@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elasticity, ``sigma = lambda tr(eps) I + 2 G eps``; where it yields, of the elastic strain.

    Parameters
    ----------
    E : Young's modulus, force per area, > 0
    nu : Poisson's ratio, -1 < nu < 0.5
    density : mass per volume, >= 0; gravity and centrifugal loads need it
    expansion : thermal strain per temperature
    plastic : how it yields; None (default) if it does not

    Examples
    --------
    >>> round(Elastic(E=210e3, nu=0.3).shear_modulus)
    80769
    >>> print(Elastic(E=210e3, nu=0.3, plastic=Plastic(235.0)))
    E 210000, nu 0.3, yields at 235
    """

    E: float
    nu: float
    density: float = 0.0
    expansion: float = 0.0
    plastic: Plastic | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "E", number(self.E, ("E",), above=0.0))
        object.__setattr__(self, "nu", number(self.nu, ("nu",), above=-1.0, below=0.5))
        object.__setattr__(self, "density", number(self.density, ("density",), least=0.0))
        object.__setattr__(self, "expansion", number(self.expansion, ("expansion",)))
        if not isinstance(self.plastic, Plastic | None):
            raise InputError(f"is {self.plastic!r}; expected a Plastic or None", where=("plastic",))

    @property
    def shear_modulus(self) -> float:
        """``G = E / (2 (1 + nu))``, force per area."""
        return self.E / (2.0 * (1.0 + self.nu))

    @property
    def bulk_modulus(self) -> float:
        """Mean pressure per volume strain, ``E / (3 (1 - 2 nu))``, force per area."""
        return self.E / (3.0 * (1.0 - 2.0 * self.nu))

    @property
    def smallest_modulus(self) -> float:
        """The smallest Young's modulus of any direction, force per area."""
        return self.E

    @property
    def expands(self) -> bool:
        """Whether temperature strains it."""
        return self.expansion != 0.0

    @property
    def feels_heat(self) -> bool:
        """Whether temperature strains it or changes how it yields."""
        return self.expands or (self.plastic is not None and self.plastic.varies_with_heat)

    @property
    def yields(self) -> bool:
        """Whether it is plastic beyond some stress."""
        return self.plastic is not None

    def __str__(self) -> str:
        return f"E {self.E:g}, nu {self.nu:g}" + (f", {self.plastic}" if self.plastic else "")


@dataclass(frozen=True, kw_only=True)
class Orthotropic:
    """Linear elasticity with three planes of symmetry; the axes 1 and 2 are in the plane of the model, 3 across it.

    ``eps_1 = sigma_1 / E1 - nu12 sigma_2 / E1 - nu13 sigma_3 / E1``, ``eps_2 = sigma_2 / E2 - nu12 sigma_1 / E1 - nu23
    sigma_3 / E2``, and so on; ``gamma_12 = sigma_12 / G12``. In an axisymmetric model 3 is the hoop direction.

    Parameters
    ----------
    E1, E2, E3 : Young's moduli, force per area, > 0
    nu12, nu13, nu23 : Poisson's ratios: nu12 is the contraction along 2 under tension along 1
    G12 : shear modulus, force per area, > 0
    G13, G23 : the same across the plane, which solid models need
    angle : from the x axis to the axis 1, about z, counterclockwise, degrees
    density : mass per volume, >= 0
    expansion1, expansion2, expansion3 : thermal strain per temperature along the axes

    Raises
    ------
    InputError
        If some stress would have no positive strain energy.

    Examples
    --------
    >>> Orthotropic(E1=140e3, E2=10e3, E3=10e3, nu12=0.3, nu13=0.3, nu23=0.45, G12=5e3, angle=30).smallest_modulus
    10000.0
    """

    E1: float
    E2: float
    E3: float
    nu12: float
    nu13: float
    nu23: float
    G12: float
    angle: float = 0.0
    density: float = 0.0
    expansion1: float = 0.0
    expansion2: float = 0.0
    expansion3: float = 0.0
    G13: float | None = None
    G23: float | None = None

    def __post_init__(self) -> None:
        for key in ("E1", "E2", "E3", "G12", "G13", "G23"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, number(getattr(self, key), (key,), above=0.0))
        for key in ("nu12", "nu13", "nu23", "angle", "expansion1", "expansion2", "expansion3"):
            object.__setattr__(self, key, number(getattr(self, key), (key,)))
        object.__setattr__(self, "density", number(self.density, ("density",), least=0.0))
        for ratio, one, two in (("nu12", "E1", "E2"), ("nu13", "E1", "E3"), ("nu23", "E2", "E3")):
            value, limit = getattr(self, ratio), (getattr(self, one) / getattr(self, two)) ** 0.5
            if abs(value) >= limit:
                raise InputError(
                    f"is {value:g}; expected a size below sqrt({one} / {two}) = {limit:g}, or a stress has no positive "
                    "energy",
                    where=(ratio,),
                )
        if self._determinant <= 0.0:
            raise InputError(
                f"nu12 = {self.nu12:g}, nu13 = {self.nu13:g} and nu23 = {self.nu23:g} together leave a stress without "
                "positive energy (1 - nu12^2 E2/E1 - nu13^2 E3/E1 - nu23^2 E3/E2 - 2 nu12 nu13 nu23 E3/E1 = "
                f"{self._determinant:.3g}); expected smaller ratios"
            )

    @property
    def solid(self) -> bool:
        """Whether the shear moduli of all planes are given."""
        return self.G13 is not None and self.G23 is not None

    @property
    def _determinant(self) -> float:
        """Of the normal compliances, times E1 E2 E3."""
        squares = self.nu12**2 * self.E2 / self.E1 + self.nu13**2 * self.E3 / self.E1 + self.nu23**2 * self.E3 / self.E2
        return 1.0 - squares - 2.0 * self.nu12 * self.nu13 * self.nu23 * self.E3 / self.E1

    @property
    def shear_modulus(self) -> float:
        """G12, force per area."""
        return self.G12

    @property
    def bulk_modulus(self) -> float:
        """Pressure per volume strain, force per area."""
        normal = 1.0 / self.E1 + 1.0 / self.E2 + 1.0 / self.E3
        cross = self.nu12 / self.E1 + self.nu13 / self.E1 + self.nu23 / self.E2
        return 1.0 / (normal - 2.0 * cross)

    @property
    def smallest_modulus(self) -> float:
        """The smallest Young's modulus along an axis, force per area."""
        return min(self.E1, self.E2, self.E3)

    @property
    def expands(self) -> bool:
        """Whether temperature strains it."""
        return any((self.expansion1, self.expansion2, self.expansion3))

    @property
    def feels_heat(self) -> bool:
        """Whether temperature strains it: it does not yield."""
        return self.expands

    @property
    def yields(self) -> bool:
        """Whether it is plastic beyond some stress: no orthotropic material is."""
        return False

    def __str__(self) -> str:
        return f"E {self.E1:g}, {self.E2:g}, {self.E3:g} at {self.angle:g} degrees"


Material = Elastic | Orthotropic
