# SPDX-License-Identifier: BSD-3-Clause
"""Fatigue criteria as users give them: their constants, and the names of decks."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar

from signorini.checks import number
from signorini.errors import InputError

_LIFE = ("strength", "strength_exponent", "ductility", "ductility_exponent")


@dataclass(frozen=True)
class FatigueCriterion:
    """A fatigue criterion: a frozen dataclass whose fields are its constants, checked when it is made.

    Attributes
    ----------
    name : in decks
    terms : what its two terms are, an amplitude and a stress
    """

    name: ClassVar[str] = ""
    terms: ClassVar[tuple[str, str]] = ("", "")

    @property
    def table(self) -> dict[str, Any]:
        """What a deck says of it."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        return {"name": self.name} | {key: value for key, value in given.items() if value is not None}

    @property
    def words(self) -> str:
        """What `check` says of it."""
        parts = (f"{key.replace('_', ' ')} {value:g}" for key, value in self.table.items() if key != "name")
        return ", ".join([self.name, *parts])


@dataclass(frozen=True, kw_only=True)
class StrainLife(FatigueCriterion):
    """A criterion whose parameter stands for a life; its constants are those of Basquin and of Manson and Coffin.

    Parameters
    ----------
    strength : fatigue strength coefficient, force per area, > 0
    strength_exponent : b < 0
    ductility : fatigue ductility coefficient, a strain, > 0
    ductility_exponent : c < 0; all four, or none where a parameter is enough
    """

    strength: float | None = None
    strength_exponent: float | None = None
    ductility: float | None = None
    ductility_exponent: float | None = None

    def __post_init__(self) -> None:
        given = [key for key in _LIFE if getattr(self, key) is not None]
        for key in _LIFE if given else ():
            if key not in given:
                words = f"is missing beside {', '.join(given)}; expected all four constants of the life, or none"
                raise InputError(words, where=(key,))
            limit = {"below": 0.0} if key.endswith("exponent") else {"above": 0.0}
            object.__setattr__(self, key, number(getattr(self, key), (key,), **limit))

    @property
    def lives(self) -> bool:
        """Whether it has the constants of a life."""
        return self.strength is not None

    @property
    def constants(self) -> tuple[float, float, float, float]:
        """Strength, its exponent, ductility and its exponent, of a criterion that has them."""
        strength, b, ductility, c = (getattr(self, key) for key in _LIFE)
        return float(strength), float(b), float(ductility), float(c)


@dataclass(frozen=True, kw_only=True)
class SWT(StrainLife):
    """Smith, Watson and Topper on the plane where it is largest: ``max(sigma_n, 0) eps_a``, force per area.

    The largest normal stress on a plane times the amplitude of its normal strain. With constants the life N in cycles::

        sigma_n,max eps_a = sigma_f^2 / E (2 N)^(2 b) + sigma_f eps_f (2 N)^(b + c)

    References
    ----------
    Smith, Watson, Topper (1970), J. Mater. 5, 767; on planes: Socie (1987), J. Eng. Mater. Technol. 109, 293.

    Examples
    --------
    >>> SWT(strength=1015.0, strength_exponent=-0.11, ductility=0.3, ductility_exponent=0.5)
    Traceback (most recent call last):
    signorini.errors.InputError: ductility_exponent: is 0.5; expected a number < 0
    """

    name: ClassVar[str] = "SWT"
    terms: ClassVar[tuple[str, str]] = ("amplitude of the normal strain", "largest normal stress")


@dataclass(frozen=True, kw_only=True)
class FatemiSocie(StrainLife):
    """Fatemi and Socie on the plane where it is largest: ``gamma_a max(1 + k sigma_n,max / sigma_y, 0)``, a strain.

    The amplitude of the shear strain on a plane (engineering strain; the radius of the smallest circle around its path)
    and the largest normal stress there. With constants, those of shear, the life N in cycles::

        gamma_a (1 + k sigma_n,max / sigma_y) = tau_f / G (2 N)^b + gamma_f (2 N)^c

    Parameters
    ----------
    yield_stress : sigma_y, force per area, > 0
    sensitivity : k to the normal stress, >= 0

    References
    ----------
    Fatemi, Socie (1988), Fatigue Fract. Eng. Mater. Struct. 11, 149.
    """

    name: ClassVar[str] = "Fatemi-Socie"
    terms: ClassVar[tuple[str, str]] = ("amplitude of the shear strain", "largest normal stress")

    yield_stress: float
    sensitivity: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "yield_stress", number(self.yield_stress, ("yield_stress",), above=0.0))
        object.__setattr__(self, "sensitivity", number(self.sensitivity, ("sensitivity",), least=0.0))


