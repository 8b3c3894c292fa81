# SPDX-License-Identifier: BSD-3-Clause
"""Sides that are tilted against each other beside the point where they touch: pressed along normals between both."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.gallery.spheres import equal_spheres
from signorini.interface.mortar import mortar_coupling
from signorini.interface.tilt import normals_between, rotate_between
from signorini.meshing.plane import quarter_disk, rectangle
from signorini.meshing.solid import extruded
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane

RADIUS, SOFT = 50.0, Elastic(E=20000.0, nu=0.3)


@pytest.mark.parametrize(("other", "error"), [(2, 2e-3), (3, 5e-3)])
def test_two_spheres_in_space_are_one_on_its_plane_of_symmetry(other, error):
    """B03: a/R = 0.2, normals tilted by up to 0.2 on either side."""
    one, two = (solve(equal_spheres(approach=4.0, n=2, other=n)).contact("contact") for n in (None, other))
    assert two.coupling == "mortar"
    assert two.normal_force[2] == pytest.approx(one.normal_force[2], rel=error)
    assert two.pressure.max() == pytest.approx(one.pressure.max(), rel=error)
    np.testing.assert_allclose(two.normals[:, 2], 1.0, atol=5e-3)


def ball(stiffness=None, *, swap=False):
    """Axisymmetric: on a rigid plane, or on a block that is so many times as stiff."""
    disk = quarter_disk(radius=RADIUS, contact_length=15.0, contact_spacing=1.25, order=2)
    pressed = Support("ball.cut", u=(None, -2.0))
    if stiffness is None:
        contact = Contact("ball.arc", Plane((0, 0), (0, 1)), name="contact")
        mesh, bodies = join({"ball": disk}), [Body("ball", SOFT)]
        return Model(mesh, kind="axisymmetric", bodies=bodies, supports=[pressed], contacts=[contact])
    x = np.concatenate([np.linspace(0.0, 15.0, 13), 15.0 * 1.4 ** np.arange(1, 7)])
    block = rectangle(x=x, y=-x[::-1], cells="quad8")
    sides = ("block.top", "ball.arc") if swap else ("ball.arc", "block.top")
    return Model(
        join({"ball": disk, "block": block}),
        kind="axisymmetric",
        bodies=[Body("ball", SOFT), Body("block", replace(SOFT, E=stiffness * SOFT.E))],
        supports=[pressed, Support("block.bottom", u=(0, 0))],
        contacts=[Contact(*sides, name="contact")],
    )


def force(model):
    return abs(solve(model).contact("contact").normal_force[1])


def test_a_stiff_block_is_a_rigid_plane():
    """Normals of the ball alone are off by 6 %."""
    plane = force(ball())
    for swap in (False, True):
        assert force(ball(1e4, swap=swap)) == pytest.approx(plane, rel=3e-3)


@pytest.mark.parametrize("stiffness", [0.3, 3.0])
def test_the_force_does_not_depend_on_which_side_is_named_first(stiffness):
    """Normals of one side alone differ by 4 %."""
    assert force(ball(stiffness)) == pytest.approx(force(ball(stiffness, swap=True)), rel=5e-3)


def matched(stiffness, *, swap=False, slab=False):
    """A cylinder on a block whose nodes lie below its own, plane strain or a slab in space of thickness 1."""
    disk = quarter_disk(radius=RADIUS, contact_length=15.0, contact_spacing=1.5)
    x = np.sort(disk.points[np.unique(disk.boundaries["arc"]), 0])
    depth = np.concatenate([-15.0 * 1.4 ** np.arange(6, 0, -1), np.linspace(-15.0, 0.0, 11)])
    parts = {"ball": disk, "block": rectangle(x=x, y=depth)}
    supports = [("ball.cut", (None, -1.0)), ("ball.axis", (0.0, None)), ("block.bottom", (0.0, 0.0))]
    if slab:
        parts = {name: extruded(part, z=[0.0, 1.0], ends=("front", "back")) for name, part in parts.items()}
        supports = [(on, (*u, None)) for on, u in supports]
        supports += [(f"{name}.{end}", (None, None, 0.0)) for name in parts for end in ("front", "back")]
    sides = ("block.top", "ball.arc") if swap else ("ball.arc", "block.top")
    return Model(
        join(parts),
        kind="3d" if slab else "plane strain",
        bodies=[Body("ball", SOFT), Body("block", replace(SOFT, E=stiffness * SOFT.E))],
        supports=[Support(on, u=u) for on, u in supports],
        contacts=[Contact(*sides, coupling="nodes", name="contact")],
    )


@pytest.mark.parametrize("slab", [False, True])
def test_pairs_of_nodes_are_the_same_whichever_side_is_named_first(slab):
    """Normals of one side alone differ by a tenth of the force."""
    one, two = (force(matched(2.0, swap=swap, slab=slab)) for swap in (False, True))
    assert one == pytest.approx(two, rel=1e-9)
    assert one == pytest.approx(force(matched(2.0)), rel=1e-9)


def moments(coupling, points):
    """Of the forces of every pair about the origin."""
    forces = [force.toarray() for force in coupling.forces]
    if len(forces) == 2:
        return forces[1] @ points[:, 0] - forces[0] @ points[:, 1]
    x, y, z = forces
    a, b, c = points.T
    return np.column_stack([z @ b - y @ c, x @ c - z @ a, y @ a - x @ b])


def test_forces_of_every_pair_balance_with_their_moments_in_the_plane():
    upper, lower = (quarter_disk(radius=1.0, contact_length=0.5, contact_spacing=h) for h in (0.1, 0.125))
    mesh = join({"upper": upper, "lower": replace(lower, points=lower.points * [1.0, -1.0] - [0.0, 0.1])})
    space = make_space(mesh)
    coupling = mortar_coupling(*(boundary(space, name, ()) for name in ("upper.arc", "lower.arc")), search=0.5)
    assert np.abs(coupling.normals[:, 0]).max() < 0.1  # their own are tilted by up to 45 degrees and more
    np.testing.assert_allclose(moments(coupling, mesh.points), 0.0, atol=1e-14)


def test_forces_of_every_pair_balance_with_their_moments_in_space():
    mesh = equal_spheres(approach=4.0, n=1, other=2, cells="triangle").mesh
    space = make_space(mesh)
    coupling = mortar_coupling(*(boundary(space, f"{name}.seat", ()) for name in ("upper", "lower")))
    np.testing.assert_allclose(moments(coupling, mesh.points), 0.0, atol=1e-10)


def test_turning_keeps_lengths_and_angles():
    rng = np.random.default_rng(3)
    before, after = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in rng.normal(size=(2, 20, 3)))
    vectors = rng.normal(size=(20, 3))
    np.testing.assert_allclose(rotate_between(before, before, after), after, atol=1e-12)
    found = rotate_between(vectors, before, after)
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), np.linalg.norm(vectors, axis=1))
    np.testing.assert_allclose(np.sum(found * after, axis=1), np.sum(vectors * before, axis=1), atol=1e-12)


def test_the_normal_between_is_that_of_both_turned_by_half():
    one, two = np.array([[np.sin(0.3), np.cos(0.3)]]), np.array([[np.sin(0.1), -np.cos(0.1)]])
    half = normals_between(one, two, np.zeros(1), 0.5)
    np.testing.assert_allclose(half, -normals_between(two, one, np.zeros(1), 0.5), atol=1e-15)
    np.testing.assert_allclose(half, [[np.sin(0.1), np.cos(0.1)]], atol=1e-15)
    np.testing.assert_array_equal(normals_between(one, 0.0 * two, np.zeros(1), 0.5), one)
