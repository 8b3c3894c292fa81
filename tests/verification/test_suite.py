# SPDX-License-Identifier: BSD-3-Clause
"""The quick cases of the verification suite, and what its table says of errors."""

import pytest

from signorini.verify import fenet, footings, hertz, indentation, patches, plasticity, punches, rings, scalar, solids
from signorini.verify.check import Check

CASES = (
    patches.patch_p1,
    patches.patch_p2,
    patches.patch_p4,
    patches.patch_p5,
    patches.patch_p6,
    patches.patch_discs,
    hertz.line_contact,
    hertz.point_contact,
    hertz.revolved_spheres,
    hertz.small_revolved_spheres,
    fenet.fenet_cylinder,
    punches.corner_exponents,
    rings.shrink_fits,
    rings.hollow_bodies,
    rings.drawn_press_fits,
    scalar.scalar_signorini,
    solids.hollow,
    plasticity.hills_tube,
    plasticity.hills_tube_of_other_cells,
    footings.flat_punch,
    plasticity.yielding_press_fits,
    plasticity.bending,
    indentation.first_yield,
)


@pytest.mark.suite
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_case(case):
    for check in case():
        assert check.passed, f"{check.case}, {check.quantity}: {check.computed} instead of {check.reference}"


def row(computed, reference, *, least=False):
    return Check(case="", quantity="", computed=computed, reference=reference, tolerance=0.1, source="", least=least)


def test_errors_and_bounds():
    assert row(2.1, 2.0).error == pytest.approx(0.05)
    assert row(-0.05, 0.0).error == pytest.approx(0.05)
    assert not row(float("nan"), 1.0).passed
    assert not row(2.0, 1.0).passed
    assert row(2.0, 1.0, least=True).error == 0.0
    assert not row(0.8, 1.0, least=True).passed
    assert not row(float("nan"), 1.0, least=True).passed
