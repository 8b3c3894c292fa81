# SPDX-License-Identifier: BSD-3-Clause
"""What every direct back end offers: one factorisation of the interior, seen from the contact interface.

With the unknowns split into interior ``i`` and interface ``c``, eliminating the interior of ``K u = f`` leaves

    S u_c = K_cc u_c - K_ci K_ii^-1 K_ic u_c = f_c - K_ci K_ii^-1 f_i,

a dense system as small as the contact interface. S may be singular (a body that only contact holds) and is never
factorised here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from signorini.arrays import Array
from signorini.errors import SignoriniError
from signorini.linalg.plan import Plan


@dataclass(frozen=True)
class Reduced:
    """A load of which the interior is eliminated: the forward half of a solve, done once.

    Attributes
    ----------
    load : the condensed load ``f_c - K_ci K_ii^-1 f_i``, (m,) or (m, k)
    expand : the other half: gives u, (n,) or (n, k), with ``K_ii u_i = f_i - K_ic u_c`` inside, of ``u_c`` on the
        interface
    """

    load: Array
    expand: Callable[[Array], Array]


@runtime_checkable
class Factorisation(Protocol):
    """A factorised interior ``K_ii`` of a symmetric matrix ``K``."""

    @property
    def name(self) -> str:
        """The back end, for reports."""

    @property
    def n(self) -> int:
        """Unknowns in all."""

    @property
    def m(self) -> int:
        """Unknowns on the interface, not eliminated; may be 0."""

    @property
    def plan(self) -> Plan | None:
        """Order, fronts and cost; None where the back end keeps them to itself."""

    def schur(self) -> Array:
        """Give the condensed stiffness ``S = K_cc - K_ci K_ii^-1 K_ic``, (m, m), in the order of the interface."""

    def parted(self) -> tuple[Array, Factorisation]:
        """S, which whoever asks may overwrite, and these factors without it; nobody is given it again."""

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load f, (n,) or (n, k)."""


class NotPositiveDefinite(SignoriniError):
    """The interior is singular or indefinite: a part of it can move without any resistance.

    Attributes
    ----------
    dof : an unknown of K where the factorisation broke down: it belongs to the part that can move
    """

    def __init__(self, dof: int) -> None:
        self.dof = int(dof)
        super().__init__(
            f"the stiffness without the interface is not positive definite (found at unknown {self.dof}): a part of it "
            "moves without resistance; hold it by supports or put its contact nodes on the interface"
        )
