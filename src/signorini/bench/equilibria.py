# SPDX-License-Identifier: BSD-3-Clause
"""Steps of the hard set with one solution, and with several: by bound, by enumeration, by search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from signorini.arrays import Array
from signorini.friction.problem import ContactProblem
from signorini.friction.uniqueness import COUNTED_PAIRS, all_solutions, countable, mu_low, search_solutions


@dataclass(frozen=True, kw_only=True)
class Equilibria:
    """Steps counted by what is known of their solutions.

    Attributes
    ----------
    unique : whose friction is below `mu_low`
    single : of few pairs, whose states were tried one by one: one of them is in equilibrium
    alone : in which a search found no second solution
    several : how many solutions were found, and where
    """

    unique: int
    single: int
    alone: int
    several: tuple[tuple[int, str], ...]

    def __str__(self) -> str:
        lines = [
            f"Certified steps with one solution: {self.unique} by the bound on friction, {self.single} as no other "
            f"state of the pairs is in equilibrium (up to {COUNTED_PAIRS}), {self.alone} as far as a search tells; "
            "several: "
            f"{len(self.several)}.",
            "",
            *(f"- {count} solutions: {name}" for count, name in self.several),
        ]
        return "\n".join(lines)


def solutions(problem: ContactProblem) -> list[Array] | None:
    """All solutions y of few pairs, those that a search finds of more; None where only one can exist, by `mu_low`."""
    bound = mu_low(problem)
    if bound is not None and problem.mu.max(initial=0.0) < bound:
        return None
    return all_solutions(problem) if countable(problem) else search_solutions(problem)


def equilibria(
    steps: Sequence[tuple[str, ContactProblem]], begin: Callable[[str, int, int], None] = lambda *_: None
) -> Equilibria:
    """What is known of the solutions of steps that have one.

    Parameters
    ----------
    steps : names and problems
    begin : told before every step its name, how many are done and how many there are

    Examples
    --------
    >>> from signorini.bench.hard import hard
    >>> equilibria(hard(range(1)).certified).several
    ()
    """
    unique, single, alone, several = 0, 0, 0, []
    for done, (name, problem) in enumerate(steps):
        begin(f"other solutions: {name}", done, len(steps))
        found = solutions(problem)
        if found is None:
            unique += 1
        elif len(found) > 1:
            several.append((len(found), name))
        elif countable(problem):
            single += 1
        else:
            alone += 1
    return Equilibria(unique=unique, single=single, alone=alone, several=tuple(several))
