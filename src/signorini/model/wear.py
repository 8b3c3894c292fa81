# SPDX-License-Identifier: BSD-3-Clause
"""How the sides of a contact wear where they slide on each other."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.checks import number
from signorini.errors import InputError


@dataclass(frozen=True)
class Wear:
    """Material that sliding takes from the sides of a contact, each with a coefficient of its own.

    Archard's law with ``coefficient`` k: the worn depth grows by ``k p |ds|``, pressure times distance slid; or by
    ``energy`` alpha: by ``alpha |q| |ds|``, the work of friction per area. What is worn is gone: debris neither carries
    nor rubs.

    Parameters
    ----------
    coefficient : Archard's k of the nonmortar side (of the first one with ``Contact.between``), area per force, >= 0:
        worn volume over force and distance
    energy : alpha in its place, volume per work, area per force, >= 0
    mortar : the same of the other side, >= 0; a rigid obstacle does not wear
    move_mesh : share of the height of a cell, > 0: where a side is worn by more than that since the mesh moved last,
        the nodes of both sides, and with them those of the bodies, move by what is worn; None (default): gaps alone
        know it

    Examples
    --------
    >>> Wear(2.9e-8, mortar=1.9e-8).by_energy, Wear(energy=4.0e-8).nonmortar
    (False, 4e-08)
    """

    coefficient: float | None = None
    energy: float | None = None
    mortar: float = 0.0
    move_mesh: float | None = None

    def __post_init__(self) -> None:
        if (self.coefficient is None) == (self.energy is None):
            found = "neither" if self.coefficient is None else "both"
            raise InputError(f"has {found} of coefficient and energy; expected one of them")
        key = "energy" if self.by_energy else "coefficient"
        object.__setattr__(self, key, number(getattr(self, key), (key,), least=0.0))
        object.__setattr__(self, "mortar", number(self.mortar, ("mortar",), least=0.0))
        if self.move_mesh is not None:
            object.__setattr__(self, "move_mesh", number(self.move_mesh, ("move_mesh",), above=0.0))
        if self.nonmortar == self.mortar == 0.0:
            raise InputError("is 0 on both sides, and nothing wears; expected a coefficient > 0")

    @property
    def by_energy(self) -> bool:
        """Whether the work of friction wears, not pressure and distance."""
        return self.energy is not None

    @property
    def nonmortar(self) -> float:
        """The coefficient of the nonmortar side, as the contact names it, area per force."""
        found = self.energy if self.by_energy else self.coefficient
        assert found is not None
        return found
