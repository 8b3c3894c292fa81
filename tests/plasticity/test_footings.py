# SPDX-License-Identifier: BSD-3-Clause
"""Flat punches on layers, a few hundredths beyond what they bear: the limit load is named there too."""

import pytest

import signorini as sg
from signorini.gallery.footings import footing
from signorini.reference.plasticity import punch_limit


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cells", "formulation", "edge"), [("tetra10", None, 0.2), ("hexahedron", "incompatible", 0.1)]
)
def test_the_same_limit_is_named_from_every_load_beyond_it(cells, formulation, edge):
    exact, named = punch_limit(1.0), []
    for beyond in (1.06, 1.05):
        model = footing(beyond * exact, edge=edge, cells=cells, formulation=formulation)
        history = sg.solve(model, raise_on_failure=False)
        assert history.status == "no_equilibrium", history.message
        named.append(beyond * float(history.message.split("flow plastically at ")[1].split("%")[0]) / 100.0)
    assert named[0] == pytest.approx(named[1], rel=1e-3)
    assert 1.0 < named[0] < 1.04
