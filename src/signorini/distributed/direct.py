# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on all ranks that MUMPS factorises together, as the first rank condenses them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray, distinct
from signorini.distributed.bodies import RowsOnRanks
from signorini.distributed.columns import ColumnsOnRanks
from signorini.distributed.constraints import ConstraintsOnRanks
from signorini.distributed.factors import (
    AskedOfFactors,
    FactorsMade,
    arbitrary_load,
    diagonal_of,
    hold_factors,
    rows_of,
    solve_factors,
    solved_there,
)
from signorini.distributed.rank_arrays import ArrayOnRanks
from signorini.distributed.ranks import MUMPS
from signorini.errors import InputError
from signorini.linalg.definite import ROUNDOFF
from signorini.linalg.protocol import NotPositiveDefinite, Reduced
from signorini.linalg.system import as_columns, like
from signorini.sparse_rows import chosen_columns, chosen_rows

_SINGULAR = (-10, -40)  # values of INFOG(1)
_NO_MEMORY = (-7, -8, -9, -11, -13, -14, -15, -17, -19, -20)  # values of INFOG(1)
_HELD_TO_LOOK = 1e-10  # of the diagonal: springs under which a motion without resistance shows


@dataclass(frozen=True, kw_only=True, eq=False)
class MatrixOnRanks:
    """The stiffness of the free displacements on all ranks, see `signorini.linalg.elsewhere.MatrixElsewhere`.

    Attributes
    ----------
    constraints : what supports hold of the bodies
    springs : (z,) on the diagonal, beside the bodies, on the ranks
    border : (m, z) rows B of the border
    """

    constraints: ConstraintsOnRanks
    springs: ArrayOnRanks
    border: sp.csr_array

    @staticmethod
    def of(constraints: ConstraintsOnRanks) -> MatrixOnRanks:
        """The bodies without springs or border; ``constraints`` as above."""
        unknowns = constraints.rows.unknowns
        none = sp.csr_array((0, unknowns.size))
        return MatrixOnRanks(constraints=constraints, springs=unknowns.zeros, border=none)

    @property
    def on_ranks(self) -> RowsOnRanks:
        """The bodies."""
        return self.constraints.rows

    @property
    def shape(self) -> tuple[int, int]:
        """(n, n), the border with it."""
        n = len(self.springs) + self.border.shape[0]
        return n, n

    @property
    def nnz(self) -> int:
        """Entries of the bodies."""
        return self.on_ranks.stiffness.nnz

    def diagonal(self) -> Array:
        """(n,) Its diagonal."""
        return np.concatenate([self.on_free.whole(), np.zeros(self.border.shape[0])])

    @property
    def on_free(self) -> ArrayOnRanks:
        """(z,) The diagonal without the border, on the ranks."""
        found: ArrayOnRanks = self.on_ranks.unknowns.made(diagonal_of, self.on_ranks.number) + self.springs
        return found

    def rows(self, wanted: IntArray) -> sp.csr_array:
        """(z, z) Some rows of the bodies, see `MatrixElsewhere.rows`.

        Parameters
        ----------
        wanted : (m,) their numbers
        """
        place, ends, z = self.on_ranks.blocks.place, self.on_ranks.ends, len(self.springs)
        order = wanted[np.argsort(place[wanted])]
        cut = np.searchsorted(place[order], ends)
        pieces = (place[order[a:b]] - first for a, b, first in zip(cut[:-1], cut[1:], ends[:-1], strict=True))
        found = self.on_ranks.team.everywhere(rows_of, self.on_ranks.number, pieces=pieces)
        free = np.full(self.on_ranks.blocks.size * self.on_ranks.blocks.count, -1)
        free[place] = np.arange(z)
        entries = sp.vstack(found, format="coo")
        i, j = order[entries.row], free[entries.col]
        springs = self.springs[order][entries.row]
        return sp.csr_array((entries.data + np.where(i == j, springs, 0.0), (i, j)), shape=(z, z))

    def stiffened(self, springs: Any) -> MatrixOnRanks:
        """This matrix with more on its diagonal.

        Parameters
        ----------
        springs : (z,) what is added, here or on the ranks
        """
        return replace(self, springs=self.springs + springs)

    def held_by_springs(self, rigid: ColumnsOnRanks, stiffness: float) -> MatrixOnRanks:
        """This matrix with a spring for each rigid motion, see :func:`signorini.condense.response.held_by_springs`.

        Parameters
        ----------
        rigid : (z, k) on the ranks
        stiffness : of the springs where nothing deforms
        """
        dofs = rigid.far_apart()
        spring = self.on_free.sum() / len(self.springs) if self.nnz else stiffness
        return self.stiffened(self.on_ranks.unknowns.spread(dofs, np.full(len(dofs), spring)))

    def bordered(self, B: sp.csr_array) -> MatrixOnRanks:
        """``[[K, B^T], [B, 0]]``.

        Parameters
        ----------
        B : (m, z)
        """
        return replace(self, border=B)

    def factorised(self, interface: ArrayLike) -> FactorsOnRanks:
        """Factorise the interior and condense it onto the interface: contact dofs, or all of the border.

        Parameters
        ----------
        interface : (m,) unknowns that are not eliminated

        Raises
        ------
        NotPositiveDefinite
            If the interior is singular or indefinite, with the unknown that moves most.
        MemoryError
            If MUMPS has too little memory.
        InputError
            If it fails for any other reason.
        """
        edge = np.asarray(interface, dtype=np.int64)
        held = FactorsHeld(self, edge)
        if not held.definite:
            motion = FactorsHeld(self.stiffened(_HELD_TO_LOOK * self.on_free), edge)
            raise NotPositiveDefinite(int(np.argmax(np.abs(motion.solved(motion.arbitrary)))))
        held.refuse_free_motions()
        if self.border.shape[0]:
            return FactorsOnRanks(held=held, interface=edge, coupling=self.border)
        coupling = chosen_rows(self.rows(edge), edge)
        coupling.data[np.isin(coupling.indices, edge)] = 0.0
        coupling.eliminate_zeros()
        return FactorsOnRanks(held=held, interface=edge, coupling=coupling)

    def parts(self, values: Array) -> Iterator[Array]:
        """Values (z, ...) on the unknowns of every rank.

        Parameters
        ----------
        values : of all free displacements
        """
        on = self.on_ranks
        return iter(np.split(on.blocks.spread(values), on.ends[1:-1]))

    def together(self, parts: Sequence[Array]) -> Array:
        """(z, ...) Values of all free displacements from those of the ranks.

        Parameters
        ----------
        parts : (own, ...) of every rank
        """
        return np.concatenate(parts)[self.on_ranks.blocks.place]


