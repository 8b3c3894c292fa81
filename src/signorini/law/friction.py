# SPDX-License-Identifier: BSD-3-Clause
"""Laws of friction as contacts have them: their parameters, the bound of pairs that have these, and the names of decks.

A new law is a class here and its name in `LAWS`. A contact takes a value of it for its friction, a deck ``friction = {
law = "NAME", ... }`` with its parameters as keys; everything else takes the law from here.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import groupby
from typing import Any, ClassVar, Literal

import numpy as np

from signorini.arrays import Array, BoolArray
from signorini.checks import number
from signorini.errors import InputError, Where
from signorini.law.bound import MOST_BRANCHES, Bound, FrictionBound, JoinedBound
from signorini.short import Short

_SLOPE_ROUNDING = 1e-12  # of a coefficient: slopes of the friction that are one line


@dataclass(frozen=True)
class FrictionLaw(ABC):
    """The friction of a contact: a frozen dataclass whose fields are its parameters, checked when it is made.

    Attributes
    ----------
    straight : whether its bounds have straight branches (`FrictionBound`), on which exact histories are followed
    """

    straight: ClassVar[bool] = False

    @classmethod
    def title(cls) -> str:
        """The name in `LAWS`, or of the class where it is in none."""
        return next((name for name, kind in LAWS.items() if kind is cls), cls.__name__)

    @property
    def table(self) -> dict[str, Any]:
        """What a deck says of it."""
        return {"law": self.title()} | {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def words(self) -> str:
        """What `check` says of it."""
        parts = (f"{field.name.replace('_', ' ')} {getattr(self, field.name):g}" for field in fields(self))
        return f"{self.title()} friction, {', '.join(parts)}"

    @property
    def ratios(self) -> tuple[float, float]:
        """Friction along and across a friction axis over the larger of both."""
        return 1.0, 1.0

    def parameters(self, points: Array) -> dict[str, Array]:
        """Every parameter at points (n, d), (n,) each."""
        return {field.name: np.full(len(points), getattr(self, field.name)) for field in fields(self)}

    @staticmethod
    @abstractmethod
    def bound(parameters: Mapping[str, Array], area: Array) -> Bound:
        """The bound of n pairs by their parameters, (n,) each, and forces per traction, (n,)."""

    @classmethod
    def posed(cls, parameters: Mapping[str, Array], area: Array) -> dict[str, Any]:
        """The friction of a `ContactProblem` by its names; ``parameters`` and ``area`` as of `bound`."""
        return {"friction": cls.bound(parameters, area)}

    @staticmethod
    def sticks(parameters: Mapping[str, Array]) -> BoolArray:
        """(n,) Pairs without any bound on their friction."""
        return np.zeros(len(next(iter(parameters.values()))), dtype=np.bool_)


@dataclass(frozen=True, repr=False)
class TabularFriction(Short, FrictionLaw):
    """A coefficient that falls as the pressure grows: friction goes straight from point to point, and on as it ends.

    Parameters
    ----------
    pressures : one to eight, > 0, that grow
    coefficients : of friction there, >= 0. The friction, coefficient times pressure, grows less and less from point to
        point, and never falls: what falls, or grows faster, has no law that always has a solution

    Examples
    --------
    >>> TabularFriction([1.0, 3.0], [0.5, 0.3]).words
    'tabular friction, 0.5 up to 1, 0.3 at 3'
    """

    straight: ClassVar[bool] = True

    pressures: Sequence[float]
    coefficients: Sequence[float]

    def __post_init__(self) -> None:
        given: dict[str, tuple[float, ...]] = {}
        for name in ("pressures", "coefficients"):
            values = getattr(self, name)
            if isinstance(values, str) or not isinstance(values, Sequence | np.ndarray) or not len(values):
                raise InputError(f"is {values!r}; expected a list of numbers", where=(name,))
            given[name] = tuple(number(value, (name, i), least=0.0) for i, value in enumerate(values))
            object.__setattr__(self, name, given[name])
        p, mu = (np.array(values) for values in given.values())
        if len(p) != len(mu) or len(p) > MOST_BRANCHES:
            words = f"has {len(mu)} for {len(p)} pressures; expected as many, at most {MOST_BRANCHES}"
            raise InputError(words, where=("coefficients",))
        steps = np.diff(p, prepend=0.0)
        if not (steps > 0.0).all():
            first = int(np.argmin(steps > 0.0))
            raise InputError(f"is {p[first]:g}; expected pressures > 0 that grow", where=("pressures", first))
        slopes = np.diff(p * mu, prepend=0.0) / steps
        for i in np.flatnonzero((slopes < 0.0) | (np.diff(slopes, prepend=slopes[0]) > _SLOPE_ROUNDING)):
            word = "falls" if slopes[i] < 0.0 else "grows faster than before"
            words = f"is {mu[i]:g} at {p[i]:g}, up to which friction {word}; expected friction that grows less and less"
            raise InputError(words, where=("coefficients", int(i)))

    @property
    def words(self) -> str:
        """What `check` says of it."""
        points = [f"{mu:g} at {p:g}" for p, mu in zip(self.pressures, self.coefficients, strict=True)]
        return f"{self.title()} friction, {', '.join([points[0].replace(' at ', ' up to '), *points[1:]])}"

    def parameters(self, points: Array) -> dict[str, Array]:
        """Every pressure and coefficient at points (n, d), (n,) each."""
        values = {f"pressure {i}": value for i, value in enumerate(self.pressures, start=1)}
        values |= {f"coefficient {i}": value for i, value in enumerate(self.coefficients, start=1)}
        return {name: np.full(len(points), value) for name, value in values.items()}

    @staticmethod
    def bound(parameters: Mapping[str, Array], area: Array) -> FrictionBound:
        """The bound of n pairs by their parameters, (n,) each, and forces per traction, (n,)."""
        count = len(parameters) // 2
        p, mu = (
            np.stack([parameters[f"{name} {i}"] for i in range(1, count + 1)]) for name in ("pressure", "coefficient")
        )
        return FrictionBound.through(p * area, p * mu * area)


LAWS: dict[str, type[FrictionLaw]] = {"tabular": TabularFriction}
"""Laws that decks name, ``friction = { law = "NAME", ... }``; parameters of Coulomb's are keys of the contact."""


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """Coulomb's law, with adhesion and a limit: `law.bound` with forces per area.

    Parameters
    ----------
    friction : coefficient >= 0; "stick" or "tied"; two coefficients along an axis and across; or a function of points
        (k, d) that gives (k,)
    adhesion : traction without pressure, >= 0
    shear_limit : largest traction, > 0; None is no limit
    """

    straight: ClassVar[bool] = True

    friction: float | tuple[float, float] | Literal["stick", "tied"] | Callable[[Array], Array] = 0.0
    adhesion: float = 0.0
    shear_limit: float | None = None

    def __post_init__(self) -> None:
        if self.friction not in ("stick", "tied") and not callable(self.friction):
            if isinstance(self.friction, str):
                raise InputError(
                    f"is '{self.friction}'; expected a number >= 0, 'stick' or 'tied'", where=("friction",)
                )
            object.__setattr__(self, "friction", coefficient(self.friction, ("friction",)))
        object.__setattr__(self, "adhesion", number(self.adhesion, ("adhesion",), least=0.0))
        if self.shear_limit is not None:
            object.__setattr__(self, "shear_limit", number(self.shear_limit, ("shear_limit",), above=0.0))

    @property
    def ratios(self) -> tuple[float, float]:
        """Two coefficients over the larger of them; (1, 1) for one.

        >>> Coulomb((0.1, 0.4)).ratios, Coulomb(0.3).ratios
        ((0.25, 1.0), (1.0, 1.0))
        """
        if not isinstance(self.friction, tuple) or not any(self.friction):
            return 1.0, 1.0
        return self.friction[0] / max(self.friction), self.friction[1] / max(self.friction)

    @property
    def coefficient(self) -> float:
        """The coefficient as one number; infinite where it sticks or is tied, NaN where it varies."""
        if callable(self.friction) or isinstance(self.friction, tuple):
            return math.nan
        return math.inf if self.friction in ("stick", "tied") else float(self.friction)

    def parameters(self, points: Array) -> dict[str, Array]:
        """Coefficient, the larger of two, adhesion and limit at points (n, d), (n,) each; infinite where there is none.

        Raises
        ------
        InputError
            If a function gives anything but one number >= 0 for every point.
        """
        n = len(points)
        if callable(self.friction):
            friction = np.asarray(self.friction(points), float)
            if friction.shape != (n,) or not (friction >= 0.0).all():
                raise InputError(
                    f"gives an array of shape {friction.shape}, smallest {friction.min(initial=np.inf):g}; expected "
                    f"one number >= 0 for each of {n} points",
                    where=("friction",),
                )
        else:
            friction = np.full(n, max(self.friction) if isinstance(self.friction, tuple) else self.coefficient)
        limit = math.inf if self.shear_limit is None else self.shear_limit
        return {"friction": friction, "adhesion": np.full(n, self.adhesion), "shear_limit": np.full(n, limit)}

    @staticmethod
    def bound(parameters: Mapping[str, Array], area: Array) -> FrictionBound:
        """The bound of n pairs by their parameters, (n,) each, and forces per traction, (n,)."""
        adhesion, limit = parameters["adhesion"] * area, parameters["shear_limit"] * area
        return FrictionBound.of(parameters["friction"], adhesion=adhesion, limit=limit)

    @classmethod
    def posed(cls, parameters: Mapping[str, Array], area: Array) -> dict[str, Any]:
        """Coefficients, and what else there is of adhesion and limits; ``parameters`` and ``area`` as of `bound`."""
        adhesion, limit = parameters["adhesion"], parameters["shear_limit"]
        return {
            "friction": parameters["friction"],
            "adhesion": adhesion * area if adhesion.any() else None,
            "limit": limit * area if np.isfinite(limit).any() else None,
        }

    @staticmethod
    def sticks(parameters: Mapping[str, Array]) -> BoolArray:
        """(n,) Pairs without any bound on their friction."""
        endless = np.isinf(parameters["friction"]) & np.isinf(parameters["shear_limit"])
        return np.asarray(endless, dtype=np.bool_)


