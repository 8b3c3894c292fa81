# SPDX-License-Identifier: BSD-3-Clause
"""Symmetric models, in which pairs come to their events in twos, and what breaks their symmetry."""

from dataclasses import replace

import numpy as np

import signorini as sg


def squeezed(one=1.0):
    """A block that is pressed, and squeezed from both sides, from the left by ``one``: at 1 pairs slip in twos."""
    return sg.Model(
        sg.rectangle(nx=4, ny=2, width=2.0, origin=(-1.0, 0.0)),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, -0.01), name="down")],
        loads=[
            sg.Load("left", traction=(20.0, 0.0), name="one"),
            sg.Load("right", traction=(-20.0, 0.0), name="other"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0), normal=(0, 1)), friction=0.2, name="joint")],
        kind="plane strain",
        steps=[
            sg.Step(scale={"down": 1.0}, path="exact"),
            sg.Step(scale={"one": one, "other": 1.0}, path="exact"),
        ],
    )


def random_squeezed(seed, one=1.0):
    """The same by a seed: crowned or flat, squeezed or pulled, mostly back again; ``one`` breaks its symmetry."""
    random = np.random.default_rng(seed)
    mesh = sg.rectangle(nx=int(random.choice([4, 6, 8])), ny=2, width=2.0, origin=(-1.0, 0.0))
    x, y = mesh.points.T
    crowned = np.column_stack([x, y + random.choice([0.0, 0.003, 0.01]) * x**2 * (1.0 - y)])
    traction = random.choice([-1.0, 1.0]) * random.uniform(5.0, 40.0)
    model, again = squeezed(), random.uniform(-1.0, 0.9)
    scales = [(one, 1.0), (again * one, again)][: 1 + (random.random() < 0.7)]
    return replace(
        model,
        mesh=replace(mesh, points=crowned),
        loads=[
            sg.Load("left", traction=(traction, 0.0), name="one"),
            sg.Load("right", traction=(-traction, 0.0), name="other"),
        ],
        contacts=[replace(model.contacts[0], friction=random.uniform(0.1, 0.7))],
        steps=[
            model.steps[0],
            *(sg.Step(scale=dict(zip(("one", "other"), part, strict=True)), path="exact") for part in scales),
        ],
    )


def squeezed_in_space(seed, one=1.0, facets=8):
    """A block with a crown across, squeezed or pulled from both sides and back; ``one`` as above.

    On octagons, or on smooth cones (0) in increments that are always as fine.
    """
    random = np.random.default_rng(seed)
    layers = np.linspace(0.0, 0.7, 2 if facets else 3)
    block = sg.box(x=np.linspace(0.0, 1.0, int(random.integers(1, 3)) + 1), y=np.linspace(-0.6, 0.6, 3), z=layers)
    x, y, z = block.points.T
    gap = random.choice([0.0, 0.002]) + random.choice([0.0, 0.01]) * x + random.choice([0.004, 0.01]) * y**2
    across = random.choice([-1.0, 1.0]) * random.uniform(5.0, 30.0)
    again, plane = random.uniform(-1.0, 0.9), sg.Plane(point=(0, 0, 0), normal=(0, 0, 1))
    scales = [(one, 1.0), (again * one, again)]
    return sg.Model(
        replace(block, points=np.column_stack([x, y, z + (0.7 - z) * gap])),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0, -0.03), name="down")],
        loads=[
            sg.Load("front", traction=(4.0, across, 0.0), name="one"),
            sg.Load("back", traction=(4.0, -across, 0.0), name="other"),
        ],
        contacts=[sg.Contact("bottom", plane, friction=random.uniform(0.1, 0.5), facets=facets, name="joint")],
        steps=[
            sg.Step(scale=scale, **({"path": "exact"} if facets else {"tolerance": 0.5}))
            for scale in [{"down": 1.0}, *(dict(zip(("one", "other"), part, strict=True)) for part in scales)]
        ],
    )


def turning_alike(one=1.0):
    """A block rounded both ways on smooth cones, pressed and pulled along its plane of symmetry; ``one`` as above.

    Friction turns alike on both sides of that plane, and tells how long increments are; pairs share no event.
    """
    block = sg.box(x=np.linspace(-0.5, 0.5, 5), y=np.linspace(-0.6, 0.6, 4), z=[0.0, 0.7])
    x, y, z = block.points.T
    gap = 0.02 * x**2 + 0.013 * y**2 + 0.004 * (y + 0.6) + 0.002
    return sg.Model(
        replace(block, points=np.column_stack([x, y, z + (0.7 - z) / 0.7 * gap])),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0, -0.03), name="down")],
        loads=[
            sg.Load("right", traction=(0.9, 2.4, 0.0), name="one"),
            sg.Load("left", traction=(-0.9, 2.4, 0.0), name="other"),
        ],
        contacts=[sg.Contact("bottom", sg.Plane(point=(0, 0, 0), normal=(0, 0, 1)), friction=0.3, name="joint")],
        steps=[sg.Step(scale={"down": 1.0, "one": one, "other": 1.0})],
    )


def flat_on_cones(seed, overlap=0.0):
    """A flat block that touches a plane all along, on smooth cones, pressed and pulled; or overlaps it."""
    random = np.random.default_rng(seed)
    pull, friction = random.uniform(-9.0, 9.0, 2), random.uniform(0.1, 0.4)
    plane = sg.Plane(point=(0, 0, 0), normal=(0, 0, 1))
    return sg.Model(
        sg.box(x=np.linspace(0.0, 1.0, 3), y=np.linspace(0.0, 1.2, 3), z=[0.0, 0.35, 0.7]),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.0, 0.0, -0.03), name="down")],
        loads=[sg.Load("right", traction=(*pull, 0.0), name="pull")],
        contacts=[sg.Contact("bottom", plane, friction=friction, interference=overlap, name="joint")],
        steps=[
            sg.Step(scale={"down": 1.0, "pull": 0.3}, tolerance=0.5),
            sg.Step(scale={"down": 1.0, "pull": 1.0}, tolerance=0.5),
        ],
    )
