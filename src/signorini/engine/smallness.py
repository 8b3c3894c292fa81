# SPDX-License-Identifier: BSD-3-Clause
"""Where displacements are too large for what is solved: small strains and rotations, sides that stay opposite."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from signorini.arrays import extent
from signorini.engine.prepare import Prepared
from signorini.fem.rigid import Part
from signorini.law.states import OPEN
from signorini.solution.state import State

_STRAINED = 0.25  # of the size of a body
_SLID = 0.1  # of the size of what touches


def large_notes(prepared: Prepared, state: State) -> Iterator[str]:
    """Bodies that strain or turn by a quarter of their size, contacts that slip by a tenth of theirs."""
    displacement = prepared.space.at_nodes(state.displacement)
    for part in prepared.parts:
        if part.kind == Part.kind:
            change = float(np.linalg.norm(extent(displacement[part.nodes]))) / (2.0 * part.size)
            if change > _STRAINED:
                yield (
                    f"{part.label} strains or turns by {change:.0%} of its size: equilibrium is that of the undeformed "
                    "bodies, which holds for small displacements"
                )
    interface = prepared.interface
    slip = np.where(state.status == OPEN, 0.0, interface.across(state.slip))
    for i, contact in enumerate(prepared.model.contacts):
        own = (interface.contact == i) & (state.status != OPEN)
        if not own.any():
            continue
        across = float(np.linalg.norm(extent(prepared.space.mesh.points[interface.node[own]])))
        if slip[own].max() > _SLID * across > 0.0:
            yield (
                f"contact '{contact.label}' slips by up to {slip[own].max():.4g}, and what touches is {across:.4g} "
                "across: its sides are opposite each other as they were to begin with, which holds for small slips"
            )
