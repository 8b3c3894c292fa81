# SPDX-License-Identifier: BSD-3-Clause
"""What every rank does: it holds rows of the bodies and some of the pairs, and iterates on them with the others."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.distributed.multigrid import CoarseGrids, SpringCycle, matrix
from signorini.distributed.ranks import Team
from signorini.fem.stiffness import reduced_stiffness
from signorini.iterative.pressed import IncrementLoad
from signorini.iterative.solve import solve_iteratively
from signorini.iterative.springs import PairSprings
from signorini.law.result import ContactAnswer


class RowsOfBodies(NamedTuple):
    """What a rank needs for its rows of the bodies, all unknowns in the order of the ranks.

    Attributes
    ----------
    transform : (p, c) displacements of its piece from the c free ones that move it, ascending
    place : (c,) where those are among all unknowns
    at : (own,) where the free ones of this rank are among its own unknowns
    first, last : its own unknowns, in blocks of d
    size, d : unknowns of all ranks, and of a node
    near_null : (own, k) motions that hardly need a force
    rigid : (own, k) rigid motions of all parts
    """

    transform: sp.csr_array
    place: IntArray
    at: IntArray
    first: int
    last: int
    size: int
    d: int
    near_null: Array
    rigid: sp.csr_array


class AskedOfPairs(NamedTuple):
    """What an increment asks of a rank.

    Attributes
    ----------
    load : of its own pairs; forces on the bodies are there
    forces : (d, a) to start from
    tied, stiffness, compliance : (a,), (a,) and (d, a) of its pairs, as of `IteratedPairs`
    """

    load: IncrementLoad
    forces: Array
    tied: BoolArray
    stiffness: Array
    compliance: Array


class OwnBodies:
    """Rows of the bodies on their rank.

    Parameters
    ----------
    team : the ranks
    K : (p, p) stiffness of the piece
    rows : of the bodies
    """

    def __init__(self, team: Team, K: sp.csr_array, rows: RowsOfBodies) -> None:
        self.team, self.d, self.rigid, self.at = team, rows.d, rows.rigid, rows.at
        self.K = matrix(team, _padded(team, K, rows), rows.last - rows.first, rows.d)
        self.K.setOption(self.K.Option.SYMMETRIC, True)
        self._near_null = rows.near_null
        self.z, self.forces = self.K.createVecs()

    @cached_property
    def grids(self) -> CoarseGrids:
        """Coarse grids, which all ranks make together for the first pairs that are iterated on."""
        return CoarseGrids(self.team, self.K, self._near_null)

    def padded(self, free: Array) -> Array:
        """(own,) Unknowns of this rank from its free displacements; what supports hold in a block is zero."""
        result = np.zeros(self.z.getLocalSize())
        result[self.at] = free
        return result

    def internal(self, z: Array) -> Array:
        """(own,) Forces K z."""
        self.z.array[:] = z
        self.K.mult(self.z, self.forces)
        return np.array(self.forces.array)


def _padded(team: Team, K: sp.csr_array, rows: RowsOfBodies) -> sp.csr_array:
    """Rows of the free displacements, those that supports hold in a block as unknowns that nothing moves."""
    reduced = reduced_stiffness(K, rows.transform)
    own = np.flatnonzero((rows.place >= rows.first) & (rows.place < rows.last))
    total, number = team.total(np.array([reduced.diagonal()[own].sum(), len(own)])).tolist()
    own = own[np.argsort(rows.place[own])]
    mine = sp.csr_array(reduced[own])
    del reduced  # as large as the rows that are made of it
    columns = rows.place.astype(mine.indices.dtype)[mine.indices]
    count = np.ones(rows.last - rows.first, dtype=np.int64)
    at = rows.place[own] - rows.first
    count[at] = np.diff(mine.indptr)
    indptr = np.concatenate([[0], np.cumsum(count)])
    across = np.setdiff1d(np.arange(len(count)), at)
    before = indptr[across] - np.arange(len(across))  # entries of the rows above, one of each that is put between
    data = np.insert(mine.data, before, total / number) if len(across) else mine.data
    columns = np.insert(columns, before, rows.first + across) if len(across) else columns
    return sp.csr_array((data, columns, indptr), shape=(len(count), rows.size))


class OwnPairs:
    """Pairs of a rank on the bodies, which answer for them all together.

    Parameters
    ----------
    bodies : on which they are
    B : (a d, b) relative displacements, pair by pair, in columns of all ranks
    """

    def __init__(self, bodies: OwnBodies, B: sp.csr_array) -> None:
        self.bodies, self.rows = bodies, B
        self.B = matrix(bodies.team, B, bodies.K.getLocalSize()[0])
        self.z, self.motion = self.B.createVecs()
        self.grids = bodies.grids
        self.cycle: SpringCycle | None = None

    def felt(self) -> Array:
        """(a,) Stiffness of the bodies at the pairs, in the direction in which it is largest."""
        if not self.B.getSize()[0]:
            return np.zeros(0)
        indptr, indices, data = self.B.matMult(self.bodies.K).getValuesCSR()
        forces = sp.csr_array((data, indices, indptr), shape=self.rows.shape)
        felt = np.asarray(forces.multiply(self.rows).sum(axis=1)).reshape(-1, self.bodies.d)
        return felt.max(axis=1, initial=0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class PressedPart:
    """What `iterative.solve` presses, on one rank; see `PressedBodies`.

    Attributes
    ----------
    own : pairs and bodies
    tied, stiffness, compliance : of the pairs
    patience, aim : of the rounds
    """

    own: OwnPairs
    tied: BoolArray
    stiffness: Array
    compliance: Array
    patience: int
    aim: float = np.inf

    @property
    def whole(self) -> bool:
        """Only a part is here."""
        return False

    @cached_property
    def moves(self) -> BoolArray:
        """(d, a) Rows of B that see anything."""
        return np.asarray(np.diff(self.own.rows.indptr).reshape(-1, self.own.bodies.d).T > 0)

    def internal(self, z: Array) -> Array:
        """(own,) Forces K z."""
        return self.own.bodies.internal(z)

    def seen(self, z: Array) -> Array:
        """(d, a) Motions of the pairs."""
        self.own.z.array[:] = z
        self.own.B.mult(self.own.z, self.own.motion)
        return np.array(self.own.motion.array.reshape(-1, self.own.bodies.d).T)

    def pushed(self, forces: Array) -> Array:
        """(own,) Forces of all pairs on the bodies."""
        self.own.motion.array[:] = forces.T.ravel()
        self.own.B.multTranspose(self.own.motion, self.own.z)
        return np.array(self.own.z.array)

    def resultants(self, forces: Array) -> Array:
        """(k,) Work on the rigid motions of all parts, of all ranks together."""
        found: Array = self.total(self.own.bodies.rigid.T @ forces)
        return found

    def total(self, values: Any) -> Any:
        """Summed over all ranks."""
        return self.own.bodies.team.total(values)

    def most(self, value: float) -> float:
        """The largest of all ranks."""
        return self.own.bodies.team.most(value)

    def preconditioner_under(self, springs: PairSprings) -> SpringCycle:
        """The cycle of the bodies, with springs in the pairs."""
        cycle = self.own.cycle
        if cycle is None:
            stuck = np.eye(len(self.compliance)) * self.stiffness[:, None, None]
            cycle = self.own.cycle = SpringCycle(self.own.grids, self.own.B, stuck)
        cycle.under(_blocks(springs))
        return cycle

    def solved(self, springs: PairSprings, preconditioner: SpringCycle, g: Array, residual: float) -> tuple[Array, int]:
        """Displacements by conjugate gradients, see `PressedBodies.solved`.

        Parameters
        ----------
        springs, preconditioner, g, residual : as there
        """
        return preconditioner.solved(_blocks(springs), g, residual)


def _blocks(springs: PairSprings) -> Array:
    """(a, d, d) Of every pair, the normal first."""
    d = len(springs.tangent) + 1
    blocks = np.zeros((len(springs.normal), d, d))
    blocks[:, 0, 0] = springs.normal
    blocks[:, 1:, 1:] = springs.tangent.transpose(2, 0, 1)
    return blocks


def hold_bodies(team: Team, rows: RowsOfBodies, stiffness: int, number: int) -> None:
    """Make the rows of the bodies, and keep them.

    Parameters
    ----------
    team, rows : the ranks and what this one makes
    stiffness, number : under which the piece is held, and the bodies will be
    """
    team.held[number] = OwnBodies(team, team.held[stiffness].K, rows)


def hold_pairs(team: Team, B: sp.csr_array, bodies: int, number: int) -> Array:
    """Put pairs on bodies, and keep them; (a,) the stiffness that they feel.

    Parameters
    ----------
    team, B : the ranks, and pairs of this one
    bodies, number : under which bodies are held, and the pairs will be
    """
    held = team.held[number] = OwnPairs(team.held[bodies], B)
    return held.felt()


def answer_pairs(
    team: Team, asked: AskedOfPairs, number: int, patience: int, pressing: int, near: int, found: int
) -> ContactAnswer:
    """Solve an increment: the answer of own pairs; own displacements are kept.

    Parameters
    ----------
    team, asked : the ranks, and what this one is asked
    number : under which pairs are held
    patience : of the rounds
    pressing, near : under which forces on the free displacements are held, and such displacements to start from
    found : under which displacements will be held
    """
    bodies: OwnBodies = team.held[number].bodies
    part = PressedPart(
        own=team.held[number],
        tied=asked.tied,
        stiffness=asked.stiffness,
        compliance=asked.compliance,
        patience=patience,
    )
    load = replace(asked.load, f=bodies.padded(team.held[pressing]))
    answer, z = solve_iteratively(part, load, bodies.padded(team.held[near]), asked.forces)
    team.held[found] = z[bodies.at]
    return answer
