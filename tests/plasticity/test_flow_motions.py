# SPDX-License-Identifier: BSD-3-Clause
"""Motions in which bodies can flow: no volume changes, and nothing strains that does not yield."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.flow_motions import FlowMotions
from signorini.engine.increment import Mechanism
from signorini.engine.prepare import prepare
from signorini.fem.locking import modes_in_flow
from signorini.plasticity.volume import flow_strains, volume_rows
from signorini.verify.footings import IN_SPACE
from tests.helpers.columns import ELASTIC, Y

HARDENING = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(Y, hardening=20.0))
PERFECT = sg.Elastic(E=200.0, nu=0.3, plastic=sg.Plastic(Y))
CASES = [
    ("quad", "plane strain", "mean dilatation"),
    ("quad", "plane strain", "incompatible"),
    ("quad8", "axisymmetric", "mean dilatation"),
    ("quad9", "axisymmetric", "mean dilatation"),
    ("triangle6", "plane strain", "mean dilatation"),
    ("hexahedron", "3d", "mean dilatation"),
    ("hexahedron", "3d", "incompatible"),
    ("quad", "plane stress", None),
]


def stack(cells, kind, formulation, *, foot=ELASTIC):
    """A distorted block that yields, tied to one that may not, both held below."""
    x, y = np.linspace(1.0, 2.0, 3), np.linspace(0.0, 1.0, 3)
    if kind == "3d":
        parts = {name: sg.box(x=x, y=y, z=z, cells=cells) for name, z in (("up", y + 1.0), ("low", y))}
    else:
        parts = {name: sg.rectangle(x=x, y=at, cells=cells) for name, at in (("up", y + 1.0), ("low", y))}
    mesh = sg.join(parts)
    d, height = mesh.points.shape[1], mesh.points[:, -1:]
    if cells != "hexahedron" or formulation != "incompatible":  # modes keep no volume of distorted ones
        mesh = replace(mesh, points=mesh.points + 0.05 * np.sin(np.pi * height) * np.cos(2.0 * mesh.points))
    return sg.Model(
        mesh,
        kind=kind,
        bodies=[sg.Body("up", PERFECT, formulation), sg.Body("low", foot)],
        supports=[sg.Support("low.bottom", u=(0.0,) * d)],
        loads=[sg.Load("up.top", pressure=1.0)],
        contacts=[sg.Contact("up.bottom", "low.top", friction="tied")],
    )


@pytest.mark.parametrize(("cells", "kind", "formulation"), CASES)
def test_the_nearest_motion_keeps_what_must_be_kept(cells, kind, formulation):
    """Whatever the motion is that it is near to."""
    prepared = prepare(stack(cells, kind, formulation))
    motions = FlowMotions.of(prepared)
    free = np.random.default_rng(0).standard_normal(prepared.constraints.transform.shape[1])
    forces = np.zeros((prepared.interface.directions, len(prepared.interface)))
    v = motions.nearest(Mechanism(free, forces))
    assert np.abs(v).max() == 1.0
    points = prepared.model.mesh.points
    assert np.abs(v.reshape(points.shape)[points[:, -1] < 1.0]).max() < 1e-9
    bodies = prepared.yielding
    rate = flow_strains(bodies, v, bodies.cold())
    assert np.abs(rate).max() > 1e-2
    assert np.abs(bodies.dilatation(rate)).max() < 1e-9 * np.abs(rate).max()


@pytest.mark.parametrize(("cells", "kind", "formulation"), CASES)
def test_a_uniform_dilatation_is_measured_exactly(cells, kind, formulation):
    """In plane stress the thickness gives way and there is none."""
    prepared = prepare(stack(cells, kind, formulation))
    points, bodies = prepared.model.mesh.points, prepared.yielding
    v = points * ((1.0, 0.0) if kind == "axisymmetric" else np.arange(1.0, 1.0 + points.shape[1]))
    trace = {"plane strain": 3.0, "axisymmetric": 2.0, "3d": 6.0, "plane stress": 0.0}[kind]
    volume = bodies.weights.sum()
    assert np.sum((volume_rows(bodies) @ v.ravel()) ** 2) == pytest.approx(trace**2 * volume, rel=1e-12)


def test_rules_with_points_that_count_negative():
    """Of linear wedges, among hexahedra around an axis."""
    (punched,) = (one for one in IN_SPACE if one.cells == "hexahedron and wedge")
    prepared = prepare(punched.model(1.0))
    bodies, points = prepared.yielding, prepared.model.mesh.points
    assert bodies.weights.min() < 0.0
    v = points * np.arange(1.0, 4.0)
    assert np.sum((volume_rows(bodies) @ v.ravel()) ** 2) == pytest.approx(36.0 * bodies.weights.sum(), rel=1e-12)


@pytest.mark.parametrize("kind", ["plane strain", "axisymmetric", "3d"])
def test_modes_that_hardly_keep_their_volume_are_told(kind):
    """By `check`, and by the results once such a body has flowed."""
    cells = "hexahedron" if kind == "3d" else "quad"
    model = replace(stack(cells, kind, "incompatible"), loads=[sg.Load("up.top", pressure=1.4)])
    model = replace(model, bodies=[replace(model.bodies[0], material=HARDENING), model.bodies[1]])
    told = [note for note in sg.solve(model).last.notes if "flow too stiffly" in note]
    assert len(told) == (kind != "plane strain")
    assert list(modes_in_flow(model).values()) == told
    calm = replace(model, bodies=[replace(model.bodies[0], formulation="mean dilatation"), model.bodies[1]])
    assert not modes_in_flow(calm)
