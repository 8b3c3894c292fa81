# SPDX-License-Identifier: BSD-3-Clause
"""Bodies and the pairs of their contacts as they are, nothing factorised or condensed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.interface.active import FreeBodies, active_pairs, with_supple
from signorini.interface.interface import Interface
from signorini.iterative.blocks import Blocks, make_blocks
from signorini.iterative.direct import Direct
from signorini.iterative.multigrid import Multigrid

ITERATIVE = "iterative"
"""The name of this way among the back ends."""

_ENDLESS_PATIENCE = 10**6  # rounds
_SHARP_AIM = 1e-12  # of the sizes of the data: what bodies that are hardly loaded bear, and thin ones bend by
_SPRING_RATIO = 4.0  # springs of closed pairs, of what their nodes feel: multipliers then converge by as much a round


class Preconditioner(Protocol):
    """What makes conjugate gradients fast: multigrid, or factors."""

    def under(self, springs: sp.csr_array) -> Callable[[Array], Array]:
        """An approximate solution x of ``(K + springs) x = b``, symmetric in b, for springs (b, b) of contacts."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bodies:
    """Stiffness and pairs in blocks of nodes.

    Attributes
    ----------
    K : (b, b) stiffness, padded to whole blocks
    B : (d a, b) relative displacements of the pairs that the law is asked of
    pairs : (a,) their numbers
    tied : (a,) those that neither slip nor open
    active, held : (n,) pairs that the law is asked of; pairs that supports hold
    stiffness : (a,) D of the springs that trial forces are made with, in all directions, force per length
    compliance : (d, a) of the interface, length per force
    rest : (a,) closure that the interface has without force, length, in series as well; None for none
    rigid : (b, k) rigid motions of all parts
    blocks : of the unknowns
    preconditioner : shared by all loads
    patience : rounds after which an increment is given up whose residual has not halved
    aim : residual down to which rounds go on that need not, as long as it falls
    name : for reports
    """

    K: sp.bsr_array
    B: sp.csr_array
    pairs: IntArray
    tied: BoolArray
    active: BoolArray
    held: BoolArray
    stiffness: Array
    compliance: Array
    rigid: sp.csr_array
    blocks: Blocks
    preconditioner: Preconditioner
    patience: int = _ENDLESS_PATIENCE
    aim: float = np.inf
    name: str = ITERATIVE
    rest: Array | None = None

    @property
    def directions(self) -> int:
        """Rows a pair, d."""
        return self.blocks.size

    def rested(self, offset: Array) -> Array:
        """(d, a) Motions of the pairs that loads do not cause, with what the interface has closed without force."""
        return offset if self.rest is None else np.concatenate([offset[:1] + self.rest, offset[1:]])

    def closing(self, compliance: Array, rest: Array) -> Bodies:
        """Bodies whose interface closes otherwise along its normals.

        Parameters
        ----------
        compliance, rest : (a,) length per force, and what it has closed without force, length
        """
        both = np.concatenate([compliance[None], self.compliance[1:]])
        return replace(self, compliance=both, rest=rest)

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
        return replace(self, preconditioner=direct, patience=patience, aim=_SHARP_AIM)

    def among(self, kept: BoolArray) -> Bodies:
        """Bodies with fewer pairs.

        Parameters
        ----------
        kept : (n,) pairs that stay
        """
        own = kept[self.pairs]
        return replace(
            self,
            B=self.B[np.flatnonzero(np.tile(own, self.directions))],
            pairs=self.pairs[own],
            tied=self.tied[own],
            active=self.active & kept,
            stiffness=self.stiffness[own],
            compliance=self.compliance[:, own],
            rest=None if self.rest is None else self.rest[own],
        )


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
    n, d = len(interface), interface.directions
    K, B, nodes, points = free[:4]
    seen, moves, held, active = active_pairs(B, interface, candidates)
    pairs = np.flatnonzero(active | (interface.tied & moves.reshape(d, n).any(axis=0)))
    own = sp.csr_array(seen[np.concatenate([pairs + k * n for k in range(d)])])
    blocks = make_blocks(nodes, axis, d)
    matrix = blocks.matrix(K)
    felt = np.asarray((own @ K).multiply(own).sum(axis=1)).ravel().reshape(d, -1).max(axis=0, initial=0.0)
    felt = with_supple(felt, interface, pairs)
    near_null = blocks.spread(_near_null(points, nodes, axis, d))
    return Bodies(
        K=matrix,
        B=blocks.columns(own),
        pairs=pairs,
        tied=interface.tied[pairs],
        active=active,
        held=held,
        stiffness=_SPRING_RATIO * felt,
        compliance=interface.compliance[:, pairs],
        rigid=sp.csr_array(blocks.columns(sp.csr_array(rigid.T)).T),
        blocks=blocks,
        preconditioner=Multigrid(matrix, near_null),
    )


def _near_null(points: Array, nodes: IntArray, axis: IntArray, d: int) -> Array:
    """(z, k) Translations and small rotations of everything together; what has no place only moves along.

    Of bodies of revolution those of their meridian, a ring that twists in its plane, and the turn about the axis.
    """
    on_mesh = (nodes < len(points))[:, None]
    centre = points.mean(axis=0)
    arm = np.where(on_mesh, points[np.minimum(nodes, len(points) - 1)] - centre, 0.0)
    arm /= np.abs(arm).max(initial=0.0) or 1.0
    modes = [axis == j for j in range(d)]
    rows = np.arange(len(axis))
    for j in range(points.shape[1]):
        for k in range(j):
            turned = np.zeros((len(axis), d))
            turned[:, j], turned[:, k] = arm[:, k], -arm[:, j]
            modes.append(turned[rows, axis])
    if d > points.shape[1]:
        modes.append(np.where(axis == 2, arm[:, 0], 0.0))
    return np.column_stack(modes).astype(np.float64)
