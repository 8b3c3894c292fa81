# SPDX-License-Identifier: BSD-3-Clause
"""The same model in other units, and in another place with other axes; of the parts that `plastic_models` uses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import signorini as sg

Back = Callable[[np.ndarray], np.ndarray]
"""Displacements (nodes, d) of the other model as those of the first."""

_LENGTH = 1e-3  # metres in a millimetre
_STRESS = 1e6  # pascals in a megapascal; forces are newtons in both
_AWAY = 10.0  # lengths: how far off the other place is


def in_other_units(model: sg.Model) -> tuple[sg.Model, Back]:
    """Pascals and metres for megapascals and millimetres."""

    def law(plastic: Any) -> Any:
        return plastic and replace(
            plastic,
            yield_stress=[(p, Y * _STRESS, *warm) for p, Y, *warm in plastic.yield_stress],
            hardening=plastic.hardening * _STRESS,
            backstresses=[(C * _STRESS, gamma) for C, gamma in plastic.backstresses],
        )

    def long(u: Sequence[float | None]) -> tuple[float | None, ...]:
        return tuple(part if part is None else part * _LENGTH for part in u)

    def shape(one: Any) -> Any:
        if not isinstance(one, sg.Circle):
            return one  # planes go through the origin
        return sg.Circle(tuple(part * _LENGTH for part in one.centre), one.radius * _LENGTH)

    def heated(load: sg.Load) -> sg.Load:
        return load if load.temperature is None else replace(load, temperature=lambda x: load.temperature(x / _LENGTH))

    bodies = [
        replace(body, material=replace(body.material, E=body.material.E * _STRESS, plastic=law(body.material.plastic)))
        for body in model.bodies
    ]
    steps = [
        replace(step, interference={name: value * _LENGTH for name, value in step.interference.items()})
        for step in model.steps
    ]
    other = replace(
        model,
        mesh=replace(model.mesh, points=model.mesh.points * _LENGTH),
        thickness=model.thickness * _LENGTH if model.kind in ("plane strain", "plane stress") else model.thickness,
        bodies=bodies,
        supports=[replace(support, u=long(support.u)) for support in model.supports],
        loads=[heated(load) for load in model.loads],
        contacts=[replace(contact, mortar=shape(contact.mortar)) for contact in model.contacts],
        obstacles=[replace(one, shape=shape(one.shape), u=long(one.u)) for one in model.obstacles],
        steps=steps,
    )
    return other, lambda u: u / _LENGTH


def turned(model: sg.Model) -> tuple[sg.Model, Back]:
    """A quarter of a turn in the plane, a third of one about a diagonal in space, along the axis of rings none."""
    d, ring = model.dimension, model.kind == "axisymmetric"
    R = np.eye(d) if ring else np.array([[0.0, -1.0], [1.0, 0.0]]) if d == 2 else np.roll(np.eye(3), 1, axis=0)
    away = _AWAY * np.array([0.0, 1.0] if ring else [1.0] * d)
    source, sign = np.abs(R).argmax(axis=1), R.sum(axis=1)

    def vector(v: Sequence[float | None]) -> tuple[float | None, ...]:
        ahead = [None if v[k] is None else float(s * v[k]) for k, s in zip(source, sign, strict=True)]
        return (*ahead, *v[d:])

    def place(x: Sequence[float]) -> tuple[float, ...]:
        return tuple((R @ x + away).tolist())

    def shape(one: Any) -> Any:
        if isinstance(one, sg.Plane):
            return sg.Plane(place(one.point), tuple((R @ one.normal).tolist()))
        return replace(one, centre=place(one.centre)) if isinstance(one, sg.Circle) else one

    def load(one: sg.Load) -> sg.Load:
        if one.temperature is not None:
            return replace(one, temperature=lambda x: one.temperature((x - away) @ R))
        return replace(one, force=vector(one.force))

    other = replace(
        model,
        mesh=replace(model.mesh, points=model.mesh.points @ R.T + away),
        supports=[replace(support, u=vector(support.u)) for support in model.supports],
        loads=[load(one) for one in model.loads],
        contacts=[replace(contact, mortar=shape(contact.mortar)) for contact in model.contacts],
        obstacles=[
            replace(one, shape=shape(one.shape), u=vector(one.u), point=None if one.point is None else place(one.point))
            for one in model.obstacles
        ],
        rigid_bodies=[replace(body, point=place(body.point)) for body in model.rigid_bodies],
    )
    return other, lambda u: u @ R