class FactorsHeld:
    """Factors on the ranks, until nobody asks for them.

    Attributes
    ----------
    matrix : what is factorised
    edge : (k,) free displacements that are not eliminated
    inside : (z,) whether one is, on the ranks
    made : how it ended on the first rank

    Parameters
    ----------
    matrix : what is factorised
    edge : (m,) unknowns that are not eliminated

    Raises
    ------
    MemoryError
        If MUMPS has too little memory.
    InputError
        If it does not fit, or fails for any reason but an interior that is not positive definite.
    """

    def __init__(self, matrix: MatrixOnRanks, edge: IntArray) -> None:
        self.matrix, team = matrix, matrix.on_ranks.team
        self._number, blocks, z = team.kept(self), matrix.on_ranks.blocks, len(matrix.springs)
        self.edge = edge[edge < z]
        self.inside = matrix.on_ranks.unknowns.spread(self.edge, np.ones(len(self.edge))) == 0.0
        place = np.concatenate([blocks.place, blocks.size * blocks.count + np.arange(matrix.border.shape[0])])
        pieces = self._asked(place[edge])
        numbers = matrix.on_ranks.number, matrix.springs.number, self._number
        made = team.everywhere(hold_factors, *numbers, pieces=pieces)
        self.made: FactorsMade = made[0]
        what = f"back end '{MUMPS}', for the factor of {z} unknowns and dense matrices of {len(edge)} of the contacts,"
        self.made.room.refuse(what)
        if self.made.status in _NO_MEMORY:
            raise MemoryError(f"MUMPS has too little memory (INFOG {self.made.status}, {self.made.detail})")
        if self.made.status < 0 and self.made.status not in _SINGULAR:
            raise InputError(
                f"back end '{MUMPS}' failed with MUMPS's error {self.made.status} ({self.made.detail}, see its "
                "reference); expected another back end"
            )

    def _asked(self, interface: IntArray) -> Iterator[AskedOfFactors]:
        on, none = self.matrix.on_ranks, np.zeros(0, dtype=np.int64)
        columns = sp.csr_array(on.blocks.columns(self.matrix.border).T)
        for rank, (first, last) in enumerate(pairwise(on.ends)):
            yield AskedOfFactors(springs=np.zeros(0), border=columns[first:last], interface=none if rank else interface)

    @property
    def definite(self) -> bool:
        """Whether no pivot of the interior was 0 or less."""
        return self.made.status >= 0 and self.made.negative == 0

    @property
    def arbitrary(self) -> Any:
        """(z,) A load on what is eliminated that no motion is orthogonal to, of the size of the diagonal."""
        load = self.matrix.on_ranks.unknowns.made(arbitrary_load, self.matrix.on_free)
        return np.where(self.inside, load, 0.0)

    def refuse_free_motions(self) -> None:
        """Refuse an interior one of whose motions has no energy but rounding, see `signorini.linalg.definite`.

        Raises
        ------
        NotPositiveDefinite
            With the unknown that moves most.
        """
        if not self.inside.any():
            return
        load = self.arbitrary
        x = self.solved(load)
        if not np.isfinite(x).all():
            raise NotPositiveDefinite(int(np.argmin(np.isfinite(x))))
        u = self.matrix.constraints.displaced(x)
        size = float(np.abs(u) @ (abs(self.matrix.on_ranks.stiffness) @ u) + self.matrix.springs @ x**2)
        if float(x @ load) <= ROUNDOFF * size:
            raise NotPositiveDefinite(int(np.argmax(np.abs(x))))

    def solved(self, f: Any) -> Any:
        """Displacements (z, ...) under forces (z, ...) on what is eliminated, nothing else moves.

        Parameters
        ----------
        f : the forces, here, or on the ranks, where displacements are then
        """
        if isinstance(f, ColumnsOnRanks):
            return f.mapped(self.matrix.on_ranks.unknowns, self.solved)
        if isinstance(f, ArrayOnRanks):
            unknowns, bodies = self.matrix.on_ranks.unknowns, self.matrix.on_ranks.number
            there = unknowns.made(solved_there, np.where(self.inside, f, 0.0), bodies, self._number)
            return np.where(self.inside, there, 0.0)
        team, columns = self.matrix.on_ranks.team, as_columns(f, len(self.inside)).copy()
        columns[self.edge] = 0.0
        found = self.matrix.together(team.everywhere(solve_factors, self._number, pieces=self.matrix.parts(columns)))
        found[self.edge] = 0.0
        return like(f, found)


