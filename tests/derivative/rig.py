# SPDX-License-Identifier: BSD-3-Clause
"""A curved pad that is pressed on a softer block, heated and pulled there and back: tilted sides, mortar, friction."""

from dataclasses import replace

import numpy as np

import signorini as sg

STEPS = (
    sg.Step(name="press", scale={"down": 1.0, "heat": 0.5}, path="exact"),
    sg.Step(name="pull", scale={"pull": 1.0, "heat": 1.0}, path="exact"),
    sg.Step(name="back", scale={"pull": -0.8}, path="exact"),
)


def rig(kind="plane strain", friction=0.35, steps=STEPS, **law):
    """Six against seven elements, a ring where axisymmetric; the pad touches near its middle at first."""
    middle = 3.0 if kind == "axisymmetric" else 0.0
    pad = sg.rectangle(nx=6, ny=3, width=2.0, origin=(middle - 1.0, 1.0))
    x, y = pad.points.T
    curved = np.column_stack([x, y + 0.02 * (x - middle - 0.1) ** 2 * (2.0 - y)])
    block = sg.rectangle(nx=7, ny=3, width=2.6, origin=(middle - 1.3, 0.0))
    mesh = sg.join({"pad": replace(pad, points=curved), "block": block})
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[
            sg.Body("pad", sg.Elastic(E=2000.0, nu=0.3, expansion=1e-4)),
            sg.Body("block", sg.Elastic(E=900.0, nu=0.25, expansion=2e-4)),
        ],
        supports=[sg.Support("pad.top", u=(None, -0.02), name="down"), sg.Support("block.bottom", u=(0.0, 0.0))],
        loads=[
            sg.Load("pad.left", traction=(6.0, 0.0), name="pull"),
            sg.Load("block", temperature=20.0, name="heat"),
        ],
        contacts=[sg.Contact("pad.bottom", "block.top", friction=friction, name="joint", **law)],
        steps=list(steps),
    )
