# SPDX-License-Identifier: BSD-3-Clause
"""A clearance that facets of a circle are too coarse to show counts as none, which is said."""

import pytest

from signorini.engine.prepare import examine
from signorini.engine.report import chord_notes
from signorini.fem.generators import annulus
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model

ELASTIC = Elastic(E=1000.0, nu=0.3)
SIDES = (("start", (None, 0)), ("end", (0, None)))


@pytest.mark.parametrize(
    ("order", "clearance", "interference", "said"),
    [(1, 0.002, 0.0, True), (2, 0.002, 0.0, False), (1, 0.1, 0.0, False), (1, 0.002, 0.01, False)],
)
def test_a_lost_clearance_is_said(order, clearance, interference, said):
    shaft = annulus(inner=0.4, outer=1.0, n_radial=3, n_angular=12, angle=90.0, order=order)
    hub = annulus(inner=1.0 + clearance, outer=2.0, n_radial=3, n_angular=9, angle=90.0, order=order)
    model = Model(
        join({"shaft": shaft, "hub": hub}),
        bodies=[Body("shaft", ELASTIC), Body("hub", ELASTIC)],
        supports=[Support(f"{body}.{side}", u=u) for body in ("shaft", "hub") for side, u in SIDES],
        contacts=[Contact("shaft.outer", "hub.inner", name="fit", interference=interference)],
    )
    notes = chord_notes(examine(model))
    assert [note[:30] for note in notes] == (["contact 'fit': gaps of the geo"] if said else [])
