# SPDX-License-Identifier: BSD-3-Clause
"""Hexahedra cut into tetrahedra: volumes, faces that fit, curved edges."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.errors import InputError
from signorini.fem.boundary import boundary
from signorini.fem.space import make_space
from signorini.meshing.plane import rectangle, target
from signorini.meshing.solid import extruded
from signorini.meshing.tetrahedra import tetrahedra


@pytest.mark.parametrize("cells", ["quad", "quad9"])
def test_tetrahedra_fill_the_same_body(cells):
    """Neighbours share their faces: what is outside closes, and bounds the volume of the cells."""
    whole = extruded(target(radii=[1.0, 2.0], n=2, cells=cells), z=[0.0, 0.4, 1.0])
    order = np.random.default_rng(0).permutation(len(whole.points))  # diagonals any way
    shuffled = replace(
        whole,
        points=whole.points[np.argsort(order)],
        cells={name: order[nodes] for name, nodes in whole.cells.items()},
        boundaries={name: order[faces] for name, faces in whole.boundaries.items()},
    )
    mesh = tetrahedra(shuffled)
    space, exact = make_space(mesh), sum(float(parts.sum()) for parts in make_space(whole).volumes)
    assert mesh.number_of_cells == 6 * whole.number_of_cells
    assert all((parts > 0.0).all() for parts in space.volumes)
    sides = [boundary(space, name, ()).blocks[0] for name in mesh.boundaries]
    forces = [side.nodal(side.outward) for side in sides]
    np.testing.assert_allclose(sum(force.sum(axis=0) for force in forces), 0.0, atol=1e-12)
    flux = sum(float((force * mesh.points[side.nodes]).sum()) / 3.0 for force, side in zip(forces, sides, strict=True))
    volume = sum(float(parts.sum()) for parts in space.volumes)
    assert volume == pytest.approx(flux, rel=1e-6)
    assert volume == pytest.approx(exact, rel=1e-12 if cells == "quad" else 1e-4)


def test_other_cells_are_refused():
    with pytest.raises(InputError, match="expected hexahedra of 8 or of 27 nodes"):
        tetrahedra(rectangle())
