# SPDX-License-Identifier: BSD-3-Clause
"""What the places of nodes change of how pairs see the bodies, in the sum over a history: normals, gaps, areas.

    sum_k  w_k . B'^T r_k + J_k . (B' u_k + C' r_k + g'),    the friction by areas, and what an output has of them

A pair depends on the nodes near it alone, so that many nodes are moved at once, see `node_differences`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.adjoint_terms import Adjoint
from signorini.derivative.body_side import pairs_at
from signorini.derivative.explicit import ShapeWeights
from signorini.derivative.interface_system import InterfaceSystem
from signorini.derivative.node_differences import NodeDifferences, adds_up, within
from signorini.derivative.pair_change import asks_for_areas, between_bodies, bound_at
from signorini.derivative.view import HistoryView
from signorini.errors import InputError
from signorini.fem.boundary import Boundary, boundary
from signorini.fem.space import Space
from signorini.interface.interface import Interface
from signorini.model.outputs import Output
from signorini.sparse_rows import selection

_RINGS = 3  # of facets around a pair that its normal, area and gap may depend on, through neighbours of neighbours


@dataclass(frozen=True, kw_only=True, eq=False)
class SideSums:
    """Sums over a history for every pair.

    Attributes
    ----------
    view, adjoint, output : the history, and the output's way back through it
    """

    view: HistoryView
    adjoint: Adjoint
    output: Output
    _columns: list[tuple[Array, Array, Array, Array]] = field(default_factory=list, init=False)
    _gap: list[Array] = field(default_factory=list, init=False)

    def add(self, system: InterfaceSystem, motion: Array, forces: Array, w: Array, u: Array, one: Array) -> None:
        """Add points, or combinations of some: k of them.

        Parameters
        ----------
        system : the interface
        motion, forces : (d, a, k) or (d a, k) J, and forces of the active pairs
        w, u : (rows, k) adjoint and actual displacements of what pairs may see
        one : (k,) sums of what is 1 at every point
        """
        n = len(self.view.interface)
        every = selection(np.flatnonzero(np.tile(system.condensed.active, system.directions)), system.directions * n).T
        J, r = (every @ part.reshape(every.shape[1], -1) for part in (motion, forces))
        self._columns.append((J, r, w, u))
        self._gap.append(J[:n] @ one)

    @cached_property
    def rows(self) -> sp.csr_array:
        """(rows, dofs) Of the displacements that pairs may see."""
        return selection(self._dofs, self.view.space.number_of_dofs)

    def gradient(self, free: BoolArray) -> tuple[IntArray, Array]:
        """Nodes (m,), and (m, d) by their places, of which some coordinates are free (nodes, d); of others it is zero.

        Raises
        ------
        InputError
            Where what nodes of meshed sides change does not add up.
        """
        interface, least = self.view.interface, self._least
        facets = [block.facets for side in self._boundaries for block in side.blocks]
        own = selection(interface.node, len(free))
        rows = sp.coo_array(interface.B)
        on_nodes = rows.col < self.view.space.dofs_of_nodes
        pair, node = rows.row[on_nodes] % len(interface), rows.col[on_nodes] // self.view.space.components
        seen = sp.csr_array((np.ones(len(pair)), (pair, node)), shape=own.shape)
        near = within(sp.csr_array(own + seen), facets, _RINGS)
        nearest = within(near[least], facets, _RINGS)
        of_pairs = (
            selection(interface.contact, len(least)) if self._lifted else sp.csr_array((len(interface), len(least)))
        )
        every = sp.csr_array(sp.vstack([near + of_pairs @ nearest, nearest]))
        # nothing at first: an output that nothing changes, as what friction takes where all sticks, adds no columns
        pairs, seen_dofs = (np.zeros((count, 0)) for count in (interface.directions * len(interface), len(self._dofs)))
        columns = [(pairs, pairs, seen_dofs, seen_dofs), *self._columns]
        J, r, w, u = (np.concatenate(part, axis=1) for part in zip(*columns, strict=True))
        gap = np.sum([np.zeros(len(interface)), *self._gap], axis=0)

        def sums(at: Space) -> Array:
            found = self._pairs(at)
            B, n, common = self._narrow(found), len(found), np.zeros(len(least))
            once = (J * (B @ u) + r * (B @ w)).sum(axis=1) + found.compliance.ravel() * (J * r).sum(axis=1)
            of_pairs = once.reshape(-1, n).sum(axis=0) + self.shape.of_pairs(found) + self._friction(found)
            gaps = found.gap
            if self._lifted:  # all gaps of a contact may be larger by what its least one lacks
                common = np.bincount(found.contact, gap, minlength=len(least)) * found.gap[least]
                gaps = found.gap - found.gap[least][found.contact]
            return np.concatenate([of_pairs + gap * gaps, common])

        nodes, found = NodeDifferences(space=self.view.space, near=every, free=free).gradient(sums)
        if between_bodies(self.view.model):
            self._check(nodes, found, free, sums)
        return nodes, found

    def _check(self, nodes: IntArray, found: Array, free: BoolArray, sums: Callable[[Space], Array]) -> None:
        """Motions of all nodes of both sides at once, by parts of the least facets there, are sums of those of each.

        Parameters
        ----------
        nodes, found : (m,) and (m, d) by their places
        free : (nodes, d) which coordinates may change
        sums : numbers by places

        Raises
        ------
        InputError
            Where that is not so.
        """
        size = np.zeros(len(nodes))
        for block in (block for side in self._boundaries for block in side.blocks):
            size[np.isin(nodes, block.facets)] = block.lengths.min()
        way = np.random.default_rng(0).uniform(-1.0, 1.0, found.shape)
        if not adds_up(self.view.space, nodes, found, np.where(free[nodes], size[:, None] * way, 0.0), sums):
            words = (
                "nodes of a straight side opposite another meshed one, or at ends that are flush, change pairs alone"
            )
            words += " otherwise than together: derivatives by their places do not add up; "
            raise InputError(f"{words}shape(motion) knows what a motion of them does", where=("nodes",))

    @property
    def places(self) -> tuple[IntArray, Array]:
        """Nodes (m,) of the pairs, and (m, d) what the output itself has of their places."""
        nodes, pair = np.unique(self.view.interface.node, return_inverse=True)
        found = np.zeros((len(nodes), self.view.space.dimension))
        np.add.at(found, pair, self.shape.places)
        return nodes, found

    @cached_property
    def _least(self) -> IntArray:
        """(contacts,) The pair of each contact with the least gap; 0 where it has none."""
        interface, found = self.view.interface, np.zeros(len(self.view.model.contacts), dtype=np.int64)
        for contact in np.unique(interface.contact):
            own = np.flatnonzero(interface.contact == contact)
            found[contact] = own[int(np.argmin(interface.gap[own]))]
        return found

    @property
    def _lifted(self) -> bool:
        """Whether gaps are means over facets, which may all be larger by one length, see `interface.gaps.resolved`."""
        return any(side.coupling == "mortar" for side in self.view.interface.sides) or self._quadratic

    @property
    def _quadratic(self) -> bool:
        return any(side.quadratic for side in self._boundaries)

    @cached_property
    def _boundaries(self) -> list[Boundary]:
        """All meshed sides."""
        model = self.view.model
        sides = {contact.nonmortar for contact in model.contacts} | {contact.mortar for contact in model.contacts}
        return [boundary(self.view.space, name, ("contact",)) for name in model.mesh.boundaries if name in sides]

    def _pairs(self, at: Space) -> Interface:
        """The pairs where nodes are elsewhere.

        Raises
        ------
        InputError
            Where others make pairs.
        """
        found = pairs_at(self.view.points[-1].system.prepared, at, self.view.model)
        if not np.array_equal(found.node, self.view.interface.node):
            words = "nodes that move a little are paired otherwise; derivatives by nodes do not know that"
            raise InputError(words, where=("nodes",))
        return found

    @cached_property
    def shape(self) -> ShapeWeights:
        """What the output itself has of the shape of the sides."""
        return ShapeWeights.of(self.output, self.view)

    @cached_property
    def _dofs(self) -> IntArray:
        """Dofs that pairs may see: those of the nodes of all sides, and of obstacles."""
        space = self.view.space
        nodes = np.unique(np.concatenate([side.nodes for side in self._boundaries]))
        return np.concatenate([space.dofs(nodes).ravel(), np.arange(space.dofs_of_nodes, space.number_of_dofs)])

    def _narrow(self, interface: Interface) -> sp.csr_array:
        """B of the dofs that pairs may see alone."""
        B = interface.B
        place = np.zeros(B.shape[1], dtype=np.int64)
        place[self._dofs] = np.arange(len(self._dofs))
        return sp.csr_array((B.data, place[B.indices], B.indptr), shape=(B.shape[0], len(self._dofs)))

    def _friction(self, interface: Interface) -> Array:
        """(n,) What areas have in the friction, where that asks for them."""
        found = np.zeros(len(interface))
        for system, term in self.adjoint.bounds.items():
            if asks_for_areas(system):
                bound = bound_at(system, interface)
                kinks = np.where(np.isfinite(bound.kinks[:-1]), bound.kinks[:-1], 0.0)
                parts = term.slopes * bound.slopes + term.starts * bound.starts + term.kinks * kinks
                found[system.active] += parts.sum(axis=0)
        return found
