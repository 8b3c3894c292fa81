# SPDX-License-Identifier: BSD-3-Clause
"""Moments of contacts are those that bodies need: about any point they balance loads and reactions."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.blocks import curved_blocks
from signorini.gallery.half_spaces import ball
from signorini.gallery.spheres import hollow_spheres


def on_a_roller(cells):
    """A block off the middle of a rigid roller, pulled aside."""
    return sg.Model(
        sg.rectangle(width=4.0, height=1.0, nx=8, ny=2, origin=(-1.0, 0.0), cells=cells),
        bodies=[sg.Body("block", sg.Elastic(E=1000.0, nu=0.3))],
        supports=[sg.Support("top", u=(0.005, -0.02))],
        contacts=[sg.Contact("bottom", sg.Circle(centre=(0.3, -5.0), radius=5.0), friction=0.3)],
        steps=[sg.Step(increments=2)],
    )


def lopsided(cells, across):
    """Curved blocks with more load on one side."""
    model = curved_blocks(cells=cells, across=across, friction=0.3)
    return replace(model, loads=[*model.loads, sg.Load(model.loads[0].on, traction=(0.4, -1.0), name="more")])


def in_space(cells):
    model = ball(n=2, cells=cells, size=4.0, block=3)
    return replace(model, contacts=[replace(model.contacts[0], friction=0.3)], steps=[sg.Step(increments=1)])


def moment(arm, force):
    if arm.shape[1] == 2:
        return arm[:, 0] @ force[:, 1] - arm[:, 1] @ force[:, 0]
    return np.cross(arm, force).sum(axis=0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("build", "given", "body"),
    [
        (on_a_roller, {"cells": "quad"}, "block"),
        (on_a_roller, {"cells": "quad8"}, "block"),
        (on_a_roller, {"cells": "triangle6"}, "block"),
        (lopsided, {"cells": "quad9", "across": (3, 5)}, "upper"),
        (in_space, {"cells": "quad"}, "ball"),
        (in_space, {"cells": "quad8"}, "ball"),
        (hollow_spheres, {"n": (1, 2), "cells": "tetra10"}, "inner"),
    ],
)
def test_moments_of_the_contact_balance_all_others(build, given, body):
    model = build(**given)
    step, points = sg.solve(model).last, model.mesh.points
    ((contact,), (cells,)) = step.contacts, model.mesh.cells.values()
    nodes = np.unique(cells[model.mesh.bodies[body]])
    assert np.isin(contact.node, nodes).all()
    force = step.external[nodes]
    np.testing.assert_allclose(force.sum(axis=0) + contact.forces.sum(axis=0), 0.0, atol=1e-9 * np.abs(force).sum())
    for about in np.vstack([np.zeros(model.dimension), points[nodes[0]], 3.0 * points[nodes[-1]] + 1.0]):
        arm = points[nodes] - about
        other = moment(arm, force)
        size = np.abs(force).sum() * np.abs(arm).max()
        np.testing.assert_allclose(contact.moment(about) + other, 0.0, atol=1e-9 * size)
        parts = [contact.moment(about, of) for of in ("pressure", "friction")]
        np.testing.assert_allclose(sum(parts), contact.moment(about), atol=1e-12 * size)
        assert np.abs(other).max() > 1e-4 * size or not about.any()
