# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that nothing touches and no load drives stay where they are, and nothing else would say where."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.engine.approach import DRIVES, change_of_loads, standing, unfelt
from signorini.engine.increments import applied
from signorini.engine.prepare import contact_law
from signorini.engine.stretch import Stretch
from signorini.friction.history.plane import Segment
from signorini.friction.law import OPEN
from signorini.iterative.bodies import Bodies

_FEELS = 1e-9  # of the largest motion of pairs: one that they feel


def resting(stretch: Stretch) -> Stretch:
    """The same stretch, in which bodies that nothing touches and no load drives do not move rigidly.

    Up to where something touches one: what holds it until then is no part of the model, and is woken from then on. The
    stretch itself where there is no such body, and where bodies are not condensed.
    """
    prepared, state = stretch.prepared, stretch.before
    if not prepared.floating.shape[1] or isinstance(prepared.bodies, Bodies):
        return stretch
    presses, apart, width = standing(prepared, state)
    touches = presses | (apart & (state.gap <= width))
    moved = np.asarray((prepared.interface.B @ prepared.motions) @ prepared.floating)
    loose = unfelt(moved[prepared.interface.rows(touches)])
    change = change_of_loads(stretch)
    work = prepared.floating.T @ (prepared.motions.T @ change)
    if not loose.shape[1] or np.abs(loose.T @ work).max() > DRIVES * float(np.abs(change).sum()):
        return stretch
    seen = np.abs(moved @ loose).max(axis=1) > _FEELS * float(np.abs(moved).max())
    ways = unfelt(loose.T)
    bodies = prepared.bodies.moving(ways)
    rigid = np.asarray(prepared.motions @ (prepared.floating @ loose))
    place = np.linalg.lstsq(rigid, state.displacement - applied(prepared, state.point)[1])[0]
    return replace(
        stretch,
        prepared=replace(
            prepared,
            bodies=bodies,
            law_or_none=contact_law(prepared.interface, bodies, prepared.scale),
            floating=prepared.floating @ ways,
            resting=rigid @ place,
        ),
        awake=prepared,
        waiting=seen.reshape(-1, len(touches)).any(axis=0),
    )


def undisturbed(stretch: Stretch, segment: Segment) -> Segment:
    """The segment as far as nothing touches a body that rests."""
    waits = stretch.waiting[stretch.prepared.condensed.active] if stretch.awake else np.zeros(0, np.bool_)
    for event in segment.events if stretch.awake else ():
        if event.what == "closes" and waits[list(event.pairs)].any():
            return replace(
                segment,
                end=replace(event.state, state=np.where(waits, OPEN, event.state.state)),
                events=tuple(earlier for earlier in segment.events if earlier.factor < event.factor),
                pieces=tuple(piece for piece in segment.pieces if piece.factor <= event.factor),
                outcome="disturbed",
                jump=None,
                message=f"something touches a body that rests at factor {event.factor:.12g}",
            )
    return segment
