# SPDX-License-Identifier: BSD-3-Clause
"""Cattaneo-Mindlin and its cycles in closed form, and Spence's stick zones; the finer ones are in `verify`."""

import numpy as np
import pytest

from signorini.engine.solve import solve
from signorini.gallery.half_planes import EQUAL, NU, punch
from signorini.reference.spence import stick_ratio
from signorini.verify.half_planes import cattaneo_mindlin


@pytest.mark.parametrize("check", list(cattaneo_mindlin()), ids=lambda check: check.quantity)
def test_cattaneo_mindlin(check):
    assert check.passed, f"{check.computed} instead of {check.reference}"


@pytest.mark.parametrize("curved", [False, True])
def test_spence(curved):
    contact = solve(punch(curved=curved, friction=0.4, spacing=0.02, closed=0.95)).contact("punch")
    x = contact.points[:, 0]
    found = x[contact.status == "stick"].max() / x[contact.closed].max()
    assert found == pytest.approx(stick_ratio(0.4, NU), abs=0.03)


def test_the_loss_formula_is_the_area_of_the_closed_loop():
    """``int q dx`` is the force, and the work of friction over a cycle by quadrature of the slip's Masing curve."""
    P, mu = EQUAL.normal.force, EQUAL.friction
    x = np.linspace(-1.0, 1.0, 20001) * EQUAL.normal.half_width
    for Q in (0.3 * mu * P, 0.9 * mu * P):
        assert np.trapezoid(EQUAL.traction(x, Q), x) == pytest.approx(Q, rel=1e-4)
        assert np.trapezoid(EQUAL.traction_back(x, Q, -0.2 * Q), x) == pytest.approx(-0.2 * Q, rel=1e-3)
        # delta(Q) up to its linear part
        load = np.linspace(0.0, Q, 20001)
        rest = P - load / mu
        delta = mu * (rest * np.log(rest) - P * np.log(P)) / (np.pi * EQUAL.normal.modulus)
        loop = 4.0 * Q * delta[-1] - 8.0 * np.trapezoid(delta, load)
        assert EQUAL.loss(Q) == pytest.approx(loop, rel=1e-5)
