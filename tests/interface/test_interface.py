# SPDX-License-Identifier: BSD-3-Clause
"""Pairs, frames, gaps and areas: signs of the contract, symmetry planes, surfaces paired from either side."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.prepare import prepare
from signorini.engine.solve import solve
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.gallery.cylinder import zhu_cylinder
from signorini.gallery.press_fit import press_fit
from signorini.meshing.plane import annulus, half_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.obstacle import Plane

STEEL = Elastic(E=1.0, nu=0.3)


def test_a_plane_gives_its_own_frame():
    interface = prepare(zhu_cylinder()).interface
    assert (interface.normals == [0.0, 1.0]).all()
    assert (interface.tangents[:, 0] == [1.0, 0.0]).all()  # t = (n_y, -n_x)
    x = prepare(zhu_cylinder()).model.mesh.points[interface.node]
    np.testing.assert_allclose(interface.gap, x[:, 1], atol=1e-14)
    # half of each neighbouring facet; together the length of the arc's polygon
    arc = x[np.argsort(x[:, 0])]
    lengths = np.linalg.norm(np.diff(arc, axis=0), axis=1)
    areas = interface.area[np.argsort(x[:, 0])]
    np.testing.assert_allclose(areas, 0.5 * (np.append(lengths, 0) + np.append(0, lengths)))


def test_curved_pairs_follow_the_averaged_normal_and_the_symmetry_planes():
    prepared = prepare(press_fit(n_radial=2, n_angular=6, interference=0.01))
    interface, points = prepared.interface, prepared.model.mesh.points
    radial = points[interface.node] / 2.0
    np.testing.assert_allclose(interface.normals, -radial, atol=1e-12)  # from the hub into the shaft
    on_axis = np.isclose(points[interface.node], 0.0).any(axis=1)
    assert on_axis.sum() == 2
    assert np.isin(np.abs(interface.normals[on_axis]), [0.0, 1.0]).all()
    np.testing.assert_allclose(interface.gap, -0.01, atol=1e-12)


def test_the_relative_displacement_has_the_signs_of_the_contract():
    prepared = prepare(press_fit(n_radial=1, n_angular=4))
    interface, space = prepared.interface, prepared.space
    n = len(interface)
    u = np.zeros((len(space.mesh.points), 2))
    u[space.mesh.nodes_of("shaft.outer")] = (0.3, -0.2)
    u[space.mesh.nodes_of("hub.inner")] = (0.1, 0.4)
    moved = interface.B @ u.ravel()
    np.testing.assert_allclose(moved[:n], interface.normals @ (0.2, -0.6))
    np.testing.assert_allclose(moved[n:], interface.tangents[:, 0] @ (0.2, -0.6))
    # forces on either side are opposite: no resultant
    forces = (interface.B.T @ np.arange(1.0, 2 * n + 1)).reshape(-1, 2)
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-12)


@pytest.mark.parametrize("along", [(12, 12), (12, 17), (9, 6)])
@pytest.mark.parametrize("cells", ["quad", "quad8", "triangle6"])
def test_friction_turns_a_shaft_as_exactly_as_pressure_presses_it(cells, along):
    """Unit traction on every pair: the friction on a node is the pressing force there, turned by a right angle."""
    prepared = prepare(press_fit(n_radial=1, n_angular=along, cells=cells))
    interface, space = prepared.interface, prepared.space
    n, x = len(interface), space.mesh.points
    (side,) = boundary(space, "shaft.outer", ()).blocks
    pressing, turning = (interface.B[rows].T @ interface.area for rows in (slice(n), slice(n, 2 * n)))
    f, q = pressing.reshape(-1, 2), turning.reshape(-1, 2)
    near = 2.0 * np.sin(1.01 * np.pi / 2.0 / along[0])  # the facets at the planes of symmetry, where nothing slides
    own = side.nodes[(x[side.nodes] > near).all(axis=1)]
    place = np.searchsorted(side.nodes, own)
    np.testing.assert_allclose(f[own], -side.nodal(side.outward)[place], atol=1e-12)
    np.testing.assert_allclose(q[own], f[own][:, ::-1] * [1.0, -1.0], atol=1e-12)


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("lift", [0.0, 0.05])
def test_a_curved_body_on_a_flat_one_pairs_from_either_side(swap, lift):
    """The flat side's nodes stand below the disk's; seen from the flat side alone the nearest is not the partner."""
    disk = half_disk(radius=8.0, contact_length=4.0, contact_spacing=0.5)
    x = np.sort(disk.points[disk.nodes_of("arc"), 0])
    near = np.abs(x) < 3.1
    arc = disk.boundaries["arc"]
    touching = (np.abs(disk.points[arc][..., 0]) < 3.1).all(axis=1)
    disk = replace(
        disk, points=disk.points + (0.0, lift), boundaries={"face": arc[touching], "cut": disk.boundaries["cut"]}
    )
    block = rectangle(x=x[near], y=[-2.0, -1.0, 0.0])
    sides = ("block.top", "disk.face") if swap else ("disk.face", "block.top")
    model = Model(
        join({"disk": disk, "block": block}),
        bodies=[Body("disk", STEEL), Body("block", STEEL)],
        supports=[Support("block.bottom", u=(0, 0)), Support("disk.cut", u=(0, -0.1))],
        contacts=[Contact(*sides)],
    )
    interface = prepare(model).interface
    points = model.mesh.points
    assert interface.sides[0].coupling == "nodes"
    opposite = interface.B[: len(interface)].copy()
    opposite.data[np.isin(opposite.indices // 2, interface.node)] = 0.0
    opposite.eliminate_zeros()
    partner = [np.unique(opposite[[k]].indices // 2) for k in range(len(interface))]
    assert [len(nodes) for nodes in partner] == [1] * len(interface)
    assert len(np.unique(partner)) == len(interface)
    np.testing.assert_allclose(points[interface.node][:, 0], points[np.concatenate(partner)][:, 0], atol=1e-9)
    assert (interface.gap >= lift - 1e-12).all()
    assert interface.gap.min() == pytest.approx(lift, abs=1e-12)


def slabs(lower=4, lift=0.0, **contact):
    """Two slabs, the upper one higher by ``lift`` at its right end."""
    upper = rectangle(width=2.0, height=1.0, nx=6, ny=2, origin=(0.0, 1.0))
    upper = replace(upper, points=upper.points + np.outer(upper.points[:, 0] * lift / 2.0, (0.0, 1.0)))
    return Model(
        join({"upper": upper, "lower": rectangle(width=2.0, height=1.0, nx=lower, ny=2)}),
        bodies=[Body("upper", STEEL), Body("lower", STEEL)],
        supports=[Support("lower.bottom", u=(0, 0)), Support("upper.top", u=(0, -0.1))],
        contacts=[Contact("upper.bottom", "lower.top", **contact)],
    )


@pytest.mark.parametrize("lower", [4, 6])
def test_gaps_are_as_asked_for(lower):
    """From the geometry, closed up to a distance, or zero; the interference comes on top."""

    def gaps(**contact):
        prepared = prepare(slabs(lower, 0.3, **contact))
        order = np.argsort(prepared.model.mesh.points[prepared.interface.node, 0])
        return prepared.interface.gap[order]

    straight = 0.05 * np.arange(7) * np.cos(np.arctan(0.15))
    np.testing.assert_allclose(gaps(), straight, atol=0.02)
    closed = gaps(adjust=0.12)
    assert (closed[:3] == 0.0).all()
    assert (closed[3:] == gaps()[3:]).all()
    assert (gaps(gap="zero") == 0.0).all()
    np.testing.assert_allclose(gaps(gap="zero", interference=0.02), -0.02)
    np.testing.assert_allclose(gaps(adjust=0.12, interference=0.02), closed - 0.02)


@pytest.mark.parametrize("coupling", ["mortar", "node-to-segment", "nodes"])
def test_supports_on_both_sides_leave_no_redundant_pair(coupling):
    """A side whose nodes are all held, partly opposite held nodes: the law is asked where something can move."""
    model = slabs(6 if coupling == "nodes" else 4, coupling=coupling, friction=0.3)
    held = [Support("lower.top", u=(0, 0)), Support("lower.bottom", u=(0, 0)), Support("upper.top", u=(0, -0.1))]
    history = solve(replace(model, supports=held))
    assert history.last.certificate.passed
    assert history.contact("upper.bottom").closed.all()
    both = [*held, Support("upper.bottom", u=(0, 0))]
    prepared = prepare(replace(model, supports=both))
    assert prepared.paths.condensed.held.all()
    assert solve(replace(model, supports=both)).last.certificate.passed


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"interference": 0.6}, "the two sides overlap with the interference of 0.6 by 0.6 at node"),
        ({"gap": -0.5}, "the two sides overlap by 0.5 at node"),
        ({"search": 1e-3, "gap": "geometry"}, None),
        ({"coupling": "nodes"}, "expected matching meshes"),
    ],
)
def test_what_cannot_be_meant_is_refused(change, said):
    if said is None:
        assert len(prepare(slabs(**change)).interface) == 7
        return
    with pytest.raises(InputError) as caught:
        prepare(slabs(**change))
    assert said in str(caught.value)
    assert caught.value.where[:2] == ("contact", 0)


@pytest.mark.parametrize("thickness", [1.0, 2.5])
def test_every_contact_keeps_its_own_data(thickness):
    mesh = join(
        {"ring": annulus(inner=1, outer=2, n_radial=2, n_angular=8), "block": rectangle(origin=(5.0, 0.0), nx=2, ny=1)}
    )
    model = Model(
        mesh,
        thickness=thickness,
        bodies=[Body("ring", STEEL), Body("block", STEEL)],
        supports=[Support("block.top", u=(0, 0)), Support("ring.inner", u=(0, 0))],
        contacts=[
            Contact("ring.outer", Plane((0, -2.5), (0, 3)), friction="stick", gap=0.25, interference=0.1),
            Contact(
                "block.bottom", Plane((0, -1), (0, 1)), friction=0.3, normal_compliance=2.0, tangential_compliance=3.0
            ),
        ],
    )
    interface = prepare(model).interface
    ring, block = interface.contact == 0, interface.contact == 1
    assert (ring.sum(), block.sum()) == (8, 3)
    np.testing.assert_allclose(interface.gap[ring], 0.15)
    np.testing.assert_allclose(interface.gap[block], 1.0)
    np.testing.assert_array_equal(interface.friction.sticks, ring)
    assert (interface.friction.steepest[block] == 0.3).all()
    assert (interface.normal_compliance[ring] == 0).all()
    assert (interface.normal_compliance[block] == 2.0).all()
    assert (interface.tangential_compliance[block] == 3.0).all()
    assert interface.area[block].sum() == pytest.approx(thickness)


def test_of_two_sides_without_roles_the_coarser_one_is_nonmortar():
    mesh = join({"low": rectangle(nx=3), "up": rectangle(nx=5, origin=(0.0, 1.0))})
    bodies = [Body(name, Elastic(E=1.0, nu=0.3)) for name in ("low", "up")]
    for pair in (("low.top", "up.bottom"), ("up.bottom", "low.top")):
        model = Model(
            mesh,
            bodies=bodies,
            supports=[Support("low.bottom", u=(0, 0))],
            contacts=[Contact.between(*pair, friction="stick")],
        )
        (sides,) = prepare(model).interface.sides
        assert (sides.nonmortar, sides.coupling) == ("low.top", "mortar")


def test_rounding_of_coordinates_is_no_gap():
    """Both sides are held: an overlap by the last digit of 0.3 was taken for a proof that nothing is in equilibrium."""
    below, above = 0.1 + 0.2, 0.3
    assert below > above
    mesh = join({"a": rectangle(x=[0, 1], y=[0, below]), "b": rectangle(x=[0, 1], y=[above, 0.6, 0.9])})
    model = Model(
        mesh,
        bodies=[Body(name, Elastic(E=1000.0, nu=0.3)) for name in "ab"],
        supports=[Support(side, u=(0, 0)) for side in ("a.bottom", "a.top", "b.bottom")],
        loads=[Load("b.top", force=(0.0, -1e-9))],
        contacts=[Contact("b.bottom", "a.top", friction=0.3)],
    )
    assert solve(model).last.certificate.worst < 1e-14
