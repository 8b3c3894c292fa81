# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and pairs on all ranks as the first one sees them: it asks for increments, and puts their answers together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, index_type
from signorini.distributed.partition import pair_owners
from signorini.distributed.parts import AskedOfPairs, RowsOfBodies, answer_pairs, hold_bodies, hold_pairs
from signorini.distributed.rank_arrays import ArrayOnRanks, Cut
from signorini.distributed.ranks import PETSC
from signorini.distributed.stiffness import StiffnessOnRanks
from signorini.fem.rigid_motions import RigidMotions
from signorini.fem.space import Space
from signorini.fem.supports import Constraints
from signorini.interface.active import with_supple
from signorini.interface.interface import Interface
from signorini.iterative.blocks import Blocks
from signorini.iterative.bodies import arms, near_null
from signorini.iterative.pairs import IteratedPairs, chosen_pairs
from signorini.iterative.pressed import IncrementLoad
from signorini.law.result import ContactAnswer
from signorini.sparse_rows import chosen_columns, transposed


class RowsOnRanks:
    """The bodies in blocks of nodes, rows on all ranks.

    Attributes
    ----------
    team : the ranks
    number : under which they hold them
    stiffness : pieces on the ranks
    blocks : of the unknowns, those of the first rank first
    ends : (ranks + 1,) where the unknowns of the ranks begin and end
    centres : (ranks, d) of the nodes of every rank, length

    Parameters
    ----------
    K : pieces on the ranks
    space, constraints : of the bodies
    rigid : motions of all parts
    """

    def __init__(self, K: StiffnessOnRanks, space: Space, constraints: Constraints, rigid: RigidMotions) -> None:
        self.team, self.number, self.stiffness = K.team, K.team.kept(self), K
        d, nodes = space.components, constraints.nodes
        new = np.append(True, nodes[1:] != nodes[:-1])[: len(nodes)]  # they ascend
        known, index = nodes[new], np.cumsum(new, dtype=index_type(len(nodes))) - 1
        owner, points = K.owner_of(known), space.mesh.points
        block = np.empty(len(known), dtype=index_type(d * len(known)))
        block[np.argsort(owner, kind="stable")] = np.arange(len(known))
        axis = (constraints.leaders % d).astype(np.int8)
        place = d * block[index] + axis
        self.blocks = Blocks(size=d, count=len(known), place=place)
        self.ends = d * np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=self.team.size))])
        count = np.bincount(K.owner, minlength=self.team.size)
        self.centres = np.stack([np.bincount(K.owner, x, self.team.size) for x in points.T], axis=1) / count[:, None]
        arm = _ArmsOfUnknowns(arms(points, known), index, axis)
        pieces = self._rows(constraints.transform, arm, rigid)
        self.team.everywhere(hold_bodies, K.number, self.number, pieces=pieces)

    def _rows(self, transform: sp.csr_array, arm: _ArmsOfUnknowns, rigid: RigidMotions) -> Iterator[RowsOfBodies]:
        d, place = self.blocks.size, self.blocks.place
        for rank, dofs in enumerate(self.stiffness.dofs):
            first, last = (int(end) for end in self.ends[rank : rank + 2])
            moved = transform[dofs]
            columns = np.unique(np.concatenate([moved.indices, np.flatnonzero((place >= first) & (place < last))]))
            numbered = np.searchsorted(columns, moved.indices)
            own = np.flatnonzero((place >= first) & (place < last))
            near = near_null(arm.of_nodes[arm.node[own]], arm.axis[own], d)
            spread = np.zeros((last - first, near.shape[1]))
            spread[place[own] - first] = near
            follow = transposed(chosen_columns(transform, own))
            motions = sp.coo_array(follow @ rigid.seen_by(follow.indices))
            yield RowsOfBodies(
                transform=sp.csr_array((moved.data, numbered, moved.indptr), shape=(len(dofs), len(columns))),
                place=place[columns],
                at=(place[own] - first).astype(np.int32),
                first=first,
                last=last,
                size=d * self.blocks.count,
                d=d,
                near_null=spread,
                rigid=sp.csr_array(
                    (motions.data, (place[own][motions.row] - first, motions.col)), (last - first, motions.shape[1])
                ),
            )

    @cached_property
    def unknowns(self) -> Cut:
        """The free displacements of every rank."""
        place, ends = self.blocks.place, self.ends

        def rank_of(free: IntArray) -> IntArray:
            return np.searchsorted(ends, place[free], side="right") - 1

        def entries_of(rank: int) -> IntArray:
            return np.flatnonzero((place >= ends[rank]) & (place < ends[rank + 1]))

        return Cut(self.team, len(place), rank_of, entries_of)

    def pair_owners(self, columns: sp.csr_array, at: Array) -> IntArray:
        """(a,) The rank that has each pair, see :func:`signorini.distributed.partition.pair_owners`.

        Parameters
        ----------
        columns : (d a, unknowns) relative displacements of the pairs
        at : (a, d) where the pairs are, length
        """
        rank = np.searchsorted(self.ends, columns.indices, side="right") - 1
        pair = np.repeat(np.arange(columns.shape[0]) % max(len(at), 1), np.diff(columns.indptr))
        shape = (len(at), self.team.size)
        return pair_owners(sp.csr_array((np.ones(len(pair)), (pair, rank)), shape=shape), at, self.centres)


