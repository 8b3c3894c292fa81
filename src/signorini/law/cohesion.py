# SPDX-License-Identifier: BSD-3-Clause
"""Bonds between the sides of a contact: what they bear in tension, up to a strength, and how they let go.

A bond that holds is rigid beside the interface's own compliance, which is in series. From its strength on its tension
falls along a straight line to zero at an opening, or at once. The damage is how much of that opening it has seen at
most: bonds that close again go back to no tension in proportion to the opening, and up the same way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.checks import choice, number
from signorini.errors import InputError

_TOUCHING = 1e-9  # of the size of the bodies: a gap of sides that touch
_GONE = 1e-10  # of the opening at which a bond is gone: less short of it is rounding
_UNHARMED = 1e-12  # of the opening at which a bond is gone: less is rounding


@dataclass(frozen=True)
class Cohesion:
    """A bond between sides that touch at the beginning: they pull on each other up to a strength.

    While it holds the sides do not part, nor slide, but for the compliances of the contact. Then its tension falls to
    zero, and what is left is the contact as it is without a bond.

    Parameters
    ----------
    strength : the most tension, force per area, > 0
    opening : at which nothing is left of the bond, length, >= 0, beyond the closed state where the contact has no
        compliance, and from no tension on where it has; 0 (default): it lets go at once
    shear : "held": while it holds the sides do not slide (default), or "free": they do without friction, as on a plane
        of symmetry, where the sides are one
    shear_strength : the most force along the sides, force per area, > 0: a bond that lets go at once does so
        there too; of one that softens a history ends there by name. None (default): no limit

    Examples
    --------
    >>> Cohesion(5.0, opening=0.02).energy, Cohesion.by_energy(5.0, energy=0.05).opening
    (0.05, 0.02)
    """

    strength: float
    opening: float = 0.0
    shear: Literal["held", "free"] = "held"
    shear_strength: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "strength", number(self.strength, ("strength",), above=0.0))
        object.__setattr__(self, "opening", number(self.opening, ("opening",), least=0.0))
        choice(self.shear, ("held", "free"), ("shear",), "shear")
        if self.shear_strength is not None:
            if self.shear == "free":
                raise InputError('is given, but the sides are "free" to slide', where=("shear_strength",))
            object.__setattr__(self, "shear_strength", number(self.shear_strength, ("shear_strength",), above=0.0))

    @classmethod
    def by_energy(
        cls,
        strength: float,
        *,
        energy: float,
        shear: Literal["held", "free"] = "held",
        shear_strength: float | None = None,
    ) -> Self:
        """A bond by the energy per area, > 0, that it takes to open it for good: half of strength times opening.

        Parameters
        ----------
        strength : the most tension, force per area
        energy : per area
        shear, shear_strength : as of the bond itself
        """
        most = number(strength, ("strength",), above=0.0)
        return cls(most, 2.0 * number(energy, ("energy",), above=0.0) / most, shear, shear_strength)

    @property
    def energy(self) -> float:
        """Per area that its opening takes."""
        return 0.5 * self.strength * self.opening

    @property
    def table(self) -> dict[str, Any]:
        """What a deck says of it."""
        opening = {"opening": self.opening} if self.opening else {}
        along = {} if self.shear_strength is None else {"shear_strength": self.shear_strength}
        return {"strength": self.strength} | opening | ({"shear": self.shear} if self.shear == "free" else along)

    @property
    def words(self) -> str:
        """What `check` says of it."""
        how = f"gone at an opening of {self.opening:g}" if self.opening else "lets go at once"
        slides = ", free to slide" if self.shear == "free" else ""
        if self.shear_strength is not None:
            slides = f" and a shear of {self.shear_strength:g}"
        return f"bonded up to a tension of {self.strength:g}{slides}, {how}"


@dataclass(frozen=True, kw_only=True, eq=False)
class Bonds:
    """What bonds remember.

    Attributes
    ----------
    damage : (n,) the largest opening over that at which they are gone, 0 .. 1; 1 where there is none
    taken : (n,) energy that they have taken for good
    loose : (n,) those that have reached their strength and hold the sides from sliding no more
    """

    damage: Array
    taken: Array
    loose: BoolArray


@dataclass(frozen=True, kw_only=True, eq=False)
class PairCohesion:
    """The bonds of n pairs.

    Attributes
    ----------
    most : (n,) tension that they bear, force; 0 where there is no bond
    opening : (n,) at which they are gone, length
    sticks : (n,) those that hold sides from sliding too
    along : (n,) force along the sides that they bear

    Examples
    --------
    >>> two, endless = np.array([2.0, 0.0]), np.full(2, np.inf)
    >>> pairs = PairCohesion(most=two, opening=np.array([0.1, 0.0]), sticks=np.ones(2, bool), along=endless)
    >>> bonds = pairs.unharmed
    >>> bonds = pairs.after(bonds, np.array([0.05, 0.3]))
    >>> bonds.damage.tolist(), bonds.taken.tolist(), pairs.tension(bonds, np.array([0.025, 0.3])).tolist()
    ([0.5, 1.0], [0.05, 0.0], [0.5, 0.0])
    """

    most: Array
    opening: Array
    sticks: BoolArray
    along: Array

    @property
    def unharmed(self) -> Bonds:
        """Nothing has happened yet."""
        none = self.most == 0.0
        return Bonds(damage=frozen(none), taken=frozen(np.zeros_like(self.most)), loose=frozen(none, np.bool_))

    def holds(self, bonds: Bonds) -> BoolArray:
        """(n,) Bonds that have not begun to open."""
        return np.asarray((self.most > 0.0) & (bonds.damage == 0.0))

    def sticking(self, bonds: Bonds) -> BoolArray:
        """(n,) Bonds that hold the sides from sliding too."""
        return self.holds(bonds) & self.sticks & ~bonds.loose

    def after(self, bonds: Bonds, gap: Array, gone: BoolArray | None = None, sheared: BoolArray | None = None) -> Bonds:
        """What bonds remember after openings.

        Parameters
        ----------
        bonds : what they remembered
        gap : (n,) openings, length; NaN where nobody has looked
        gone, sheared : (n,) those that have let go at once, all of them or along the sides
        """
        seen = np.divide(gap, self.opening, out=np.zeros_like(gap), where=self.opening > 0.0)
        seen = np.where(np.isfinite(seen) & (seen > _UNHARMED), np.minimum(seen, 1.0), 0.0)
        damage = np.maximum(bonds.damage, np.where(seen > 1.0 - _GONE, 1.0, seen))
        if gone is not None:
            damage = np.where(gone, 1.0, damage)
        loose = bonds.loose if sheared is None else frozen(bonds.loose | sheared, np.bool_)
        return Bonds(damage=frozen(damage), taken=frozen(0.5 * self.most * self.opening * damage), loose=loose)

    def tension(self, bonds: Bonds, gap: Array) -> Array:
        """(n,) The most tension, force, that bonds bear at openings (n,): on the line of their damage where they open.

        Beyond the opening that the damage says, on the line on which it grows.
        """
        span = np.where(self.opening > 0.0, self.opening, 1.0)
        seen = np.maximum(bonds.damage, np.clip(np.where(self.opening > 0.0, gap / span, 0.0), 0.0, 1.0))
        limit = self.most * (1.0 - seen)
        part = np.divide(gap, seen * span, out=np.ones_like(gap), where=(seen > 0.0) & (seen < 1.0))
        return np.asarray(limit * np.clip(part, 0.0, 1.0))

    def among(self, kept: BoolArray) -> PairCohesion:
        """The bonds of the kept pairs, (n,)."""
        names = ("most", "opening", "sticks", "along")
        return replace(self, **{name: getattr(self, name)[kept] for name in names})

    @property
    def parameters(self) -> dict[str, Array]:
        """(n,) What there is of every pair by name."""
        shear = np.where(self.sticks, self.along, 0.0)
        return {"tension that a bond bears": self.most, "opening of a bond": self.opening, "shear of a bond": shear}


def bonded(
    cohesions: Sequence[Cohesion | None], contact: IntArray, gap: Array, area: Array, size: float
) -> tuple[Array, PairCohesion]:
    """Gaps of pairs, of those that are bonded without rounding, and their bonds: pairs that touch have one.

    Parameters
    ----------
    cohesions : of every contact
    contact, gap, area : (n,) of every pair
    size : of the bodies, length

    Raises
    ------
    InputError
        Where no pair of a contact touches, with its index.
    """
    strength, opening = (
        np.array([getattr(cohesion, name, 0.0) for cohesion in cohesions])[contact] for name in ("strength", "opening")
    )
    there = (strength > 0.0) & (gap <= _TOUCHING * size)
    for i in np.flatnonzero([cohesion is not None for cohesion in cohesions]):
        if not there[contact == i].any():
            words = 'bonds nothing: no pair touches at the beginning; expected sides that do, or gap = "zero"'
            raise InputError(words, where=("contact", int(i), "cohesion"))
    most = np.where(there, strength * area, 0.0)
    sticks = np.array([cohesion is not None and cohesion.shear == "held" for cohesion in cohesions])[contact]
    limits = [None if cohesion is None else cohesion.shear_strength for cohesion in cohesions]
    along = np.array([np.inf if limit is None else limit for limit in limits])[contact] * area
    pairs = PairCohesion(
        most=frozen(most),
        opening=frozen(np.where(there, opening, 0.0)),
        sticks=frozen(there & sticks, np.bool_),
        along=frozen(along),
    )
    return np.where(there & (gap > -_TOUCHING * size), 0.0, gap), pairs
