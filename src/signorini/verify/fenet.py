# SPDX-License-Identifier: BSD-3-Clause
"""NAFEMS/FENET advanced contact benchmark 1 at small strain."""

from __future__ import annotations

from collections.abc import Iterator

from signorini.api import solve
from signorini.gallery.fenet import HERTZ, cylinder_on_block
from signorini.model.step import Step
from signorini.verify.check import Check, checks_of

_SMALL_STRAIN = "independent small-strain computation"
_SUNK = {0.0: -1.28131, 0.1: -1.27425}
_PEAK = {0.0: 3592.0, 0.1: 3663.0}
"""Of that computation: displacement of the block's top centre and largest pressure, by mu."""


def fenet_cylinder() -> Iterator[Check]:
    """Without friction, and with mu = 0.1 on the exact path."""
    for friction, across in ((0.0, (40, 40)), (0.0, (40, 60)), (0.1, (40, 40))):
        case = f"FENET 1 cylinder on block, mu {friction:g}, {across[0]} : {across[1]} cells"
        solution = solve(cylinder_on_block(friction=friction, across=across))
        contact = solution.contact("contact")
        centre = solution.along([(0.0, 0.0)], body="block").displacement[0, 1]
        peak = float(contact.pressure.max())
        yield from checks_of(
            case,
            ("u_y at the block's top centre", centre, _SUNK[friction], 0.01),
            ("p_0", peak, _PEAK[friction], 0.01),
            source=_SMALL_STRAIN,
        )
        if not friction:
            half_width = contact.points[contact.closed, 0].max()
            yield from checks_of(
                case,
                ("p_0 against half-planes", peak, HERTZ.peak_pressure, 0.01),
                ("a, to a cell", half_width, HERTZ.half_width, 0.25 / HERTZ.half_width),
                source="Hertz",
            )
    # all of the load at once, as in the computation that printed "about 2.0"; cells of 1 mm
    model = cylinder_on_block(friction=0.1, across=(10, 10), steps=(Step(increments=1),))
    contact = solve(model).contact("contact")
    stuck = contact.points[contact.status == "stick", 0].max()
    yield from checks_of(
        "FENET 1 cylinder on block, mu 0.1, 10 : 10 cells, one increment",
        ("half-width of stick, to a cell", stuck, 2.0, 0.5, _SMALL_STRAIN),
    )
