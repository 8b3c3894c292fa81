# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in space beside closed forms and beside the plane model; the finer meshes are in `verify`."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.engine.solve import solve
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.gallery.half_spaces import EQUAL, ball, hertz
from signorini.gallery.press_fit import press_fit, press_fit_in_space
from signorini.meshing.plane import target
from signorini.meshing.solid import extruded
from signorini.reference.hertz_point import round_punch
from signorini.verify.space import ball_on_plane, mindlin, press_fit_as_slab


@pytest.mark.parametrize(
    "check", [*ball_on_plane(), *mindlin(), *press_fit_as_slab()], ids=lambda check: f"{check.case}: {check.quantity}"
)
def test_closed_form(check):
    assert check.passed, f"{check.computed} instead of {check.reference}"


@pytest.mark.parametrize("block", [3, 4])
def test_hertz_on_a_coarse_block(block):
    contact, exact = solve(ball(n=3, block=block, size=10.0)).contact("contact"), hertz(2)
    assert contact.coupling == ("nodes" if block == 3 else "mortar")
    assert contact.pressure.max() == pytest.approx(exact.peak_pressure, rel=0.015)
    np.testing.assert_allclose(contact.normal_force[2], exact.force / 4.0, rtol=1e-9)


def test_hertz_with_quadratic_tetrahedra():
    contact, exact = solve(ball(n=2, cells="tetra10", size=6.0)).contact("contact"), hertz(1)
    centre = contact.pressure[np.hypot(*contact.points.T[:2]).argmin()]
    assert centre == pytest.approx(exact.peak_pressure, rel=0.03)
    np.testing.assert_allclose(contact.normal_force[2], exact.force / 4.0, rtol=1e-9)


def test_a_quarter_a_half_and_a_whole_ball_are_one():
    one, *others = (solve(ball(n=2, angle=angle, size=5.0)).contact("contact") for angle in (90.0, 180.0, 360.0))
    for other in others:
        for point, pressure in zip(one.points, one.pressure, strict=True):
            same = np.linalg.norm(other.points - point, axis=1).argmin()
            assert other.pressure[same] == pytest.approx(pressure, abs=1e-8 * one.pressure.max())


@pytest.mark.parametrize("counts", [(8, 8), (8, 11), (11, 8)])
def test_a_slab_of_rings_is_the_plane_strain_model(counts):
    """Also where the meshes do not match: gaps between the circles are integrated by other rules."""
    flat = solve(press_fit(kind="plane strain", n_radial=2, n_angular=counts, friction=0.2)).contact("fit")
    deep = solve(press_fit_in_space(n_radial=2, n_angular=counts, friction=0.2)).contact("fit")
    for point, pressure in zip(deep.points, deep.pressure, strict=True):
        same = np.linalg.norm(flat.points - point[:2], axis=1).argmin()
        assert pressure == pytest.approx(flat.pressure[same], rel=1e-6)


def test_boundaries_may_leave_out_middle_nodes():
    """Supports and loads then act on those too, in the plane and in space."""
    for model in (ball(n=1, cells="quad8", size=3.0), press_fit(n_radial=1, n_angular=3, cells="quad8")):
        mesh, ends = model.mesh, model.dimension**2 // 2  # 2 of an edge, 4 of a face
        full = {name: boundary(make_space(mesh), name, ()).blocks[0].facets for name in mesh.boundaries}
        one, other = (
            solve(replace(model, mesh=replace(mesh, boundaries=sides)))
            for sides in (full, {name: facets[:, :ends] for name, facets in full.items()})
        )
        np.testing.assert_allclose(one.last.displacement, other.last.displacement, atol=1e-14)
        np.testing.assert_allclose(one.last.contacts[0].pressure, other.last.contacts[0].pressure, rtol=1e-12)


