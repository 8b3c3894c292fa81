# SPDX-License-Identifier: BSD-3-Clause
"""As many increments as it takes: twice as many, until the answer changes less than a tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.engine.increments import follow_increments
from signorini.engine.leg import Leg
from signorini.engine.prepare import Prepared
from signorini.engine.span import Span
from signorini.errors import SolveFailed
from signorini.solution.state import LoadPoint, State

MOST = 4096
"""Increments of one straight part of a step."""
_MORE = 'expected less? Give the step increments = "auto" or their number'


def follow_automatically(
    prepared: Prepared,
    tolerance: float,
    where: str,
    span: Span,
    state: State,
    end: LoadPoint,
    *,
    enough: int | None = None,
) -> Leg:
    """Follow a straight part of a step in 1, 2, 4, ... increments, each time from its beginning.

    Parameters
    ----------
    tolerance : largest change of a contact force from one number to the next, of the largest force
    where : name of the step, for messages
    enough : increments at which to stop whatever they still change, and to say so; None: go on to 4096

    Raises
    ------
    SolveFailed
        If an increment has no certified solution however short, or 4096 are not enough.
    """
    coarse: Leg | None = None
    change, number = np.inf, 1
    while number <= MOST:
        try:
            fine = follow_increments(prepared, number, where, span, state, end)
        except SolveFailed as failure:
            if failure.status == "no_equilibrium" or 2 * number > MOST:
                raise
            coarse, number = None, 2 * number
            continue
        if coarse is not None:
            size = float(np.abs(fine.after.forces).max(initial=0.0)) or 1.0
            change = float(np.abs(fine.after.forces - coarse.after.forces).max(initial=0.0)) / size
            note = f"{number} increments: half as many change contact forces by {change:.1e} of the largest"
            if change <= tolerance:
                return replace(fine, path="increments", notes=(note,))
            if enough is not None and number >= enough:
                return replace(fine, path="increments", notes=(f"{note}; {_MORE}",))
        coarse, number = fine, 2 * number
    raise SolveFailed(
        f"{where}: {MOST} increments still change contact forces by {change:.1e} of the largest; expected a larger "
        'tolerance, or path = "exact"',
        status="not_found",
    )
