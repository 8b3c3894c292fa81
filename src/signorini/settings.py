# SPDX-License-Identifier: BSD-3-Clause
"""How exactly and how long the methods that solve contact may try: one value for all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from signorini.checks import number, whole
from signorini.errors import InputError

MAX_TOLERANCE = 1e-8
"""Of the data: what certificates allow, beyond which no answer would pass."""

_COUNTS = {
    "newton_steps": 1,
    "searched_steps": 1,
    "tree_pairs": 0,
    "tree_programs": 1,
    "many_pairs": 0,
    "swept_rounds": 0,
    "proximal_rounds": 0,
    "multiplier_rounds": 1,
    "path_increments": 1,
    "automatic_increments": 1,
}
"""Fields that are whole numbers, and the least of each."""


@dataclass(frozen=True, kw_only=True)
class SolverSettings:
    """Limits of the methods that solve contact; whatever they are, answers are certified to 1e-8.

    Parameters
    ----------
    tolerance : of solutions of the law of contact, relative to the data, 0 < tolerance <= 1e-8
    newton_steps, searched_steps : most linear systems of one run of Newton's method, in the plane and in space
    pivots_per_pair : most pivots of a covering path in the plane, in rounds
    springs : stiffness of the springs that show where a body runs, falling, of the interface stiffness
    many_pairs : pairs from which a path is first followed among those alone that Newton's method found touching
    tree_pairs, tree_programs : most pairs, and most linear programs, of the proof by a tree of states in the plane
    swept_rounds, proximal_rounds : most rounds of sweeps with proximal Newton steps, and of these alone, in space
    multiplier_rounds : most rounds of multipliers on the bodies as they are
    path_increments : most increments to events of one straight part of a step in space, and in the plane of events,
        where 100 a pair are no more
    automatic_increments : most increments of one straight part of a step with ``increments = "auto"``

    Raises
    ------
    InputError
        For a number out of its range, with its name.

    Examples
    --------
    >>> SolverSettings(newton_steps=0)
    Traceback (most recent call last):
    signorini.errors.InputError: newton_steps: is 0; expected a whole number >= 1
    """

    tolerance: float = 1e-10
    newton_steps: int = 200
    searched_steps: int = 25
    pivots_per_pair: Sequence[int] = (10, 100)
    springs: Sequence[float] = (1e-3, 1e-6, 1e-9)
    many_pairs: int = 200
    tree_pairs: int = 25
    tree_programs: int = 2000
    swept_rounds: int = 15
    proximal_rounds: int = 50
    multiplier_rounds: int = 200
    path_increments: int = 20000
    automatic_increments: int = 4096

    def __post_init__(self) -> None:
        tolerance = number(self.tolerance, ("tolerance",), above=0.0)
        if tolerance > MAX_TOLERANCE:
            raise InputError(f"is {tolerance:g}; expected at most {MAX_TOLERANCE:g}", where=("tolerance",))
        checked: dict[str, Any] = {"tolerance": tolerance}
        checked |= {name: whole(getattr(self, name), (name,), least=least) for name, least in _COUNTS.items()}
        pivots = _listed(self.pivots_per_pair, "pivots_per_pair")
        checked["pivots_per_pair"] = tuple(whole(k, ("pivots_per_pair", i)) for i, k in enumerate(pivots))
        if not len(pivots):
            raise InputError("is empty; expected one number or more", where=("pivots_per_pair",))
        springs = _listed(self.springs, "springs")
        checked["springs"] = tuple(number(k, ("springs", i), above=0.0) for i, k in enumerate(springs))
        for name, value in checked.items():
            object.__setattr__(self, name, value)


def _listed(value: Any, name: str) -> Sequence[Any]:
    """A list, or what was found instead."""
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise InputError(f"is {value!r}; expected a list of numbers", where=(name,))
    return value


DEFAULT_SETTINGS = SolverSettings()
"""Where none are given: checked once, for small problems are solved thousands of times."""
