# SPDX-License-Identifier: BSD-3-Clause
"""A bank of linear complementarity problems with known answers, and generators of more."""

from signorini.lcp.problems.bank import bank
from signorini.lcp.problems.contact import frictional_contact, gap_slip_contact
from signorini.lcp.problems.generators import (
    badly_scaled,
    bimatrix_game,
    degenerate,
    infeasible,
    random_p,
    random_psd,
    with_solution,
)
from signorini.lcp.problems.obstacle import obstacle
from signorini.lcp.problems.posed import PosedLCP

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
