# SPDX-License-Identifier: BSD-3-Clause
"""Every family of cells, alone and mixed, in every kind of model: patch tests, quadratic fields, boundaries."""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from skfem.models.elasticity import linear_elasticity

from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.jacobian import jacobians
from signorini.fem.loads import nodal_loads
from signorini.fem.measure import facet_areas
from signorini.fem.space import make_space
from signorini.fem.stiffness import stiffness
from signorini.fem.stress import body_stresses
from signorini.meshing.plane import annulus, half_disk, quarter_disk, rectangle
from signorini.model.body import Body
from signorini.model.conditions import Load
from signorini.model.material import Elastic
from signorini.model.mesh import Mesh
from signorini.model.model import Model
from tests.helpers.families import FAMILIES, KINDS, MIXED, bent, block, lame

QUADRATIC = ("triangle6", "quad8", "quad9")
QUADRATURES = {"triangle": 1, "quad": 2, "triangle6": 2, "quad8": 5, "quad9": 5}


def model_of(mesh, kind="plane strain", formulation="standard", **parts):
    return Model(mesh, kind=kind, bodies=[Body("block", Elastic(E=3.0, nu=0.3), formulation)], **parts)


def space_of(model):
    return make_space(model.mesh, kind=model.kind)


@pytest.mark.parametrize(
    ("family", "formulation", "kind"),
    [(f, "standard", kind) for f in (*FAMILIES, *MIXED) for kind in KINDS]
    + [(f, "incompatible", kind) for f in ("quad", "triangle+quad") for kind in KINDS]
    + [(f, "mean dilatation", kind) for f in FAMILIES for kind in KINDS if f != "triangle" and kind != "plane stress"],
)
def test_patch(family, formulation, kind):
    """A constant strain: the stress is constant at every node, and the tractions on the boundary balance it."""
    model = model_of(block(family), kind, formulation)
    space = space_of(model)
    slope = np.array([[0.2, 0.0], [0.0, -0.3]] if model.axisymmetric else [[0.2, 0.1], [-0.4, -0.3]])
    u = model.mesh.points @ slope.T
    (stress,) = body_stresses(space, model, u)
    lambda_, shear = lame(model)
    hoop = 0.2 if model.axisymmetric else 0.0
    trace = lambda_ * (slope[0, 0] + slope[1, 1] + hoop)
    xx, yy = trace + 2 * shear * slope[0, 0], trace + 2 * shear * slope[1, 1]
    zz, xy = 0.0 if kind == "plane stress" else trace + 2 * shear * hoop, shear * (slope[0, 1] + slope[1, 0])
    np.testing.assert_allclose(stress.stress, np.tile([xx, yy, zz, xy, 0, 0], (len(stress.nodes), 1)), atol=1e-12)
    forces = np.zeros_like(u)
    for name in model.mesh.boundaries:
        (side,) = boundary(space, name, ()).blocks
        normals = side.outward / side.weights[..., None]
        traction = normals @ np.array([[xx, xy], [xy, yy]])
        forces[side.nodes] += side.nodal(facet_areas(model, side)[..., None] * traction)
    inner = stiffness(space, model) @ u.ravel()
    np.testing.assert_allclose(inner, forces.ravel(), rtol=0, atol=1e-12 * np.abs(inner).max())


@pytest.mark.parametrize("family", FAMILIES)
def test_the_stiffness_is_that_of_scikit_fem(family):
    elements = {
        "triangle": skfem.ElementTriP1(),
        "quad": skfem.ElementQuad1(),
        "triangle6": skfem.ElementTriP2(),
        "quad8": skfem.ElementQuadS2(),
        "quad9": skfem.ElementQuad2(),
    }
    grid = [np.linspace(0, 1, 4), np.linspace(0, 1, 3)]
    mesh = (skfem.MeshTri if "tri" in family else skfem.MeshQuad).init_tensor(*grid)
    mesh = type(mesh)(bent(Mesh(points=mesh.p.T, cells={}, bodies={})).points.T, mesh.t)
    scalar = skfem.Basis(mesh, elements[family])
    vector = skfem.Basis(mesh, skfem.ElementVector(elements[family]), intorder=QUADRATURES[family])
    cells = scalar.element_dofs.T
    ours = Mesh(points=scalar.doflocs.T, cells={family: cells}, bodies={"block": np.arange(len(cells))})
    model = model_of(ours)
    lambda_, shear = lame(model)
    K, expected = stiffness(space_of(model), model), linear_elasticity(lambda_, shear).assemble(vector)
    assert abs(K - expected).max() <= 1e-14 * abs(expected).max()


