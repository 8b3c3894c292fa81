# SPDX-License-Identifier: BSD-3-Clause
"""Stresses at places over steps of a history, at every moment between which an exact path is linear."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from signorini.arrays import Array, frozen, stored
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
    rows = [
        (factor, in_state(probe, state, None if state is None else state.displacement if u is None else u))
        for factor, state, u in moments_along(looked_at, recovery)
    ]
    stress, strain, gradient = together(probe, [row for _, row in rows])
    single = probe.weights.nnz == len(points)
    node = probe.nodes[probe.weights.indices, 1] if single else np.full(len(points), -1)
    return StressHistory(
        points=frozen(points),
        bodies=tuple(probe.model.bodies[body].name for body in probe.body),
        node=frozen(node, np.int64),
        load_factor=frozen(np.array([factor for factor, _ in rows])),
        stress=frozen(stress),
        strain=frozen(strain),
        gradient=frozen(gradient),
        exact=is_exact(history.model, looked_at),
    )


def moments_along(
    looked_at: Sequence[Span], recovery: Callable[[], Recovery], seen: Container[Instant] = ()
) -> Iterator[tuple[float, StepResult | Instant | None, Array | None]]:
    """Load factors and states of all moments that are looked at; None of bodies at rest.

    Behind them displacements (nodes, d), where they were not kept with the state, and are found.

    Parameters
    ----------
    looked_at : parts of steps
    recovery : finds displacements, if any are missing
    seen : states whose stresses are known already, of which no displacements are looked for
    """
    for span in looked_at:
        if span.at_rest:
            yield 0.0, None, None
        if span.before is not None and stored(span.before, "displacement") is not None:
            yield span.before.load_factor, span.before, None
        missing = [moment for moment in span.moments[:-1] if not moment.deformed and moment not in seen]
        found = recovery().displacements(span.step, missing) if missing else iter(())
        for moment in span.moments[:-1]:
            known = moment.deformed or moment in seen
            yield moment.load_factor, moment, None if known else next(found)
        for _ in found:  # what is left compares what was found with the end
            pass
        yield span.step.load_factor, span.step, None


def is_exact(model: Model, looked_at: Sequence[Span]) -> bool:
    """Whether stresses are linear between moments: without contact in elastic bodies, and on exact paths.

    Not where pairs follow the bodies, whose steps are paths from stride to stride.

    Parameters
    ----------
    model, looked_at : the bodies, and parts of steps
    """
    if not model.contacts:
        return not model.yields
    return not model.slides and all(span.step.path == "exact" for span in looked_at)


InState = tuple[Array, Array, Array]
"""Stresses, their derivatives and plastic strains of p places in one state, (p, 6) each."""


def in_state(probe: StressProbe, state: StepResult | Instant | None, displacement: Array | None) -> InState:
    """Stresses of places in one state.

    Parameters
    ----------
    probe : the places
    state, displacement : of the bodies, (nodes, d); None of bodies at rest
    """
    if state is None or displacement is None:
        nothing = np.zeros((len(probe.body), 6))
        return nothing, nothing if probe.slopes is not None else nothing[:0], nothing
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


def together(probe: StressProbe, states: Sequence[InState]) -> InState:
    """(p, t, 6) Stresses, strains and derivatives of the stresses, of places at several moments.

    Parameters
    ----------
    probe : the places
    states : what `in_state` says of each moment
    """
    stress, gradient, flowed = (np.stack([state[k] for state in states], axis=1) for k in range(3))
    return stress, probe.elastic_strain(stress) + flowed, gradient
