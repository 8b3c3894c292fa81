# SPDX-License-Identifier: BSD-3-Clause
"""Frictional contact as a linear complementarity problem: a curved rough punch on an elastic half-plane.

The compliance of m surface strips is that of Flamant's solution, integrated over a strip, with its coupling of normal
and tangential displacements; the forces and gaps are those of a punch pressed and dragged.
"""

from __future__ import annotations

import numpy as np

from benchmarks.lcp_problems.posed import PosedLCP
from signorini.arrays import Array


def half_plane_compliance(m: int, *, poisson: float = 0.3) -> tuple[Array, Array, Array]:
    """(A_nn, A_nt, A_tt) of m strips on a half-plane: displacement of the middle of strip i per force on strip j.

    The half-width of the row of strips is 1, E = 1, and displacements are relative to a point at depth 20.

    References
    ----------
    Johnson (1985), Contact Mechanics, sections 2.3 to 2.5 (line loads, uniform strips).
    """
    h = 1.0 / m
    x = (2 * np.arange(m) + 1) * h - 1
    distance = x[:, None] - x
    upper, lower = distance + h, distance - h
    integral = _log_primitive(upper) - _log_primitive(lower)
    A_nn = -2 * (1 - poisson**2) / np.pi * (integral / (2 * h) - np.log(20.0))
    A_nt = -(1 - 2 * poisson) * (1 + poisson) / 2 * np.sign(distance)
    return A_nn, A_nt, A_nn.copy()


def frictional_contact(m: int, rng: np.random.Generator, *, friction: float = 0.4) -> PosedLCP:
    """The regular (force) form, n = 3 m: ``z = (p, mu p + p_t, s_minus)``, ``w = (gap, s_plus, mu p - p_t)``.

    With ``gap = A_nn p + A_nt p_t + g`` and ``slip = A_tn p + A_tt p_t + t = s_plus - s_minus``. Lemke's method needs
    no covering vector of its own here, but theta must leave first in ties.

    References
    ----------
    Klarbring (1986), Computer Methods in Applied Mechanics and Engineering 58:185-200.
    """
    A_nn, A_nt, A_tt = half_plane_compliance(m)
    g, t = _punch(m, rng)
    eye, zero = np.eye(m), np.zeros((m, m))
    M = np.block(
        [
            [A_nn - friction * A_nt, A_nt, zero],
            [A_nt.T - friction * A_tt, A_tt, eye],
            [2 * friction * eye, -eye, zero],
        ]
    )
    q = np.concatenate([g, t, np.zeros(m)])
    return PosedLCP(
        name=f"frictional contact, {m} pairs, mu = {friction:g}",
        source="rough punch on a half-plane, force form",
        M=M,
        q=q,
        traits=frozenset({"contact"}),
    )


def gap_slip_contact(m: int, rng: np.random.Generator, *, friction: float = 0.4) -> PosedLCP:
    """The gap-slip form, n = 3 m: ``z = (gap, s_plus, s_minus)``, ``w = (p, mu p + p_t, mu p - p_t)``.

    ``s_plus`` and ``s_minus`` may rise together, M (0, 1, 1) = 0: textbook Lemke ends on spurious rays. The covering
    vector (1, 1 + mu, 1 + mu) is carried by the problem.
    """
    A_nn, A_nt, A_tt = half_plane_compliance(m)
    g, t = _punch(m, rng)
    S = np.linalg.inv(np.block([[A_nn, A_nt], [A_nt.T, A_tt]]))
    S_nn, S_nt, S_tn, S_tt = S[:m, :m], S[:m, m:], S[m:, :m], S[m:, m:]
    p, p_t = -S_nn @ g - S_nt @ t, -S_tn @ g - S_tt @ t
    plus, minus = friction * S_nn + S_tn, friction * S_nn - S_tn
    plus_t, minus_t = friction * S_nt + S_tt, friction * S_nt - S_tt
    M = np.block([[S_nn, S_nt, -S_nt], [plus, plus_t, -plus_t], [minus, minus_t, -minus_t]])
    return PosedLCP(
        name=f"gap-slip contact, {m} pairs, mu = {friction:g}",
        source="rough punch on a half-plane, gap-slip form",
        M=M,
        q=np.concatenate([p, friction * p + p_t, friction * p - p_t]),
        covering=np.repeat([1.0, 1.0 + friction, 1.0 + friction], m),
        traits=frozenset({"contact"}),
    )


def _punch(m: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Gaps of a curved rough punch pushed in, and the tangential displacement imposed at no force."""
    x = (2 * np.arange(m) + 1) / m - 1
    shape = rng.uniform(0.5, 2.0) * x**2 + rng.uniform(-0.3, 0.3) * x + 0.02 * rng.standard_normal(m)
    return shape - rng.uniform(0.5, 1.5), rng.uniform(-0.6, 0.6) + rng.uniform(-0.1, 0.1) * x


def _log_primitive(x: Array) -> Array:
    """Integral of ln|x|."""
    return x * np.log(np.abs(x)) - x
