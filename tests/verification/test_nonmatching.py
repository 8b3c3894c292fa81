# SPDX-License-Identifier: BSD-3-Clause
"""Meshes that do not match, beyond patch tests: Hertz contact, symmetry, curves cut into chords, sliding, circles."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.gallery.blocks import block_on_foundation, stacked_blocks
from signorini.meshing.plane import quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Circle, Plane, Profile
from signorini.model.step import Step

ELASTIC = Elastic(E=1000.0, nu=0.3)
HALF_WIDTH, RADIUS, FORCE = 0.42, 4.0, 19.0348  # of contact, by Hertz


def graded(n, *, half=False):
    """n facets over |x| < 0.6, longer ones up to 3."""
    inner = np.linspace(-0.6, 0.6, n + 1)
    steps = np.cumsum(np.cumprod(np.full(12, 1.35)))
    outer = 0.6 + 2.4 * steps / steps[-1]
    x = np.concatenate([-outer[::-1], inner, outer])
    return x[x > -1e-9] if half else x


def hertz(upper, lower, *, swap=False, friction=0.0, half=False, cells="quad", coupling="auto"):
    """A block with a round lower face on a flat one; with "half" cut in two by symmetry."""
    steps = np.cumsum(np.cumprod(np.full(11, 1.35)))
    depth = 3.0 * np.append(0.0, steps / steps[-1])
    top = rectangle(x=graded(upper, half=half), y=depth, cells=cells)
    points = top.points.copy()
    points[:, 1] += points[:, 0] ** 2 / (2 * RADIUS) * (1 - points[:, 1] / 3.0)
    mesh = join(
        {
            "upper": replace(top, points=points),
            "lower": rectangle(x=graded(lower, half=half), y=-depth[::-1], cells=cells),
        }
    )
    sides = ("lower.top", "upper.bottom") if swap else ("upper.bottom", "lower.top")
    supports = [Support("lower.bottom", u=(0, 0)), Support("upper.top", u=(0, None))]
    if half:
        supports += [Support("lower.left", u=(0, None)), Support("upper.left", u=(0, None))]
    return Model(
        mesh,
        bodies=[Body("upper", ELASTIC), Body("lower", ELASTIC)],
        supports=supports,
        loads=[Load("upper.top", force=(None, -FORCE / (2 if half else 1)), spread="displacement")],
        contacts=[Contact(*sides, friction=friction, coupling=coupling, name="contact")],
        steps=[Step(increments=1)],
    )


def profile(model):
    contact = solve(model).contact("contact")
    order = np.argsort(contact.points[:, 0])
    return contact.points[order, 0], contact.pressure[order], contact.traction[order]


@pytest.fixture(scope="module")
def fine():
    return profile(hertz(160, 160))[:2]


@pytest.mark.parametrize(
    ("upper", "lower", "swap", "cells", "error", "zigzag"),
    [
        (30, 30, False, "quad", 0.003, 0.001),
        (30, 45, False, "quad", 0.005, 0.002),  # the coarser side is the nonmortar one
        (45, 30, True, "quad", 0.005, 0.002),
        (30, 60, False, "quad", 0.005, 0.002),
        (30, 45, True, "quad", 0.012, 0.012),  # the finer one feels the kinks of the other
        (15, 22, False, "quad8", 0.01, 0.005),
    ],
)
def test_hertz(fine, upper, lower, swap, cells, error, zigzag):
    x, pressure, _ = profile(hertz(upper, lower, swap=swap, cells=cells))
    inside = np.abs(x) < 0.85 * HALF_WIDTH
    defect = ((pressure - np.interp(x, *fine)) / fine[1].max())[inside]
    assert np.abs(defect).max() < error
    assert np.abs(defect[1:-1] - 0.5 * (defect[2:] + defect[:-2])).max() < zigzag


@pytest.mark.parametrize("friction", [0.0, 0.3, "stick"])
@pytest.mark.parametrize("cells", ["quad", "quad8"])
def test_half_a_model_is_half_of_the_whole(friction, cells):
    """At the plane of symmetry the weights see one half; nodes on the plane do not slide."""
    whole, half = (profile(hertz(20, 32, friction=friction, cells=cells, half=cut)) for cut in (False, True))
    right = whole[0] > -1e-9
    for one, two in zip(whole, half, strict=True):
        np.testing.assert_allclose(two, one[right], atol=1e-8 * whole[1].max())


def test_node_to_segment_finds_the_same_contact(fine):
    x, pressure, _ = profile(hertz(30, 30, coupling="node-to-segment"))
    inside = np.abs(x) < 0.85 * HALF_WIDTH
    np.testing.assert_allclose(pressure[inside], np.interp(x, *fine)[inside], atol=0.02 * fine[1].max())


def curved(upper, lower):
    """Two blocks that meet on y = x^2 / 4, each with nodes of its own on it."""
    meshes = {}
    for name, n, sign in (("upper", upper, 1), ("lower", lower, -1)):
        mesh = rectangle(width=2.0, height=1.0, nx=n, ny=4, origin=(-1.0, min(0.0, sign)))
        points = mesh.points.copy()
        points[:, 1] += points[:, 0] ** 2 / 4 * (1 - sign * points[:, 1])
        meshes[name] = replace(mesh, points=points)
    return Model(
        join(meshes),
        bodies=[Body("upper", Elastic(E=1000.0, nu=0.0)), Body("lower", Elastic(E=1000.0, nu=0.0))],
        supports=[Support("lower.bottom", u=(0, 0)), Support((0.0, 1.0), u=(0, None))],
        loads=[Load("upper.top", pressure=1.0)],
        contacts=[Contact("upper.bottom", "lower.top", friction="stick", name="contact")],
    )


@pytest.mark.parametrize("obstacle", [True, False])
def test_long_facets_behind_short_ones_feign_no_contact(obstacle):
    """Facets four times as long as the one before: the mean gap of dual functions there is negative, no point is."""
    radius, approach = 50.0, 0.03125
    a = np.sqrt(approach * radius)
    disk = quarter_disk(radius=radius, contact_length=1.5 * a, contact_spacing=0.1 * a, order=2)
    ball, other = Body("ball", ELASTIC), Plane((0, 0), (0, 1))
    mesh, bodies, contact = join({"ball": disk}), [ball], Contact("ball.arc", other, name="contact")
    supports = [Support("ball.cut", u=(None, -approach))]
    if not obstacle:
        depth = np.concatenate([-np.geomspace(2 * radius, 0.1 * a, 20), [0.0]])
        x = np.concatenate([[0.0], np.geomspace(0.15 * a, radius, 24)])
        mesh = join({"ball": disk, "table": rectangle(x=x, y=depth, cells="quad8")})
        bodies, contact = [ball, replace(ball, name="table")], Contact("ball.arc", "table.top", name="contact")
        supports += [Support("table.bottom", u=(0, 0))]
    model = Model(mesh, kind="axisymmetric", bodies=bodies, supports=supports, contacts=[contact])
    contact = solve(model).contact("contact")
    assert contact.points[contact.closed, 0].max() < 1.3 * a
    if obstacle:
        force = 4 / 3 * ELASTIC.E / (1 - ELASTIC.nu**2) * np.sqrt(radius * approach**3)
        assert contact.normal_force[1] == pytest.approx(force, rel=0.03)


@pytest.mark.parametrize(("upper", "lower", "error"), [(12, 16, 0.03), (16, 12, 0.08), (12, 24, 0.03)])
def test_chords_of_one_curve_leave_no_gaps(upper, lower, error):
    """Gaps of the polygons, up to h^2 kappa / 8, would open most of the contact: E / p is 1000.

    Of a curve that is no circle facets at its end know less, from one side alone: a gap of 3e-5 where they leave 2e-3.
    """
    x, reference, _ = profile(curved(48, 48))
    at, pressure, _ = profile(curved(upper, lower))
    inside = np.abs(at) < 0.8
    defect = (pressure - np.interp(at, x, reference))[inside]
    assert np.sqrt(np.mean(defect**2)) < error


def test_gaps_that_are_meant_stay():
    """A slot that is a little wider than its tongue is no chord."""
    model = curved(12, 16)
    points = model.mesh.points.copy()
    points[np.unique(model.mesh.cells["quad"][model.mesh.bodies["upper"]])] += (0.0, 0.05)
    model = replace(
        model,
        mesh=replace(model.mesh, points=points),
        loads=[],
        supports=[model.supports[0], Support("upper.top", u=(0, -0.01))],
    )
    assert solve(model).contact("contact").gap.min() > 0.03


@pytest.mark.parametrize("share", [0.5, 0.99, 1.01])
def test_a_pushed_block_sticks_below_the_friction_and_slides_above(share):
    """Patch test P6 on meshes that do not match: T < mu N sticks, and T > mu N cannot be held."""
    model = block_on_foundation(friction=0.2, across=(4, 3))
    push = Load("block.left", traction=(share * 0.2 * 25.0, 0.0), name="push")
    held = [support for support in model.supports if support.on != (1.0, 2.0)]
    model = replace(
        model,
        supports=[*held, Support("foundation.left", u=(0, None))],
        loads=[*model.loads, push],
        steps=[Step(increments=1)],
    )
    history = solve(model, raise_on_failure=False)
    assert history.solved == (share < 1)
    if history.solved:
        contact = history.contact("interface")
        assert contact.tangential_force[0] == pytest.approx(-share * 0.2 * 25.0)
        assert contact.normal_force[1] == pytest.approx(25.0)


def test_sides_can_be_chosen_by_their_meshes():
    model = stacked_blocks(across=(7, 4))
    for side, name, sign in (("named", "upper.bottom", 1), ("coarser", "lower.top", -1)):
        contact = solve(replace(model, contacts=[replace(model.contacts[0], side=side)])).contact("interface")
        assert contact.nonmortar == name
        np.testing.assert_allclose(contact.normal_force, [0.0, sign * 1e5], atol=1e-6)
        assert contact.moment((0.5, 1.0)) == pytest.approx(0.0, abs=1e-6)
        assert contact.moment((0.0, 1.0)) == pytest.approx(sign * 0.5e5)
        np.testing.assert_allclose(contact.extent, [[0.0, 1.0], [1.0, 1.0]], atol=1e-12)


def disc_on_disc(lower_cells, cells="quad"):
    """Axisymmetric, pressed by 10; the axis holds both sideways."""
    mesh = join(
        {
            "upper": rectangle(width=1.0, height=0.5, nx=3, ny=2, origin=(0.0, 1.0), cells=cells),
            "lower": rectangle(width=1.0, height=1.0, nx=lower_cells, ny=2, cells=cells),
        }
    )
    return Model(
        mesh,
        kind="axisymmetric",
        bodies=[Body("upper", ELASTIC), Body("lower", ELASTIC)],
        supports=[Support("lower.bottom", u=(None, 0))],
        loads=[Load("upper.top", pressure=10.0)],
        contacts=[Contact("upper.bottom", "lower.top", friction=0.3, name="contact")],
    )


@pytest.mark.parametrize("cells", ["quad", "triangle", "quad8", "triangle6"])
@pytest.mark.parametrize("lower", [3, 2, 5])
def test_uniform_pressure_passes_between_discs(lower, cells):
    history = solve(disc_on_disc(lower, cells))
    contact = history.contact("contact")
    np.testing.assert_allclose(contact.pressure, 10.0, rtol=1e-9)
    np.testing.assert_allclose(contact.traction, 0.0, atol=1e-8)
    assert contact.area.sum() == pytest.approx(np.pi)
    r, z = history.model.mesh.points.T
    np.testing.assert_allclose(history.last.displacement[:, 0], 0.3 * 10.0 / 1000.0 * r, atol=1e-12)
    np.testing.assert_allclose(history.last.displacement[:, 1], -10.0 / 1000.0 * z, atol=1e-12)


@pytest.mark.parametrize("cells", ["quad", "quad8"])
@pytest.mark.parametrize("obstacle", [Circle((0.0, -RADIUS), RADIUS), Profile(((-3, 0), (3, 0)), fillet=0.1)])
def test_rigid_shapes_press_as_bodies_do(obstacle, cells):
    """A rigid circle under a flat block is Hertz contact of one elastic body; a straight profile is a plane."""
    upper = rectangle(x=graded(24), y=np.linspace(0, 3, 12) ** 1.5 / 3**0.5, cells=cells)
    model = Model(
        upper,
        bodies=[Body("block", ELASTIC)],
        supports=[Support("top", u=(0, None))],
        loads=[Load("top", force=(None, -FORCE), spread="displacement")],
        contacts=[Contact("bottom", obstacle, name="contact")],
    )
    contact = solve(model).contact("contact")
    assert contact.normal_force[1] == pytest.approx(FORCE)
    if isinstance(obstacle, Circle):
        stiffness = ELASTIC.E / (1 - ELASTIC.nu**2)
        half_width = np.sqrt(4 * FORCE * RADIUS / (np.pi * stiffness))
        assert contact.pressure.max() == pytest.approx(2 * FORCE / (np.pi * half_width), rel=0.02)
        arm = contact.points + (0.0, RADIUS)
        # of quadratic facets the means over what a pair sees, beside the circle's by the square of a facet
        facets = np.diff(np.sort(contact.points[:, 0])).max() / RADIUS
        mean = 1e-9 if cells == "quad" else facets**2 / 12.0
        np.testing.assert_allclose(contact.normals, arm / np.linalg.norm(arm, axis=1)[:, None], atol=mean)
    else:
        assert contact.closed.all()
