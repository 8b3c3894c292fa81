# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at places over steps of a history, at every moment between which an exact path is linear."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from signorini.arrays import Array, frozen
from signorini.engine.recovery import Recovery
from signorini.errors import InputError, one_of
from signorini.fem.kinematics import Group
from signorini.fem.probe import StressProbe
from signorini.fem.stress import DeformedBodies, at_best_points
from signorini.model.model import Model
from signorini.plasticity.fields import by_family
from signorini.solution.history import History
from signorini.solution.results import Instant, StepResult
from signorini.solution.stress_history import StressHistory

_SAME_LOAD = 1e-9  # of a step: where a cycle begins


@dataclass(frozen=True, kw_only=True, eq=False)
class Span:
    """The part of a step that is looked at: all of it, or the last cycle where it repeats.

    Attributes
    ----------
    step : that is looked at
    before : the end of the step, or of the history, that it begins with; None where it begins with bodies at rest, or
        within the step
    at_rest : whether it begins with bodies at rest
    moments : of the step, in order, the end last
    """

    step: StepResult
    before: StepResult | Instant | None
    at_rest: bool
    moments: tuple[Instant, ...]


def spans(history: History, steps: Sequence[str]) -> list[Span]:
    """What is looked at of a history.

    Parameters
    ----------
    history : with a step at least
    steps : by name; the last one if none is given

    Raises
    ------
    InputError
        For an unknown or unfinished step.
    """
    names = [step.name for step in history.steps]
    for name in steps:
        if name not in names:
            raise InputError(one_of(name, names, "step"), where=("steps",))
    chosen = [names.index(name) for name in steps] or [len(names) - 1]
    found = []
    for index in chosen:
        step, repeat = history.steps[index], history.model.steps[index].repeat
        if not step.finished:
            raise InputError(f"'{step.name}' was not finished; expected one that was", where=("steps",))
        begin = index + 1 - 1.0 / repeat - _SAME_LOAD
        if repeat > 1:
            own = tuple(instant for instant in step.instants if instant.load_factor >= begin)
            found.append(Span(step=step, before=None, at_rest=False, moments=own))
            continue
        before = history.steps[index - 1] if index else history.begin
        joins = bool(found) and found[-1].step is before
        rest = before is None
        found.append(Span(step=step, before=None if joins else before, at_rest=rest, moments=tuple(step.instants)))
    return found


def stress_history(history: History, probe: StressProbe, points: Array, *, steps: Sequence[str]) -> StressHistory:
    """Stresses at places at every moment of steps.

    Displacements are those that were kept, at ends of steps, at times asked for and wherever ``at = "events"``; the
    others are found from the forces of the contacts. They are gone when their stresses are known.

    Parameters
    ----------
    history : solved
    probe : the places
    points : (p, d) undeformed coordinates of the places, length
    steps : by name; the last one if none is given

    Raises
    ------
    InputError
        For an unknown step, and where displacements on the way were not kept and do not follow from what was.
    """
    looked_at = spans(history, steps)
    recovery = cache(partial(Recovery.of, history))
    rows = [row for span in looked_at for row in _along(span, probe, recovery)]
    stress, gradient, flowed = (np.stack([row[1][k] for row in rows], axis=1) for k in range(3))
    single = probe.weights.nnz == len(points)
    node = probe.nodes[probe.weights.indices, 1] if single else np.full(len(points), -1)
    return StressHistory(
        points=frozen(points),
        bodies=tuple(probe.model.bodies[body].name for body in probe.body),
        node=frozen(node, np.int64),
        load_factor=frozen(np.array([row[0] for row in rows])),
        stress=frozen(stress),
        strain=frozen(probe.elastic_strain(stress) + flowed),
        gradient=frozen(gradient),
        exact=_is_exact(history.model, looked_at),
    )


def _along(
    span: Span, probe: StressProbe, recovery: Callable[[], Recovery]
) -> Iterator[tuple[float, tuple[Array, Array, Array]]]:
    """Load factors of the moments of a step, and what `_in_state` says of each."""
    if span.at_rest:
        nothing = np.zeros((len(probe.body), 6))
        yield 0.0, (nothing, nothing if probe.slopes is not None else nothing[:0], nothing)
    if span.before is not None and span.before.displacement is not None:
        yield span.before.load_factor, _in_state(probe, span.before, span.before.displacement)
    missing = [moment for moment in span.moments[:-1] if not moment.deformed]
    found = recovery().displacements(span.step, missing) if missing else iter(())
    for moment in span.moments[:-1]:
        u = moment.displacement
        yield moment.load_factor, _in_state(probe, moment, next(found) if u is None else u)
    for _ in found:  # what is left compares what was found with the end
        pass
    yield span.step.load_factor, _in_state(probe, span.step, span.step.displacement)


def _is_exact(model: Model, looked_at: Sequence[Span]) -> bool:
    """Whether stresses are linear between moments: without contact in elastic bodies, and on exact paths.

    Not where pairs follow the bodies, whose steps are paths from stride to stride.
    """
    if not model.contacts:
        return not model.yields
    return not model.slides and all(span.step.path == "exact" for span in looked_at)


def _in_state(probe: StressProbe, state: StepResult | Instant, displacement: Array) -> tuple[Array, Array, Array]:
    """Stresses, their derivatives and plastic strains of the places in one state, each (p, 6)."""
    if state.plastic is None:
        deformed = DeformedBodies.of(probe.space, probe.model, displacement, state.factors)
        stress, gradient = probe.stress(deformed)
        return stress, gradient, np.zeros_like(stress)
    strains = by_family(probe.space, probe.model, state.plastic.state.strain)
    deformed = DeformedBodies.of(probe.space, probe.model, displacement, state.factors, strains)
    width = 4 if probe.model.components == 2 else 6

    def flowed(group: Group) -> Array:
        found = at_best_points(group, strains)
        return np.zeros((len(group.index), len(group.block.to_best), width)) if found is None else found

    tensor = np.zeros((len(probe.body), 6))
    tensor[:, :width] = probe.mean(flowed, width)
    tensor[:, 3:] *= 0.5
    return (*probe.stress(deformed), tensor)
