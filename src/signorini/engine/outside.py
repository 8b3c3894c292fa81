# SPDX-License-Identifier: BSD-3-Clause
"""What acts on the bodies from outside at every instant of a history, and how far loads and obstacles have moved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.examine import Examined, examine
from signorini.engine.moments import dofs_on_the_way, whole_dofs
from signorini.engine.reactions import reactions, rigid_dofs, rigid_result
from signorini.engine.recovery import Recovery
from signorini.errors import InputError
from signorini.model.model import Model
from signorini.solution.history import History
from signorini.solution.obstacle_result import ObstacleResult
from signorini.solution.results import Instant, StepResult

_ROUNDING_TOL = 1e-12  # of all nodal forces: a smaller resultant is none


def outside_names(model: Model) -> tuple[str, ...]:
    """Names of the columns of `outside`, in order."""
    held, bolts = {body.name for body in model.rigid_bodies}, {bolt.label for bolt in model.bolts}
    supports = [support for support in model.supports if support.label not in bolts]
    parts = {support.label: _reaction_parts(model, str(support.on) in held) for support in supports}
    parts |= {foundation.label: _reaction_parts(model, False) for foundation in model.foundations}
    return (
        *(f"{name}.reaction_{part}" for name, each in parts.items() for part in each),
        *(f"{load.label}.approach" for load in model.loads),
        *(name for body in _rigid(model) for name in _rigid_parts(model, body)),
    )


def _rigid(model: Model) -> list[str]:
    """Names of obstacles, then of rigid bodies."""
    return [*(obstacle.name for obstacle in model.obstacles), *(body.name for body in model.rigid_bodies)]


def _rigid_parts(model: Model, name: str) -> list[str]:
    """Names of the columns of an obstacle or a rigid body."""
    along = "xyz"[: model.dimension]
    around = [""] if model.dimension == 2 else ["_x", "_y", "_z"]
    moved = [f"{name}.{what}_{axis}" for what in ("displacement", "force") for axis in along]
    return [*moved, *(f"{name}.{what}{axis}" for what in ("rotation", "moment") for axis in around)]


def _reaction_parts(model: Model, rigid: bool) -> list[str]:
    """Components of what a support bears; of a rigid body its moments too."""
    axes = list("xyz"[: model.dimension if rigid else model.components])
    if not rigid:
        return axes
    return [*axes, *(["moment"] if model.dimension == 2 else [f"moment_{axis}" for axis in "xyz"])]


def outside(history: History, recovery: Callable[[], Recovery]) -> Mapping[str, Array]:
    """Columns over all instants of a history, in order.

    Reactions of supports and foundations on the bodies; ``approach`` of a load, how far its points move along it, in
    the mean with their forces; motions of obstacles and rigid bodies, and what acts on these. NaN where displacements
    were not kept and do not follow from the forces of the contacts.

    Parameters
    ----------
    history : solved
    recovery : what displacements are found with
    """
    names = outside_names(history.model)
    rows: list[Mapping[str, float]] = []
    for number, step in enumerate(history.steps, start=1):
        rows += _on_the_way(history, number, recovery)
        rows.append(_end(step, _examined(history, recovery)))
    return {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}


def _on_the_way(history: History, number: int, recovery: Callable[[], Recovery]) -> list[Mapping[str, float]]:
    """Values by column at the instants of a step before its end; empty where they are not known."""
    moments = history.steps[number - 1].instants[:-1]
    if not moments:
        return []
    try:
        found = recovery()
        known = dofs_on_the_way(found, history, number, moments)
    except InputError:
        return [{} for _ in moments]
    return [_row(found, instant, u) for instant, u in zip(moments, known, strict=True)]


def _examined(history: History, recovery: Callable[[], Recovery]) -> Examined:
    """The model on its mesh."""
    try:
        return recovery().examined
    except InputError:
        return examine(replace(history.model, fatigue=()), start=history.end)


def _row(recovery: Recovery, instant: Instant, u: Array) -> Mapping[str, float]:
    """Values by column in one state, from its displacements (dofs,)."""
    examined = recovery.examined
    model, space, constraints = examined.model, examined.space, examined.constraints
    loads, external, held = recovery.loads(instant), recovery.external(instant, u), recovery.held(instant, u)
    rigid = {}
    for j, body in enumerate(_rigid(model)):
        force = external if j < len(model.obstacles) else loads + held
        rigid[body] = rigid_result(model, space, j, u, force)
    return _values(examined, reactions(model, space, constraints, u, held), rigid, u)


def _end(step: StepResult, examined: Examined) -> Mapping[str, float]:
    """Values by column at the end of a step."""
    u = whole_dofs(examined, step.displacement, step.motions)
    return _values(examined, step.reactions, {**step.obstacles, **step.rigid_bodies}, u)


def _values(
    examined: Examined, borne: Mapping[str, Array], rigid: Mapping[str, ObstacleResult], u: Array
) -> Mapping[str, float]:
    """Values by column.

    Parameters
    ----------
    examined : the model
    borne : reactions by support and foundation
    rigid : obstacles and rigid bodies by name
    u : (dofs,) displacements
    """
    found: dict[str, float] = {}
    model = examined.model
    held = {support.label: any(support.on == body.name for body in model.rigid_bodies) for support in model.supports}
    for name, force in borne.items():
        parts = _reaction_parts(model, held.get(name, False))
        found |= {f"{name}.reaction_{part}": value for part, value in zip(parts, force, strict=False)}
    for load in model.loads:
        f = examined.loads.get(load.label)
        size = 0.0 if f is None else float(np.linalg.norm(_resultant(examined, f)))
        if f is not None and size > 0.0:
            acts = f != 0.0
            found[f"{load.label}.approach"] = float(f[acts] @ u[acts]) / size
    for name, result in rigid.items():
        values = [*result.displacement, *result.force, *np.atleast_1d(result.rotation), *np.atleast_1d(result.moment)]
        found |= dict(zip(_rigid_parts(model, name), values, strict=True))
    return found


def _resultant(examined: Examined, force: Array) -> Array:
    """Of nodal forces (dofs,), those on obstacles and rigid bodies included; 0 where it is rounding."""
    model, space = examined.model, examined.space
    total = space.at_nodes(force).sum(axis=0)
    for j in range(len(_rigid(model))):
        total[: model.dimension] += force[rigid_dofs(model, space, j)[0][: model.dimension]]
    rounding = _ROUNDING_TOL * np.abs(force).sum()
    return np.where(np.abs(total) > rounding, total, 0.0)
