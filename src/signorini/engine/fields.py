# SPDX-License-Identifier: BSD-3-Clause
"""Whether the displacements that are asked for fit in memory, before anything is solved."""

from __future__ import annotations

from signorini.errors import InputError
from signorini.memory import available_memory
from signorini.model.model import Model

_SHARE = 0.5  # of the memory that there is


def refuse_fields(model: Model) -> None:
    """Refuse to keep more displacements than fit in half of the memory; stresses are computed one state at a time.

    Raises
    ------
    InputError
        The first step whose times are too many, with how many there is room for.
    """
    each = 8 * model.mesh.points.size
    room = max(int(_SHARE * available_memory() / each) - len(model.steps), 0)
    left = room
    for i, step in enumerate(model.steps):
        asked = len(step.at) if isinstance(step.at, tuple) else 0
        left -= asked
        if left < 0:
            raise InputError(
                f"asks for {asked} fields of {each / 1e6:.3g} MB; in half of the memory there is room for {room} in "
                "all steps. Expected fewer, or steps in runs of their own (--from)",
                where=("step", i, "at"),
            )
