# SPDX-License-Identifier: BSD-3-Clause
"""B15: contacts that slide and roll over many elements."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from signorini.api import solve
from signorini.gallery.sliding import HALF_WIDTH, PRESSING, dragged_cylinder, driven_wheel, free_wheel, half_width
from signorini.solution import results
from signorini.verify.check import Check, checks_of

_FRICTION = 0.3  # coefficient of all of them
_RATIO = 0.64  # of the tangential force over that of sliding: Carter's case of which CONTACT's guide tells the numbers

_ROLLED = {1e-3: 5.259e-4, 0.05: 4.29e-4, 10.0: 3.59e-4}  # creepage by friction: 0.457 kappa a / R, CONTACT's guide
_DISSIMILAR = 0.2877 * 0.1 / 25.0  # kappa a / R of its rollers
_PRESSED = 103.81 / 103.14  # largest pressure with that much friction over the one with hardly any


def sliding_cylinder() -> Iterator[Check]:
    """A cylinder dragged over a flat by its half-width: Hertz's pressure goes along, and friction is Coulomb's."""
    model = dragged_cylinder(stroke=HALF_WIDTH, spacing=0.2, friction=_FRICTION)
    drag = solve(model).steps[-1]
    contact, peak = drag.contacts[0], 2.0 * PRESSING / (math.pi * HALF_WIDTH)
    normal, tangential = contact.pressure @ contact.area, contact.traction @ contact.area
    yield from checks_of(
        "B15 cylinder dragged over a flat",
        ("largest pressure", contact.pressure.max(), peak, 1e-2, "Hertz (1882)"),
        ("friction over mu times normal force", abs(tangential) / (_FRICTION * normal), 1.0, 1e-12, "Coulomb's law"),
        ("energy that is not accounted for, of the work", drag.energy_defect / drag.work, 0.0, 1e-12, "balance"),
        ("energy set free by handing over, of the work", drag.released / drag.work, 0.0, 1e-6, "none"),
        source="Johnson (1985), section 4.2",
    )


def rolling_wheel() -> Iterator[Check]:
    """Carter's problem as a transient: where a driven wheel sticks, and how fast it creeps."""
    ways, width = (4.0, 4.0), half_width(10.0, 100.0, 200.0 / (1.0 - 0.499**2))
    turned = {}
    for ratio in (_RATIO, -_RATIO):
        *_, roll, on = solve(driven_wheel(ratio=ratio, ways=ways, across=8, friction=_FRICTION)).steps
        begin, end = (np.asarray(step.obstacles["wheel"].rotation, np.float64) for step in (roll, on))
        turned[ratio] = 100.0 * float(end - begin)
        contact = on.contacts[0]
    # surfaces that stretch under pressure turn the wheel by a little too, one way as the other
    creepage = abs(turned[_RATIO] - turned[-_RATIO]) / (2.0 * ways[1] * width)
    sticks = (contact.status == results.STICK).sum() / (contact.status != results.OPEN).sum()
    yield from checks_of(
        "B15 driven wheel, F / (mu P) = 0.64",
        ("part of the contact that sticks", sticks, math.sqrt(1.0 - _RATIO), 0.05),
        ("creepage", creepage, _FRICTION * width / 100.0 * (1.0 - math.sqrt(1.0 - _RATIO)), 0.08),
        source="Carter (1926); Johnson (1985), section 8.3",
    )


def dissimilar_rollers() -> Iterator[Check]:
    """Bentall and Johnson's aluminium roller, free to roll on one of steel: it creeps, and friction holds it back."""
    ways, peaks = (3.0, 1.0), []
    for friction, reference in _ROLLED.items():
        *_, roll, on = solve(free_wheel(friction=friction, ways=ways, across=6)).steps
        begin, end = (np.asarray(step.obstacles["wheel"].rotation, np.float64) for step in (roll, on))
        creepage = 1.0 - 2000.0 * abs(float(end - begin)) / ways[1]
        peaks.append(on.contacts[0].pressure.max())
        yield from checks_of(
            f"B15 rollers of aluminium and steel, mu = {friction:g}",
            ("creepage of free rolling", creepage * 2000.0 / 0.2877 * _DISSIMILAR, reference, 1.5e-2),
            source="Bentall, Johnson (1967); CONTACT, user guide 5.3",
        )
    yield from checks_of(
        "B15 rollers of aluminium and steel",
        ("largest pressure, mu = 10 over 0.001", peaks[-1] / peaks[0], _PRESSED, 1e-3),
        source="CONTACT, user guide 5.3",
    )