@pytest.mark.parametrize("kind", ["plane strain", "plane stress"])
@pytest.mark.parametrize("family", QUADRATIC)
def test_quadratic_displacements_have_exact_linear_stresses(family, kind):
    model = model_of(rectangle(width=2.0, height=1.0, nx=3, ny=2, cells=family), kind)
    x, y = model.mesh.points.T
    u = np.column_stack([x**2 - 2 * x * y, 0.5 * x * y + y**2])
    (stress,) = body_stresses(space_of(model), model, u)
    lambda_, shear = lame(model)
    xx, yy, xy = 2 * x - 2 * y, 0.5 * x + 2 * y, -2 * x + 0.5 * y
    np.testing.assert_allclose(stress.stress[:, 0], lambda_ * (xx + yy) + 2 * shear * xx, atol=1e-12)
    np.testing.assert_allclose(stress.stress[:, 1], lambda_ * (xx + yy) + 2 * shear * yy, atol=1e-12)
    np.testing.assert_allclose(stress.stress[:, 3], shear * xy, atol=1e-12)


@pytest.mark.parametrize("family", [*FAMILIES, *MIXED])
def test_a_closed_surface_under_pressure_has_no_resultant(family):
    sides = ("left", "right", "bottom", "top")
    model = model_of(block(family), loads=[Load(name, pressure=2.0) for name in sides])
    forces = sum(nodal_loads(space_of(model), model).values()).reshape(-1, 2)
    x, y = model.mesh.points.T
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-13)
    assert x @ forces[:, 1] - y @ forces[:, 0] == pytest.approx(0.0, abs=1e-13)
    assert (x @ forces[:, 0] + y @ forces[:, 1]) / 2 == pytest.approx(
        -2.0 * sum(v.sum() for v in space_of(model).volumes), rel=1e-12
    )


@pytest.mark.parametrize("family", FAMILIES)
def test_weight(family):
    """Gravity on a cylinder standing on the axis."""
    mesh = rectangle(width=2.0, height=3.0, nx=2, ny=3, cells=family)
    model = model_of(mesh, "axisymmetric", loads=[Load("block", body_force=(0.0, -2.0))])
    forces = nodal_loads(space_of(model), model)["block"].reshape(-1, 2)
    assert forces[:, 1].sum() == pytest.approx(-2.0 * np.pi * 2.0**2 * 3.0, rel=1e-13)
    assert mesh.points[:, 1] @ forces[:, 1] == pytest.approx(1.5 * forces[:, 1].sum(), rel=1e-13)


@pytest.mark.parametrize(("family", "rate"), [("quad", 2), ("triangle", 2), ("quad8", 4), ("triangle6", 4)])
def test_sides_of_a_circle(family, rate):
    def error(n):
        space = make_space(annulus(inner=1.0, outer=2.0, n_radial=1, n_angular=n, cells=family))
        side = boundary(space, "outer", ())
        radial = space.mesh.points[side.nodes] / 2.0
        np.testing.assert_allclose(np.linalg.norm(radial, axis=1), 1.0, atol=1e-14)
        np.testing.assert_allclose(side.nodal_normals, radial, atol=2e-3 if rate == 4 else 1e-12)
        assert side.nodal_lengths.sum() == pytest.approx(side.lengths.sum())
        assert len(side.corner_nodes) == n
        return 4.0 * np.pi - side.lengths.sum()

    assert np.log2(error(12) / error(24)) == pytest.approx(rate, abs=0.1)


def test_areas_of_a_disc():
    """Tributary areas around the axis; the node on it has that of the cone of its hat function."""
    for family, first in (("quad", np.pi * 0.5**2 / 3), ("quad8", 0.0)):
        model = model_of(rectangle(width=2.0, height=1.0, nx=4, ny=1, cells=family), "axisymmetric")
        side = boundary(space_of(model), "bottom", ())
        areas = side.nodal(facet_areas(model, block) for block in side.blocks)
        assert areas.sum() == pytest.approx(np.pi * 4.0, rel=1e-14)
        assert areas[np.argmin(model.mesh.points[side.nodes, 0])] == pytest.approx(first, abs=1e-15)
    straight = boundary(make_space(rectangle(width=6.0, nx=2, cells="quad9")), "top", ())
    np.testing.assert_allclose(np.sort(straight.nodal_lengths), [0.5, 0.5, 1.0, 2.0, 2.0])


