# SPDX-License-Identifier: BSD-3-Clause
"""The condensed contact problem with friction, in the plane and in space, and the solver that always answers."""

from signorini.attempt import MethodRun
from signorini.friction.certificate import certify
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.friction.uniqueness import mu_low
from signorini.law.result import ContactAnswer
from signorini.law.states import OPEN, SLIP, SLIP_MINUS, SLIP_PLUS, STICK, UNDECIDED

__all__ = [
    "OPEN",
    "SLIP",
    "SLIP_MINUS",
    "SLIP_PLUS",
    "STICK",
    "UNDECIDED",
    "ContactAnswer",
    "ContactProblem",
    "MethodRun",
    "certify",
    "mu_low",
    "solve_contact",
]
