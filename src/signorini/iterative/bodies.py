# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and the pairs of their contacts as they are, nothing factorised or condensed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, distinct
from signorini.interface.active import FreeBodies, with_supple
from signorini.interface.interface import Interface
from signorini.iterative.blocks import make_blocks
from signorini.iterative.direct import Direct
from signorini.iterative.multigrid import Multigrid
from signorini.iterative.pairs import IteratedPairs, chosen_pairs
from signorini.iterative.pressed import IncrementLoad
from signorini.iterative.solve import solve_iteratively
from signorini.iterative.springs import PairSprings
from signorini.law.result import ContactAnswer
from signorini.linalg.krylov import conjugate_gradients
from signorini.linalg.symmetric_blocks import SymmetricBlocks

ITERATIVE = "iterative"
"""The name of this way among the back ends."""

_SPRING_SHARE = 0.25  # of the springs of pairs: what is left of them where multigrid has to bear them
_SHARP_AIM = 1e-12  # of the sizes of the data: what bodies that are hardly loaded bear, and thin ones bend by


class Preconditioner(Protocol):
    """What makes conjugate gradients fast: multigrid, or factors."""

    def under(self, B: sp.csr_array, springs: PairSprings) -> Callable[[Array], Array]:
        """An approximate solution x of ``(K + B' S B) x = b``, symmetric in b, for springs S of pairs, motions B."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bodies(IteratedPairs):
    """Stiffness and pairs in blocks of nodes, all in this process; see `PressedBodies`.

    Attributes
    ----------
    K : (b, b) stiffness, padded to whole blocks
    B : (d a, b) relative displacements of the pairs that the law is asked of
    rigid : (b, k) rigid motions of all parts
    preconditioner : shared by all loads
    aim : residual down to which rounds go on that need not, as long as it falls
    """

    K: SymmetricBlocks
    B: sp.csr_array
    rigid: sp.csr_array
    preconditioner: Preconditioner
    aim: float = np.inf
    name: str = ITERATIVE

    def answered(self, load: IncrementLoad, free: Array, forces: Array) -> tuple[ContactAnswer, Array]:
        """Solve one increment, see `IteratedPairs.answered`.

        Parameters
        ----------
        load, free, forces : as there
        """
        spread = self.blocks.spread
        answer, z = solve_iteratively(self, replace(load, f=spread(load.f)), spread(free), forces)
        return answer, z[self.blocks.place]

    @property
    def whole(self) -> bool:
        """Unless factors serve, with which rounds go on to the last digits."""
        return not np.isfinite(self.aim)

    @cached_property
    def moves(self) -> BoolArray:
        """(d, a) Rows of B that see anything."""
        return np.asarray(np.diff(self.B.indptr).reshape(self.directions, -1) > 0)

    @cached_property
    def _transposed(self) -> sp.csr_array:
        return self.B.T.tocsr()

    def internal(self, z: Array) -> Array:
        """(b,) Forces K z."""
        return np.asarray(self.K @ z)

    def seen(self, z: Array) -> Array:
        """(d, a) Motions B z of the pairs."""
        return np.asarray(self.B @ z).reshape(self.directions, -1)

    def pushed(self, forces: Array) -> Array:
        """(b,) Forces of the pairs on the bodies."""
        return np.asarray(self._transposed @ forces.ravel())

    def resultants(self, forces: Array) -> Array:
        """(k,) Work of forces on the rigid motions of all parts."""
        return np.asarray(self.rigid.T @ forces)

    def total(self, values: Any) -> Any:
        """The values: all of them are here."""
        return values

    def most(self, value: float) -> float:
        """The value as well."""
        return value

    def preconditioner_under(self, springs: PairSprings) -> Callable[[Array], Array]:
        """What makes conjugate gradients fast under springs in the pairs."""
        return self.preconditioner.under(self.B, springs)

    def solved(
        self, springs: PairSprings, preconditioner: Callable[[Array], Array], g: Array, residual: float
    ) -> tuple[Array, int]:
        """Displacements under forces by conjugate gradients, see `PressedBodies.solved`.

        Parameters
        ----------
        springs, preconditioner, g, residual : as there
        """

        def product(v: Array) -> Array:
            return self.internal(v) + self.pushed(springs.forces(self.seen(v)))

        return conjugate_gradients(product, preconditioner, g, residual)

    def factored(self, nodes: IntArray, points: Array, *, patience: int) -> Bodies:
        """Bodies with factors in place of multigrid: thin bodies and flat cells cost those nothing.

        Parameters
        ----------
        nodes : (z,) node of each free displacement
        points : (nodes, d) where they are
        patience : see `Bodies`; rounds take several factorisations each
        """
        known = np.unique(nodes)
        direct = Direct(self.K, np.repeat(known, self.blocks.size), points)
        stiffness = self.stiffness / _SPRING_SHARE
        return replace(self, preconditioner=direct, stiffness=stiffness, patience=patience, aim=_SHARP_AIM)

    def among(self, kept: BoolArray) -> Bodies:
        """Bodies with fewer pairs.

        Parameters
        ----------
        kept : (n,) pairs that stay
        """
        rows = np.flatnonzero(np.tile(kept[self.pairs], self.directions))
        return replace(self, B=self.B[rows], **self.parts_among(kept))


def make_bodies(
    free: FreeBodies, interface: Interface, axis: IntArray, *, rigid: sp.csr_array, candidates: BoolArray
) -> Bodies:
    """Put bodies and pairs into blocks.

    Parameters
    ----------
    free : as they are; the points are those of the mesh, rigid obstacles have none
    interface : the pairs
    axis : (z,) direction of each free displacement
    rigid : (z, k) rigid motions of all parts
    candidates : (n,) pairs that may touch
    """
    d = interface.directions
    K, B, nodes, points = free[:4]
    chosen = chosen_pairs(B, interface, candidates)
    blocks = make_blocks(nodes, axis, d)
    matrix, motions = blocks.matrix(K), blocks.columns(chosen.B)
    felt = _felt(chosen.B, K).reshape(d, -1).max(axis=0, initial=0.0)
    near = blocks.spread(near_null(arms(points, nodes), axis, d))
    return Bodies(
        **chosen.data(interface, _SPRING_SHARE * with_supple(felt, interface, chosen.pairs)),
        K=matrix,
        B=motions,
        rigid=sp.csr_array(blocks.columns(sp.csr_array(rigid.T)).T),
        blocks=blocks,
        preconditioner=Multigrid(matrix, near, motions),
    )


def _felt(B: sp.csr_array, K: sp.csr_array) -> Array:
    """(m,) ``b K b'`` of every row b of B; only what of K is between the unknowns that some row sees is looked at."""
    seen = distinct(B.indices)
    rows = sp.csr_array(B[:, seen])
    return np.asarray((rows @ K[seen][:, seen]).multiply(rows).sum(axis=1)).ravel()


