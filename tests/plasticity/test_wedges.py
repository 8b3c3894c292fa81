# SPDX-License-Identifier: BSD-3-Clause
"""Wedges among hexahedra: a few, as meshers put them around an axis, yield with a mean dilatation."""

from dataclasses import replace

import pytest

import signorini as sg
from signorini.gallery.footings import footing
from signorini.meshing.solid import extruded

STEEL = sg.Elastic(E=210e3, nu=0.3, plastic=sg.Plastic(235.0))


def pressure(cells, depth):
    """Mean under a rough punch on a layer, over the shear strength."""
    edge = 0.2
    return -sg.solve(footing(edge=edge, cells=cells, depth=depth, rough=True)).last.reactions["punch"][1] / edge


def test_a_few_wedges_have_a_limit_load():
    """About the edge, where strains are largest: as high as that of hexahedra but for some hundredths, at any depth."""
    hexahedra = pressure("hexahedron", 0.32)
    shallow, deep = (pressure("hexahedron and wedge", depth) for depth in (0.32, 1.28))
    assert hexahedra < shallow < 1.06 * hexahedra
    assert deep == pytest.approx(shallow, rel=2e-3)


def test_many_wedges_are_refused_as_they_lock():
    triangles = sg.rectangle(nx=2, ny=2, cells="triangle")
    with pytest.raises(sg.InputError, match=r"cells \(wedge\) would lock where it flows") as found:
        sg.Model(
            extruded(triangles, z=[0.0, 0.25], ends=("back", "front")),
            bodies=[sg.Body(next(iter(triangles.bodies)), STEEL)],
            supports=[sg.Support("bottom", u=(0, 0, 0))],
        )
    assert found.value.where == ("body", 0, "formulation")
    body = sg.Body("block", STEEL).in_kind("3d")
    assert body.check_flow((), "3d", {"hexahedron": 90, "wedge": 10}) is None
    with pytest.raises(sg.InputError, match=r"\(hexahedron and wedge\) would lock .* a tenth of the cells wedges at"):
        body.check_flow((), "3d", {"hexahedron": 89, "wedge": 10})
    modes = replace(body, formulation="incompatible")
    with pytest.raises(sg.InputError, match="would lock where it flows"):
        modes.check_flow((), "3d", {"hexahedron": 90, "wedge": 10})


def test_nearly_incompressible_bodies_may_have_as_many():
    mesh = footing(edge=0.2, cells="hexahedron and wedge").mesh
    rubber = sg.Body(next(iter(mesh.bodies)), sg.Elastic(E=1.0, nu=0.4999), "mean dilatation")
    model = sg.Model(
        mesh, bodies=[rubber], supports=[sg.Support("bottom", u=(0, 0, 0))], loads=[sg.Load("seat", pressure=0.01)]
    )
    assert sg.solve(model).solved
