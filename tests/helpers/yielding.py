# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that yield whose strains are prescribed: their points, and blocks of one cell."""

from dataclasses import replace

import numpy as np

import signorini as sg
from signorini.engine.prepare import prepare

KINDS = ("plane strain", "axisymmetric", "space")

LAWS = {
    "perfect": sg.Plastic(1.0),
    "linear": sg.Plastic(1.0, hardening=20.0),
    "table": sg.Plastic([(0.0, 1.0), (0.002, 1.1), (0.01, 1.3)], hardening=2.0),
    "prager": sg.Plastic(1.0, backstresses=[(50.0, 0.0)]),
    "both": sg.Plastic(1.0, hardening=20.0, backstresses=[(50.0, 0.0), (10.0, 0.0)]),
}


def block(kind, plastic, *, n=1, nu=0.3, E=200.0, formulation=None, bent=0.0, **given):
    """A unit square, a ring 0 .. 1 or a unit cube of n cells along each edge; ``given`` as of `Model`.

    Parameters
    ----------
    formulation : of its cells
    bent : by how much nodes inside are moved at random, of the size of a cell
    """
    grid = np.linspace(0.0, 1.0, n + 1)
    body = sg.Body("block", sg.Elastic(E=E, nu=nu, plastic=plastic), formulation)
    mesh = sg.box(x=grid, y=grid, z=grid) if kind == "space" else sg.rectangle(x=grid, y=grid)
    inside = ((mesh.points > 0.0) & (mesh.points < 1.0)).all(axis=1)
    moves = np.random.default_rng(5).uniform(-1.0, 1.0, size=mesh.points.shape)
    mesh = replace(mesh, points=mesh.points + bent / n * moves * inside[:, None])
    return sg.Model(mesh, bodies=[body], **({} if kind == "space" else {"kind": kind}), **given)


def points_of(kind, plastic, n=2, **given):
    """The points of a block that is held at its foot; ``given`` as of `block`."""
    zero = (0.0,) * (3 if kind == "space" else 2)
    return prepare(block(kind, plastic, n=n, supports=[sg.Support("bottom", u=zero)], **given)).yielding


def pulled(kind, plastic, *, sides=None, along=1.0, steps, **given):
    """A block of one cell that is pulled along its last axis; its sides are free, or held.

    Parameters
    ----------
    sides : "held": no motion across; None: uniaxial stress
    along : strain at factor 1 of "pull"
    """
    d = 3 if kind == "space" else 2
    names = ("left", "right", "front", "back", "bottom", "top") if d == 3 else ("left", "right", "bottom", "top")
    supports = []
    for i, name in enumerate(names[: 2 * (d - 1)]):
        if sides == "held" or (i % 2 == 0 and kind != "axisymmetric"):
            supports.append(sg.Support(name, u=tuple(0.0 if axis == i // 2 else None for axis in range(d))))
    supports += [
        sg.Support(name, u=(*(None,) * (d - 1), value), name=moved)
        for name, value, moved in ((names[-2], 0.0, "foot"), (names[-1], along, "pull"))
    ]
    return block(kind, plastic, supports=supports, steps=steps, **given)


def sheared(kind, plastic, angle, steps):
    """A block of one cell whose top moves along x by the angle, simple shear."""
    d = 3 if kind == "space" else 2
    zero, top = (0.0,) * d, (angle, *(0.0,) * (d - 1))
    supports = [sg.Support("bottom", u=zero), sg.Support("top", u=top, name="shear")]
    return block(kind, plastic, supports=supports, steps=steps)
