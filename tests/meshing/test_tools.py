# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries of meshed tools, and how wrong facets are named."""

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.meshing.facets import FACETS, corner_volumes, make_facets, outer_facets
from signorini.meshing.plane import rectangle
from signorini.meshing.profile import mesh_profile
from signorini.meshing.solid import box, extruded
from signorini.meshing.surface import mesh_surface
from signorini.model.mesh import CORNERS, Mesh


def changed(mesh, **parts):
    return Mesh(**{**{key: getattr(mesh, key) for key in ("points", "cells", "bodies", "boundaries")}, **parts})


def folded(mesh):
    """One corner of the first cell pushed through it."""
    points, (cells,) = np.array(mesh.points), mesh.cells.values()
    points[cells[0, 0]] = points[cells[0, : CORNERS[next(iter(mesh.cells))]]].mean(axis=0) + 0.4
    return changed(mesh, points=points)


@pytest.mark.parametrize(
    ("tool", "read"),
    [(rectangle(nx=2), mesh_profile), (box(x=[0, 1, 2], y=[0, 1], z=[0, 1]), mesh_surface)],
    ids=["plane", "space"],
)
def test_a_tool_with_a_folded_cell_is_refused(tool, read):
    read(tool, "top")
    with pytest.raises(InputError, match=r"cell 1 \(\w+\) near .* has no area or is turned inside out"):
        read(folded(tool), "top")


@pytest.mark.parametrize("cells", ["quad", "quad8", "triangle", "triangle6"])
def test_corners_of_cells_and_their_mirror_images(cells):
    plane = rectangle(cells=cells)
    for mesh in (plane, extruded(plane, z=[0, 1], ends=("front", "back"))):
        mirrored = changed(mesh, points=mesh.points * ([-1.0] + [1.0] * (mesh.points.shape[1] - 1)))
        for family, own in mesh.cells.items():
            volumes = corner_volumes(mesh.points, family, own)
            assert volumes.shape == (len(own), CORNERS[family])
            assert (volumes > 0.0).all()
            np.testing.assert_array_equal(corner_volumes(mirrored.points, family, own), -volumes)
            assert {node for facet in FACETS[family] for node in facet[: CORNERS[family]]} >= set(
                range(CORNERS[family])
            )


def test_wrong_faces_are_named_by_the_numbers_of_their_nodes():
    mesh = box(x=[0, 1, 2], y=[0, 1], z=[0, 1])
    inside = [[4, 5, 7, 6]]
    numbered = changed(mesh, boundaries={"inside": inside, "none": [[0, 3, 5, 10]]}, node_numbers=100 + np.arange(12))
    for name, words in (
        ("inside", "'inside' lies inside: the face between nodes 104, 105, 107 and 106 belongs to two cells"),
        ("none", "'none' has a face between nodes 100, 103, 105 and 110 that no cell has"),
    ):
        with pytest.raises(InputError, match=words):
            outer_facets(make_facets(numbered), numbered, name, ())
