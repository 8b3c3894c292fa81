# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries in space of triangles and quadrilaterals: wedges beside hexahedra, linear and quadratic."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import signorini as sg
from signorini.engine.prepare import prepare
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box, extruded
from signorini.model.mesh import Mesh, join

STEEL = sg.Elastic(E=2e5, nu=0.3)
TURN = Rotation.from_rotvec([0.3, -0.5, 0.7]).as_matrix()
SIZE = 2.0
ORDERS = {1: ("triangle", "quad"), 2: ("triangle6", "quad8")}


def block(count, order, z=0.0, shift=0):
    """A cube of wedges and hexahedra, columns of one or the other in turn."""
    grid = np.linspace(0.0, SIZE, count + 1)
    plane = rectangle(x=grid, y=grid, cells="quad" if order == 1 else "quad9")
    (cells,) = plane.cells.values()
    cut = (np.arange(len(cells)) + shift) % 2 == 0
    halves = [[0, 1, 2], [0, 2, 3]] if order == 1 else [[0, 1, 2, 4, 5, 8], [0, 2, 3, 8, 6, 7]]
    kinds = [np.concatenate([cells[cut][:, half] for half in halves]), cells[~cut][:, : 4 * order]]
    mesh = Mesh(
        points=plane.points,
        cells=dict(zip(ORDERS[order], kinds, strict=True)),
        bodies={"block": np.arange(sum(map(len, kinds)))},
        boundaries={"wall": plane.boundaries["left"]},
    )
    return extruded(mesh, z=z + grid)


def pressed(lower, upper, **given):
    """Two cubes pressed onto each other, the foot of the lower one moved as uniform compression moves it."""
    mesh = join({"low": lower, "up": upper})
    mesh = sg.Mesh(points=mesh.points @ TURN.T, cells=mesh.cells, bodies=mesh.bodies, boundaries=mesh.boundaries)
    n = TURN[:, 2]
    sigma = -25.0 * np.outer(n, n)
    strain = ((1 + STEEL.nu) * sigma - STEEL.nu * np.trace(sigma) * np.eye(3)) / STEEL.E
    foot = mesh.points[boundary(make_space(mesh), "low.bottom", ()).nodes]
    model = sg.Model(
        mesh,
        bodies=[sg.Body(name, STEEL) for name in ("low", "up")],
        supports=[sg.Support(tuple(x), u=tuple(strain @ x)) for x in foot],
        loads=[sg.Load("up.top", pressure=25.0)],
        contacts=[sg.Contact("up.bottom", "low.top", friction=0.2, **given)],
        steps=[sg.Step(increments=1)],
    )
    return model, sigma


def cubes(count, order, z=0.0):
    grid = np.linspace(0.0, SIZE, count + 1)
    return box(x=grid, y=grid, z=z + grid, cells="hexahedron" if order == 1 else "hexahedron20")


@pytest.mark.parametrize("order", [1, 2])
def test_the_force_of_a_pressure_and_the_volume_inside_the_skin(order):
    """Of the mixed ends with quadrilaterals around, by the divergence theorem: a face turned or lost would show."""
    mesh = block(3, order)
    assert [faces.shape[1] for faces in mesh.boundaries["top"]] == [3, 4]  # corners suffice
    space = make_space(mesh)
    for name, out in (("bottom", -1.0), ("top", 1.0)):
        side = boundary(space, name, ())
        assert [b.facets.shape[1] for b in side.blocks] == ([3, 4] if order == 1 else [6, 8])
        forces = side.nodal(b.outward for b in side.blocks)
        np.testing.assert_allclose(forces.sum(axis=0), [0, 0, out * SIZE**2], atol=1e-13)
        moments = np.cross(mesh.points[side.nodes], forces).sum(axis=0)
        np.testing.assert_allclose(moments, [out * SIZE**3 / 2, -out * SIZE**3 / 2, 0], atol=1e-13)
        np.testing.assert_allclose(side.nodal_normals, np.tile([0, 0, out], (len(side.nodes), 1)), atol=1e-14)
    assert sum(parts.sum() for parts in space.volumes) == pytest.approx(SIZE**3, rel=1e-13)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(
    "case", ["mixed on mixed", "matching", "matching nodes", "mixed on hexahedra", "hexahedra on mixed"]
)
def test_patch(case, order):
    upper, lower = {
        "mixed on mixed": (block(3, order, z=SIZE), block(2, order)),
        "matching": (block(3, order, z=SIZE), block(3, order)),
        "matching nodes": (block(3, order, z=SIZE), block(3, order, shift=1)),  # quadrilaterals opposite triangles
        "mixed on hexahedra": (block(3, order, z=SIZE), cubes(2, order)),
        "hexahedra on mixed": (cubes(2, order, z=SIZE), block(3, order)),
    }[case]
    model, sigma = pressed(lower, upper)
    step = sg.solve(model).last
    contact = step.contacts[0]
    assert contact.coupling == ("nodes" if (case, order) == ("matching", 1) else "mortar")
    np.testing.assert_allclose(contact.pressure, 25.0, rtol=1e-9)
    np.testing.assert_allclose(contact.traction, 0.0, atol=25e-9)
    np.testing.assert_allclose(contact.normal_force, 25.0 * SIZE**2 * TURN[:, 2], rtol=1e-9)
    assert contact.area.sum() == pytest.approx(SIZE**2, rel=1e-12)
    for part in body_stresses(make_space(model.mesh), model, step.displacement):
        wanted = np.tile(sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (len(part.nodes), 1))
        np.testing.assert_allclose(part.stress, wanted, atol=25e-9)


