# SPDX-License-Identifier: BSD-3-Clause
"""Limit loads of meshes, from above and from below, and what messages say of them."""

from __future__ import annotations

import re
from collections.abc import Callable

from signorini.engine.solve import solve
from signorini.model.model import Model
from signorini.outcome import Outcome

NEXT_LOAD = 0.998
"""Of the limit that is named: the next load."""
_ATTEMPTS = 8  # loads, from one beyond the limit on: 2 to 5 are the rule


def limit_load(model_at: Callable[[float], Model], beyond: float) -> tuple[float, float]:
    """The limit load of a mesh: a load beyond which flow is proved, and one a little less that is carried.

    A bound that is named from a load far beyond it is not the smallest; one named from itself is.

    Parameters
    ----------
    model_at : the model under a load
    beyond : a load that cannot be carried
    """
    load, above = beyond, float("nan")
    for _ in range(_ATTEMPTS):
        history = solve(model_at(load), raise_on_failure=False)
        if history.solved:
            return above, load
        if history.status != Outcome.NO_EQUILIBRIUM:
            break
        above = said(r"flow plastically at ([\d.]+)%", history.message) * load
        load = NEXT_LOAD * above
    return above, float("nan")


def said(pattern: str, words: str) -> float:
    """A percentage as a part; NaN, which passes nothing, where it is not said."""
    found = re.search(pattern, words)
    return float(found[1]) / 100.0 if found else float("nan")