class _ArmsOfUnknowns(NamedTuple):
    """Where free displacements are and what their direction is, for motions that hardly need a force.

    Attributes
    ----------
    of_nodes : (k, d) arms of the nodes that have any, see `signorini.iterative.bodies.arms`
    node, axis : (z,) of every free displacement the one of these nodes, and its direction
    """

    of_nodes: Array
    node: IntArray
    axis: IntArray


class PairsHeld:
    """Pairs on the ranks, until nobody asks for them.

    Attributes
    ----------
    number : under which they are held
    at : (a, d) where the pairs are, length
    owner : (a,) rank of every pair
    felt : of every rank the stiffness of the bodies at its pairs, (a,)

    Parameters
    ----------
    rows : the bodies
    B : (d a, z) relative displacements of the pairs
    at : (a, d) where the pairs are, length
    """

    def __init__(self, rows: RowsOnRanks, B: sp.csr_array, at: Array) -> None:
        self.number, self.at = rows.team.kept(self), at
        columns = rows.blocks.columns(B)
        self.owner = rows.pair_owners(columns, at)
        steps = len(at) * np.arange(rows.blocks.size)
        pieces = (columns[(np.flatnonzero(self.owner == r)[:, None] + steps).ravel()] for r in range(rows.team.size))
        self.felt = rows.team.everywhere(hold_pairs, rows.number, self.number, pieces=pieces)


@dataclass(frozen=True, kw_only=True, eq=False)
class BodiesOnRanks(IteratedPairs):
    """Pairs, and the ranks that answer for their bodies.

    Attributes
    ----------
    rows : the bodies
    B : (d a, z) relative displacements of the pairs
    on_ranks : the pairs there
    """

    rows: RowsOnRanks
    B: sp.csr_array
    on_ranks: PairsHeld
    name: str = PETSC

    def answered(self, load: IncrementLoad, free: Any, forces: Array) -> tuple[ContactAnswer, Any]:
        """Solve one increment on all ranks, see `IteratedPairs.answered`; displacements stay there.

        Parameters
        ----------
        load, free, forces : as there; the forces of the load are on the free displacements, here or on the ranks
        """
        unknowns = self.rows.unknowns
        pressing, near, z = unknowns.of(load.f), unknowns.of(free), ArrayOnRanks(unknowns, np.float64)
        numbers = pressing.number, near.number, z.number
        asked = self._asked(replace(load, f=np.zeros(0)), forces)
        answers = self.rows.team.everywhere(answer_pairs, self.on_ranks.number, self.patience, *numbers, pieces=asked)
        joined = {name: self._together([getattr(answer, name) for answer in answers]) for name in ("h", "r", "state")}
        return replace(answers[0], **joined), z

    def among(self, kept: BoolArray) -> BodiesOnRanks:
        """Bodies with fewer pairs.

        Parameters
        ----------
        kept : (n,) pairs that stay
        """
        own = kept[self.pairs]
        B = self.B[np.flatnonzero(np.tile(own, self.directions))]
        return replace(self, B=B, on_ranks=PairsHeld(self.rows, B, self.on_ranks.at[own]), **self.parts_among(kept))

    def _asked(self, load: IncrementLoad, forces: Array) -> Iterator[AskedOfPairs]:
        for rank in range(self.rows.team.size):
            own = self.on_ranks.owner == rank
            yield AskedOfPairs(
                load=replace(load, offset=load.offset[:, own], bound=load.bound.among(own)),
                forces=forces[:, own],
                tied=self.tied[own],
                stiffness=self.stiffness[own],
                compliance=self.compliance[:, own],
            )

    def _together(self, parts: Sequence[Array]) -> Any:
        """Values (..., a) of all pairs from those of every rank."""
        joined = np.concatenate(parts, axis=-1)
        result = np.empty_like(joined)
        result[..., np.argsort(self.on_ranks.owner, kind="stable")] = joined
        return result


def make_bodies_on_ranks(
    rows: RowsOnRanks,
    places_of: Callable[[IntArray], Array],
    B: sp.csr_array,
    interface: Interface,
    candidates: BoolArray,
) -> BodiesOnRanks:
    """Put pairs on bodies that are on all ranks.

    Parameters
    ----------
    rows : the bodies
    places_of : (k, d) where nodes (k,) are, length
    B : (d n, z) relative displacements of the pairs in terms of the free displacements
    interface : the pairs
    candidates : (n,) pairs that may touch
    """
    chosen = chosen_pairs(B, interface, candidates)
    held = PairsHeld(rows, chosen.B, places_of(interface.node[chosen.pairs]))
    felt = np.empty(len(held.owner))
    felt[np.argsort(held.owner, kind="stable")] = np.concatenate(held.felt)
    data = chosen.data(interface, with_supple(felt, interface, chosen.pairs))
    return BodiesOnRanks(**data, blocks=rows.blocks, rows=rows, B=chosen.B, on_ranks=held)
