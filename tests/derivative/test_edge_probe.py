# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that share events: what takes them apart, asked of two ways back, as ways forwards have it."""

import pytest

import signorini as sg
from signorini.derivative.edge_probe import EdgeProbe
from signorini.derivative.validity import edges


@pytest.fixture(scope="module")
def symmetric():
    """A block that is pressed, and squeezed alike from both sides: pairs slip in twos."""
    model = sg.Model(
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
            sg.Step(scale={"one": 1.0, "other": 1.0}, path="exact"),
        ],
    )
    return sg.solve(model, tape=True)._taped


@pytest.mark.parametrize("parameter", ["friction.joint", "E.block", "support.down", "load.one", "load.other"])
def test_the_probe_finds_what_ways_forwards_find(symmetric, parameter):
    kind, _, name = parameter.partition(".")
    probe = EdgeProbe(symmetric.view.points)
    assert probe
    wanted = bool(edges(symmetric.view, symmetric.forward(kind, name)))
    assert wanted == (kind == "load")
    assert probe.takes_apart(symmetric.change(kind, name)) == wanted