def arms(points: Array, nodes: IntArray) -> Array:
    """(z, d) Of free displacements from the centre of all points, the longest 1; of what has no place none.

    Parameters
    ----------
    points : (n, d) of the nodes of the mesh, length
    nodes : (z,) node of each free displacement
    """
    on_mesh = (nodes < len(points))[:, None]
    arm = np.where(on_mesh, points[np.minimum(nodes, len(points) - 1)] - points.mean(axis=0), 0.0)
    arm /= np.abs(arm).max(initial=0.0) or 1.0
    return arm


def near_null(arm: Array, axis: IntArray, d: int) -> Array:
    """(z, k) Translations and small rotations of everything together; what has no place only moves along.

    Of bodies of revolution those of their meridian, a ring that twists in its plane, and the turn about the axis.

    Parameters
    ----------
    arm : (z, 2 or 3) see `arms`
    axis : (z,) direction of each free displacement
    d : directions
    """
    modes = [axis == j for j in range(d)]
    rows = np.arange(len(axis))
    for j in range(arm.shape[1]):
        for k in range(j):
            turned = np.zeros((len(axis), d))
            turned[:, j], turned[:, k] = arm[:, k], -arm[:, j]
            modes.append(turned[rows, axis])
    if d > arm.shape[1]:
        modes.append(np.where(axis == 2, arm[:, 0], 0.0))
    return np.column_stack(modes).astype(np.float64)
