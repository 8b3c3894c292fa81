# SPDX-License-Identifier: BSD-3-Clause
"""Friction that steps change: the names of its coefficients, and which of them holds where."""

from __future__ import annotations

import math
from collections.abc import Mapping

from signorini.engine.tape import Leg
from signorini.model.model import Model

_SAME_LOAD = 1e-9  # of a step: load factors that are one


def coefficients(model: Model) -> dict[str, float]:
    """Coefficients of friction that steps give, by name, "contact@step"; of several that share a name the first.

    Friction that has two of them, or sticks, has none.

    Examples
    --------
    >>> from signorini.model.step import Step
    >>> from types import SimpleNamespace
    >>> steps = [Step(), Step(friction={"joint": 0.2}), Step(name="free", friction={"joint": 0})]
    >>> coefficients(SimpleNamespace(steps=steps))
    {'joint@step 2': 0.2, 'joint@free': 0.0}
    """
    found: dict[str, float] = {}
    for number, step in enumerate(model.steps, start=1):
        for contact, value in step.friction.items():
            if isinstance(value, int | float) and math.isfinite(value):
                found.setdefault(_name(contact, step.name, number), float(value))
    return found


def in_force(leg: Leg, before: Mapping[str, str]) -> dict[str, str]:
    """By contact whose friction some step has changed, the name of the coefficient that it has in a leg.

    Parameters
    ----------
    leg : of the history
    before : the same in the leg before it
    """
    found = dict(before)
    reached = math.floor(leg.low + _SAME_LOAD) + 1
    for number, step in enumerate(leg.prepared.model.steps[:reached], start=1):
        found |= {contact: _name(contact, step.name, number) for contact in step.friction}
    return found


def _name(contact: str, step: str, number: int) -> str:
    return f"{contact}@{step or f'step {number}'}"
