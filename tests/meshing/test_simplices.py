"""Triangles and tetrahedra that are bisected: meshes stay meshes, names and shapes stay theirs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signorini.accuracy.curves import Spline, curves_of
from signorini.errors import InputError
from signorini.fem.space import make_space
from signorini.meshing.plane import annulus, quarter_disk, rectangle
from signorini.meshing.simplices import Simplices
from signorini.meshing.solid import box, extruded
from signorini.model.mesh import Mesh, join

FAMILIES = {
    "triangle": lambda: rectangle(nx=3, ny=2, cells="triangle"),
    "quad": lambda: rectangle(nx=3, ny=2),
    "quad9": lambda: rectangle(nx=3, ny=2, order=2),
    "hexahedron": lambda: box(x=[0, 1, 1.5], y=[0, 2], z=[0, 0.5]),
    "hexahedron27": lambda: box(x=[0, 1, 1.5], y=[0, 2], z=[0, 0.5], cells="hexahedron27"),
    "wedge": lambda: extruded(rectangle(nx=2, ny=1, cells="triangle"), z=[0, 0.4, 1.0], ends=("low", "high")),
}


def volume(mesh):
    return sum(float(part.sum()) for part in make_space(mesh).volumes)


@pytest.mark.parametrize("family", FAMILIES)
@settings(max_examples=5, deadline=None)
@given(seed=st.integers(0, 10**6), order=st.sampled_from([1, 2]))
def test_whatever_is_refined_it_is_a_mesh_of_the_same_bodies(family, seed, order):
    """As large as before, every inner facet between two cells, every outer one on a boundary of that name."""
    rng, mesh = np.random.default_rng(seed), FAMILIES[family]()
    simplices = Simplices.of(mesh)
    for _ in range(2):
        simplices = simplices.refined(rng.choice(len(simplices.cells), 1 + len(simplices.cells) // 8))
    fine = simplices.mesh(order)
    assert volume(fine) == pytest.approx(volume(mesh), rel=1e-12)
    ((_, facets),) = make_space(fine).facets.items()
    _, times = np.unique(facets.key, return_counts=True)
    outer = sum(len(part) for name in fine.boundaries for part in fine.facets(name))
    assert times.max() == 2
    assert (times == 1).sum() == outer
    for name in mesh.boundaries:
        low, high = (mesh.points[mesh.nodes_of(name)].min(axis=0), mesh.points[mesh.nodes_of(name)].max(axis=0))
        found = fine.points[fine.nodes_of(name)]
        assert np.allclose(found.min(axis=0), low)
        assert np.allclose(found.max(axis=0), high)


def test_bodies_keep_their_cells_and_nodes_their_names():
    part = rectangle(nx=2, ny=1, cells="triangle")
    apart = Mesh(points=part.points + [0, 3], cells=part.cells, bodies=part.bodies, boundaries=part.boundaries)
    mesh = join({"one": part, "other": apart})
    named = Mesh(**{**vars(mesh), "nodes": {"left": mesh.nodes_of("one.left"), "tip": [0]}})
    fine = Simplices.of(named).refined([0, 1, 2, 3]).mesh(2)
    lower = fine.points[fine.cells["triangle6"][fine.bodies["one"]]][..., 1]
    assert lower.max() == 1.0
    assert len(fine.bodies["one"]) > len(fine.bodies["other"]) == 4
    assert sorted(fine.nodes["left"]) == sorted(fine.nodes_of("one.left"))
    assert fine.nodes["tip"].tolist() == [0]


def test_a_middle_node_alone_is_refused():
    mesh = rectangle(nx=1, ny=1, cells="triangle", order=2)
    middle = int(mesh.facets("bottom")[0][0, 2])
    wrong = Mesh(**{**vars(mesh), "nodes": {"support": [middle]}})
    with pytest.raises(InputError, match=r"holds node .* the middle of an edge, without both its ends"):
        Simplices.of(wrong)


def test_arcs_stay_arcs():
    """New nodes lie on the circle of the old ones, in linear and in quadratic meshes."""
    for cells in ("quad", "triangle"):
        for order in (1, 2):
            mesh = quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=1.0, cells=cells, order=order)
            curves = curves_of(mesh)
            simplices = Simplices.of(mesh)
            for _ in range(3):
                simplices = simplices.refined(np.arange(len(simplices.cells)), curves)
            fine = simplices.mesh(2, curves)
            at = fine.points[fine.nodes_of("arc")]
            assert np.linalg.norm(at - [0.0, 8.0], axis=1) == pytest.approx(8.0, rel=1e-12)
            assert volume(fine) == pytest.approx(16.0 * np.pi, rel=1e-7)


def test_bent_edges_stay_parabolas_without_a_shape():
    """Halves of a parabola are parabolas: the body is as large as it was."""
    mesh = quarter_disk(radius=8.0, contact_length=4.0, contact_spacing=1.0, cells="triangle", order=2)
    simplices = Simplices.of(mesh)
    for _ in range(2):
        simplices = simplices.refined(np.arange(len(simplices.cells)))
    assert volume(simplices.mesh(2)) == pytest.approx(volume(mesh), rel=1e-12)


def test_shapes_are_known():
    ring = annulus(inner=1.0, outer=2.0, n_radial=2, n_angular=12)
    assert {name: str(curve) for name, curve in curves_of(ring).items()} == {
        "inner": "a circle of radius 1",
        "outer": "a circle of radius 2",
    }
    pipe = extruded(ring, z=[0.0, 1.0, 2.0])
    assert str(curves_of(pipe)["inner"]) == "a cylinder of radius 1"
    assert curves_of(box(x=[0, 1], y=[0, 1], z=[0, 1])) == {}


@pytest.mark.parametrize("closed", [True, False])
def test_splines_are_of_fourth_order(closed):
    """Through points of an ellipse, closed or a half of it: twice as many leave a sixteenth."""
    near = np.linspace(0.35, 2.8, 23)
    errors = []
    for count in (24, 48):
        angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)[: None if closed else count // 2 + 1]
        line = Spline(np.column_stack([3.0 * np.cos(angle), 2.0 * np.sin(angle)]), closed=closed)
        found = line(1.01 * np.column_stack([3.0 * np.cos(near), 2.0 * np.sin(near)]))
        errors.append(np.abs(((found / [3.0, 2.0]) ** 2).sum(axis=1) - 1.0).max())
    assert errors[1] < errors[0] / 10.0


def test_values_are_carried_linearly():
    simplices = Simplices.of(rectangle(nx=2, ny=2, cells="triangle"))
    slope = np.array([2.0, -3.0])
    finer = simplices.refined([0, 3, 4])
    assert finer.carried(simplices.points @ slope) == pytest.approx(finer.points @ slope)


def test_angles_are_bounded_below():
    """Whatever is refined in the plane: half of the smallest angle at least (Rosenberg, Stenger 1975)."""
    simplices = Simplices.of(rectangle(nx=2, ny=2, cells="triangle"))
    rng = np.random.default_rng(3)
    for _ in range(8):
        simplices = simplices.refined(rng.choice(len(simplices.cells), 3))
    x = simplices.points[simplices.cells]
    edges = np.stack([x[:, (i + 1) % 3] - x[:, i] for i in range(3)], axis=1)
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    cosines = np.stack([-np.einsum("mi,mi->m", edges[:, i], edges[:, i - 1]) for i in range(3)])
    assert np.degrees(np.arccos(cosines)).min() >= 22.5 - 1e-9
