# SPDX-License-Identifier: BSD-3-Clause
"""Lame's press fit: the closed form and the rate at which it is met, on meshes that match or not."""

from dataclasses import replace

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.gallery.press_fit import press_fit
from signorini.reference.lame import press_fit_pressure

RINGS = {"inner": 1.0, "interface": 2.0, "outer": 3.0, "interference": 0.01}
BODIES = {"inner_body": (2000.0, 0.3), "outer_body": (1000.0, 0.3)}


def reference(kind):
    return press_fit_pressure(**RINGS, **BODIES, plane_strain=kind == "plane strain")


def mean_error(kind, cells, n):
    contact = solve(press_fit(n_radial=n, n_angular=3 * n, kind=kind, cells=cells)).contact("fit")
    mean = contact.pressure @ contact.area / contact.area.sum()
    return abs(mean / reference(kind) - 1.0)


@pytest.mark.parametrize("cells", ["quad", "triangle"])
@pytest.mark.parametrize("kind", ["plane stress", "plane strain"])
def test_converges_at_the_second_order(kind, cells):
    errors = [mean_error(kind, cells, n) for n in (4, 8, 16)]
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert rates.min() > 1.9, (errors, rates)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize("kind", ["plane stress", "plane strain"])
def test_every_nodal_pressure(kind):
    contact = solve(press_fit(n_radial=16, n_angular=48, kind=kind)).contact("fit")
    np.testing.assert_allclose(contact.pressure, reference(kind), rtol=1e-3)
    np.testing.assert_allclose(contact.gap, 0.0, atol=1e-12)


def test_friction_changes_nothing_where_nothing_slides():
    smooth, rough = (solve(press_fit(friction=mu)).contact("fit") for mu in (0.0, 0.3))
    np.testing.assert_allclose(rough.pressure, smooth.pressure, rtol=1e-9)
    np.testing.assert_allclose(rough.traction, 0.0, atol=1e-9 * reference("plane stress"))


@pytest.mark.parametrize("cells", ["quad", "quad8", "triangle6"])
@pytest.mark.parametrize("interference", [0.01, 1e-5])
@pytest.mark.parametrize("along", [(12, 17), (8, 24)])
def test_meshes_that_do_not_match(cells, interference, along):
    """Facets on one circle leave gaps that are no gaps, however small the interference is beside them."""
    contact = solve(press_fit(n_radial=6, n_angular=along, interference=interference, cells=cells)).contact("fit")
    assert contact.coupling == "mortar"
    np.testing.assert_allclose(contact.pressure, reference("plane stress") * interference / 0.01, rtol=0.01)


def test_the_coarser_side_is_the_smoother_one():
    """The finer side as nonmortar is noted; the coarser one can be asked for."""
    model = press_fit(n_angular=(24, 12))
    noted = solve(model)
    assert any("'fit': the nonmortar side is the finer one" in note for note in noted.last.notes)
    chosen = solve(replace(model, contacts=[replace(model.contacts[0], side="coarser")]))
    assert chosen.contact("fit").nonmortar == "hub.inner"
    assert not chosen.last.notes
    spread = [np.ptp(history.contact("fit").pressure) for history in (noted, chosen)]
    assert spread[1] < 0.1 * spread[0]
