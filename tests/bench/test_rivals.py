# SPDX-License-Identifier: BSD-3-Clause
"""The rivals of the hard set solve what they are known to solve."""

import numpy as np
import pytest

from signorini.bench.hard import RIVALS, hard, lemke_alone
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact


def slides(mu: float) -> ContactProblem:
    """One pair pressed by 2 and dragged so that it slips for mu = 0.3."""
    return ContactProblem.of(
        W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[mu], motions=np.zeros((2, 0)), scale=1.0
    )


def test_lemke_solves_one_pair_in_every_state() -> None:
    for mu in (0.0, 0.3, 2.0):
        assert solve_contact(slides(mu)).solved
        assert lemke_alone(slides(mu), None)


@pytest.mark.slow
def test_lemke_solves_every_held_step_and_newton_does_not() -> None:
    report = hard(range(39))
    assert set(RIVALS) == {"Newton alone", "Lemke alone"}
    assert report.held["Lemke alone"] == report.held["steps"] > report.held["Newton alone"]
