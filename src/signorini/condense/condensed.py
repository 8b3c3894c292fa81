# SPDX-License-Identifier: BSD-3-Clause
"""The condensed interface in its image form: regular also where contact alone holds a body, for any compliance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.clock import Clock
from signorini.condense.ties import Springs, Ties, make_springs, make_ties
from signorini.interface.interface import Interface
from signorini.linalg.protocol import Factorisation, Reduced
from signorini.linalg.registry import factorise

# of the size of a row of B: below it supports hold what the row sees
_HELD = 1e-12


@dataclass(frozen=True, kw_only=True, eq=False)
class Condensed:
    """The bodies as their contact pairs feel them.

    With S the condensed stiffness on the contact dofs, ``u_c = B_c z_c`` the relative displacement, r the forces of
    the pairs and D a positive interface stiffness (any: it changes nothing but the conditioning),
    ``S z_c = f_c + B_c^T r`` becomes ``(I - A D^) u_c - A r = B_c (S + B_c^T D^ B_c)^-1 f_c`` with
    ``A = B_c (S + B_c^T D^ B_c)^-1 B_c^T``, which is regular where S is not. The interface compliance
    C = diag(c / area) is in series: h = u_c + C r + h_0 obeys the exact law, and

        G h - W r = b,    W = E A E + E C,   G = I - W D,   E = (I + D C)^-1,   D^ = D E,

    so that C = 0 (exact) and C -> infinity are both harmless. Everything here is scaled by the roots of D.

    Attributes
    ----------
    factorisation : of the bodies, with the contact dofs last
    W : (d a, 2 a) for the a active pairs, symmetric, spectrum in [0, 1]
    active : (n,) pairs that the law is asked of: candidates that can move along their normal
    held : (n,) pairs that cannot, because supports hold them
    root : (d a,) square roots of D, force per length to the 1/2
    dofs : (m,) the contact dofs among the free displacements
    compliance : (d a,) of the interface, C, length per force
    ties : tied pairs, which are no unknowns of the law: all displacements here leave them at rest
    B : (d a, m) relative displacements of the active pairs in terms of them, B_c
    """

    factorisation: Factorisation
    W: Array
    active: BoolArray
    held: BoolArray
    root: Array
    dofs: IntArray
    B: sp.csr_array
    compliance: Array
    ties: Ties
    _springs: Springs

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.factorisation.name

    @property
    def active_rows(self) -> IntArray:
        """Rows of B that belong to active pairs: normals, then tangents."""
        return np.nonzero(np.tile(self.active, self.directions))[0]

    @property
    def directions(self) -> int:
        """Rows a pair, d."""
        return len(self.root) // max(1, int(self.active.sum()))

    def reduce(self, f: Array) -> Reduced:
        """Loads (z,) on the free displacements, condensed onto the contact dofs."""
        return self.factorisation.reduce(f)

    def right_hand_side(self, f_c: Array, offset: Array, motions: Array) -> Array:
        """``b = E B_c (S + B_c^T D^ B_c)^-1 f_c + G h_0``, scaled.

        Parameters
        ----------
        f_c : (m,) condensed load
        offset : (d a,) h_0, length: initial gaps and minus the tangential displacements of the step before, each plus
            the relative displacement that supports prescribe
        motions : (d a, k) what the pairs see of the rigid motions that supports leave free, scaled: ``W R = R``
        """
        response = self._softening * (self.B @ self._solve(f_c))
        scaled = self.root * offset
        strain = scaled - self.W @ scaled
        # no gap loads a rigid motion, R' G = 0; rounding would, where gaps are large beside what the loads move
        strain -= motions @ np.linalg.lstsq(motions, strain)[0]
        result: Array = self.root * response + strain
        return result

    def displacement(self, reduced: Reduced, h: Array, r: Array, offset: Array) -> Array:
        """Free displacements (z,) under a load and the solution h, r (d a,), in the units of the problem."""
        if not len(self.dofs):
            return reduced.expand(reduced.load)
        moved = h - self.compliance * r - offset
        springs = self.root**2 * self._softening
        return reduced.expand(self._solve(reduced.load + self.B.T @ (r + springs * moved)))

    def among(self, kept: BoolArray) -> Condensed:
        """The same bodies with fewer pairs; no sparse matrix is factorised again.

        Parameters
        ----------
        kept : (n,) pairs that stay; together with the supports they hold the bodies

        Raises
        ------
        LinAlgError
            If they do not.
        """
        rows = np.tile(kept[self.active], self.directions)
        return _image(
            self.factorisation,
            self.B[rows],
            self.root[rows] ** 2,
            self.compliance[rows],
            active=self.active & kept,
            held=self.held,
            dofs=self.dofs,
            ties=self.ties,
        )

    @property
    def settled(self) -> BoolArray:
        """(n,) Pairs that the law need not be asked of, because supports or ties hold them."""
        settled = self.held.copy()
        settled[self.ties.rows % len(settled)] = True
        return settled

    @property
    def _softening(self) -> Array:
        return 1.0 / (1.0 + self.root**2 * self.compliance)

    def _solve(self, f_c: Array) -> Array:
        return self._springs.solve(f_c)


def condense(
    K: sp.csr_array,
    B: sp.csr_array,
    interface: Interface,
    nodes: IntArray,
    points: Array,
    *,
    candidates: BoolArray,
    backend: str,
    clock: Clock,
) -> Condensed:
    """Factorise the bodies once and condense them onto the contact pairs.

    Parameters
    ----------
    K : (z, z) stiffness of the free displacements
    B : (d n, z) relative displacements of the pairs in terms of them
    interface : the pairs
    nodes : (z,) node of each free displacement
    points : (nodes, d) where the nodes are
    candidates : (n,) pairs that may touch; the nodes of the others are eliminated like any other
    backend : of the factorisation, "auto" or a name
    clock : counts the factorisation and the condensation apart

    Raises
    ------
    NotPositiveDefinite
        If a part of a body can move without moving a contact node.
    """
    n = len(interface)
    size = np.sqrt(np.asarray(B.multiply(B).sum(axis=1)).ravel())
    B = sp.csr_array(sp.diags_array(np.where(size > _HELD, 1.0, 0.0)) @ B)
    B.eliminate_zeros()
    held = size[:n] <= _HELD
    active = candidates & ~held & ~interface.tied
    ties = make_ties(B, np.nonzero(interface.rows(interface.tied) & (size > _HELD))[0])
    B = B[np.nonzero(interface.rows(active))[0]]
    dofs = np.unique(np.concatenate([B.indices, ties.B.indices]))
    with clock.phase("factorisation"):
        factorisation = factorise(K, dofs, nodes=nodes, points=points, backend=backend)
    with clock.phase("condensation"):
        K_c = sp.csr_array(K[dofs][:, dofs])
        return _condense(factorisation, K_c, sp.csr_array(B[:, dofs]), interface, active, held, dofs, ties)


def _condense(
    factorisation: Factorisation,
    K_c: sp.csr_array,
    B_c: sp.csr_array,
    interface: Interface,
    active: BoolArray,
    held: BoolArray,
    dofs: IntArray,
    ties: Ties,
) -> Condensed:
    """From the contact dofs to the pairs."""
    pairs = np.nonzero(active)[0]
    stiffness = _interface_stiffness(K_c, B_c, interface, pairs)
    compliance = (interface.compliance / interface.areas)[interface.rows(active)]
    return _image(factorisation, B_c, stiffness, compliance, active=active, held=held, dofs=dofs, ties=ties)


def _image(
    factorisation: Factorisation,
    B_c: sp.csr_array,
    stiffness: Array,
    compliance: Array,
    *,
    active: BoolArray,
    held: BoolArray,
    dofs: IntArray,
    ties: Ties,
) -> Condensed:
    """The image form for a stiffness D and a compliance C of the interface, each (d a,)."""
    softening = 1.0 / (1.0 + stiffness * compliance)
    stiff = factorisation.schur() + (B_c.T @ sp.diags_array(stiffness * softening) @ B_c).toarray()
    springs = make_springs(stiff, ties.B[:, dofs].toarray())
    A = springs.compliance(B_c) if len(dofs) else np.zeros((0, 0))
    root = np.sqrt(stiffness)
    W = (root * softening)[:, None] * A * (root * softening)
    W[np.diag_indices_from(W)] += stiffness * softening * compliance
    return Condensed(
        factorisation=factorisation,
        W=0.5 * (W + W.T),
        active=active,
        held=held,
        root=root,
        dofs=dofs,
        B=B_c,
        compliance=compliance,
        ties=ties,
        _springs=springs,
    )


def _interface_stiffness(K_c: sp.csr_array, B_c: sp.csr_array, interface: Interface, pairs: IntArray) -> Array:
    """D, (d a,) force per length: of the size that makes Newton's method most robust, equal in all directions.

    Half the mean stiffness that a pair of the contact feels where only its own nodes move, spread like the areas and
    divided by the root of their number (between the stiffness of a node and that of the whole surface).
    """
    felt = (B_c @ K_c).multiply(B_c).sum(axis=1)[: len(pairs)]
    result = np.zeros(len(pairs))
    for contact in np.unique(interface.contact[pairs]):
        own = interface.contact[pairs] == contact
        area = interface.area[pairs][own]
        result[own] = 0.5 * felt[own].mean() / np.sqrt(own.sum()) * area / area.mean()
    return np.tile(result, interface.directions)
