# SPDX-License-Identifier: BSD-3-Clause
"""Where increments come to nothing: pairs run away, so that the load has a limit, or the increments only creep."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signorini.friction.history.rates import NoRates
from signorini.friction.history.segment import Breakpoint

_STANDSTILL = 1e-5  # part of the way: increments that get on no farther stand still
_RUNAWAY_INCREMENTS = 4  # in which pairs run away
_RUNAWAY_SPEED = 1e3  # times as fast as the loads deform the bodies
_CREEPING_INCREMENTS = 50  # increments that creep


def standstill(pieces: Sequence[Breakpoint], scale: float) -> NoRates | None:
    """Why a way in increments ends here; None where it goes on.

    At a limit of the load the curve of equilibria turns back, and motions grow like the root of what is left of the
    load. That they run away in increments that shrink is strong evidence of it, no proof.

    Parameters
    ----------
    pieces : the ends of the increments so far, the start first
    scale : motions that the loads cause

    Examples
    --------
    >>> ends = [1.0, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
    >>> motions = [np.array([1.0 - left**0.5]) for left in ends]
    >>> pieces = [Breakpoint(factor=1.0 - left, h=h, r=h) for left, h in zip(ends, motions)]
    >>> standstill(pieces[:5], 1.0), standstill(pieces, 1e-3).proved
    (None, True)
    """
    load, moved = _got_on(pieces, _RUNAWAY_INCREMENTS)
    if load <= _STANDSTILL and moved > _RUNAWAY_SPEED * scale * load:
        fast = moved / (scale * load)
        words = f"within the last {load:.1e} of the way pairs move {fast:.1e} times as fast as the loads deform bodies"
        words = f"{words}: strong evidence, no proof"
        return NoRates(proof=f"the load has a limit here: {words}", proved=True)
    load, _ = _got_on(pieces, _CREEPING_INCREMENTS)
    if load <= _STANDSTILL:
        return NoRates(proof=f"{_CREEPING_INCREMENTS} increments get on by {load:.1e} of the way", proved=False)
    return None


def _got_on(pieces: Sequence[Breakpoint], number: int) -> tuple[float, float]:
    """Part of the way, and largest motion, of the last increments; infinite where there are fewer."""
    if len(pieces) <= number:
        return np.inf, 0.0
    before, now = pieces[-1 - number], pieces[-1]
    return now.factor - before.factor, float(np.abs(now.h - before.h).max(initial=0.0))