@dataclass(frozen=True, kw_only=True, eq=False)
class FactorsOnRanks:
    """Bodies that all ranks have factorised, see `signorini.linalg.protocol.Factorisation`.

    Attributes
    ----------
    held : the factors
    interface : (m,) unknowns that are not eliminated
    coupling : (m, z) rows of the interface in what is eliminated
    """

    held: FactorsHeld
    interface: IntArray
    coupling: sp.csr_array
    name: str = MUMPS
    plan: None = None

    @property
    def n(self) -> int:
        """Unknowns in all."""
        return self.held.matrix.shape[0]

    @property
    def m(self) -> int:
        """Unknowns on the interface."""
        return len(self.interface)

    def schur(self) -> Array:
        """Give S, (m, m)."""
        assert self.held.made.condensed is not None
        return self.held.made.condensed

    def parted(self) -> tuple[Array, FactorsOnRanks]:
        """S, which may be overwritten, and these factors without it."""
        S = self.schur()
        self.held.made = self.held.made._replace(condensed=None)
        return S, self

    def reduce(self, f: Any) -> Reduced:
        """Eliminate the interior of a load f, (n,) or (n, k), by one solve; to expand takes another.

        That on the free displacements alone, (z,) or (z, k), may be on the ranks, and so is then what is expanded.
        """
        if isinstance(f, ArrayOnRanks | ColumnsOnRanks):
            return self._reduced_there(f)
        z, load = len(self.held.inside), as_columns(f, self.n)
        u = self.held.solved(load[:z])

        def expand(kept: Array) -> Array:
            edge, result = as_columns(kept, self.m), np.zeros((self.n, u.shape[1]))
            result[:z] = u - self.held.solved(self.coupling.T @ edge)
            result[self.interface] = edge
            return like(f, result)

        return Reduced(like(f, load[self.interface] - self.coupling @ u), expand)

    @cached_property
    def _near(self) -> tuple[IntArray, sp.csr_array]:
        """(k,) What is eliminated that the interface feels, ascending, and its columns (m, k) of the coupling."""
        seen = distinct(self.coupling.indices)
        return seen, chosen_columns(self.coupling, seen)

    def _reduced_there(self, f: ArrayOnRanks | ColumnsOnRanks) -> Reduced:
        """A load on the ranks: what the interface feels and holds comes here, and goes there, and nothing else."""
        unknowns, (seen, coupling), edge = self.held.matrix.on_ranks.unknowns, self._near, self.held.edge
        u = self.held.solved(f if isinstance(f, ColumnsOnRanks) else unknowns.of(f))

        def expand(kept: Array) -> Any:
            inner = u - self.held.solved(ColumnsOnRanks.spread(unknowns, seen, coupling.T @ kept))
            return inner + ColumnsOnRanks.spread(unknowns, edge, kept) if len(edge) else inner

        return Reduced((f[edge] if len(edge) else 0.0) - coupling @ u[seen], expand)
