# SPDX-License-Identifier: BSD-3-Clause
"""The stiffness of a model whose rows are on all ranks, as the first one sees it: what it makes of displacements."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import numpy as np

from signorini.arrays import Array, BoolArray, Int32Array, IntArray
from signorini.distributed.borders import hold_border
from signorini.distributed.columns import ColumnsOnRanks
from signorini.distributed.partition import owners
from signorini.distributed.pieces import OwnStiffness, Piece, pieces, whole_nodes
from signorini.distributed.rank_arrays import ArrayOnRanks, Cut, KeptThere, found_there, references
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
    cells : whether ranks keep the cells of their pieces, for what derivatives make of them
    """

    def __init__(
        self,
        team: Team,
        space: Space,
        model: Model,
        constraints: Constraints,
        interface: Interface,
        *,
        cells: bool = False,
    ) -> None:
        self.team, self.number = team, team.kept(self)
        self._cells = team.kept(self) if cells else None
        self._d, self._space, self._model = space.components, space, model
        self.shape = (space.number_of_dofs, space.number_of_dofs)
        self.owner = team.owners[space.mesh] = owners(space, interface.B, team.size)
        self._vectors: Cut | None = None
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
        found = self.team.everywhere(_hold_piece, self.number, self._cells, pieces=self._pieces(constraints))
        self.nnz = sum(found)
        if self._vectors is not None:
            self._hold_borders()

    @property
    def vectors(self) -> Cut:
        """The displacements of every rank, of its own nodes; of obstacles and rigid bodies the first one.

        Arrays that are cut like this are multiplied where they are.
        """
        if self._vectors is None:
            d, owner, size = self._d, self.owner, self.shape[0]

            def entries_of(rank: int) -> IntArray:
                own = (d * np.flatnonzero(owner == rank)[:, None] + np.arange(d)).ravel()
                return own if rank else np.append(own, np.arange(d * len(owner), size))

            def rank_of(dofs: IntArray) -> IntArray:
                nodes = dofs // d
                return np.where(nodes < len(owner), owner[np.minimum(nodes, len(owner) - 1)], 0)

            self._vectors = Cut(self.team, size, rank_of, entries_of)
            self._hold_borders()
        return self._vectors

    def _hold_borders(self) -> None:
        """Have ranks know whose displacements they need beside their own."""
        self._borders = self.team.kept(self)  # matrices of pieces before have theirs
        place = np.empty(len(self.owner), np.int32)
        place[np.argsort(self.owner, kind="stable")] = np.arange(len(place), dtype=np.int32)
        given = self._d, self.number, self._borders
        self.team.everywhere(hold_border, *given, pieces=(place[nodes] for nodes in self._nodes))

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

    def __matmul__(self, u: Any) -> Any:
        """(dofs,) Forces K u of displacements u, (dofs,)."""
        return self.forces(u, "plain")

    def internal_forces(self, u: Any) -> Any:
        """(dofs,) Forces K u as if in twice the digits, see :func:`signorini.fem.internal_forces.internal_forces`."""
        return self.forces(u, "sharp")

    def __abs__(self) -> _SizesOnRanks:
        """|K|, by whose product with |u| rounding is told."""
        return _SizesOnRanks(self)

    def of_pieces(self, work: Callable[..., Any], *given: Any) -> MatrixOfPieces:
        """A matrix (dofs, dofs) that every rank makes of the cells of its piece, to be multiplied with.

        Parameters
        ----------
        work, given : ``work(space, model, *given)``, a function of a module that gives (p, p) of the dofs of the piece
        """
        return MatrixOfPieces(self, work, given)

    def at_pieces(self, values: Array) -> KeptThere:
        """Values (nodes, ...) at the nodes of every piece, to be given to what ranks make of the pieces."""
        return KeptThere(self.team, (values[nodes] for nodes in self._nodes))

    def hold_matrix(self, number: int, work: Callable[..., Any], given: tuple[Any, ...]) -> tuple[int, int]:
        """Have ranks keep a matrix, see `of_pieces`; the numbers under which they do, and of its borders.

        Parameters
        ----------
        number, work, given : under which they do, and what they make it of
        """
        assert self.vectors.size
        self.team.soon(_hold_matrix, number, self._cells, work, references(given))
        return number, self._borders

    def vector_of_pieces(self, work: Callable[..., Any], *given: Any) -> ArrayOnRanks:
        """(dofs,) What every rank makes of the cells of its piece, on the ranks.

        Parameters
        ----------
        work, given : ``work(space, model, *given)``, a function of a module that gives (p,) of the dofs of the piece
        """
        return self.vectors.made(_vector_there, self.vectors.number, self._cells, work, *given)

    @cached_property
    def places(self) -> Cut:
        """The coordinates of the own nodes of every rank, (nodes d,) in all."""
        d, owner = self._space.dimension, self.owner

        def entries_of(rank: int) -> IntArray:
            return (d * np.flatnonzero(owner == rank)[:, None] + np.arange(d)).ravel()

        return Cut(self.team, d * len(owner), lambda places: owner[places // d], entries_of)

    def by_places(self, work: Callable[..., Any], tables: Sequence[ColumnsOnRanks], *given: Any) -> ArrayOnRanks:
        """(nodes d,) What every rank makes of the cells of its piece by the places of its own nodes, on the ranks.

        Parameters
        ----------
        work, given : ``work(space, model, *tables, *given)`` gives (nodes, d) of the piece
        tables : displacements (dofs, k), of which it is given those of the piece
        """
        vectors = self.vectors  # whose borders are known then
        columns = [vectors.of(column) for table in tables for column in table.T]
        counts = [table.shape[1] for table in tables]
        return self.places.made(_by_places_there, self._cells, self._borders, work, counts, *columns, *given)

    def forces(self, u: Any, how: str, matrix: tuple[int, int] | None = None) -> Any:
        """(dofs,) Forces of displacements u, (dofs,), see `OwnStiffness.forces`; where u is, here or on the ranks.

        Parameters
        ----------
        u : the displacements; on the ranks several at once, (dofs, k)
        how : see `OwnStiffness.forces`
        matrix : numbers under which ranks hold another one, for displacements there, and borders; None: the stiffness
        """
        if isinstance(u, ColumnsOnRanks):
            return u.mapped(self.vectors, lambda each: self.forces(each, how, matrix))
        if isinstance(u, ArrayOnRanks):
            there = self.vectors.of(u)  # borders are known then
            return self.vectors.made(_forces_there, there, *(matrix or (self.number, self._borders)), how)
        result = np.zeros(self.shape[0])
        found = self.team.everywhere(_forces, self.number, how, pieces=(u[dofs] for dofs in self.dofs))
        for nodes, own, forces in zip(self._nodes, self._own, found, strict=True):
            result[self._dofs(nodes[own])] = forces
        return result


class MatrixOfPieces:
    """A matrix (dofs, dofs) of which every rank has made the rows of its own nodes, of the cells of its piece.

    Parameters
    ----------
    K, work, given : see `StiffnessOnRanks.of_pieces`
    """

    def __init__(self, K: StiffnessOnRanks, work: Callable[..., Any], given: tuple[Any, ...]) -> None:
        self._stiffness, self._held = K, K.hold_matrix(K.team.kept(self), work, given)

    def __matmul__(self, u: Any) -> Any:
        """Products with displacements (dofs,) or (dofs, k), on the ranks."""
        return self._stiffness.forces(u, "plain", self._held)


class _SizesOnRanks(NamedTuple):
    K: StiffnessOnRanks

    def __matmul__(self, u: Any) -> Any:
        return self.K.forces(u, "sizes")


def _hold_piece(team: Team, piece: Piece, number: int, cells: int | None) -> int:
    """Assemble a piece and keep it, with its cells where that is asked; the entries of the rows that are own ones."""
    if cells is not None:
        team.held[cells] = piece
    held = team.held[number] = piece.assembled()
    return int(np.diff(held.K.indptr)[held.own].sum())


def _hold_matrix(team: Team, number: int, cells: int, work: Callable[..., Any], given: tuple[Any, ...]) -> None:
    piece: Piece = team.held[cells]
    team.held[number] = OwnStiffness(K=piece.made(work, *found_there(team, given)), own=piece.own_dofs)


def _vector_there(team: Team, entries: int, cells: int, work: Callable[..., Any], *given: Any) -> Array:
    """On the displacements of this rank; nothing of the cells is on obstacles, which are behind them."""
    piece: Piece = team.held[cells]
    found = piece.made(work, *given)[piece.own_dofs]
    return np.concatenate([found, np.zeros(len(team.held[entries]) - len(found))])


def _by_places_there(
    team: Team, cells: int, borders: int, work: Callable[..., Any], counts: list[int], *given: Any
) -> Array:
    """By the places of own nodes, in whose cells others are too."""
    piece: Piece = team.held[cells]
    ends = [0, *accumulate(counts)]
    columns = [team.held[borders].with_others(each) for each in given[: ends[-1]]]
    none = np.zeros((len(piece.own_dofs), 0))
    tables = [np.stack(columns[a:b], axis=1) if b > a else none for a, b in pairwise(ends)]
    found: Array = piece.made(work, *tables, *given[ends[-1] :])[piece.own]
    return found.ravel()


def _forces(team: Team, u: Array, number: int, how: str) -> Array:
    found: Array = team.held[number].forces(u, how)
    return found


def _forces_there(team: Team, u: Array, number: int, borders: int, how: str) -> Array:
    """Forces on the displacements of this rank; nothing of the bodies acts on obstacles, which are behind them."""
    forces = team.held[number].forces(team.held[borders].with_others(u), how)
    return np.concatenate([forces, np.zeros(len(u) - len(forces))])
