# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that vibrate, with frequencies and loops in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.links import Equation
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane
from signorini.reference.vibration import BarInBed

_HEIGHT, _PRESSURE, _FRICTION = 0.1, 1.0, 0.5  # of the bar, on it, of the bed
_STEEL = Elastic(E=100.0, nu=0.0, density=1.0)  # without contraction: a bar, and pressure that stays uniform


def bar_in_a_bed(cells: int) -> tuple[Model, BarInBed]:
    """A bar of unit thickness whose first half lies on a rough plane and whose second half sticks out.

    Sections stay upright by equations, so that strains are those of a bar. One step: pressure on the whole bar.

    Parameters
    ----------
    cells : along each half
    """
    along = np.concatenate([np.linspace(0.0, 1.0, cells + 1), 1.0 + np.linspace(0.0, 1.0, cells + 1)[1:]])
    mesh = rectangle(x=along, y=[0.0, _HEIGHT])
    bottom, points = mesh.boundaries["bottom"], mesh.points
    in_bed = np.flatnonzero((points[bottom, 0] <= 1.0).all(axis=1))
    beyond = np.flatnonzero((points[:, 0] > 1.0) & (points[:, 1] == 0.0))
    mesh = replace(mesh, boundaries={**mesh.boundaries, "foot": bottom[in_bed]}, nodes={"guided": beyond})
    model = Model(
        mesh,
        kind="plane stress",
        bodies=[Body("block", _STEEL)],
        supports=[Support("guided", u=(None, 0.0))],
        equations=[Equation([((x, 0.0), "x", 1.0), ((x, _HEIGHT), "x", -1.0)]) for x in along.tolist()],
        loads=[Load("top", pressure=_PRESSURE)],
        contacts=[Contact("foot", Plane(point=(0.0, 0.0), normal=(0.0, 1.0)), friction=_FRICTION, name="bed")],
    )
    exact = BarInBed(
        stiffness=_STEEL.E * _HEIGHT,
        line_density=_STEEL.density * _HEIGHT,
        friction=_FRICTION * _PRESSURE,
        free=1.0,
        bed=1.0,
    )
    return model, exact
