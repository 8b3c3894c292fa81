# SPDX-License-Identifier: BSD-3-Clause
"""The condensed 2D Coulomb problem and the solver that always answers."""

from signorini.attempt import MethodRun
from signorini.friction.certificate import certify
from signorini.friction.law import OPEN, SLIP_MINUS, SLIP_PLUS, STATE_NAMES, STICK, UNDECIDED
from signorini.friction.problem import CoulombProblem
from signorini.friction.result import CoulombResult
from signorini.friction.solve import CoulombSettings, solve_coulomb
from signorini.friction.uniqueness import index, mu_low

__all__ = [
    "OPEN",
    "SLIP_MINUS",
    "SLIP_PLUS",
    "STATE_NAMES",
    "STICK",
    "UNDECIDED",
    "CoulombProblem",
    "CoulombResult",
    "CoulombSettings",
    "MethodRun",
    "certify",
    "index",
    "mu_low",
    "solve_coulomb",
]
