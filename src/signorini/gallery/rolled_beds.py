# SPDX-License-Identifier: BSD-3-Clause
"""A bed that yields, over which a rigid wheel rolls to and fro without friction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.gallery.large_bodies import graded_lines
from signorini.gallery.yielding import PERFECT, SHEAR_STRENGTH
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Circle
from signorini.model.rigid import Rigid
from signorini.model.step import Step
from signorini.reference.hertz import contact_modulus

_SIZE = 12.0  # half-widths of contact from the middle to the ends of the bed and down
_END_LENGTH = 1.5  # half-widths beyond a stroke in which cells are fine: the contact at its end
_DEEP = 2.0  # half-widths down to which cells are fine: the largest shear is at 0.78


def rolled_bed(p_0: float, *, n: int, run: float, strokes: int) -> Model:
    """A bed that is drawn to and fro under a wheel, which a force presses on it at one end.

    Parameters
    ----------
    p_0 : largest pressure of an elastic contact, force per area; its half-width is 1
    n : cells in a half-width
    run : half a stroke
    strokes : one there, one back, and so on, each a step behind the two that press
    """
    young, nu = 1000.0 * SHEAR_STRENGTH, 0.3
    fine = run + _END_LENGTH
    beyond = fine + graded_lines(2.0 / n, 1.0 / n, _SIZE - fine, 1.3)[1:]
    x = np.concatenate([-beyond[::-1], np.linspace(-fine, fine, round(2.0 * fine * n) + 1), beyond])
    bed = rectangle(x=x, y=-graded_lines(_DEEP, 1.0 / n, _SIZE, 1.3)[::-1])
    held = np.unique(np.concatenate([bed.facets(side)[0].ravel() for side in ("bottom", "left", "right")]))
    radius = 0.5 * contact_modulus((young, nu)) / p_0
    ends = [run * (-1.0) ** (k + 1) for k in range(strokes + 1)]
    (name,) = bed.bodies
    return Model(
        replace(bed, nodes={**bed.nodes, "held": held}),
        title="Bed that a wheel rolls over",
        bodies=[Body(name, Elastic(E=young, nu=nu, plastic=PERFECT))],
        supports=[Support("held", u=(-1.0, 0.0), name="drag")],
        obstacles=[Rigid("wheel", Circle((0.0, radius), radius), u=(0.0, None), force=(None, -0.5 * np.pi * p_0))],
        contacts=[Contact("top", "wheel", sliding="finite", name="tread")],
        steps=[
            Step(name="place", scale={"wheel": 0.0, "drag": ends[0]}, increments=1),
            Step(name="press", scale={"wheel": 1.0, "drag": ends[0]}, increments=2),
            *(
                Step(name=f"stroke {k + 1}", scale={"wheel": 1.0, "drag": end}, increments=1)
                for k, end in enumerate(ends[1:])
            ),
        ],
    )
