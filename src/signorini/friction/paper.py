# SPDX-License-Identifier: BSD-3-Clause
"""The paper's penalised law as one LCP with three multipliers a pair, literally.

A contact point is a rigid-perfectly-plastic point: ``P_tau = E_tau (u_tau - l_1 + l_2)``, ``P_n = E_n (u_n - l_3)``,
with l_1, l_2 slip either way and l_3 opening, and f + nu = 0, nu >= 0, l >= 0, nu l = 0 for ``f_1 = P_tau + mu P_n``,
``f_2 = -P_tau + mu P_n``, ``f_3 = P_n`` (P_n <= 0 presses). Zhu Changming, equations (12)-(37), misprints corrected.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from signorini.arrays import Array
from signorini.short import Short

C = np.array([[1.0, -1.0, 0.0], [0.0, 0.0, 1.0]])
"""``u_c^s = C lambda``: what the multipliers do to (u_tau, u_n); the paper's (16)."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PaperProblem(Short):
    """``nu = M lambda + q``, ``nu >= 0``, ``lambda >= 0``, ``nu . lambda = 0``; multipliers pair by pair.

    Attributes
    ----------
    M : (3 n, 3 n) ``-(E_lambda + E_phi K_c^-1 Phi)``
    q : (3 n,) ``-E_phi K_c^-1 f_c - U g``, pressure
    covering : (3 n,) for Lemke: 1 + mu in the slip rows, above the mu that would let l_1 and l_2 rise together
    """

    M: Array
    q: Array
    covering: Array
    _penalties: Array
    _B: Array
    _K_c: tuple[Array, bool]
    _f_c: Array
    _weighted: Array
    _offset: Array

    def recover(self, multipliers: Array) -> tuple[Array, Array]:
        """Displacements and tractions of multipliers: ``K_c u = f_c + Phi lambda``, ``P = D_c (u_c - C lambda)``.

        Parameters
        ----------
        multipliers : (3 n,) length

        Returns
        -------
        u : (m,) of the contact dofs
        P : (n, 2) tractions (tau, n), tension positive
        """
        slip = multipliers.reshape(-1, 3) @ C.T
        u = self.solve(self._f_c + self._B.T @ (self._weighted * slip.ravel()))
        u_c = (self._B @ u + self._offset).reshape(-1, 2)
        return u, self._penalties * (u_c - slip)

    def solve(self, f_c: Array) -> Array:
        """``K_c^-1 f_c`` on the contact dofs, (m, ...)."""
        solved: Array = scipy.linalg.cho_solve(self._K_c, f_c)
        return solved


def paper_problem(
    S: Array, B: Array, f: Array, offset: Array, friction: Array, area: Array, *, E_tau: float, E_n: float
) -> PaperProblem:
    """Build M and q from the stiffness condensed on the contact dofs: ``f = U u_c - U C lambda`` with U = N diag(E).

    ``K_c = S + B^T W_c D_c B`` is factorised as it stands: regular where contact alone holds a body, and as badly
    conditioned as the penalties make it.

    Parameters
    ----------
    S : (m, m) condensed stiffness
    B : (2 n, m) relative displacements, (tau, n) pair by pair
    f : (m,) condensed load
    offset : (2 n,) initial gaps in the normal entries, and what supports prescribe
    friction, area : (n,) Coulomb's coefficient, and area of every pair
    E_tau, E_n : penalties, pressure per length

    Raises
    ------
    numpy.linalg.LinAlgError
        If K_c is not positive definite in floating-point numbers.
    """
    n = len(friction)
    penalties = np.array([E_tau, E_n])
    weighted = np.repeat(area, 2) * np.tile(penalties, n)
    K_c = scipy.linalg.cho_factor(S + B.T @ (weighted[:, None] * B), lower=True)
    f_c = f - B.T @ (weighted * offset)
    U = scipy.linalg.block_diag(*(np.array([[1.0, mu], [-1.0, mu], [0.0, 1.0]]) * penalties for mu in friction))
    # K_c^-1 Phi with C taken out: so M (1, 1, 0) = 0 holds exactly at every pair, as in the paper's law
    response = scipy.linalg.cho_solve(K_c, B.T * weighted)
    return PaperProblem(
        M=(U - U @ B @ response) @ scipy.linalg.block_diag(*[C] * n),
        q=-U @ (B @ scipy.linalg.cho_solve(K_c, f_c) + offset),
        covering=np.column_stack([1.0 + friction, 1.0 + friction, np.ones(n)]).ravel(),
        _penalties=penalties,
        _B=B,
        _K_c=K_c,
        _f_c=f_c,
        _weighted=weighted,
        _offset=offset,
    )
