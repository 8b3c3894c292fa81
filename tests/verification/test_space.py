# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in space: patch tests of every family, matching and not, turned in space; rigid motions; friction as in 2D."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import signorini as sg
from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.stress import body_stresses
from signorini.gallery.blocks import curved_blocks
from signorini.meshing.plane import rectangle
from signorini.meshing.solid import box, extruded
from signorini.model.mesh import join

FAMILIES = ("hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10")
WEDGES = {"wedge": "triangle", "wedge15": "triangle6"}
STEEL = sg.Elastic(E=2e5, nu=0.3)


def cube(family, cells, z=0.0, size=2.0):
    grid = np.linspace(0.0, size, cells + 1)
    if family in WEDGES:
        plane = rectangle(x=grid, y=grid, cells=WEDGES[family])
        sides = {"left": "left", "right": "right", "front": "bottom", "back": "top"}
        walls = {name: plane.boundaries[old] for name, old in sides.items()}
        mesh = extruded(replace(plane, boundaries=walls), z=z + grid)
        space = make_space(mesh)
        full = {name: tuple(b.facets for b in boundary(space, name, ()).blocks) for name in mesh.boundaries}
        return replace(mesh, boundaries=full)
    return box(x=grid, y=grid, z=z + grid, cells=family)


def jiggled(mesh, rng, by=0.1):
    """Every node inside moved; linear families only, whose edges stay straight."""
    points = mesh.points.copy()
    inside = ((points > points.min(axis=0)) & (points < points.max(axis=0))).all(axis=1)
    points[inside] += by * rng.uniform(-1.0, 1.0, (inside.sum(), 3))
    return replace(mesh, points=points)