def _alike(part: tuple[type[FrictionLaw], Mapping[str, Array]]) -> tuple[type[FrictionLaw], tuple[str, ...]]:
    """What contacts that lie in one block share: their law, and the names of its parameters."""
    return part[0], tuple(part[1])


def coefficient(value: Any, where: Where) -> float | tuple[float, float]:
    """One coefficient of friction >= 0, or two of them.

    Examples
    --------
    >>> coefficient([0.1, 0.3], ("friction",))
    (0.1, 0.3)
    """
    if not isinstance(value, Sequence) or isinstance(value, str):
        return number(value, where, least=0.0)
    if len(value) != 2:
        raise InputError(f"has {len(value)} coefficients; expected one, or two along two directions", where=where)
    return number(value[0], (*where, 0), least=0.0), number(value[1], (*where, 1), least=0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class PairFriction:
    """The friction of n pairs: blocks of them one after the other, each with a law and its parameters.

    Attributes
    ----------
    blocks : laws, and parameters by name, (m,) of the m pairs of the block
    """

    blocks: tuple[tuple[type[FrictionLaw], Mapping[str, Array]], ...]

    @classmethod
    def of(cls, laws: Sequence[FrictionLaw], points: Sequence[Array]) -> PairFriction:
        """The friction of contacts, which lie one after the other.

        Parameters
        ----------
        laws : of every contact
        points : of the pairs of every contact, (k, d)

        Raises
        ------
        InputError
            If a function that gives the friction gives something else, with the contact's index.
        """
        each: list[tuple[type[FrictionLaw], Mapping[str, Array]]] = []
        for i, (law, of_law) in enumerate(zip(laws, points, strict=True)):
            try:
                each.append((type(law), law.parameters(of_law)))
            except InputError as error:
                raise error.inside("contact", i) from error
        blocks = []
        if not each:
            each = [(Coulomb, Coulomb().parameters(np.zeros((0, 2))))]
        for (kind, _), members in groupby(each, _alike):
            given = [parameters for _, parameters in members]
            blocks.append((kind, {name: np.concatenate([part[name] for part in given]) for name in given[0]}))
        return cls(blocks=tuple(blocks))

    @cached_property
    def _ends(self) -> list[int]:
        """Numbers of pairs at which blocks end, but the last."""
        return np.cumsum([len(next(iter(of.values()))) for _, of in self.blocks])[:-1].tolist()

    def among(self, kept: BoolArray) -> PairFriction:
        """The friction of the kept pairs, (n,)."""
        parts = zip(self.blocks, np.split(kept, self._ends), strict=True)
        return PairFriction(
            blocks=tuple((law, {name: of[own] for name, of in parameters.items()}) for (law, parameters), own in parts)
        )

    def bonded(self, held: BoolArray, sticks: BoolArray) -> PairFriction:
        """The friction with pairs (n,) that are held, of contacts with Coulomb's law: they stick, or have no friction.

        Parameters
        ----------
        held : (n,) pairs that are bonded
        sticks : (n,) whether they stick
        """
        coefficient, blocks = np.where(sticks, np.inf, 0.0), []
        for (law, parameters), own, mu in zip(
            self.blocks, np.split(held, self._ends), np.split(coefficient, self._ends), strict=True
        ):
            given = {"friction": mu, "shear_limit": np.full(len(mu), np.inf)} if own.any() else {}
            changed = {name: np.where(own, value, parameters[name]) for name, value in given.items()}
            blocks.append((law, {**parameters, **changed}))
        return PairFriction(blocks=tuple(blocks))

    def bound(self, area: Array) -> Bound:
        """The bound of friction forces; ``area`` (n,) forces per traction."""
        parts = zip(self.blocks, np.split(area, self._ends), strict=True)
        bounds = tuple(law.bound(parameters, own) for (law, parameters), own in parts)
        if len(bounds) == 1:
            return bounds[0]
        straight = [bound for bound in bounds if isinstance(bound, FrictionBound)]
        return FrictionBound.joined(straight) if len(straight) == len(bounds) else JoinedBound(parts=bounds)

    def posed(self, area: Array) -> dict[str, Any]:
        """The friction of a `ContactProblem` by its names; ``area`` (n,) forces per traction."""
        if len(self.blocks) > 1:
            return {"friction": self.bound(area)}
        law, parameters = self.blocks[0]
        return law.posed(parameters, area)

    @cached_property
    def steepest(self) -> Array:
        """(n,) Largest friction per pressure, at the smallest pressures: Coulomb's coefficient without adhesion."""
        return self._bound_of_tractions.steepest

    @cached_property
    def rubs(self) -> BoolArray:
        """(n,) Pairs that have friction."""
        at_rest = self._bound_of_tractions.tangent(np.zeros(len(self.sticks)))[1]
        return np.asarray((self.steepest > 0) | (at_rest > 0), dtype=np.bool_)

    @cached_property
    def sticks(self) -> BoolArray:
        """(n,) Pairs without any bound on their friction."""
        return np.concatenate([law.sticks(parameters) for law, parameters in self.blocks])

    @cached_property
    def bounded(self) -> BoolArray:
        """(n,) Pairs that have friction up to a bound."""
        return self.rubs & ~self.sticks

    @property
    def straight(self) -> bool:
        """Whether the bounds of all pairs have straight branches."""
        return all(law.straight for law, _ in self.blocks)

    @property
    def parameters(self) -> dict[str, Array]:
        """(n,) Parameters by name, behind that of a law that is not Coulomb's; NaN where pairs have none."""
        found: dict[str, Array] = {}
        start = 0
        for law, parameters in self.blocks:
            prefix = "" if law is Coulomb else f"{law.title()} "
            for name, values in parameters.items():
                whole = found.setdefault(prefix + name, np.full(len(self.sticks), np.nan))
                whole[start : start + len(values)] = values
            start += len(values)
        return found

    @cached_property
    def _bound_of_tractions(self) -> Bound:
        return self.bound(np.ones(len(self.sticks)))
