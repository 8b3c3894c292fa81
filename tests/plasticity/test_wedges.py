# SPDX-License-Identifier: BSD-3-Clause
"""Wedges among hexahedra: a few, as meshers put them around an axis, yield with a mean dilatation."""

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from signorini.gallery.yielding import footing
from signorini.meshing.solid import extruded

STEEL = sg.Elastic(E=210e3, nu=0.3, plastic=sg.Plastic(235.0))


def slab(split, depth):
    """The flat punch on a layer that cannot move across, 4 cells under half of it; some hexahedra are two wedges.

    Parameters
    ----------
    split : says of the middles (m, 2) of the cells which
    depth : to which the punch is driven
    """
    flat = footing(n=4, depth=depth, rough=True)
    quads, (name,) = flat.mesh.cells["quad"], flat.mesh.bodies
    two = split(flat.mesh.points[quads].mean(axis=1))
    kinds = {"quad": quads[~two], "triangle": np.concatenate([quads[two][:, :3], quads[two][:, [0, 2, 3]]])}
    cells = {family: nodes for family, nodes in kinds.items() if len(nodes)}
    plane = sg.Mesh(
        points=flat.mesh.points,
        cells=cells,
        bodies={name: np.arange(sum(map(len, cells.values())))},
        boundaries={side: flat.mesh.facets(side) for side in flat.mesh.boundaries},
    )
    across = [sg.Support(side, u=(None, None, 0.0)) for side in ("back", "front")]
    supports = [replace(support, u=(*support.u, None)) for support in flat.supports]
    return sg.Model(
        extruded(plane, z=[0.0, 0.25], ends=("back", "front")),
        bodies=flat.bodies,
        supports=[*supports, *across],
        steps=flat.steps,
    )


def pressure(split, depth):
    """Mean, over the shear strength."""
    return -4.0 * sg.solve(slab(split, depth)).last.reactions["punch"][1]


def at_the_edge(middles):
    """Where the punch ends and strains are largest."""
    return (abs(middles[:, 0] - 1.0) < 0.5) & (middles[:, 1] > -0.5)


def test_a_few_wedges_have_a_limit_load():
    """As high as that of hexahedra but for a twentieth, however deep the punch is driven."""
    hexahedra = pressure(lambda middles: middles[:, 0] < 0.0, 0.32)
    shallow, deep = (pressure(at_the_edge, depth) for depth in (0.32, 1.28))
    assert hexahedra < shallow < 1.06 * hexahedra
    assert deep == pytest.approx(shallow, rel=2e-3)


def test_many_wedges_are_refused_as_they_lock():
    with pytest.raises(sg.InputError, match=r"cells \(wedge\) would lock where it flows") as found:
        slab(lambda middles: middles[:, 0] > 0.0, 0.1)
    assert found.value.where == ("body", 0, "formulation")
    body = sg.Body("block", STEEL).in_kind("3d")
    assert body.check_flow((), "3d", {"hexahedron": 90, "wedge": 10}) is None
    with pytest.raises(sg.InputError, match=r"\(hexahedron and wedge\) would lock .* a tenth of the cells wedges at"):
        body.check_flow((), "3d", {"hexahedron": 89, "wedge": 10})
    modes = replace(body, formulation="incompatible")
    with pytest.raises(sg.InputError, match="would lock where it flows"):
        modes.check_flow((), "3d", {"hexahedron": 90, "wedge": 10})


def test_nearly_incompressible_bodies_may_have_as_many():
    mesh = slab(at_the_edge, 0.1).mesh
    rubber = sg.Body(next(iter(mesh.bodies)), sg.Elastic(E=1.0, nu=0.4999), "mean dilatation")
    model = sg.Model(
        mesh, bodies=[rubber], supports=[sg.Support("bottom", u=(0, 0, 0))], loads=[sg.Load("seat", pressure=0.01)]
    )
    assert sg.solve(model).solved