@pytest.mark.parametrize("family", QUADRATIC)
def test_quadratic_disks_are_round(family):
    for make in (quarter_disk, half_disk):
        mesh = make(radius=8.0, contact_length=4.0, contact_spacing=0.5, cells=family)
        arc = mesh.points[mesh.nodes_of("arc")]
        np.testing.assert_allclose(np.linalg.norm(arc - [0.0, 8.0], axis=1), 8.0, rtol=1e-14)
        share = 0.25 if make is quarter_disk else 0.5
        space = make_space(mesh)
        assert sum(v.sum() for v in space.volumes) == pytest.approx(share * np.pi * 64.0, rel=5e-4)
        for block_ in space.blocks:
            bent = jacobians(mesh.points[block_.cells], block_.gradients)
            assert np.linalg.det(bent).min() > 0, block_.family
        linear = make(radius=8.0, contact_length=4.0, contact_spacing=0.5, cells=family.rstrip("689"))
        order2 = make(radius=8.0, contact_length=4.0, contact_spacing=0.5, cells=family.rstrip("689"), order=2)
        if family != "quad9":
            np.testing.assert_array_equal(order2.points, mesh.points)
        assert mesh.number_of_cells == linear.number_of_cells


def changed(mesh, **parts):
    return replace(mesh, **parts)


SQUARES = rectangle(width=2.0, nx=2, cells="quad8")


def _linear_neighbour():
    cells = SQUARES.cells["quad8"]
    return changed(SQUARES, cells={"quad": cells[:1, :4], "quad8": cells[1:]})


def _hanging():
    cells = SQUARES.cells["quad8"]
    top = cells[0]
    points = np.vstack([SQUARES.points, [[0.0, 2.0], [0.5, 2.0]]])
    small = [[top[3], top[6], len(points) - 1, len(points) - 2]]
    return changed(SQUARES, points=points, cells={"quad8": cells, "quad": small}, bodies={"block": [0, 1, 2]})


def _own_middle():
    cells = np.array(SQUARES.cells["quad8"])
    shared = cells[0, 5]
    cells[0, 5] = len(SQUARES.points)
    return changed(SQUARES, points=np.vstack([SQUARES.points, SQUARES.points[shared]]), cells={"quad8": cells})


def _moved_middle(by):
    points = np.array(SQUARES.points)
    points[SQUARES.cells["quad8"][1, 6]] += by
    return changed(SQUARES, points=points)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            _linear_neighbour,
            r"cell 1 \(quad\) and cell 2 \(quad8\) meet along the edge between nodes \d+ and \d+ without",
        ),
        (_hanging, r"the middle of an edge of cell 1 \(quad8\), is the corner of another"),
        (_own_middle, "without sharing a middle node"),
        (lambda: _moved_middle((0.3, 0.0)), r"cell 2 \(quad8\) near .* is turned inside out"),
        (lambda: _moved_middle((0.0, -1.2)), r"cell 2 \(quad8\) .*; expected the middle nodes near the middles"),
    ],
)
def test_cells_that_do_not_fit(make, message):
    with pytest.raises(InputError, match=message):
        make_space(make())


@pytest.mark.parametrize("far", [1e15, -1e20, 1e160])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_node_that_leaves_no_digits_to_the_others(far, axis):
    points = np.array(SQUARES.points)
    points[3, axis] = far
    with pytest.raises(
        InputError, match=r"node 4 at \(.*\) is more than 1e\+12 times as far away as cell \d+ \(\w+\) is long"
    ):
        make_space(changed(SQUARES, points=points))


def test_a_collapsed_edge_is_named():
    points = np.array(SQUARES.points)
    one, two = SQUARES.cells["quad8"][1, :2]
    points[two] = points[one]
    with pytest.raises(
        InputError, match=rf"cell 2 \(\w+\) has an edge of length 0, from node {one + 1} to node {two + 1} at"
    ):
        make_space(changed(SQUARES, points=points))


def test_a_quarter_point_is_allowed():
    make_space(_moved_middle((-0.25, 0.0)))


def test_middle_nodes_of_boundaries():
    bottom = SQUARES.boundaries["bottom"]
    ends = changed(SQUARES, boundaries={"bottom": bottom[:, :2]})
    np.testing.assert_array_equal(boundary(make_space(ends), "bottom", ()).blocks[0].facets, bottom)
    wrong = np.array(bottom)
    wrong[0, 2] = 9
    with pytest.raises(InputError, match=r"'bottom' has node 10 between nodes \d+ and \d+, where the cell has node"):
        boundary(make_space(changed(SQUARES, boundaries={"bottom": wrong})), "bottom", ())
    linear = rectangle(nx=2)
    extra = np.column_stack([linear.boundaries["bottom"], [5, 4]])
    with pytest.raises(InputError, match="where the cell has no node"):
        boundary(make_space(changed(linear, boundaries={"bottom": extra})), "bottom", ())


def test_negative_radii():
    with pytest.raises(InputError, match=r"node \d+ has the radius -1; expected x = r >= 0"):
        make_space(rectangle(width=2.0, nx=2, origin=(-1.0, 0.0)), kind="axisymmetric")
    with pytest.raises(InputError, match=r"thickness: is 2; an axisymmetric model has none"):
        model_of(rectangle(), "axisymmetric", thickness=2.0)
