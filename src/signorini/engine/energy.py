# SPDX-License-Identifier: BSD-3-Clause
"""What temperature adds to the elastic energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from signorini.engine.prepare import Prepared
from signorini.fem.thermal import held_energy
from signorini.solution.state import State


def heat_of(prepared: Prepared) -> Callable[[State], float]:
    """``- u f_T + s G s / 2``: the elastic energy is ``u K u / 2`` and this; thermal forces ``f_T = sum_k s_k f_k``.

    G is the energy of the held bodies; s the factors of the temperatures. As external work counts that of the thermal
    forces, the change of it is also what heating does beyond that.
    """
    names, G = held_energy(prepared.space, prepared.model)

    def heat(state: State) -> float:
        s = np.array([state.point.factors.get(name, 0.0) for name in names])
        forces = sum((s[k] * prepared.loads[name] for k, name in enumerate(names)), np.zeros(len(state.displacement)))
        return float(0.5 * s @ G @ s - state.displacement @ forces)

    return heat
