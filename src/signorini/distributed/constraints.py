# SPDX-License-Identifier: BSD-3-Clause
"""Supports and free displacements of bodies on ranks: vectors of all displacements stay there, an own share on each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, IntArray, distinct, stored
from signorini.distributed.bodies import RowsOnRanks
from signorini.distributed.columns import ColumnsOnRanks
from signorini.distributed.kept_rows import put_away
from signorini.distributed.multigrid import matrix
from signorini.distributed.rank_arrays import ArrayOnRanks, Cut, Remembered
from signorini.distributed.ranks import Team
from signorini.fem.rigid_motions import RigidMotions
from signorini.fem.supports import Constraints, Motions, transform_of
from signorini.sparse_rows import chosen_columns, chosen_rows, seen_by, transposed

_FOLLOWS = -2  # in place of a free displacement: what dependent dofs have in `Constraints.free`


@dataclass(frozen=True, kw_only=True, eq=False)
class ConstraintsOnRanks(Constraints):
    """Constraints by which vectors of all displacements are on the ranks, and are computed with there.

    What is asked of an array that is here is answered here, as by `Constraints`; the transform is made anew for it.

    Attributes
    ----------
    rows : the bodies
    moved : what every rank knows of its share
    followed : (dofs,) free displacements that no other dof follows
    remembered : forces and offsets of supports that change, as ranks have them
    """

    rows: RowsOnRanks
    moved: MotionsHeld
    followed: Any
    remembered: Remembered

    @staticmethod
    def of(constraints: Constraints, rows: RowsOnRanks, rigid: RigidMotions) -> ConstraintsOnRanks:
        """Of bodies whose rows are on the ranks.

        Parameters
        ----------
        constraints, rows : what supports hold, and the bodies under them
        rigid : motions of all parts
        """
        vectors, unknowns = rows.stiffness.vectors, rows.unknowns
        free, few = vectors.of(constraints.free), (constraints.dependent, constraints.shares)
        return ConstraintsOnRanks(
            free=free,  # type: ignore[arg-type]
            transform=_TransformMade(free, unknowns.size, *few),
            prescribed={name: vectors.of(u) for name, u in constraints.prescribed.items()},  # type: ignore[misc]
            springs=constraints.springs,
            owner=vectors.of(constraints.owner),  # type: ignore[arg-type]
            nodes=unknowns.of(constraints.nodes),  # type: ignore[arg-type]
            dependent=few[0],
            shares=few[1],
            rows=rows,
            moved=MotionsHeld(rows, constraints, rigid),
            followed=vectors.of(constraints.alone),
            remembered=Remembered(),
        )

    @property
    def zeros(self) -> Any:
        """(dofs,) Zeros, on the ranks."""
        return self.rows.stiffness.vectors.zeros

    def placed(self, values: Any) -> Any:
        """Values (dofs,), which nobody changes, on the ranks."""
        return self.remembered.of(self.rows.stiffness.vectors, values)

    def spread(self, dofs: IntArray, values: Array) -> Any:
        """(dofs, ...) Values (k, ...) at some dofs (k,), zero elsewhere, on the ranks."""
        return ColumnsOnRanks.spread(self.rows.stiffness.vectors, dofs, values)

    def beside(self, columns: Sequence[Any]) -> Any:
        """(n, k) Arrays side by side that are on the ranks."""
        return ColumnsOnRanks(columns[0].cut, columns)

    @property
    def alone(self) -> Any:
        """(dofs,) Free displacements that no other dof follows, on the ranks."""
        return self.followed

    @cached_property
    def held(self) -> Any:
        """(dofs,) Whether a support, the axis or nothing at all holds the dof, on the ranks."""
        return self.free == -1

    @property
    def _transposed(self) -> sp.csc_array:
        """Not kept, for forces that are here."""
        return transposed(self.transform)

    def displaced(self, free: Any) -> Any:
        """(dofs,) Displacements by free ones (z,) alone; of several (z, k) at once (dofs, k)."""
        if isinstance(free, ColumnsOnRanks):
            return free.mapped(self.rows.stiffness.vectors, self.displaced)
        if not isinstance(free, ArrayOnRanks):
            return super().displaced(free)
        return self.rows.stiffness.vectors.made(_displaced, self.rows.unknowns.of(free), self.moved.number)

    def on_free(self, forces: Any) -> Any:
        """(z,) What forces (dofs,) are on the free displacements; of several (dofs, k) at once (z, k)."""
        if isinstance(forces, ColumnsOnRanks):
            return forces.mapped(self.rows.unknowns, self.on_free)
        if not isinstance(forces, ArrayOnRanks):
            return super().on_free(forces)
        return self.rows.unknowns.made(_on_free, self.rows.stiffness.vectors.of(forces), self.moved.number)

    def free_of(self, displacement: Any) -> Any:
        """(z,) The free displacements in some of all dofs (dofs,)."""
        if not isinstance(displacement, ArrayOnRanks):
            return super().free_of(displacement)
        return self.rows.unknowns.made(_free_of, self.rows.stiffness.vectors.of(displacement), self.moved.number)

    def in_free(self, rows: sp.csr_array) -> sp.csr_array:
        """(k, z) Rows (k, dofs) in terms of the free displacements: of these, only what rows see is asked for."""
        follow = np.isin(self.dependent, rows.indices)
        shares = chosen_rows(self.shares, follow)
        seen = distinct(np.concatenate([rows.indices, shares.indices]))
        few = np.searchsorted(seen, self.dependent[follow]), chosen_columns(shares, seen)
        transform = transform_of(self.free[seen], self.rows.unknowns.size, *few)
        return sp.csr_array(chosen_columns(rows, seen) @ transform)

    def spread_free(self, free: IntArray, values: Array) -> Any:
        """(z, ...) Values (k, ...) at some free displacements (k,), zero elsewhere, on the ranks."""
        return ColumnsOnRanks.spread(self.rows.unknowns, free, values)

    def carried(self, rigid: Motions, by: Array) -> Any:
        """(dofs,) Displacements by combinations (k,) of the rigid motions that ranks know, there."""
        assert rigid is self.moved.rigid
        return self.rows.stiffness.vectors.made(_carried, self.moved.number, by)

    def of_free(self, rigid: Motions, by: Array) -> Any:
        """(z, m) The free displacements in combinations (k, m) of k rigid motions, on the ranks."""
        return ColumnsOnRanks(self.rows.unknowns, [self.free_of(self.carried(rigid, each)) for each in by.T])

    def resultants(self, rigid: Motions, forces: Any) -> Array:
        """(k,) Work of forces (dofs,) on k rigid motions."""
        if not isinstance(forces, ArrayOnRanks) or rigid is not self.moved.rigid:
            return super().resultants(rigid, forces)
        given = self.rows.stiffness.vectors.of(forces)
        return np.asarray(sum(self.rows.team.everywhere(_resultants, given.number, self.moved.number)))

    def handed_on(self, forces: Any) -> Any:
        """Forces on all dofs (dofs,), those on dependent ones given to the dofs that they follow from."""
        if not len(self.dependent) or not isinstance(forces, ArrayOnRanks):
            return super().handed_on(forces)
        seen = distinct(self.shares.indices)
        handed = chosen_columns(self.shares, seen).T @ forces[self.dependent]
        return np.where(self.free == _FOLLOWS, 0.0, forces) + self.spread(seen, handed)

    def completed(self, displacement: Any) -> Any:
        """Displacements of all dofs (dofs,), those of dependent ones as they follow from the others."""
        if not isinstance(displacement, ArrayOnRanks):
            return super().completed(displacement)
        if not len(self.dependent):
            return displacement
        given = self.spread(self.dependent, seen_by(self.shares, displacement))
        return np.where(self.free == _FOLLOWS, given, displacement)

    def foundation_forces(self, displacement: Any) -> Any:
        """Forces of all elastic foundations on the bodies, (dofs,)."""
        if not isinstance(displacement, ArrayOnRanks):
            return super().foundation_forces(displacement)
        seen = distinct(np.concatenate([np.zeros(0, np.int64), *(S.indices for S in self.springs.values())]))
        near = displacement[seen]
        springs = [S[:, seen] for S in self.springs.values()]
        return self.spread(seen, sum((-(S.T @ (S @ near)) for S in springs), np.zeros(len(seen))))


def kept_away(constraints: Constraints, vectors: Cut) -> Constraints:
    """Constraints under which nothing is solved now, with arrays on the ranks: whoever asks is given all of them.

    Parameters
    ----------
    constraints : what supports hold
    vectors : the displacements of every rank
    """
    if not isinstance(stored(constraints, "transform"), sp.csr_array):
        return constraints
    free = vectors.of(constraints.free)
    count, few = constraints.transform.shape[1], (constraints.dependent, constraints.shares)
    return replace(
        constraints,
        free=free,  # type: ignore[arg-type]
        transform=_TransformMade(free, count, *few),
        prescribed={name: vectors.of(u) for name, u in constraints.prescribed.items()},  # type: ignore[misc]
        owner=vectors.of(constraints.owner),  # type: ignore[arg-type]
        nodes=put_away(constraints.nodes),
    )


class _TransformMade:
    """The transform of constraints, made of what ranks know for whoever asks for it, and not kept.

    Parameters
    ----------
    free : (dofs,) on the ranks
    count, dependent, shares : as of `signorini.fem.supports.transform_of`
    """

    def __init__(self, free: ArrayOnRanks, count: int, dependent: IntArray, shares: sp.csr_array) -> None:
        self._free, self._few = free, (count, dependent, shares)

    def whole(self) -> sp.csr_array:
        """(dofs, z)."""
        return transform_of(self._free.whole(), *self._few)  # type: ignore[arg-type]


class MotionsHeld:
    """What ranks know of how their own displacements follow from the free ones, until nobody asks for it.

    Attributes
    ----------
    number : under which they hold it
    rigid : motions of all parts

    Parameters
    ----------
    rows, constraints, rigid : as of `ConstraintsOnRanks.of`
    """

    def __init__(self, rows: RowsOnRanks, constraints: Constraints, rigid: RigidMotions) -> None:
        self.number, self.rigid = rows.team.kept(self), rigid
        cuts = rows.stiffness.vectors, rows.unknowns
        pieces = _own_motions(rows, cuts, constraints, rigid)
        rows.team.everywhere(_hold, rows.number, self.number, pieces=pieces)


class _OwnMotions(NamedTuple):
    """Rows of the displacements of one rank.

    Attributes
    ----------
    transform : (own, unknowns) from the free displacements, in the order of the ranks
    leaders : (own free,) which of its own displacements its free ones are
    motions : (own, k) rigid motions
    """

    transform: sp.csr_array
    leaders: IntArray
    motions: sp.csr_array


def _own_motions(
    rows: RowsOnRanks, cuts: tuple[Cut, Cut], constraints: Constraints, rigid: RigidMotions
) -> Iterator[_OwnMotions]:
    """Of every rank; ``cuts`` are those of all displacements and of the free ones."""
    d = rows.blocks.size
    leaders = d * constraints.nodes + constraints.leaders % d
    for own, free in zip(*(cut.entries() for cut in cuts), strict=True):
        yield _OwnMotions(
            transform=rows.blocks.columns(sp.csr_array(constraints.transform[own])),
            leaders=np.searchsorted(own, leaders[free]).astype(np.int32),
            motions=chosen_rows(rigid.seen_by(own), own),
        )


class _MotionsThere:
    """Rows of the displacements of a rank, in PETSc.

    Parameters
    ----------
    team, own : the ranks and the rows of this one
    bodies : under which number bodies are held
    """

    def __init__(self, team: Team, own: _OwnMotions, bodies: int) -> None:
        self.bodies, self.leaders, self.motions = team.held[bodies], own.leaders, own.motions
        self.transform = matrix(team, own.transform, self.bodies.K.getLocalSize()[1])
        self.z, self.u = self.transform.createVecs()


def _hold(team: Team, own: _OwnMotions, bodies: int, number: int) -> None:
    team.held[number] = _MotionsThere(team, own, bodies)


def _displaced(team: Team, free: Array, number: int) -> Array:
    there: _MotionsThere = team.held[number]
    there.z.array[:] = there.bodies.padded(free)
    there.transform.mult(there.z, there.u)
    return np.array(there.u.array)


def _on_free(team: Team, forces: Array, number: int) -> Array:
    there: _MotionsThere = team.held[number]
    there.u.array[:] = forces
    there.transform.multTranspose(there.u, there.z)
    return np.array(there.z.array[there.bodies.at])


def _free_of(team: Team, displacement: Array, number: int) -> Array:
    found: Array = displacement[team.held[number].leaders]
    return found


def _carried(team: Team, number: int, by: Array) -> Array:
    found: Array = team.held[number].motions @ by
    return found


def _resultants(team: Team, forces: int, number: int) -> Array:
    return np.asarray(team.held[number].motions.T @ team.held[forces])
