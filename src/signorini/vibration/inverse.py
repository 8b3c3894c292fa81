# SPDX-License-Identifier: BSD-3-Clause
"""``(K + s M)^-1`` under the constraints of a joint, on one factorisation for all joints.

The displacements of the pairs that touch are kept last. On them the condensed matrix S takes the springs of compliant
pairs, ``S + B_s^T C^-1 B_s``, and what holds rigidly, ``B_r u = 0``, takes multipliers: both dense, and small.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from signorini.arrays import Array, IntArray
from signorini.condense.ties import Ties, make_ties
from signorini.errors import InputError
from signorini.linalg.protocol import Factorisation, NotPositiveDefinite
from signorini.linalg.registry import factorise
from signorini.model.modes import STUCK
from signorini.vibration.bodies import VibratingBodies

_SHIFT = 1e-3
"""Of the omega^2 of stretching: well below what vibrates in it, and enough to hold what nothing else holds."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ShiftedBodies:
    """``K + s M``, factorised.

    Attributes
    ----------
    bodies : without the constraints of joints
    shift : s, angle^2 per time^2
    dofs : (m,) free displacements of the pairs that touch, kept last
    factor : of the others
    """

    bodies: VibratingBodies
    shift: float
    dofs: IntArray
    factor: Factorisation

    @cached_property
    def triangle(self) -> Array:
        """(m, m) Cholesky's factor of the condensed matrix, without springs of compliant pairs."""
        S = self.factor.schur()
        return np.asarray(np.linalg.cholesky(S) if len(S) else S, dtype=np.float64)


def shifted(bodies: VibratingBodies) -> ShiftedBodies:
    """Factorise bodies for all states of their joints.

    Raises
    ------
    InputError
        If something has neither mass nor stiffness.
    """
    shift = _SHIFT * bodies.stretch
    dofs = np.unique(bodies.B[bodies.rows(STUCK)].indices)
    A = sp.csr_array(bodies.K + shift * bodies.M)
    nodes = bodies.constraints.nodes
    try:
        factor = factorise(A, dofs, nodes=nodes, points=bodies.space.places)
    except NotPositiveDefinite as error:
        words = f"something moves at node {nodes[error.dof] + 1} that has neither mass nor stiffness"
        raise InputError(words) from error
    return ShiftedBodies(bodies=bodies, shift=shift, dofs=dofs, factor=factor)


@dataclass(frozen=True, kw_only=True, eq=False)
class JointInverse:
    """The inverse of ``K + s M``, springs of the joint included, on displacements with ``B_r u = 0``.

    Attributes
    ----------
    shifted : the bodies
    K : (z, z) stiffness with the springs of the joint
    ties : what the joint holds rigidly
    """

    shifted: ShiftedBodies
    K: sp.csr_array
    ties: Ties
    _chol: Array
    _held: Array
    _gram: Array

    @staticmethod
    def of(shifted: ShiftedBodies, joint: str) -> JointInverse:
        """Of bodies with a joint in a state."""
        bodies, dofs = shifted.bodies, shifted.dofs
        rows = bodies.rows(joint)
        compliance = bodies.compliance.ravel()[rows]
        springs = bodies.B[rows[compliance > 0.0]]
        scaled = sp.diags_array(1.0 / compliance[compliance > 0.0]) @ springs
        ties = make_ties(bodies.B, rows[compliance == 0.0])
        stiff = sp.csr_array(springs.T @ scaled)
        chol = shifted.triangle
        if stiff.nnz:
            chol = np.linalg.cholesky(shifted.factor.schur() + stiff[dofs][:, dofs].toarray())
        held = ties.B[:, dofs].toarray().T
        held = _forward(chol, held) if held.size else held
        gram = np.linalg.cholesky(held.T @ held) if held.size else np.zeros((0, 0))
        K = sp.csr_array(bodies.K + stiff) if stiff.nnz else bodies.K
        return JointInverse(shifted=shifted, K=K, ties=ties, _chol=chol, _held=held, _gram=gram)

    def __call__(self, f: Array) -> Array:
        """Displacements (z,) or (z, k) under forces."""
        reduced = self.shifted.factor.reduce(f)
        if not len(self.shifted.dofs):
            return reduced.expand(reduced.load)
        y = _forward(self._chol, reduced.load)
        if self._held.size:
            y = y - self._held @ scipy.linalg.cho_solve((self._gram, True), self._held.T @ y, check_finite=False)
        return reduced.expand(scipy.linalg.solve_triangular(self._chol, y, lower=True, trans=1, check_finite=False))


def _forward(triangle: Array, values: Array) -> Array:
    """``L^-1 values``, (m,) or (m, k)."""
    solved: Array = scipy.linalg.solve_triangular(triangle, values, lower=True, check_finite=False)
    return solved
