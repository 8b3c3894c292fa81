# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on all ranks that MUMPS factorises together, as the first rank condenses them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from signorini.arrays import Array, IntArray
from signorini.distributed.bodies import RowsOnRanks
from signorini.distributed.factors import (
    AskedOfFactors,
    FactorsMade,
    diagonal_of,
    hold_factors,
    rows_of,
    solve_factors,
)
from signorini.distributed.ranks import MUMPS
from signorini.errors import InputError
from signorini.linalg.definite import ROUNDOFF
from signorini.linalg.protocol import NotPositiveDefinite, Reduced
from signorini.linalg.system import as_columns, like

_SINGULAR = (-10, -40)  # values of INFOG(1)
_NO_MEMORY = (-7, -8, -9, -11, -13, -14, -15, -17, -19, -20)  # values of INFOG(1)
_HELD_TO_LOOK = 1e-10  # of the diagonal: springs under which a motion without resistance shows


@dataclass(frozen=True, kw_only=True, eq=False)
class MatrixOnRanks:
    """The stiffness of the free displacements on all ranks, see `signorini.linalg.elsewhere.MatrixElsewhere`.

    Attributes
    ----------
    on_ranks : the bodies
    transform : (dofs, z) displacements of the free ones
    springs : (z,) on the diagonal, beside the bodies
    border : (m, z) rows B of the border
    """

    on_ranks: RowsOnRanks
    transform: sp.csr_array
    springs: Array
    border: sp.csr_array

    @staticmethod
    def of(on_ranks: RowsOnRanks, transform: sp.csr_array) -> MatrixOnRanks:
        """The bodies without springs or border; ``transform`` as above."""
        z = len(on_ranks.blocks.place)
        none = sp.csr_array((0, z))
        return MatrixOnRanks(on_ranks=on_ranks, transform=transform, springs=np.zeros(z), border=none)

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
        found = self.on_ranks.team.everywhere(diagonal_of, self.on_ranks.number)
        return np.concatenate([self.together(found) + self.springs, np.zeros(self.border.shape[0])])

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
        return sp.csr_array((entries.data + np.where(i == j, self.springs[i], 0.0), (i, j)), shape=(z, z))

    def stiffened(self, springs: Array) -> MatrixOnRanks:
        """This matrix with more on its diagonal.

        Parameters
        ----------
        springs : (z,) what is added
        """
        return replace(self, springs=self.springs + springs)

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
            motion = FactorsHeld(self.stiffened(_HELD_TO_LOOK * self.diagonal()[: len(self.springs)]), edge)
            raise NotPositiveDefinite(int(np.argmax(np.abs(motion.solved(motion.arbitrary)))))
        held.refuse_free_motions()
        if self.border.shape[0]:
            return FactorsOnRanks(held=held, interface=edge, coupling=self.border)
        inside = sp.diags_array(held.inside.astype(np.float64))
        coupling = self.rows(edge)[edge] @ inside
        return FactorsOnRanks(held=held, interface=edge, coupling=sp.csr_array(coupling))

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
    inside : (z,) free displacements that are eliminated
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
        self.inside = np.ones(z, dtype=np.bool_)
        self.inside[edge[edge < z]] = False
        place = np.concatenate([blocks.place, blocks.size * blocks.count + np.arange(matrix.border.shape[0])])
        pieces = self._asked(place[edge])
        made = team.everywhere(hold_factors, matrix.on_ranks.number, self._number, pieces=pieces)
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
        for rank, springs in enumerate(self.matrix.parts(self.matrix.springs)):
            border = columns[on.ends[rank] : on.ends[rank + 1]]
            yield AskedOfFactors(springs=springs, border=border, interface=none if rank else interface)

    @property
    def definite(self) -> bool:
        """Whether no pivot of the interior was 0 or less."""
        return self.made.status >= 0 and self.made.negative == 0

    @property
    def arbitrary(self) -> Array:
        """(z,) A load on what is eliminated that no motion is orthogonal to, of the size of the diagonal."""
        random, diagonal = np.random.default_rng(0), self.matrix.diagonal()[: len(self.inside)]
        size = np.sqrt(np.abs(diagonal)) * random.uniform(0.5, 1.5, len(diagonal))
        return np.where(self.inside, size * random.choice([-1.0, 1.0], len(diagonal)), 0.0)

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
        u = self.matrix.transform @ x
        size = float(np.abs(u) @ (abs(self.matrix.on_ranks.stiffness) @ u) + self.matrix.springs @ x**2)
        if float(x @ load) <= ROUNDOFF * size:
            raise NotPositiveDefinite(int(np.argmax(np.abs(x))))

    def solved(self, f: Array) -> Array:
        """Displacements (z, ...) under forces (z, ...) on what is eliminated, nothing else moves.

        Parameters
        ----------
        f : the forces
        """
        team, columns = self.matrix.on_ranks.team, as_columns(f, len(self.inside))
        inner = np.where(self.inside[:, None], columns, 0.0)
        found = team.everywhere(solve_factors, self._number, pieces=self.matrix.parts(inner))
        return like(f, np.where(self.inside[:, None], self.matrix.together(found), 0.0))


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

    def reduce(self, f: Array) -> Reduced:
        """Eliminate the interior of a load f, (n,) or (n, k), by one solve; to expand takes another."""
        z, load = len(self.held.inside), as_columns(f, self.n)
        u = self.held.solved(load[:z])

        def expand(kept: Array) -> Array:
            edge, result = as_columns(kept, self.m), np.zeros((self.n, u.shape[1]))
            result[:z] = u - self.held.solved(self.coupling.T @ edge)
            result[self.interface] = edge
            return like(f, result)

        return Reduced(like(f, load[self.interface] - self.coupling @ u), expand)