@pytest.mark.parametrize("coupling", ["mortar", "node-to-segment", "nodes"])
def test_every_coupling_of_matching_sides(coupling):
    model, _ = pressed(block(3, 1), block(3, 1, z=SIZE), coupling=coupling)
    contact = sg.solve(model).last.contacts[0]
    assert contact.coupling == coupling
    np.testing.assert_allclose(contact.pressure, 25.0, rtol=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_on_a_rigid_plane_and_on_springs(order):
    """The same uniform pressure from a plane and from a foundation: the block comes down by p H / E, and by p / k."""
    mesh = block(3, order)
    top = mesh.points[:, 2] == SIZE
    given = {"bodies": [sg.Body("block", STEEL)], "loads": [sg.Load("top", traction=(0, 0, -25.0))]}
    held = [sg.Support((0, 0, SIZE), u=(0, 0, None)), sg.Support((SIZE, 0, SIZE), u=(None, 0, None))]
    plane = sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)))
    step = sg.solve(sg.Model(mesh, supports=held, contacts=[plane], **given)).last
    np.testing.assert_allclose(step.contacts[0].pressure, 25.0, rtol=1e-9)
    np.testing.assert_allclose(step.displacement[top, 2], -25.0 * SIZE / 2e5, rtol=1e-9)
    springs = sg.Foundation("bottom", normal_stiffness=1e3, tangential_stiffness=10.0)
    given["bodies"] = [sg.Body("block", sg.Elastic(E=2e5, nu=0.0))]  # springs hold it sideways: it may not widen
    step = sg.solve(sg.Model(mesh, foundations=[springs], **given)).last
    np.testing.assert_allclose(step.displacement[top, 2], -25.0 * SIZE / 2e5 - 25.0 / 1e3, rtol=1e-9)


def test_a_boundary_that_names_corners_holds_the_middles_too():
    mesh = block(2, 2)
    model = sg.Model(
        mesh,
        bodies=[sg.Body("block", STEEL)],
        supports=[sg.Support("bottom", u=(0, 0, 0))],
        loads=[sg.Load("top", pressure=25.0)],
    )
    assert len(mesh.nodes_of("bottom")) == 9
    foot = mesh.points[:, 2] == 0.0
    assert foot.sum() == 23  # 9 corners, 12 edges and 2 diagonals
    np.testing.assert_array_equal(sg.solve(model).last.displacement[foot], 0.0)


def test_a_rigid_surface_of_both_kinds():
    surface = sg.mesh_surface(block(3, 2), "top")
    np.testing.assert_allclose(surface.nearest([[0.3, 0.4, 5.0]])[0], [3.0])


def test_linear_beside_quadratic_faces_are_refused():
    one, other = block(2, 1), block(2, 2, z=5.0)
    mesh = join({"one": one, "other": other})
    both = sg.Mesh(
        points=mesh.points,
        cells=mesh.cells,
        bodies=mesh.bodies,
        boundaries={"ends": (*mesh.facets("one.top"), *mesh.facets("other.bottom"))},
    )
    with pytest.raises(InputError, match="'ends' belongs to linear and to quadratic cells; expected one order"):
        boundary(make_space(both), "ends", ("load", 0))


@pytest.mark.parametrize("kinds", ["mixed", "triangles"])
@pytest.mark.parametrize("counts", [(3, 2), (2, 3), (5, 4)])
def test_facets_of_a_curved_interface_feign_no_gaps(kinds, counts):
    """Two nets of flat faces on one cylinder, also where a triangle at the rim turns to no neighbour."""

    def bent(count, z):
        grid = np.linspace(0.0, SIZE, count + 1)
        mesh = block(count, 1, z=z) if kinds == "mixed" else box(x=grid, y=grid, z=z + grid, cells="tetra")
        x, _, z = mesh.points.T
        z = z - 0.15 * (x - 1.0) ** 2 * (1.0 - np.abs(z - SIZE) / SIZE)
        return replace(mesh, points=np.column_stack([mesh.points[:, :2], z]))

    def interface(lift):
        upper = bent(counts[0], SIZE)
        mesh = join({"low": bent(counts[1], 0.0), "up": replace(upper, points=upper.points + [0, 0, lift])})
        model = sg.Model(
            mesh,
            bodies=[sg.Body(name, STEEL) for name in ("low", "up")],
            supports=[sg.Support("low.bottom", u=(0, 0, 0)), sg.Support("up.top", u=(0, 0, -0.001))],
            contacts=[sg.Contact("up.bottom", "low.top")],
        )
        return prepare(model).interface

    touching = interface(0.0)
    np.testing.assert_allclose(touching.gap, 0.0, atol=4e-4)  # facets leave up to 0.03
    assert interface(0.5).gap.min() > 0.4
