# SPDX-License-Identifier: BSD-3-Clause
"""Built-in meshes: areas, lengths, names, orientation, and refined meshes that keep the nodes of the coarse one."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.meshing.plane import annulus, half_disk, quarter_disk, rectangle
from signorini.meshing.solid import extruded

R = 8.0
both_cells = pytest.mark.parametrize("cells", ["quad", "triangle"])


def area(mesh):
    return sum(volumes.sum() for volumes in make_space(mesh).volumes)


def length(mesh, name):
    return boundary(make_space(mesh), name, ("test",)).lengths.sum()


def assert_sound(mesh):
    """Counterclockwise convex cells, every node used, and a closed boundary made of the named parts alone."""
    space = make_space(mesh)
    for block in space.blocks:
        jacobians = np.einsum("mki,qkj->mqij", mesh.points[block.cells], block.corners)
        assert np.linalg.det(jacobians).min() > 0
        edges = np.sort(np.stack([block.cells, np.roll(block.cells, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        found, count = np.unique(edges, axis=0, return_counts=True)
        outer = found[count == 1]
        named = np.vstack([np.sort(facets, axis=1) for facets in mesh.boundaries.values()])
        assert sorted(map(tuple, outer.tolist())) == sorted(map(tuple, named.tolist()))
    assert len(space.used_nodes) == len(mesh.points)


@both_cells
@pytest.mark.parametrize(("nx", "ny"), [(1, 1), (5, 2)])
def test_rectangle(cells, nx, ny):
    mesh = rectangle(width=3.0, height=2.0, nx=nx, ny=ny, origin=(-1.0, 4.0), cells=cells)
    assert_sound(mesh)
    assert area(mesh) == pytest.approx(6.0)
    assert set(mesh.boundaries) == {"left", "right", "bottom", "top"}
    for name, axis, value in (("left", 0, -1), ("right", 0, 2), ("bottom", 1, 4), ("top", 1, 6)):
        np.testing.assert_allclose(mesh.points[mesh.nodes_of(name), axis], value)
        assert length(mesh, name) == pytest.approx(2.0 if axis == 0 else 3.0)


@both_cells
@pytest.mark.parametrize(
    ("contact_length", "contact_spacing", "refine"),
    [(4.0, 0.5, 1), (4.0, 0.5, 3), (5.6, 0.2, 1), (1.0, 0.125, 2), (0.1, 0.05, 1), (0.02, 0.001, 1), (3.0, 3.0, 1)],
)
def test_quarter_disk(cells, contact_length, contact_spacing, refine):
    mesh = quarter_disk(
        radius=R, contact_length=contact_length, contact_spacing=contact_spacing, refine=refine, cells=cells
    )
    assert_sound(mesh)
    assert set(mesh.boundaries) == {"arc", "axis", "cut"}
    arc = mesh.points[mesh.nodes_of("arc")]
    np.testing.assert_allclose(np.linalg.norm(arc - (0, R), axis=1), R, rtol=1e-12)
    x = np.sort(arc[:, 0])
    inside = x[x < contact_length * (1 + 1e-9)]
    np.testing.assert_allclose(inside, np.arange(len(inside)) * contact_spacing / refine, atol=1e-12 * R)
    assert inside[-1] == pytest.approx(contact_length)
    assert arc[np.argmin(arc[:, 0])].tolist() == [0.0, 0.0]
    assert (mesh.points[mesh.nodes_of("axis"), 0] == 0.0).all()
    assert (mesh.points[mesh.nodes_of("cut"), 1] == R).all()
    assert length(mesh, "axis") == pytest.approx(R)
    assert length(mesh, "cut") == pytest.approx(R)
    # of the polygon inscribed by the arc's nodes
    turns = np.sort(np.arctan2(arc[:, 0], R - arc[:, 1]))
    assert area(mesh) == pytest.approx(0.5 * R**2 * np.sin(np.diff(turns)).sum())


def test_the_size_of_the_papers_mesh():
    mesh = quarter_disk(radius=R, contact_length=4.0, contact_spacing=0.5)
    assert (mesh.number_of_cells, len(mesh.points)) == (76, 93)


@both_cells
def test_half_disk_is_a_quarter_and_its_mirror(cells):
    options = {"radius": R, "contact_length": 4.0, "contact_spacing": 0.5, "cells": cells}
    half, quarter = half_disk(**options), quarter_disk(**options)
    assert_sound(half)
    assert set(half.boundaries) == {"arc", "cut"}
    assert area(half) == pytest.approx(2 * area(quarter))
    assert length(half, "arc") == pytest.approx(2 * length(quarter, "arc"))
    tree = KDTree(half.points)
    for points in (quarter.points, quarter.points * (-1, 1)):
        assert tree.query(points)[0].max() < 1e-12 * R


@both_cells
@pytest.mark.parametrize("angle", [90.0, 200.0, 360.0])
def test_annulus(cells, angle):
    n = 18
    mesh = annulus(inner=1.0, outer=2.5, n_radial=3, n_angular=n, angle=angle, centre=(1.0, -2.0), cells=cells)
    assert_sound(mesh)
    assert set(mesh.boundaries) == {"inner", "outer"} | (set() if angle == 360 else {"start", "end"})
    chord = 2 * np.sin(np.radians(angle) / n / 2)
    for name, radius in (("inner", 1.0), ("outer", 2.5)):
        np.testing.assert_allclose(np.linalg.norm(mesh.points[mesh.nodes_of(name)] - (1, -2), axis=1), radius)
        assert length(mesh, name) == pytest.approx(n * radius * chord)
    assert area(mesh) == pytest.approx(n * 0.5 * np.sin(np.radians(angle) / n) * (2.5**2 - 1.0))


@pytest.mark.parametrize(
    "make",
    [
        lambda n: rectangle(width=2.0, nx=3 * n, ny=2 * n),
        lambda n: annulus(inner=1.0, outer=2.0, n_radial=2 * n, n_angular=6 * n, angle=90.0),
        lambda n: quarter_disk(radius=R, contact_length=4.0, contact_spacing=0.5, refine=n),
        lambda n: half_disk(radius=R, contact_length=2.0, contact_spacing=0.25, refine=n),
    ],
    ids=["rectangle", "annulus", "quarter_disk", "half_disk"],
)
def test_refined_meshes_are_nested_along_their_boundaries(make):
    """Every boundary node of the coarse mesh is one of the fine mesh, four times as many cells."""
    coarse, fine = make(1), make(2)
    assert fine.number_of_cells == 4 * coarse.number_of_cells
    for name in coarse.boundaries:
        tree = KDTree(fine.points[fine.nodes_of(name)])
        missing = tree.query(coarse.points[coarse.nodes_of(name)])[0].max()
        assert missing < 1e-12 * R, name


def test_raised_meshes_keep_all_names():
    plane = replace(rectangle(nx=2, cells="quad8"), nodes={"corner": np.array([0])})
    mesh = extruded(plane, z=[0.0, 0.5, 2.0], ends=("front", "back"))
    assert set(mesh.boundaries) == {*plane.boundaries, "front", "back"}
    assert len(mesh.boundaries["left"]) == 2
    np.testing.assert_array_equal(np.unique(mesh.points[mesh.boundaries["back"], 2]), [2.0])
    corner = mesh.points[mesh.nodes["corner"]]
    np.testing.assert_allclose(corner[:, :2], np.tile(plane.points[0], (5, 1)))
    np.testing.assert_allclose(corner[:, 2], [0.0, 0.25, 0.5, 1.25, 2.0])


@pytest.mark.parametrize(
    ("ends", "said"),
    [
        (("front", "left"), r"ends\[1\]: 'left' is taken: the plane mesh has it"),
        (("corner", "back"), r"ends\[0\]: 'corner' is taken"),
        (("one", "one"), "ends: is .*; expected two names"),
        (("", "back"), r"ends\[0\]"),
    ],
)
def test_ends_of_raised_meshes_need_names_of_their_own(ends, said):
    plane = replace(rectangle(), nodes={"corner": np.array([0])})
    with pytest.raises(InputError, match=said):
        extruded(plane, z=[0.0, 1.0], ends=ends)