@pytest.mark.parametrize(
    ("family", "formulation"),
    [(family, "standard") for family in (*FAMILIES, *WEDGES)]
    + [("hexahedron", "incompatible")]
    + [(family, "mean dilatation") for family in ("hexahedron", "hexahedron20", "hexahedron27", "tetra10")],
)
def test_a_linear_field_has_its_stress_and_needs_its_tractions_only(family, formulation):
    rng = np.random.default_rng(1)
    mesh = cube(family, 2)
    if family in ("hexahedron", "tetra"):
        mesh = jiggled(mesh, rng)
    body = sg.Body("block", STEEL, formulation=formulation)
    model = sg.Model(mesh, bodies=[body])
    space = make_space(mesh)
    slope = rng.standard_normal((3, 3)) * 1e-3
    u = mesh.points @ slope.T
    strain = (slope + slope.T) / 2
    lame = STEEL.E * STEEL.nu / (1 + STEEL.nu) / (1 - 2 * STEEL.nu)
    sigma = lame * np.trace(strain) * np.eye(3) + 2 * STEEL.shear_modulus * strain
    (found,) = body_stresses(space, model, u)
    wanted = sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    np.testing.assert_allclose(found.stress, np.tile(wanted, (len(u), 1)), atol=1e-9 * np.abs(sigma).max())
    traction = np.zeros_like(u)
    for name in mesh.boundaries:
        side = boundary(space, name, ())
        traction[side.nodes] += side.nodal(block.outward @ sigma for block in side.blocks)
    forces = (stiffness(space, model) @ u.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(forces, traction, atol=1e-9 * np.abs(traction).max())


def pressed(lower, upper, turn):
    """Two cubes pressed onto each other, the foot of the lower one moved as uniform compression moves it."""
    mesh = join({"low": lower, "up": upper})
    mesh = replace(mesh, points=mesh.points @ turn.T)
    n = turn @ (0.0, 0.0, 1.0)
    sigma = -25.0 * np.outer(n, n)
    strain = ((1 + STEEL.nu) * sigma - STEEL.nu * np.trace(sigma) * np.eye(3)) / STEEL.E
    foot = np.unique(mesh.boundaries["low.bottom"])
    model = sg.Model(
        mesh,
        bodies=[sg.Body(name, STEEL) for name in ("low", "up")],
        supports=[sg.Support(tuple(x), u=tuple(strain @ x)) for x in mesh.points[foot]],
        loads=[sg.Load("up.top", pressure=25.0)],
        contacts=[sg.Contact("up.bottom", "low.top", friction=0.2)],
        steps=[sg.Step(increments=1)],
    )
    return model, sigma


@pytest.mark.parametrize("family", [*FAMILIES, *WEDGES])
@pytest.mark.parametrize("counts", [(2, 2), (2, 3)])
def test_patch(family, counts):
    turn = Rotation.from_rotvec([0.3, -0.5, 0.7]).as_matrix()
    model, sigma = pressed(cube(family, counts[0]), cube(family, counts[1], z=2.0), turn)
    step = sg.solve(model).last
    contact = step.contacts[0]
    matching = counts[0] == counts[1] and family in ("hexahedron", "tetra", "wedge")
    assert contact.coupling == ("nodes" if matching else "mortar")
    np.testing.assert_allclose(contact.pressure, 25.0, rtol=1e-9)
    np.testing.assert_allclose(contact.traction, 0.0, atol=25e-9)
    np.testing.assert_allclose(contact.normal_force, 100.0 * turn[:, 2], rtol=1e-9)
    np.testing.assert_allclose(contact.normals, np.tile(turn[:, 2], (len(contact.node), 1)), atol=1e-12)
    for part in body_stresses(make_space(model.mesh), model, step.displacement):
        wanted = np.tile(sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (len(part.nodes), 1))
        np.testing.assert_allclose(part.stress, wanted, atol=25e-9)


def test_what_nothing_holds_is_named_with_its_motion():
    mesh = cube("hexahedron", 1)
    body = [sg.Body("block", STEEL)]
    load = [sg.Load("top", pressure=1.0)]
    with pytest.raises(InputError, match=r"body 'block' can move along x"):
        sg.solve(sg.Model(mesh, bodies=body, loads=load))
    hinged = [sg.Support((0, 0, 0), u=(0, 0, 0)), sg.Support((2, 0, 0), u=(0, 0, 0))]
    with pytest.raises(InputError, match=r"rotate about the axis through \(1, 0, 0\) along \(1, 0, 0\)"):
        sg.solve(sg.Model(mesh, bodies=body, supports=hinged, loads=load))


@pytest.mark.parametrize("friction", [0.1, 0.3, "stick"])
def test_a_slab_in_plane_strain_is_the_plane_model(friction):
    """A block dragged over a plane, one cell deep and held sideways: the answer of the same cells in 2D."""
    grid = np.linspace(0.0, 2.0, 9)
    plane, solid = rectangle(x=grid, y=grid[:5]), box(x=grid, y=[0.0, 1.0], z=grid[:5])
    flat = sg.Model(
        plane,
        bodies=[sg.Body("block", STEEL)],
        loads=[sg.Load("top", traction=(3.0, -10.0))],
        supports=[sg.Support("right", u=(0, None))],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0), (0, 1)), friction=friction)],
        steps=[sg.Step(increments=3)],
    )
    deep = sg.Model(
        solid,
        bodies=flat.bodies,
        loads=[sg.Load("top", traction=(3.0, 0.0, -10.0))],
        supports=[
            sg.Support("right", u=(0, None, None)),
            sg.Support("front", u=(None, 0, None)),
            sg.Support("back", u=(None, 0, None)),
        ],
        contacts=[sg.Contact("bottom", sg.Plane((0, 0, 0), (0, 0, 1)), friction=friction)],
        steps=flat.steps,
    )
    one, two = sg.solve(flat).last, sg.solve(deep).last
    a, b = one.contacts[0], two.contacts[0]
    order = np.searchsorted(a.points[:, 0], b.points[:, 0])
    np.testing.assert_allclose(b.pressure, a.pressure[order], atol=1e-8 * a.pressure.max())
    np.testing.assert_allclose(b.shear[:, 0], a.shear[order, 0], atol=1e-8 * a.pressure.max())
    np.testing.assert_allclose(b.shear[:, 1], 0.0, atol=1e-8 * a.pressure.max())
    assert two.dissipation == pytest.approx(one.dissipation, rel=1e-8, abs=1e-12)
    assert (b.status == a.status[order]).all()


@pytest.mark.parametrize(
    ("cells", "across", "error"),
    [
        ("quad", (3, 3), 1e-12),
        ("quad8", (4, 4), 1e-12),
        ("quad9", (3, 3), 1e-12),
        ("quad8", (3, 5), 1e-5),
        ("quad9", (5, 3), 1e-5),
    ],
)
def test_pressure_passes_through_a_curved_side_as_in_the_plane(cells, across, error):
    """Patch test P5 as a slab: exact where faces match; faces that do not are cut on plane pieces of each."""
    flat = curved_blocks(cells=cells, across=across, friction=0.3)
    ends = [replace(s, on=(*s.on, 0.0), u=(*s.u, None)) for s in flat.supports]
    model = sg.Model(
        extruded(flat.mesh, z=[0.0, 0.4, 1.0]),
        bodies=flat.bodies,
        supports=[*ends, sg.Support("bottom", u=(None, None, 0.0)), sg.Support("top", u=(None, None, 0.0))],
        loads=flat.loads,
        contacts=flat.contacts,
    )
    contact = sg.solve(model).contact("interface")
    assert contact.closed.all()
    np.testing.assert_allclose(contact.pressure, 10.0, rtol=error)
    np.testing.assert_allclose(contact.traction, 0.0, atol=10.0 * error)
