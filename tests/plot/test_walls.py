# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles in pictures are where bodies lie against them."""

import numpy as np
import pytest

import signorini as sg
from signorini.plot.picture_data import PictureData
from signorini.plot.pictures import picture

PUNCH = sg.Profile([(3.0, 3.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0)], fillet=0.2)


PLANE, ROUND = sg.Plane((0.0, 1.2), (0.0, -1.0)), sg.Circle((2.0, 3.0), 2.0)


@pytest.mark.parametrize(("shape", "u"), [(PLANE, (0.1, -0.25)), (PUNCH, (0.05, -0.1)), (ROUND, (-0.03, -0.2))])
def test_closed_nodes_lie_on_the_obstacle_where_it_is_drawn(shape, u):
    model = sg.Model(
        sg.rectangle(width=4, height=1, nx=32, ny=8),
        bodies=[sg.Body("block", sg.Elastic(E=100.0, nu=0.3))],
        supports=[sg.Support("bottom", u=(0, 0))],
        obstacles=[sg.Rigid("tool", shape, u=u)],
        contacts=[sg.Contact("top", "tool", name="seat")],
    )
    solution = sg.solve(model)
    data = PictureData(solution)
    (wall,) = data.walls
    contact = solution.contact("seat")
    moved = (data.bodies.points + data.bodies.displacement)[contact.node]
    depth = wall.depth(moved, moved=True)
    allowed = (1e-9 if isinstance(shape, sg.Plane) else 0.1) * abs(u[1])  # gaps are linear in the displacements
    assert contact.closed.sum() > 5
    assert np.abs(depth[contact.closed]).max() < allowed
    assert depth.max() < allowed
    for what in ("mesh", "stress"):
        assert picture(data, what).axes[0].get_ylim()[1] > 1.0
