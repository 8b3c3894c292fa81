# SPDX-License-Identifier: BSD-3-Clause
"""Energy that increments miss: what a jump sets free is told from what rounding leaves."""

import numpy as np
import pytest

from signorini.friction.history.segment import Breakpoint
from signorini.friction.history.space.missed_jumps import first_missed_jump
from signorini.friction.history.state import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.states import STICK

WIDTH = 1e-10


@pytest.mark.parametrize(("slip", "missed"), [(1e-13, None), (1e-2, 2)])
def test_forces_that_turn_while_nothing_moves_miss_no_energy(slip, missed):
    """Corners that two contacts share leave forces undetermined: they turn by slips of rounding, of any increment."""
    problem = ContactProblem.of(W=0.5 * np.eye(3), b=np.zeros(3), friction=[0.5], motions=np.zeros((3, 0)), scale=1.0)

    def at(h, r):
        h, r = np.array([h]).T, np.array([r]).T
        return PathState(b=h[:, 0], h=h, r=r, state=[STICK], anchor=0.0 * h[1:], slip=h[1:], dissipation=np.zeros(1))

    states = [at([0, 0, 0], [1, -0.3, 0]), at([0, 0, 0], [1, -0.3, 0]), at([0, slip, 0], [1, 0, -0.5])]
    states.append(at([0, slip, 0], [1, 0, -0.5]))
    factors = [0.0, 0.4, 0.5, 1.0]
    pieces = [Breakpoint(factor=s, h=now.h, r=now.r, state=now) for s, now in zip(factors, states, strict=True)]
    assert first_missed_jump(problem, states[0], pieces, 0.0, WIDTH) == missed
