# SPDX-License-Identifier: BSD-3-Clause
"""A bank of linear complementarity problems with known answers, and generators of more."""

from benchmarks.lcp_problems.bank import bank
from benchmarks.lcp_problems.contact import frictional_contact, gap_slip_contact
from benchmarks.lcp_problems.generators import (
    badly_scaled,
    bimatrix_game,
    degenerate,
    infeasible,
    random_p,
    random_psd,
    with_solution,
)
from benchmarks.lcp_problems.obstacle import obstacle
from benchmarks.lcp_problems.posed import PosedLCP

__all__ = [
    "PosedLCP",
    "badly_scaled",
    "bank",
    "bimatrix_game",
    "degenerate",
    "frictional_contact",
    "gap_slip_contact",
    "infeasible",
    "obstacle",
    "random_p",
    "random_psd",
    "with_solution",
]
