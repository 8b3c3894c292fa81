# SPDX-License-Identifier: BSD-3-Clause
"""B16: bolts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from signorini.api import solve
from signorini.gallery.bolts import PRELOAD, bolted_sleeve
from signorini.verify.check import Check, checks_of


def stiffness_diagram() -> Iterator[Check]:
    """The triangle of a bolted joint: what a locked bolt bears of a pull, before and after the sleeve is free."""
    model, bolt, sleeve = bolted_sleeve()
    share = bolt / (bolt + sleeve)
    tighten, pull = model.steps
    tight, half, far = (
        solve(replace(model, steps=[tighten, replace(pull, scale={"pull": part})])).steps for part in (0.0, 1.0, 2.0)
    )
    yield from checks_of(
        "B16 bolted sleeve",
        ("shortening of the bolt", tight[0].bolts["bolt"].shortening, PRELOAD / bolt + PRELOAD / sleeve, 1e-10),
        ("force of the bolt under a pull of the preload", half[1].bolts["bolt"].force, PRELOAD * (1.0 + share), 1e-10),
        ("force of the bolt under twice of it", far[1].bolts["bolt"].force, 2.0 * PRELOAD, 1e-10),
        source="VDI 2230, joint diagram",
    )
