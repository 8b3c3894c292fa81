# SPDX-License-Identifier: BSD-3-Clause
"""How far a load can be raised where no method ends with an answer: by bisection."""

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.result import ContactAnswer
from signorini.law.states import OPEN, STICK
from signorini.settings import SolverSettings

_BISECTIONS = 10


@dataclass(frozen=True, kw_only=True)
class LimitLoad:
    """How far a load could be raised from a base load.

    Attributes
    ----------
    factor : largest part of the way from the base to the full load with a certified solution; 1 where all of it has one
    beyond : smallest part tried without one; infinite where none failed
    result : the solution at ``factor``
    closed, sticking : number of pairs closed, and sticking, there; few of them sticking speak for a limit load
    """

    factor: float
    beyond: float
    result: ContactAnswer
    closed: int
    sticking: int

    @property
    def message(self) -> str:
        """The same in words."""
        return (
            f"certified up to {self.factor:.4g} of the load; there {self.sticking} of {self.closed} closed pairs stick"
        )


def limit_load(
    problem: ContactProblem, base: Array, start: Array | None = None, *, settings: SolverSettings | None = None
) -> LimitLoad | None:
    """How far the load can be raised from ``base`` to the problem's b: bisection, each load from the last solution.

    Parameters
    ----------
    problem : the problem at its full load
    base : (3n,) a b that has a solution, of the step before for instance; a multiple of b will not do, since the
        solutions grow with it
    start : (3, n) ``y`` of a solution at the base

    Returns
    -------
    LimitLoad, or None where the base load itself has no certified solution
    """
    result = solve_contact(replace(problem, b=base), start, settings=settings)
    if not result.solved:
        return None
    factor, beyond, trial = 0.0, np.inf, 1.0
    for _ in range(_BISECTIONS + 1):
        b = (1.0 - trial) * base + trial * problem.b
        tried = solve_contact(replace(problem, b=b), result.y, settings=settings)
        if tried.solved:
            factor, result = trial, tried
        else:
            beyond = trial
        if factor == 1.0:
            break
        trial = (factor + min(beyond, 1.0)) / 2.0
    closed, stick = np.count_nonzero(result.state != OPEN), np.count_nonzero(result.state == STICK)
    return LimitLoad(factor=factor, beyond=beyond, result=result, closed=int(closed), sticking=int(stick))
