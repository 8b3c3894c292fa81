# SPDX-License-Identifier: BSD-3-Clause
"""The bank: every problem that every method is tried on."""

from __future__ import annotations

import numpy as np

from benchmarks.lcp_problems.collected import collected
from benchmarks.lcp_problems.contact import frictional_contact, gap_slip_contact
from benchmarks.lcp_problems.generators import badly_scaled, degenerate, infeasible, random_p, random_psd
from benchmarks.lcp_problems.known import known
from benchmarks.lcp_problems.obstacle import obstacle
from benchmarks.lcp_problems.posed import PosedLCP


def bank(*, seed: int = 0) -> list[PosedLCP]:
    """Problems of the literature and generated ones, small enough for every method (n <= 100).

    Examples
    --------
    >>> problems = bank()
    >>> len({problem.name for problem in problems}) == len(problems)
    True
    """
    rng = np.random.default_rng(seed)
    generated = [random_p(n, rng) for n in (3, 10, 30, 100)]
    generated += [
        random_psd(n, rank, rng, skew=skew)
        for n, rank in ((4, 2), (10, 10), (10, 5), (50, 50), (50, 20))
        for skew in (0.0, 0.5)
    ]
    generated += [degenerate(n, rng) for n in (6, 12, 40)]
    generated += [badly_scaled(n, rng) for n in (5, 20, 60)]
    generated += [infeasible(n, rng) for n in (3, 12, 50)]
    for friction in (0.0, 0.3, 0.8):
        generated += [frictional_contact(m, rng, friction=friction) for m in (2, 5, 12, 30)]
    for friction in (0.3, 0.8):
        generated += [gap_slip_contact(m, rng, friction=friction) for m in (2, 5, 12, 30)]
    return known() + collected() + generated + [obstacle(8)]
