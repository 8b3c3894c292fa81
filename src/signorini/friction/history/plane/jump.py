# SPDX-License-Identifier: BSD-3-Clause
"""Say of a load without gradual continuation who is involved, and whether bodies slide away as a whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.friction.history.plane.rate_law import weight
from signorini.friction.history.rates import NoRates
from signorini.friction.history.segment import Jump
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import Pull, pulled_away
from signorini.law.bound import FrictionBound

STEP_BEYOND = 1e-4
"""Part of what is left of the segment, past the jump, at which the loads are asked whether they pull bodies away."""

LEAVING = "a rigid motion of the bodies shows that more load has no equilibrium"
SLIDING = f"gross sliding: every closed pair has used up its friction, and {LEAVING}"
LIMITED = "gross sliding: every closed pair has used up its friction, which more load exceeds at these pressures"


def explain(
    problem: ContactProblem, now: PathState, b_end: Array, factor: float, acting: IntArray, lost: NoRates, width: Array
) -> Jump:
    """The jump at a state that no rates continue.

    Parameters
    ----------
    problem : its mu holds
    now : the state there
    b_end : (2n,) load at the end of the segment
    factor : part of the segment behind
    acting : pairs whose event it is; all at their limit where there is none
    lost : what the search for rates found
    width : (n,) of zero for a force
    """
    p, friction = now.r
    spent = (problem.bound.at(p) - np.abs(friction)) / weight(problem.mu) <= width
    beyond = now.b + STEP_BEYOND * (b_end - now.b)
    further = replace(problem, b=frozen(beyond))
    pull = pulled_away(further) if problem.floating else None
    leaves = isinstance(pull, Pull)
    pressed = p > width
    slides = problem.floating and bool(pressed.any() and spent[pressed].all())
    # friction that is not in proportion to the pressures depends on how they are shared
    limit = pulled_away(further, FrictionBound.constant(problem.bound.at(p))) if slides and not leaves else None
    limits = isinstance(limit, Pull)
    pairs = acting if len(acting) else np.flatnonzero(spent)
    reason = (SLIDING if slides else LEAVING) if leaves else LIMITED if limits else ""
    shown = pull if leaves else limit
    if isinstance(shown, Pull):
        reason += f": {STEP_BEYOND:g} of the way further nothing takes {shown.share:.2g} of the load on the bodies"
    elif shown is not None:
        reason = str(shown)
    return Jump(
        factor=factor,
        pairs=tuple(int(k) for k in pairs),
        proof=f"{lost.proof}; {reason}" if reason else lost.proof,
        margin=lost.margin or (shown.share if isinstance(shown, Pull) else 0.0),
        gross_sliding=slides and (leaves or limits),
    )