@pytest.mark.parametrize("cells", ["quad", "quad8", "quad9", "triangle"])
@pytest.mark.parametrize("angle", [90.0, 180.0, 360.0])
def test_a_raised_disk_has_its_volume_and_closes(cells, angle):
    """The divergence theorem on its outside: a side turned the wrong way or missing would show."""
    mesh = extruded(target(radii=[1.0, 1.5, 3.0], n=3, angle=angle, cells=cells), z=[-1.0, 0.0, 3.0])
    space = make_space(mesh)
    total, flux = 0.0, np.zeros(3)
    for name in mesh.boundaries:
        side = boundary(space, name, ())
        forces = side.nodal(block.outward for block in side.blocks)
        total += float((forces * mesh.points[side.nodes]).sum()) / 3.0
        flux += forces.sum(axis=0)
    turn = np.radians(angle)
    exact = 0.5 * 3.0**2 * turn * 4.0
    if cells in ("quad", "triangle"):  # a polygon of 6 sides a quarter
        assert total == pytest.approx(exact * np.sinc(1.0 / 12.0), rel=1e-10)
    else:
        assert total == pytest.approx(exact, rel=1e-3)
    np.testing.assert_allclose(flux, 0.0, atol=1e-12)


def test_formulas_of_point_contact_fit_each_other():
    """Pressures add up to the force, friction to Q, and the loop of Masing's rule to the loss."""
    normal, Q = EQUAL.normal, 0.7 * EQUAL.most
    r = np.sin(np.linspace(0.0, np.pi / 2, 20001)) * normal.contact_radius
    assert np.trapezoid(normal.pressure(r) * 2 * np.pi * r, r) == pytest.approx(normal.force, rel=1e-6)
    assert np.trapezoid(EQUAL.traction(r, Q) * 2 * np.pi * r, r) == pytest.approx(Q, rel=1e-6)
    load = np.linspace(0.0, Q, 20001)
    shift = np.array([EQUAL.shift(q) for q in load])
    assert EQUAL.loss(Q) == pytest.approx(4.0 * Q * shift[-1] - 8.0 * np.trapezoid(shift, load), rel=1e-6)
    s = r[:-1]
    inside = np.trapezoid(round_punch(s, force=1.0, radius=1.0) * 2 * np.pi * s, s)
    assert inside == pytest.approx(1.0 - np.sqrt(1.0 - s[-1] ** 2), rel=1e-4)


def test_in_space_increments_end_at_events_where_none_are_asked_for():
    model = ball(n=2, block=2, size=4.0)
    rubbing = replace(model, contacts=[replace(model.contacts[0], friction=0.3)])
    assert solve(model).last.increments == 1
    step = solve(rubbing).last
    assert 2 <= step.increments <= 16 + 8
    assert f"{step.increments} increments to events, none needs to be shorter than" in step.notes[0]
    asked = replace(rubbing, steps=[sg.Step(increments=1)])
    assert solve(asked).last.increments == 1


@pytest.mark.parametrize("modulus", [1.0, 0.05])
def test_a_thin_plate_passes_on_what_presses_it(modulus):
    """Held at three points, as it is while it is condensed, the plate would bend 10^5 times as far as it moves."""
    lines = {"x": [0.0, 0.56, 1.0], "y": [0.0, 0.8]}
    mesh = sg.join({"block": sg.box(**lines, z=[0.0, 0.5, 1.0]), "plate": sg.box(**lines, z=[1.0, 1.01])})
    model = sg.Model(
        mesh,
        kind="3d",
        bodies=[sg.Body("block", sg.Elastic(E=1.0, nu=0.0)), sg.Body("plate", sg.Elastic(E=modulus, nu=0.0))],
        supports=[sg.Support("block.bottom", u=(0, 0, 0))],
        loads=[sg.Load("plate.top", pressure=1e-3)],
        contacts=[sg.Contact("plate.bottom", "block.top", friction="stick")],
        steps=[sg.Step(increments=1)],
    )
    np.testing.assert_allclose(sg.solve(model).last.contacts[0].pressure, 1e-3, rtol=1e-9)
