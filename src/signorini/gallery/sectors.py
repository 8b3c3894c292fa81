# SPDX-License-Identifier: BSD-3-Clause
"""Rings in contact, whole and as one of their sectors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.meshing.plane import annulus
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.links import CyclicSymmetry
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh, join
from signorini.model.model import Model
from signorini.model.step import Step

SECTORS = 6
"""Of the whole ring, each with a pad."""

_SECTOR_CELLS = 8  # cells of a sector around the axis; a pad has half of them
_STEEL = Elastic(E=200.0, nu=0.3, density=2.0)


def ring_on_pads(*, whole: bool) -> Model:
    """A ring that spins and is dragged around by a traction that repeats, on pads that press it with friction.

    Parameters
    ----------
    whole : all sectors, or one with cyclic symmetry
    """
    count = SECTORS if whole else 1
    parts: dict[str, Mesh] = {"ring": _arc(1.0, 2.0, 360.0 / SECTORS * count, _SECTOR_CELLS * count)}
    for k in range(count):
        pad = _arc(0.7, 1.0, 180.0 / SECTORS, _SECTOR_CELLS // 2)
        parts[f"pad{k}"] = replace(pad, points=pad.points @ _rotation((0.5 + 2.0 * k) * np.pi / SECTORS).T)
    pads = [f"pad{k}" for k in range(count)]
    return Model(
        join(parts),
        kind="plane strain",
        bodies=[Body(name, _STEEL) for name in parts],
        supports=[Support(on, u=(0.0, 0.0)) for on in ("ring.outer", *(f"{pad}.inner" for pad in pads))],
        loads=[
            Load("ring.outer", traction=_spokes, name="spokes"),
            Load("ring.inner", traction=_spokes, name="drag"),
            Load("ring", centrifugal=0.5, name="spin"),
        ],
        contacts=[Contact(f"{pad}.outer", "ring.inner", friction=0.15, interference=0.002, name=pad) for pad in pads],
        cyclic_symmetries=[] if whole else [CyclicSymmetry("ring.start", "ring.end", sectors=SECTORS)],
        steps=[
            Step(name="press", scale={"spokes": 0.0, "spin": 0.0, "drag": 0.0}),
            Step(name="drag", scale={"spokes": 1.0, "spin": 1.0, "drag": 1.0}),
        ],
    )


def ring_on_shaft(*, whole: bool) -> Model:
    """A ring that is shrunk on a shaft and dragged around it until some of it slips: sectors cut their contact.

    Parameters
    ----------
    whole : all sectors, or one with cyclic symmetry
    """
    count = SECTORS if whole else 1
    angle = 360.0 / SECTORS * count
    parts = {"ring": _arc(1.0, 1.3, angle, 5 * count), "shaft": _arc(0.5, 1.0, angle, 4 * count)}
    return Model(
        join(parts),
        kind="plane strain",
        bodies=[Body(name, _STEEL) for name in parts],
        supports=[Support("shaft.inner", u=(0.0, 0.0))],
        loads=[Load("ring.outer", traction=_spokes, name="drag"), Load("ring.outer", pressure=_lobes, name="lobes")],
        contacts=[Contact("ring.inner", "shaft.outer", friction=0.2, interference=0.002)],
        cyclic_symmetries=[]
        if whole
        else [CyclicSymmetry(f"{name}.start", f"{name}.end", sectors=SECTORS) for name in parts],
        steps=[
            Step(name="press", scale={"drag": 0.0, "lobes": 0.0}),
            Step(name="drag", scale={"drag": 0.35, "lobes": 1.0}),
        ],
    )


def _arc(inner: float, outer: float, angle: float, cells: int) -> Mesh:
    return annulus(inner=inner, outer=outer, n_radial=3, n_angular=cells, angle=angle, centre=(0.0, 0.0))


def _rotation(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _spokes(at: Array) -> Array:
    """A traction around the axis that repeats with the sectors and is no mirror image of itself, (k, 2)."""
    angle = np.arctan2(at[:, 1], at[:, 0])
    size = 0.02 + 0.01 * np.sin(SECTORS * angle) + 0.01 * np.cos(2 * SECTORS * angle)
    around: Array = size[:, None] * np.column_stack([-at[:, 1], at[:, 0]])
    return around


def _lobes(at: Array) -> Array:
    """A pressure on a few places around the axis, drawn elsewhere, (k,)."""
    found: Array = 0.1 * np.sin(SECTORS * np.arctan2(at[:, 1], at[:, 0]) + 4.4)
    return found
