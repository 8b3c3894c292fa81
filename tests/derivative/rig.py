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


def ball_rig(friction=0.3, increments=2):
    """A pad that is curved both ways, pressed on a softer block and pulled askew: pairs slip and turn."""
    pad = sg.box(x=np.linspace(0, 1, 3), y=np.linspace(0, 1, 3), z=[1.0, 2.0])
    x, y, z = pad.points.T
    curved = np.column_stack([x, y, z + 0.03 * ((x - 0.45) ** 2 + (y - 0.52) ** 2) * (2.0 - z)])
    block = sg.box(x=np.linspace(-0.1, 1.1, 4), y=np.linspace(-0.1, 1.1, 4), z=[0.0, 1.0])
    return sg.Model(
        sg.join({"pad": replace(pad, points=curved), "block": block}),
        bodies=[sg.Body("pad", sg.Elastic(E=2000.0, nu=0.3)), sg.Body("block", sg.Elastic(E=900.0, nu=0.25))],
        supports=[
            sg.Support("pad.top", u=(0.0, 0.0, -0.02), name="down"),
            sg.Support("block.bottom", u=(0.0, 0.0, 0.0)),
        ],
        loads=[sg.Load("pad.left", traction=(30.0, 11.0, 0.0), name="pull")],
        contacts=[sg.Contact("pad.bottom", "block.top", friction=friction, name="joint")],
        steps=[
            sg.Step(name="press", scale={"down": 1.0}, increments=1),
            sg.Step(name="pull", scale={"pull": 1.0}, increments=increments),
        ],
    )


def tilted_rig(friction=0.2, facets=8, steps=None):
    """A block with four corners above a rigid plane, pressed unevenly and pulled one way and the other."""
    block = sg.box(x=np.linspace(0, 1, 2), y=np.linspace(0, 1.2, 2), z=[0.0, 0.7])
    x, y, z = block.points.T
    gap = 0.002 + 0.01 * x + 0.006 * y + 0.004 * x * y
    block = replace(block, points=np.column_stack([x, y, z + (0.7 - z) * gap]))
    path = "exact" if facets else None
    pulled = {"down": 1.0, "pull": 0.4}
    return sg.Model(
        block,
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0, -0.03), name="down")],
        loads=[
            sg.Load("right", traction=(9.0, 4.0, 0.0), name="pull"),
            sg.Load("back", traction=(0.0, 11.0, 0.0), name="across"),
        ],
        contacts=[
            sg.Contact(
                "bottom", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)), friction=friction, facets=facets, name="joint"
            )
        ],
        steps=steps
        or [
            sg.Step(name="press", scale=pulled, path=path),
            sg.Step(name="turn", scale={"pull": 0.1, "across": 1.0}, path=path),
        ],
    )


def twisted_rig():
    """A hub shrunk on a shaft, which is pulled and twisted."""
    shaft = sg.rectangle(nx=2, ny=6, width=5.0, height=12.0, origin=(5.0, 0.0))
    hub = sg.rectangle(nx=2, ny=3, width=5.0, height=6.0, origin=(10.0, 0.0))
    contact = sg.Contact("hub.left", "shaft.right", friction=0.15, interference=0.05, name="joint", facets=8)
    return sg.Model(
        sg.join({"shaft": shaft, "hub": hub}),
        kind="axisymmetric twist",
        bodies=[sg.Body("shaft", sg.Elastic(E=1000.0, nu=0.3)), sg.Body("hub", sg.Elastic(E=800.0, nu=0.25))],
        supports=[sg.Support("hub.right", u=(None, 0.0, 0.0))],
        loads=[sg.Load("shaft.top", traction=(0.0, 0.2, 0.1), name="pull")],
        contacts=[contact],
        steps=[
            sg.Step(name="fit", scale={"pull": 0.0}, path="exact"),
            sg.Step(name="pull", scale={"pull": 1.0}, path="exact"),
        ],
    )
