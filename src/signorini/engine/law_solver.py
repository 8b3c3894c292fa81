# SPDX-License-Identifier: BSD-3-Clause
"""Solvers of a law of the interface that is found on top of a solver of contact: closures, bonds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, Self

from signorini.arrays import Array, BoolArray
from signorini.condense.condensed import Condensed
from signorini.engine.solver import CondensedSolver, ContactSolver
from signorini.interface.interface import Interface
from signorini.solution.scale import Scale


class CompliantSolver(ContactSolver, Protocol):
    """Bodies whose pairs have a compliance each, which may be another."""

    def closing(self, compliance: Array, rest: Array) -> Self:
        """Bodies whose interface closes otherwise along its normals; nothing sparse is factorised again.

        Parameters
        ----------
        compliance, rest : (n,) length per force, and what it has closed without force, length
        """


@dataclass(frozen=True, kw_only=True, eq=False)
class LawSolver:
    """What a law on top of a solver of contact leaves to that solver, of the one door of `ContactSolver`.

    Attributes
    ----------
    bodies : of contact without that law
    """

    bodies: CompliantSolver

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.bodies.name

    @property
    def active(self) -> BoolArray:
        """(n,) Pairs that the law is asked of."""
        return self.bodies.active

    @property
    def held(self) -> BoolArray:
        """(n,) Pairs that supports hold on both sides."""
        return self.bodies.held

    @property
    def paths(self) -> None:
        """None: exact paths are those of `engine.closure_paths` and `engine.bond_paths`."""

    @property
    def condensed(self) -> Condensed | None:
        """The interface as the bodies feel it, without what the law adds."""
        return self.bodies.condensed

    @property
    def elastic(self) -> Self:
        """Itself."""
        return self

    def under(self, interface: Interface, scale: Scale, absent: BoolArray) -> Self:
        """Bodies under another law, see `ContactSolver.under`.

        Parameters
        ----------
        interface, scale : friction, gaps and sizes of the data of the moment
        absent : (n,) pairs that are switched off
        """
        return replace(self, bodies=self.bodies.under(interface, scale, absent))

    def moving(self, ways: Array, interface: Interface, scale: Scale) -> Self:
        """Bodies of which some rest, see `ContactSolver.moving`.

        Parameters
        ----------
        ways : (k, m) combinations of the rigid motions
        interface, scale : as of `under`
        """
        return replace(self, bodies=self.bodies.moving(ways, interface, scale))

    def paired(self, elastic: CondensedSolver, interface: Interface) -> Self:  # noqa: ARG002
        """Bodies with other pairs, see `ContactSolver.paired`.

        Parameters
        ----------
        elastic : the same bodies with these pairs
        interface : not looked at
        """
        return replace(self, bodies=elastic)