@dataclass(frozen=True, kw_only=True)
class FatigueLimits(FatigueCriterion):
    """A criterion of endurance: 1 at the limit in reversed bending and in reversed torsion alike, below it no crack.

    Parameters
    ----------
    bending_limit : stress amplitude f that reversed bending endures, force per area, > 0
    torsion_limit : shear stress amplitude t that reversed torsion endures, force per area
    """

    least_ratio: ClassVar[float] = 0.0

    bending_limit: float
    torsion_limit: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "bending_limit", number(self.bending_limit, ("bending_limit",), above=0.0))
        least = self.least_ratio * self.bending_limit
        object.__setattr__(self, "torsion_limit", number(self.torsion_limit, ("torsion_limit",), least=least))


@dataclass(frozen=True, kw_only=True)
class Crossland(FatigueLimits):
    """Crossland: ``(sqrt(J2)_a + (3 t / f - sqrt(3)) sigma_h,max) / t``, at most 1 where nothing cracks.

    ``sqrt(J2)_a`` is the radius of the smallest ball around the path of the deviator s, in the norm ``sqrt(s:s / 2)``;
    sigma_h the hydrostatic stress. t is at least f / sqrt(3).

    References
    ----------
    Crossland (1956), Proc. Int. Conf. Fatigue of Metals, London, 138; the ball: Papadopoulos (1994), Int. J. Fatigue
    16, 377.
    """

    name: ClassVar[str] = "Crossland"
    terms: ClassVar[tuple[str, str]] = ("amplitude of sqrt(J2)", "largest hydrostatic stress")
    least_ratio: ClassVar[float] = 1.0 / math.sqrt(3.0)

    @property
    def slope(self) -> float:
        """What the hydrostatic stress counts for."""
        return 3.0 * self.torsion_limit / self.bending_limit - math.sqrt(3.0)


@dataclass(frozen=True, kw_only=True)
class DangVan(FatigueLimits):
    """Dang Van: ``max over time of (tau(t) + (3 t / f - 3/2) sigma_h(t)) / t``, at most 1 where nothing cracks.

    tau(t) is Tresca's shear stress of the grains that have shaken down: of the deviator less the centre of the smallest
    ball around its path; sigma_h the hydrostatic stress. The torsion limit t is at least f / 2.

    References
    ----------
    Dang Van, Cailletaud, Flavenot, Le Douaron, Lieurade (1989), in: Biaxial and Multiaxial Fatigue, EGF 3, 459.
    """

    name: ClassVar[str] = "Dang Van"
    terms: ClassVar[tuple[str, str]] = ("shear stress of the grains", "hydrostatic stress at that time")
    least_ratio: ClassVar[float] = 0.5

    @property
    def slope(self) -> float:
        """What the hydrostatic stress counts for."""
        return 3.0 * self.torsion_limit / self.bending_limit - 1.5


@dataclass(frozen=True, kw_only=True)
class Ruiz(FatigueCriterion):
    """Ruiz on contacts: ``F1 = q_max delta`` and ``F2 = delta max over time of (sigma_T q)``, which is the parameter.

    q is the friction (force per area), delta the amplitude of the slip (length; half its range, in space the radius of
    the smallest circle around its path), sigma_T the largest normal stress along the surface, 0 where it is pressed.
    F1 has the units of force over length, F2 those of F1 times stress.

    References
    ----------
    Ruiz, Boddington, Chen (1984), Exp. Mech. 24, 208.
    """

    name: ClassVar[str] = "Ruiz"
    terms: ClassVar[tuple[str, str]] = ("F1", "largest stress along the surface")


CRITERIA: dict[str, type[FatigueCriterion]] = {kind.name: kind for kind in (SWT, FatemiSocie, Crossland, DangVan, Ruiz)}
"""Criteria that decks name."""
