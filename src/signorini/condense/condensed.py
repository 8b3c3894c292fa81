# SPDX-License-Identifier: BSD-3-Clause
"""The condensed interface in its image form: regular also where contact alone holds a body, for any compliance."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray, IntArray
from signorini.clock import Clock
from signorini.condense.basis import Basis, make_basis
from signorini.condense.body_blocks import make_body_blocks
from signorini.condense.kept import Kept, interface_stiffness
from signorini.condense.operator import InterfaceOperator
from signorini.condense.response import ByNodes, Response, keep_pairs
from signorini.condense.ties import Ties
from signorini.dense import solve_triangular
from signorini.interface.active import FreeBodies, active_pairs
from signorini.interface.interface import Interface
from signorini.linalg.elsewhere import is_elsewhere
from signorini.linalg.plan import Plans
from signorini.linalg.protocol import Factorisation, NotPositiveDefinite, Reduced
from signorini.linalg.registry import factorise, takes_borders
from signorini.sparse_rows import chosen_columns, chosen_rows

_LOOSE_COMPLIANCE = 1e14  # of 1 / D: a compliance from which bodies held by contact alone are as good as free


@dataclass(frozen=True, kw_only=True, eq=False)
class Condensed:
    """The bodies as their contact pairs feel them.

    With S the condensed stiffness on the contact dofs, ``u_c = B_c z_c`` the relative displacement and r the forces of
    the pairs, ``S z_c = f_c + B_c^T r``. The interface compliance C = diag(c / area) is in series: h = u_c + C r + h_0
    obeys the exact law. With Z the rigid motions that nothing but contact resists and S~ = S held by springs on Z (see
    `condense.body_blocks`)

        h = X r + B_c S~^-1 f_c + h_0 + B_c Z a,    X = B_c S~^-1 B_c^T + C,    Z^T (f_c + B_c^T r) = 0.

    Scaled by the roots of an interface stiffness D (any: it changes nothing but the conditioning) and with R an
    orthonormal basis of B_c Z, P = I - R R^T, this is ``G h - W r = b`` with

        A = P X P,    G = I - W = (I + A)^-1 - R R^T,    R^T b = the resultants of f_c,

    so that C = 0 (exact), C -> infinity and bodies held by contact alone are all harmless.

    Attributes
    ----------
    response : how the bodies answer, through what their factorisation keeps last
    image : A, W and the rigid motions B_c Z of the a active pairs, d rows each, scaled
    active : (n,) pairs that the law is asked of: candidates that can move along their normal
    held : (n,) pairs that cannot, because supports hold them
    root : (a,) square roots of D, in all directions the same, force per length to the 1/2
    dofs : (m,) the contact dofs among the free displacements
    compliance : (d, a) of the interface, C, length per force
    ties : tied pairs, which are no unknowns of the law: all displacements here leave them at rest; None where none is
    B : (d a, m) relative displacements of the active pairs in terms of them, B_c
    K : (m, m) stiffness between the contact dofs where all others are held
    """

    response: Response
    image: InterfaceOperator
    active: BoolArray
    held: BoolArray
    root: Array
    dofs: IntArray
    B: sp.csr_array
    compliance: Array
    ties: Ties | None
    K: sp.csr_array
    _basis: Basis
    _leaning: Array

    @property
    def factorisation(self) -> Factorisation:
        """Of the bodies."""
        return self.response.factorisation

    @property
    def name(self) -> str:
        """Of the back end, for reports."""
        return self.factorisation.name

    def reduce(self, f: Array) -> Reduced:
        """Loads (z,) or (z, k) on the free displacements, condensed onto what is kept."""
        return self.response.reduce(f)

    def right_hand_side(self, load: Array, offset: Array) -> Array:
        """b of ``G h - W r = b``, scaled.

        Parameters
        ----------
        load : condensed, see `reduce`
        offset : (d, a) h_0, length: initial gaps and minus the tangential displacements of the step before, each plus
            the relative displacement that supports prescribe
        """
        basis = self._basis
        resultant = basis.coefficients(self.response.resultant(load))
        free = self.root * (self.response.moved(load).reshape(offset.shape) + offset)
        return self.image.load(free.ravel() - self._leaning @ resultant, resultant)

    def free(self, motion: Array, resultant: Array) -> Array:
        """(p, d a + k) Scaled motions of the pairs without their rigid part, and scaled resultants: linear in both.

        Parameters
        ----------
        motion : (p, d, a) of the pairs where no force acts on them, length
        resultant : (p, k) work of the loads on the rigid motions
        """
        coefficients, R = self._basis.coefficients(resultant.T).T, self.image.R
        c = (self.root * motion).reshape(len(motion), -1) - coefficients @ self._leaning.T
        return np.concatenate([c - (c @ R) @ R.T, coefficients], axis=1)

    def free_transposed(self, free: Array) -> tuple[Array, Array]:
        """The transpose of `free`, of functionals (p, d a + k): in motions (p, d, a) and in resultants (p, k)."""
        R, rows = self.image.R, self.compliance.size
        c = free[:, :rows] - (free[:, :rows] @ R) @ R.T
        resultant: Array = free[:, rows:] - c @ self._leaning
        if R.shape[1]:
            resultant = solve_triangular(self._basis.triangle, resultant.T).T
        return self.root * c.reshape(-1, *self.compliance.shape), resultant

    def travel(self, left: Array) -> Array:
        """(k,) Rigid motion of relative displacements (d a,) of the pairs, length, beyond what deforms the bodies.

        Of several at once (k, p) of (d a, p).
        """
        scaled = (np.tile(self.root, len(self.compliance)) * left.T).T
        return solve_triangular(self._basis.triangle, self._basis.R.T @ scaled)

    def travel_transposed(self, travel: Array) -> Array:
        """(d a,) The transpose of `travel`."""
        seen = self._basis.R @ solve_triangular(self._basis.triangle, travel, transposed=True)
        return np.tile(self.root, len(self.compliance)) * seen

    def of_gaps(self, gap: Array) -> Array:
        """What gaps (a,), length, of the active pairs add to b: nothing of the bodies is asked."""
        moved = np.zeros_like(self.compliance)
        moved[0] = self.root * gap
        return self.image.load(moved.ravel(), np.zeros(self.image.R.shape[1]))

    def displacement(self, reduced: Reduced, h: Array, r: Array, offset: Array) -> Array:
        """Free displacements (z,) under a load and the solution h, r (d, a), in the units of the problem.

        Parameters
        ----------
        reduced : the load, see `reduce`
        h, r : (d, a) relative displacements, length, and forces; for k loads at once (d, a, k)
        offset : (d, a) h_0, see `right_hand_side`
        """
        if not len(self.dofs):
            return reduced.expand(reduced.load)

        beyond = self.beyond_forces(h, r, offset)
        return self.response.displacement(reduced, r.reshape(beyond.shape), lambda moved: self.travel(beyond - moved))

    def beyond_forces(self, h: Array, r: Array, offset: Array) -> Array:
        """(d a,) Of relative displacements ``h - C r - h_0``, what the bodies do; for k loads at once (d a, k).

        Parameters
        ----------
        h, r, offset : (d, a) or (d, a, k), as of `displacement`
        """
        beyond: Array = (h.T - self.compliance.T * r.T - offset.T).T  # directions last
        return beyond.reshape(self.compliance.size, *r.shape[2:])

    def on_springs(self, f: Array) -> Array:
        """Free displacements (z,) under loads (z,) where springs of stiffness D hold every pair, closed or not.

        Then r = -h, and ``G h - W r = b`` says h = b: what bodies do that are held, without asking how contact does it.
        """
        reduced, offset = self.reduce(f), np.zeros_like(self.compliance)
        b = self.right_hand_side(reduced.load, offset).reshape(offset.shape)
        return self.displacement(reduced, b / self.root, -self.root * b, offset)

    def among(self, kept: BoolArray) -> Condensed:
        """Bodies with fewer pairs; no sparse matrix is factorised again.

        Parameters
        ----------
        kept : (n,) pairs that stay; together with the supports they hold the bodies

        Raises
        ------
        LinAlgError
            If they do not.
        """
        own = kept[self.active]
        root, compliance = self.root[own], self.compliance[:, own]
        rows = np.tile(own, len(compliance))
        response = self.response.among(rows)
        return replace(
            self,
            response=response,
            active=self.active & kept,
            root=root,
            B=chosen_rows(self.B, rows),
            compliance=compliance,
            **_image(response, root, compliance),
        )

    def closing(self, compliance: Array) -> Condensed:
        """Bodies whose interface gives way otherwise along its normals, (a,) length per force; K stays factorised."""
        both = np.concatenate([compliance[None], self.compliance[1:]])
        return replace(self, compliance=both, **_image(self.response, self.root, both))

    def paired(self, B: sp.csr_array, interface: Interface, stiffness: float, reach: float) -> Condensed:
        """Bodies whose pairs are others; nothing is factorised again.

        Where contact alone holds a body pairs that are far from it see the most of how it turns: with D as it is they
        would have nearly all of an orthonormal R, and resultants of the pairs that press few digits.

        Parameters
        ----------
        B : (d n, z) relative displacements of the pairs in terms of the free displacements, all of them kept ones
        interface : the pairs, as many as before; those that were tied are as they were
        stiffness : as of `condense`
        reach : gap, length, beyond which D falls with its square
        """
        assert isinstance(self.response, ByNodes)
        seen, _, held, active = active_pairs(B, interface, np.ones(len(interface), np.bool_))
        B_c = chosen_columns(chosen_rows(seen, interface.rows(active)), self.dofs)
        response = replace(self.response, B=B_c)
        near = np.minimum(1.0, reach / np.maximum(interface.gap[active], reach)) if response.rigid.size else None
        return replace(self, held=held, **_seen_by(active, interface, response, (self.K, B_c), stiffness, near))

    def moving(self, ways: Array) -> Condensed:
        """Bodies of whose k rigid motions only some combinations (k, m) occur: springs hold the others."""
        response = self.response.moving(ways)
        return replace(self, response=response, **_image(response, self.root, self.compliance))


def condense(
    bodies: FreeBodies,
    interface: Interface,
    *,
    kept: Kept,
    rigid: Array,
    stiffness: float,
    backend: str,
    clock: Clock,
    plans: Plans | None = None,
) -> Condensed:
    """Factorise the bodies once and condense them onto the contact pairs.

    Parameters
    ----------
    bodies : as they are
    interface : the pairs
    kept : what is kept of them for the pairs
    rigid : (z, k) rigid motions that neither supports nor ties resist
    stiffness : of the size of the data, force per length: what pairs count with whose sides are both rigid
    backend : of the factorisation, "auto" or a name
    clock : counts the factorisation and the condensation apart
    plans : see :func:`signorini.linalg.registry.factorise`

    Raises
    ------
    NotPositiveDefinite
        If a part of a body can move without moving a contact node.
    LinAlgError
        If contact hardly holds a body that nothing else holds.
    """
    K, nodes, points = bodies.K, bodies.nodes, bodies.points
    B, dofs, ties, active = kept.B, kept.dofs, kept.ties, kept.active
    response: Response | None = None
    with clock.phase("factorisation"):
        by_nodes = interface.directions == 2 or ties is not None or len(bodies.kept)
        if not by_nodes and B.shape[0] and (is_elsewhere(K) or takes_borders(backend)):
            at = points[interface.node[active]]
            with suppress(NotPositiveDefinite):  # the contact may still hold what moves
                seen = bodies._replace(B=B)
                response = keep_pairs(seen, at=at, rigid=rigid, stiffness=stiffness, backend=backend, plans=plans)
        if response is None:
            factorisation = factorise(K, dofs, nodes=nodes, points=points, backend=backend, plans=plans)
    with clock.phase("condensation"):
        B_c, K_c = kept.contact, kept.block(K)
        if response is None:
            size = float(K_c.diagonal().mean()) if K_c.nnz else stiffness
            S, factorisation = factorisation.parted()
            parts = make_body_blocks(S, kept.tied, rigid[dofs], size=size)
            del S
            parts = parts.inverted() if len(bodies.kept) else parts
            response = ByNodes(factorisation=factorisation, parts=parts, B=B_c, rigid=rigid[dofs])
        found = _seen_by(active, interface, response, (K_c, B_c), stiffness, room=response.room)
        return Condensed(held=kept.held, dofs=dofs, ties=ties, K=K_c, **found)


def _seen_by(
    active: BoolArray,
    interface: Interface,
    response: Response,
    contact: tuple[sp.csr_array, sp.csr_array],
    stiffness: float,
    near: Array | None = None,
    room: Array | None = None,
) -> dict[str, Any]:
    """What active pairs make of the response of the bodies, as fields of `Condensed`; the arguments as there.

    Parameters
    ----------
    active, interface, response, stiffness : as of `Condensed` and `condense`
    contact : K between the contact dofs, and B of the active pairs
    near : (a,) by what roots of D are less; None: by nothing
    room : of a response that nobody has asked for it, see `InterfaceOperator.of_compliance`
    """
    K, B = contact
    root = np.sqrt(interface_stiffness(K, B, interface, np.flatnonzero(active), stiffness))
    root = root if near is None else near * root
    compliance = interface.compliance[:, active]
    image = _image(response, root, compliance, room)
    return {"response": response, "active": active, "root": root, "B": B, "compliance": compliance, **image}


def _image(response: Response, root: Array, compliance: Array, room: Array | None = None) -> dict[str, Any]:
    """Compliance and rigid motions, scaled by the roots of D."""
    scale = np.tile(root, len(compliance))
    motions = scale[:, None] * response.motions
    basis = make_basis(motions)
    A = response.compliance()
    A *= scale
    A *= scale[:, None]
    A[np.diag_indices_from(A)] += (root**2 * compliance).ravel()
    if basis.R.size and A.diagonal().max(initial=0.0) > _LOOSE_COMPLIANCE:
        raise np.linalg.LinAlgError("contact hardly resists a rigid motion")
    leaning = basis.project(A)
    A.flags.writeable = motions.flags.writeable = False
    image = InterfaceOperator.of_compliance(A, motions, basis.R, room)
    return {"image": image, "_basis": basis, "_leaning": leaning}
