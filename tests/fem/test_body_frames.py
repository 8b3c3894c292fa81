# SPDX-License-Identifier: BSD-3-Clause
"""Frames of bodies that turn: where they take nodes, and the derivative of that."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

import signorini as sg
from signorini.fem.body_frames import BodyFrames, mean_turn, rotation, rotation_rates
from signorini.fem.space import Space, make_space
from signorini.fem.stress import body_stresses
from signorini.fem.turning_bodies import turning_bodies

STEEL = sg.Elastic(E=200.0, nu=0.3)


def roller(dimension: int, *, hub: bool, **given: object) -> sg.Model:
    """A ring on a bed, in space as long as both are wide."""
    ring = sg.annulus(inner=1.0, outer=2.0, n_radial=2, n_angular=12, centre=(0.0, 2.0))
    bed = sg.rectangle(x=np.linspace(-3.0, 3.0, 7), y=np.linspace(-1.0, 0.0, 3))
    if dimension == 3:
        ring, bed = (sg.extruded(mesh, z=[0.0, 1.0, 2.0], ends=("near", "far")) for mesh in (ring, bed))
    return sg.Model(
        mesh=sg.join({"ring": ring, "bed": bed}),
        kind="plane strain" if dimension == 2 else "3d",
        bodies=[sg.Body("ring", STEEL), sg.Body("bed", STEEL)],
        supports=[sg.Support("bed.bottom", u=(0.0,) * dimension), *given.pop("supports", [])],
        rigid_bodies=[sg.RigidBody("hub", on="ring.inner", point=(0.0, 2.0, 1.0)[:dimension])] if hub else [],
        contacts=[sg.Contact("ring.outer", "bed.top", friction=0.3, sliding="finite", name="c")],
        **given,
    )


def framed(model: sg.Model) -> tuple[Space, BodyFrames]:
    """The space of a model, and the frames of its bodies."""
    space = make_space(model.mesh, obstacles=len(model.rigid_bodies))
    return space, turning_bodies(space, model)


@pytest.mark.parametrize("hub", [True, False])
@pytest.mark.parametrize("dimension", [2, 3])
def test_rows_and_forces_are_seen_by_the_derivative_of_places(dimension: int, hub: bool) -> None:
    """Against differences; forces do the same work."""
    space, frames = framed(roller(dimension, hub=hub))
    random = np.random.default_rng(0)
    u, way = 0.3 * random.normal(size=(2, space.number_of_dofs))
    nodes = space.mesh.points.size
    step = 1e-5
    there, back = (frames.displaced(u + sign * step * way) for sign in (1.0, -1.0))
    slope = frames.tangent(sp.eye_array(len(u), format="csr"), u) @ way
    assert np.abs((there - back) / (2.0 * step) - slope)[:nodes].max() < 1e-8
    forces = random.normal(size=len(u))
    assert frames.felt(forces, u) @ way == pytest.approx(forces @ slope, rel=1e-12)


@pytest.mark.parametrize("hub", [True, False])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_rigid_motion_strains_nothing(dimension: int, hub: bool) -> None:
    """The motion of a frame is read off its nodes again, stresses turn with the body."""
    model = roller(dimension, hub=hub)
    space, frames = framed(model)
    (frame,) = frames.frames
    angles = np.array([2.5]) if dimension == 2 else np.array([0.7, -1.1, 1.6])
    u = np.zeros(space.number_of_dofs)
    own = frame.places[frame.places < len(space.mesh.points)]
    lever = np.zeros((len(frame.places), 3))
    lever[:, :dimension] = frame.lever
    u.reshape(-1, dimension)[frame.places] = np.cross([0.0, 0.0, *angles][-3:], lever)[:, :dimension] + 0.4
    if hub:
        u[frame.turning] = angles / frame.reading[dimension, frame.turning[0]]
        u[space.obstacle_dofs(0)[:dimension]] = 0.4
    assert frame.motion(u)[1] == pytest.approx(angles, abs=1e-12)
    assert np.abs(frames.elastic(u)[space.dofs(own)]).max() < 1e-13
    outside = own[np.linalg.norm(space.mesh.points[own, :2] - [0.0, 2.0], axis=1) > 1.01]
    space.at_nodes(u)[outside, 0] += 1e-3 * space.mesh.points[outside, 0]
    still = body_stresses(space, model, space.at_nodes(frames.elastic(u)))[0].stress
    found = body_stresses(space, model, space.at_nodes(frames.displaced(u)))[0].stress
    turn = np.eye(3)
    turn[:dimension, :dimension] = rotation(frame.motion(u)[1])
    tensor = still[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    expected = (turn @ tensor @ turn.T)[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    assert np.abs(found - expected).max() < 1e-11 * np.abs(still).max()
    assert np.abs(still).max() > 0.1


def test_rates_of_a_rotation_vector_are_those_of_its_matrix() -> None:
    """Spin in space, by differences; near no rotation its series."""
    for angles in (np.array([0.5, -1.2, 0.8]), np.array([2e-5, 1e-5, 3e-5])):
        way, step = np.array([0.3, 0.4, -0.2]), 1e-6
        change = (rotation(angles + step * way) - rotation(angles - step * way)) / (2.0 * step) @ rotation(angles).T
        spin = np.array([change[2, 1], change[0, 2], change[1, 0]])
        assert rotation_rates(angles) @ way == pytest.approx(spin, abs=1e-9)


def test_small_rotations_are_found_in_displacements() -> None:
    """In the plane and in space, whatever else they do."""
    points = np.random.default_rng(1).normal(size=(9, 3))
    assert mean_turn(points, np.cross([0.1, 0.2, -0.3], points) + 5.0) == pytest.approx([0.1, 0.2, -0.3])
    assert mean_turn(points[:, :2], 0.1 * points[:, 1::-1] * [-1.0, 1.0]) == pytest.approx([0.1])


@pytest.mark.parametrize(
    "supports",
    [
        [sg.Support((2.0, 2.0), u=(0.0, None))],
        [sg.Support((2.0, 2.0), u=(0.0, 0.0)), sg.Support((1.0, 2.0), u=(0.0, None))],
    ],
)
def test_what_fixed_directions_hold_has_no_frame(supports: list[sg.Support]) -> None:
    """A hinge at one node has one, whose point is there."""
    assert not framed(roller(2, hub=False, supports=supports))[1]
    _, frames = framed(roller(2, hub=False, supports=[sg.Support((2.0, 2.0), u=(0.0, 0.0))]))
    assert frames.frames[0].lever[np.argmin(np.abs(frames.frames[0].lever).sum(axis=1))].tolist() == [0.0, 0.0]
