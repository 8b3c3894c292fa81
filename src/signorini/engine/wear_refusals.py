# SPDX-License-Identifier: BSD-3-Clause
"""Steps that wear and are refused: blocks of cycles that only bodies can follow, increments that lose much energy."""

from __future__ import annotations

from signorini.engine.energy import missing_energy
from signorini.engine.prepare import Prepared
from signorini.errors import SolveFailed
from signorini.model.stage import Stage
from signorini.outcome import Outcome
from signorini.solution.state import State

NEEDS_OF_STRIDES = (
    "blocks of cycles that slide far need strides that recur: no 'increments', no results at events, no temperature, "
    "no body that turns, no closure, and cycles alike; expected that, or no 'block'"
)
"""What blocks need where sides slide far."""

NEEDS_OF_PAIRS = "blocks of cycles need exact paths; expected no 'increments', no results at events, no closure"
"""What they need elsewhere."""

_MOST_MISSING = 0.1  # of the work of a step: what given increments may leave where sides wear


def unfit_for_blocks(stage: Stage, words: str) -> SolveFailed:
    """The refusal of a step in blocks, with what these need."""
    return SolveFailed(f"{stage.name}: {words}", status=Outcome.NOT_FOUND)


def refuse_unbalanced(stage: Stage, begin: tuple[Prepared, State], end: tuple[Prepared, State]) -> None:
    """Refuse a step whose increments, which were given, are so long that much of the work is missing.

    Parameters
    ----------
    stage : the step
    begin, end : model and state at its ends

    Raises
    ------
    SolveFailed
        If that is so.
    """
    (prepared, before), (then, after) = begin, end
    if not isinstance(stage.step.increments, int) or after.work == before.work:
        return
    missing = missing_energy(prepared, before, after, then)
    if missing > _MOST_MISSING:
        words = f"increments are too long where sides wear: {missing:.0%} of the work is missing in the energy balance"
        raise SolveFailed(f"{stage.name}: {words}; expected more of them, or none given", status=Outcome.NOT_FOUND)
