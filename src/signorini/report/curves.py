# SPDX-License-Identifier: BSD-3-Clause
"""Charts of a history: contacts along their surface, their forces on the way, hysteresis, reactions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.plot.curve import Curve, closed_range
from signorini.plot.history import contact_forces, friction_direction
from signorini.plot.picture_data import PictureData
from signorini.plot.style import named
from signorini.report.charts import ChartData, Line
from signorini.solution.history import History

_MOST_STEPS = 60  # of which profiles are on the page
_MIN_SHARE = 1e-9  # of the largest of its kind: smaller ones are rounding, and no curve


def profiles(data: PictureData) -> Iterator[ChartData]:
    """Pressure and friction along every contact of a plane model, at the ends of steps."""
    count = len(data.history.steps)
    numbers = sorted(set(np.linspace(1, count, min(count, _MOST_STEPS)).round().astype(int).tolist()))
    steps = {number: data.curves(number) for number in numbers}
    for i, contact in enumerate(data.model.contacts):
        groups = {}
        ranges = np.array([closed_range(curves[i]) for curves in steps.values()])
        for number, curves in steps.items():
            curve = _within(curves[i], ranges[:, 0].min(), ranges[:, 1].max())
            lines = [Line(name="pressure", x=curve.s, y=curve.pressure, colour=0)]
            if curve.friction > 0:
                lines.append(Line(name="friction", x=curve.s, y=curve.traction, colour=1))
                if curve.hoop is not None:
                    lines.append(Line(name="friction around the axis", x=curve.s, y=curve.hoop, colour=2))
            if curve.has_bound:
                bound, name = curve.friction * curve.pressure, f"\u00b1 {curve.friction:g} times the pressure"
                lines += [Line(name=name, x=curve.s, y=bound, colour=1, dashed=True)]
                lines += (
                    [Line(name=name, x=curve.s, y=-bound, colour=1, dashed=True)] if (curve.traction < 0).any() else []
                )
            groups[f"end of step {number}, {data.history.steps[number - 1].name}"] = lines
        shown = f"{contact.label}: pressure and friction along the surface"
        yield ChartData(
            title=shown,
            x=named(steps[numbers[-1]][i].place, data.units),
            y=f"pressure and friction, {data.units.pressure}",
            groups=groups,
        )


def _within(curve: Curve, low: float, high: float) -> Curve:
    """The part of a curve that is worth showing."""
    own = (curve.s >= low) & (curve.s <= high)
    return replace(
        curve,
        s=curve.s[own],
        pressure=curve.pressure[own],
        traction=curve.traction[own],
        hoop=None if curve.hoop is None else curve.hoop[own],
        status=curve.status[own],
    )


def forces(data: PictureData) -> Iterator[ChartData]:
    """Normal force, friction force and work of friction of every contact over the load."""
    for i, contact in enumerate(data.model.contacts):
        found = contact_forces(data.history, i)
        if len(found.load) < 2:
            continue
        along, words = friction_direction(found, data.solid)
        lines = [Line(name="normal force", x=found.load, y=np.linalg.norm(found.normal, axis=1), colour=0)]
        if np.abs(found.friction).max() > 0.0:
            lines.append(Line(name=f"friction force {words}", x=found.load, y=found.friction @ along, colour=1))
        if data.model.twists:
            lines.append(Line(name="torque over the largest radius", x=found.load, y=found.friction[:, 2], colour=2))
        load = "load: step k goes from k - 1 to k"
        yield ChartData(title=f"{contact.label}: forces", x=load, y=_force(data), groups={"": lines})
        if found.dissipation.max() > 0.0:
            work = [Line(name="dissipated by friction", x=found.load, y=found.dissipation, colour=2)]
            yield ChartData(
                title=f"{contact.label}: work of friction", x=load, y=f"work, {data.units.work}", groups={"": work}
            )


def hysteresis(data: PictureData) -> Iterator[ChartData]:
    """Friction force over mean slip of every contact of a plane model that has slipped."""
    if data.solid:
        return
    instants = [instant for step in data.history.steps for instant in step.instants]
    for i, contact in enumerate(data.model.contacts):
        found = contact_forces(data.history, i)
        along, _ = friction_direction(found, solid=False)
        force = (found.friction @ along)[-len(instants) :]
        slips = np.array([_mean(instant.contacts[i].slip, instant.contacts[i].area) for instant in instants])
        ways = [("friction force", force, slips[:, 0])]
        if data.model.twists:
            ways.append(("torque over the largest radius", found.friction[-len(instants) :, 2], slips[:, 1]))
        for name, values, slip in ways:
            if len(instants) < 3 or np.ptp(slip) == 0.0 or np.abs(values).max() == 0.0:
                continue
            loop = [Line(name=name, x=slip, y=values, colour=1)]
            words = f"{contact.label}: {name} over slip"
            yield ChartData(title=words, x=f"mean slip, {data.units.length}", y=_force(data), groups={"": loop})


def _mean(values: Array, weights: Array) -> Array:
    """(1 or 2,) Of values (n,) or (n, 2)."""
    return np.atleast_1d(values.T @ weights / (weights.sum() or 1.0))


def reactions(data: PictureData) -> Iterator[ChartData]:
    """Reactions of supports at the ends of steps."""
    history: History = data.history
    steps = np.arange(len(history.steps) + 1.0)
    if len(steps) < 3 or history.loaded:
        return
    names = list(dict.fromkeys(name for step in history.steps for name in step.reactions))
    found = {
        name: np.array(
            [np.zeros(data.model.components), *(_reaction(step.reactions.get(name), data) for step in history.steps)]
        )
        for name in names
    }
    if data.model.twists:
        for name, values in found.items():
            if values[:, 2].any():
                torque = [Line(name=name, x=steps, y=values[:, 2], colour=2)]
                words = f"torque of {name}"
                yield ChartData(title=words, x="ends of steps", y=f"torque, {data.units.work}", groups={"": torque})
        found = {name: values[:, :2] for name, values in found.items()}
    largest = max((float(np.abs(values).max()) for values in found.values()), default=0.0)
    for name, values in found.items():
        lines = [
            Line(name=f"{name}, {data.model.axes[k]}", x=steps, y=values[:, k], colour=k)
            for k in range(values.shape[1])
            if np.abs(values[:, k]).max() > _MIN_SHARE * largest
        ]
        if lines:
            yield ChartData(title=f"reaction of {name}", x="ends of steps", y=_force(data), groups={"": lines})


def _reaction(force: Array | None, data: PictureData) -> Array:
    """The force of a support, without the moments of one on a rigid body; nothing where it has let go."""
    return np.zeros(data.model.components) if force is None else np.asarray(force)[: data.model.components]


def _force(data: PictureData) -> str:
    """What an axis of forces says."""
    unit = data.units.force
    return unit if unit == "force" else f"force, {unit}"
