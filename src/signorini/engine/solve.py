# SPDX-License-Identifier: BSD-3-Clause
"""Follow the load history of a model, step after step. Model in, history out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from signorini.clock import Clock
from signorini.engine.exact import follow_exactly
from signorini.engine.increments import follow_increments
from signorini.engine.leg import Leg
from signorini.engine.prepare import Prepared, prepare
from signorini.engine.report import step_result
from signorini.errors import SolveFailed
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.solution.history import History
from signorini.solution.results import StepResult
from signorini.solution.state import State, initial_state

_BEHIND_A_JUMP = 10  # increments


def solve(model: Model, *, backend: str = "auto", raise_on_failure: bool = True, clock: Clock | None = None) -> History:
    """Solve every step of a model and certify every increment; see :func:`signorini.api.solve`, which dresses it."""
    return solve_prepared(prepare(model, backend=backend, clock=clock), raise_on_failure=raise_on_failure)


def solve_prepared(prepared: Prepared, *, raise_on_failure: bool = True) -> History:
    """Solve the load history of a prepared model; see :func:`solve`.

    Pairs that were left out as too far apart are looked at after every increment; where one has met the other side, or
    nothing was found without them, everything is solved again with all pairs.
    """
    history = _follow(prepared)
    if prepared.limited and not history.solved:
        history = _follow(prepared.widened())
    if raise_on_failure and not history.solved:
        raise SolveFailed(history.message, status=history.status, solution=history)
    return history


def _follow(prepared: Prepared) -> History:
    """Step after step, up to the end or to what stops it."""
    model = prepared.model
    factors = model.factors()
    state = initial_state(factors[0], prepared.space.number_of_dofs, prepared.interface.gap)
    steps: list[StepResult] = []
    prepared.clock.expect(sum(step.increments or 1 for step in model.steps))
    try:
        for number, (step, end) in enumerate(zip(model.steps, factors[1:], strict=True), start=1):
            name = f"step '{step.name}'" if step.name else f"step {number}"
            leg = _leg(prepared, step, number, name, state, end)
            steps.append(step_result(prepared, step, number, leg))
            state = leg.after
    except SolveFailed as failure:
        return _history(prepared, failure.status, str(failure), steps)
    return _history(prepared, "solved", "", steps)


def _leg(prepared: Prepared, step: Step, number: int, name: str, state: State, end: Mapping[str, float]) -> Leg:
    """Follow a step as asked; where nothing was asked, exactly if there is Coulomb friction.

    Where the exact path that nobody asked for ends in a jump or is lost, the step is followed in increments, and its
    notes say so: what they reach behind a jump is a candidate.
    """
    friction = prepared.interface.friction
    rubbing = bool(((friction > 0) & np.isfinite(friction)).any())
    if step.path != "exact" and (step.path is not None or step.increments is not None or not rubbing):
        return follow_increments(prepared, step, name, state, end)
    try:
        return follow_exactly(prepared, number, name, state, end)
    except SolveFailed as failure:
        if step.path == "exact":
            raise
        leg = follow_increments(prepared, replace(step, increments=_BEHIND_A_JUMP), name, state, end)
        return replace(leg, notes=(f"{failure}; followed in {_BEHIND_A_JUMP} increments to what is a candidate",))


def _history(prepared: Prepared, status: str, message: str, steps: list[StepResult]) -> History:
    return History(
        model=prepared.model,
        status=status,
        message=message,
        steps=tuple(steps),
        backend=prepared.condensed.factorisation.name,
        timings=dict(prepared.clock.seconds),
        pairs=len(prepared.interface),
    )
