# SPDX-License-Identifier: BSD-3-Clause
"""Pairs that the law is asked of and unknowns that are kept for them: what of a condensation no stiffness changes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray, distinct
from signorini.condense._kernels import block_on, felt_stiffness
from signorini.condense.ties import Ties, make_ties
from signorini.interface.active import FreeBodies, active_pairs, with_supple
from signorini.interface.interface import Interface
from signorini.linalg.elsewhere import is_elsewhere
from signorini.sparse_rows import chosen_columns, chosen_rows, rows_of


@dataclass(frozen=True, kw_only=True, eq=False)
class Kept:
    """What is kept of the bodies for their pairs, whatever their stiffness.

    Attributes
    ----------
    held : (n,) pairs that cannot move along their normal, because supports hold them
    active : (n,) pairs that the law is asked of
    ties : tied pairs; None where supports hold all that is tied, or nothing is
    B : (d a, z) relative displacements of the active pairs in terms of the free displacements
    dofs : (m,) free displacements that pairs see
    contact : (d a, m) B in terms of them
    tied : (t, m) relative displacements of the ties in terms of them
    """

    held: BoolArray
    active: BoolArray
    ties: Ties | None
    B: sp.csr_array
    dofs: IntArray
    contact: sp.csr_array
    tied: Array

    @staticmethod
    def of(bodies: FreeBodies, interface: Interface, candidates: BoolArray) -> Kept:
        """What is kept of bodies; their stiffness is not looked at.

        Parameters
        ----------
        bodies, interface : with the pairs
        candidates : (n,) pairs that may touch; the nodes of the others are eliminated like any other
        """
        seen, moves, held, active = active_pairs(bodies.B, interface, candidates)
        rows = np.nonzero(interface.rows(interface.tied) & moves)[0]
        ties = make_ties(seen, rows) if len(rows) else None
        B = chosen_rows(seen, interface.rows(active))
        of_ties = bodies.kept[:0] if ties is None else ties.B.indices
        dofs = distinct(np.concatenate([B.indices, of_ties, bodies.kept]))
        contact = chosen_columns(B, dofs)
        tied = np.zeros((0, len(dofs))) if ties is None else chosen_columns(ties.B, dofs).toarray()
        return Kept(held=held, active=active, ties=ties, B=B, dofs=dofs, contact=contact, tied=tied)

    def block(self, K: sp.csr_array) -> sp.csr_array:
        """(m, m) The stiffness between what is kept where all else is held, of one on the free displacements (z, z)."""
        K = K.rows(self.dofs) if is_elsewhere(K) else K
        place = np.full(K.shape[0], -1, np.int64)
        place[self.dofs] = np.arange(len(self.dofs))
        data, indices, indptr = block_on(K.indptr, K.indices, K.data, self.dofs, place)
        return rows_of(data, indices, indptr, (len(self.dofs),) * 2)


def interface_stiffness(
    K_c: sp.csr_array, B_c: sp.csr_array, interface: Interface, pairs: IntArray, stiffness: float
) -> Array:
    """D, (a,) force per length: of the size that makes Newton's method most robust, equal in all directions.

    Half the mean stiffness that a pair of the contact feels where only its own nodes move, spread like the areas and
    divided by the root of their number (between the stiffness of a node and that of the whole surface). Of sides that
    differ much the soft one counts: no more than four times what both are in series, which is the sum of equal ones.

    Parameters
    ----------
    K_c, B_c : stiffness and relative displacements of the active pairs, in terms of the contact dofs
    interface, pairs : all pairs, and the numbers (a,) of the active ones
    stiffness : of the size of the data, where both sides are rigid
    """
    begin, column = (places.astype(np.int32, copy=False) for places in (B_c.indptr, B_c.indices))  # one type of them
    felt, gives = felt_stiffness(begin, column, B_c.data, K_c.indptr, K_c.indices, K_c.data, len(pairs))
    felt = np.minimum(felt, np.divide(4.0, gives, out=np.full_like(gives, np.inf), where=gives > 0.0))
    felt = with_supple(felt, interface, pairs)
    felt[felt == 0.0] = stiffness  # both sides are rigid, and nothing gives way
    result = np.zeros(len(pairs))
    for contact in distinct(interface.contact[pairs]):
        own = interface.contact[pairs] == contact
        area = interface.area[pairs][own]
        result[own] = 0.5 * felt[own].mean() / np.sqrt(own.sum()) * area / area.mean()
    return result
