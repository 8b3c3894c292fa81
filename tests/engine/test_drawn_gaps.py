# SPDX-License-Identifier: BSD-3-Clause
"""What a user draws, clearance or overlap, is told from what facets of a curve leave between them."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.examine import examine
from signorini.engine.solve import solve
from signorini.meshing.plane import annulus, rectangle
from signorini.meshing.solid import extruded
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.reference.lame import press_fit_pressure

STEEL = (200e3, 0.3)


def fit(counts, clearance, *, cells="quad", deep=False, **contact):
    """A quarter of a shaft, radii 5 and 10, in a hub that is wider by a clearance, up to radius 20."""
    radii = {"shaft": (5.0, 10.0), "hub": (10.0 + clearance, 20.0)}
    rings = {
        name: annulus(inner=a, outer=b, n_radial=4, n_angular=n, angle=90.0, cells=cells)
        for (name, (a, b)), n in zip(radii.items(), counts, strict=True)
    }
    held = [("start", (None, 0.0)), ("end", (0.0, None))]
    if deep:
        rings = {name: extruded(ring, z=[0.0, 2.0, 4.0]) for name, ring in rings.items()}
        held = [(side, (*u, None)) for side, u in held] + [("bottom", (None, None, 0)), ("top", (None, None, 0))]
    return Model(
        join(rings),
        bodies=[Body(name, Elastic(*STEEL)) for name in rings],
        supports=[Support(f"{name}.{side}", u=u) for name in rings for side, u in held],
        contacts=[Contact("shaft.outer", "hub.inner", name="fit", **contact)],
    )


@pytest.mark.parametrize(
    ("cells", "counts", "deep", "error"),
    [
        ("quad", (6, 9), False, 1e-6),
        ("quad", (9, 6), False, 2e-6),
        ("quad8", (3, 4), False, 1e-8),
        ("quad", (6, 9), True, 1e-5),
        ("quad8", (4, 3), True, 1e-5),
        ("triangle", (6, 9), True, 1e-5),
    ],
)
@pytest.mark.parametrize("clearance", [0.0, 0.01, -0.01])
def test_gaps_between_circles_whatever_their_facets(cells, counts, deep, error, clearance):
    """Facets leave up to 0.05; the rest is of the order of the clearance: which way it is measured."""
    drawn = examine(fit(counts, clearance, cells=cells, deep=deep)).interface.gap
    asked = examine(fit(counts, 0.0, cells=cells, deep=deep, gap=clearance)).interface.gap
    np.testing.assert_allclose(drawn, asked, atol=error + 0.01 * abs(clearance))


@pytest.mark.parametrize(
    ("cells", "counts"), [("quad", (6, 9)), ("quad", (9, 6)), ("quad", (24, 36)), ("quad8", (6, 9))]
)
@pytest.mark.parametrize("overlap", [0.1, 0.005, 0.001])
def test_a_press_fit_drawn_with_its_overlap(cells, counts, overlap):
    """R 10: polygons of 6 and 9 facets a quarter are up to 0.09 beside the circle. As with ``interference``; Lame."""
    drawn = solve(fit(counts, -overlap, cells=cells)).contact("fit")
    asked = solve(fit(counts, 0.0, cells=cells, interference=overlap)).contact("fit")
    exact = press_fit_pressure(
        inner=5, interface=10, outer=20, interference=overlap, inner_body=STEEL, outer_body=STEEL, plane_strain=True
    )
    means = [found.pressure @ found.area / found.area.sum() for found in (drawn, asked)]
    assert means[0] == pytest.approx(means[1], rel=0.005 + 0.2 * overlap)  # the shaft itself is larger
    assert means[0] == pytest.approx(exact, rel=0.02 + 0.1 * overlap)


def test_a_flat_beside_an_arc_stays_flat():
    """A block with rounded edges on a finer one: where it is flat nothing is added."""

    def block(n, y, bent):
        mesh = rectangle(width=4.0, height=1.0, nx=n, ny=2, origin=(-2.0, y))
        points = mesh.points.copy()
        beyond = np.maximum(np.abs(points[:, 0]) - 1.0, 0.0)
        points[:, 1] += bent * (2.0 - np.sqrt(4.0 - beyond**2)) * (1.0 - points[:, 1])
        return replace(mesh, points=points)

    mesh = join({"upper": block(8, 0.0, 1.0), "lower": block(12, -1.0, 0.0)})
    bodies = [Body(name, Elastic(*STEEL)) for name in ("upper", "lower")]
    supports = [Support("lower.bottom", u=(0, 0)), Support("upper.top", u=(0, -0.01))]
    model = Model(mesh, bodies=bodies, supports=supports, contacts=[Contact("upper.bottom", "lower.top")])
    interface = examine(model).interface
    x = model.mesh.points[interface.node, 0]
    np.testing.assert_allclose(interface.gap[np.abs(x) < 1.01], 0.0, atol=1e-9)
    assert (interface.gap[np.abs(x) > 1.4] > 0.02).all()
