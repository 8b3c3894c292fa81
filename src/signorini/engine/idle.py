# SPDX-License-Identifier: BSD-3-Clause
"""Loads and moving supports that would never act."""

from __future__ import annotations

from collections.abc import Mapping

from signorini.errors import InputError
from signorini.model.model import Model


def refuse_idle(model: Model, factors: Mapping[str, float]) -> None:
    """A load that no step names, and that a history to go on from did not know, is a forgotten one.

    Parameters
    ----------
    factors : load factors at the end of that history, empty where there is none

    Raises
    ------
    InputError
        The first of them.
    """
    names = model.scaled_names
    used = set(factors)
    for step in model.steps:
        used |= set(names if step.scale is None else step.scale)
    for name in names:
        if name not in used:
            raise InputError(
                f"no step's scale names '{name}': it would never act. Expected a factor for it in a step",
                where=("step",),
            )
