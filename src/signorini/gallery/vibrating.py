# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that vibrate, with frequencies and loops in closed form."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

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


def plane_bar(length: float, height: float, cells: tuple[int, int], *, guided: bool, clamped: bool) -> Model:
    """A bar or beam in plane stress with quadratic cells and sqrt(E / rho) = 10, without loads.

    Parameters
    ----------
    length, height : of the bar
    cells : along it, and across
    guided : its lower side moves along it alone, so that nothing bends
    clamped : its left end is held along it
    """
    mesh = rectangle(width=length, height=height, nx=cells[0], ny=cells[1], cells="quad8")
    guide = [Support("bottom", u=(None, 0.0))] if guided else []
    clamp = [Support("left", u=(0.0, None))] if clamped else []
    return Model(mesh, kind="plane stress", bodies=[Body("block", _STEEL)], supports=[*guide, *clamp])


def thin_disc(radius: float, nu: float, cells: int, family: Literal["quad", "quad8"]) -> Model:
    """A slice of a long cylinder that moves radially alone: axisymmetric, with a modulus and a density of 1.

    Parameters
    ----------
    radius : of the disc
    nu : Poisson's ratio
    cells : along the radius
    family : of the cells
    """
    mesh = rectangle(width=radius, height=radius / cells, nx=cells, ny=1, cells=family)
    return Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("block", Elastic(E=1.0, nu=nu, density=1.0))],
        supports=[Support("bottom", u=(None, 0.0)), Support("top", u=(None, 0.0))],
    )
