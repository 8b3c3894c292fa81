# SPDX-License-Identifier: BSD-3-Clause
"""The stiffness of a model whose rows are on all ranks, as the first one sees it: what it makes of displacements."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, Int32Array, IntArray
from signorini.distributed.partition import owners
from signorini.distributed.pieces import Piece, pieces, whole_nodes
from signorini.distributed.ranks import Team
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.model.model import Model


class StiffnessOnRanks:
    """Stiffness of bodies and elastic foundations, (dofs, dofs), a piece on every rank.

    Attributes
    ----------
    team : the ranks
    number : under which they hold their pieces
    owner : (n,) rank that owns each node of the mesh
    shape : of the matrix
    nnz : entries, those of all ranks together

    Parameters
    ----------
    team : the ranks
    space, model, constraints : of the bodies
    interface : the pairs, which weigh in the cut
    """

    def __init__(self, team: Team, space: Space, model: Model, constraints: Constraints, interface: Interface) -> None:
        self.team, self.number = team, team.kept(self)
        self._d, self._space, self._model = space.components, space, model
        self.shape = (space.number_of_dofs, space.number_of_dofs)
        self.owner = team.owners[space.mesh] = owners(space, interface.B, team.size)
        self.cut(constraints)

    def cut(self, constraints: Constraints) -> None:
        """Cut the mesh into pieces and assemble them, for equations and rigid parts as constraints have them.

        Parameters
        ----------
        constraints : what supports hold, and what moves together
        """
        self._whole = self._asked(constraints)
        self._nodes: list[Int32Array] = []
        self._own: list[BoolArray] = []
        found = self.team.everywhere(_hold_piece, self.number, pieces=self._pieces(constraints))
        self.nnz = sum(found)

    def _pieces(self, constraints: Constraints) -> Any:
        for piece in pieces(self._space, self._model, constraints, self.owner, self._whole):
            self._nodes.append(piece.nodes.astype(np.int32))
            self._own.append(piece.own)
            yield piece

    @property
    def dofs(self) -> Iterator[IntArray]:
        """Of every rank those of its piece, in their order there; made when they are asked for, they are not kept."""
        return (self._dofs(nodes) for nodes in self._nodes)

    def _dofs(self, nodes: Int32Array) -> IntArray:
        return (self._d * nodes.astype(np.int64)[:, None] + np.arange(self._d)).ravel()

    def serves(self, constraints: Constraints) -> bool:
        """Whether the pieces are large enough for other constraints."""
        asked = zip(self._asked(constraints), self._whole, strict=True)
        return all(np.isin(nodes, whole).all() for nodes, whole in asked)

    def owner_of(self, nodes: IntArray) -> IntArray:
        """Rank that owns each of some nodes; obstacles and rigid bodies, behind those of the mesh, the first one."""
        padded = np.append(self.owner, 0)
        return padded[np.minimum(nodes, len(self.owner))]

    def _asked(self, constraints: Constraints) -> list[IntArray]:
        by = self.owner_of(constraints.nodes)
        return whole_nodes(constraints.transform, self._d, self.owner, by, self.team.size)

    def __matmul__(self, u: Array) -> Array:
        """(dofs,) Forces K u of displacements u, (dofs,)."""
        return self.forces(u, "plain")

    def internal_forces(self, u: Array) -> Array:
        """(dofs,) Forces K u as if in twice the digits, see :func:`signorini.fem.internal_forces.internal_forces`."""
        return self.forces(u, "sharp")

    def __abs__(self) -> _SizesOnRanks:
        """|K|, by whose product with |u| rounding is told."""
        return _SizesOnRanks(self)

    def forces(self, u: Array, how: str) -> Array:
        """(dofs,) Forces of displacements u, (dofs,), see `OwnStiffness.forces`."""
        result = np.zeros(self.shape[0])
        found = self.team.everywhere(_forces, self.number, how, pieces=(u[dofs] for dofs in self.dofs))
        for nodes, own, forces in zip(self._nodes, self._own, found, strict=True):
            result[self._dofs(nodes[own])] = forces
        return result


class _SizesOnRanks(NamedTuple):
    K: StiffnessOnRanks

    def __matmul__(self, u: Array) -> Array:
        return self.K.forces(u, "sizes")


def _hold_piece(team: Team, piece: Piece, number: int) -> int:
    """Assemble a piece and keep it; the entries of the rows that are this rank's own."""
    held = team.held[number] = piece.assembled()
    return int(np.diff(held.K.indptr)[held.own].sum())


def _forces(team: Team, u: Array, number: int, how: str) -> Array:
    found: Array = team.held[number].forces(u, how)
    return found
