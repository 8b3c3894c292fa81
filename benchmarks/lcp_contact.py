# SPDX-License-Identifier: BSD-3-Clause
"""Frictional contact LCPs of assembled finite elements: the paper's cylinder and a rough block, condensed.

With ``G h - W r = b``, h = (gap, slip) and r = (p, p_t) (``signorini.friction.ContactProblem``), the forms are

    force     z = (p, mu p + p_t, s_minus), w = (gap, s_plus, mu p - p_t); regular, bodies held by supports
    gap-slip  z = (gap, s_plus, s_minus), w = (p, mu p + p_t, mu p - p_t); bodies that contact alone holds too
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.linalg

from benchmarks.lcp_problems import PosedLCP
from signorini.arrays import Array
from signorini.engine.prepare import Prepared, prepare
from signorini.friction.problem import ContactProblem
from signorini.gallery.cylinder import zhu_cylinder
from signorini.meshing.plane import rectangle
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.model import Model
from signorini.model.obstacle import Plane


def cylinder(n: int, rng: np.random.Generator) -> PosedLCP:
    """The paper's cylinder, about n / 3 pairs, in the gap-slip form; friction and load drawn."""
    pairs, friction = round(n / 3), rng.uniform(0.05, 0.6)
    prepared = prepare(zhu_cylinder(friction=friction, contact_spacing=4.0 / max(8, pairs - 6)))
    law = loaded(prepared.widened() if prepared.limited else prepared, rng.uniform(0.3, 1.5))
    return gap_slip_form(f"FE cylinder, {law.pairs} pairs, mu = {friction:.2f}", law)


def rough_block(n: int, rng: np.random.Generator) -> PosedLCP:
    """A block with a crowned rough bottom, n / 3 pairs, clamped at the top and moved down and aside; force form."""
    pairs, friction = round(n / 3), rng.uniform(0.1, 0.8)
    x = np.linspace(-1.0, 1.0, pairs)
    y = np.append(0.0, np.cumsum(np.geomspace(2.0 / pairs, 0.25, 14)))
    mesh = rectangle(x=x, y=y / y[-1])
    points = mesh.points.copy()
    width = max(3, pairs // 12)  # the waves of the roughness are a twelfth of the block, whatever the mesh
    waves = np.convolve(rng.standard_normal(pairs + width - 1), np.full(width, width**-0.5), "valid")
    rough = 0.02 * x**2 + 1e-3 * waves
    points[:, 1] += (1.0 - points[:, 1]) * rough[np.searchsorted(x, points[:, 0] - 1e-12)]
    model = Model(
        replace(mesh, points=points),
        bodies=[Body("block", Elastic(E=100.0, nu=0.3))],
        supports=[Support("top", u=(float(rng.uniform(-0.01, 0.01)), -float(rng.uniform(0.012, 0.022))))],
        contacts=[Contact("bottom", Plane(point=(0, 0), normal=(0, 1)), friction=friction, name="ground")],
    )
    prepared = prepare(model)
    law = loaded(prepared.widened() if prepared.limited else prepared, 1.0)
    return force_form(f"FE rough block, {law.pairs} pairs, mu = {friction:.2f}", law)


def loaded(prepared: Prepared, factor: float) -> ContactProblem:
    """The law of the first step from rest, loads times the factor."""
    interface, condensed, T = prepared.interface, prepared.paths.condensed, prepared.constraints.transform
    zero = np.zeros(prepared.space.number_of_dofs)
    imposed = sum(prepared.constraints.prescribed.values(), zero)
    load = T.T @ (factor * sum(prepared.loads.values(), zero) - prepared.K @ imposed)
    offset = interface.motion(imposed)
    offset[0] += interface.gap
    b = condensed.right_hand_side(condensed.reduce(load).load, offset[:, condensed.active])
    return replace(prepared.paths.law, b=b)


def gap_slip_form(name: str, law: ContactProblem) -> PosedLCP:
    """``r = S h - F`` with ``S = W^-1 - I``, ``F = W^-1 b``; a pair locked by supports has no slip variables."""
    n, mu = law.pairs, law.mu
    moves = np.flatnonzero(~law.locked)
    kept = np.concatenate([np.arange(n), n + moves])
    inverse = scipy.linalg.inv(law.W[np.ix_(kept, kept)], check_finite=False)
    S, F = inverse - np.eye(len(kept)), inverse @ law.b[kept]
    friction, size = mu[moves], len(moves)
    normal, tangent = slice(0, n), slice(n, n + size)
    plus = friction[:, None] * S[moves] + S[tangent]
    minus = friction[:, None] * S[moves] - S[tangent]
    M = np.vstack([np.hstack([rows, -rows[:, tangent]]) for rows in (S[normal], plus, minus)])
    q = -np.concatenate([F[normal], friction * F[moves] + F[tangent], friction * F[moves] - F[tangent]])
    covering = np.concatenate([np.ones(n), 1.0 + friction, 1.0 + friction])
    return _posed(name + ", gap-slip form", M, q, covering)


def force_form(name: str, law: ContactProblem) -> PosedLCP:
    """``h = A r + g`` with ``A = G^-1 W``, ``g = G^-1 b``."""
    n, mu = law.pairs, law.mu
    if law.locked.any() or law.floating:
        raise ValueError("the force form needs supports that hold every body and lock no pair")
    factors = scipy.linalg.lu_factor(np.eye(2 * n) - law.W, check_finite=False)
    A, g = scipy.linalg.lu_solve(factors, law.W), scipy.linalg.lu_solve(factors, law.b)
    to_p_t = A[:, :n] - A[:, n:] * mu  # p_t = (mu p + p_t) - mu p
    eye, zero = np.eye(n), np.zeros((n, n))
    M = np.block(
        [[to_p_t[:n], A[:n, n:], zero], [to_p_t[n:], A[n:, n:], eye], [2 * mu[:, None] * eye, -eye, zero]],
    )
    return _posed(name + ", force form", M, np.append(g, np.zeros(n)), None)


def _posed(name: str, M: Array, q: Array, covering: Array | None) -> PosedLCP:
    return PosedLCP(
        name=name, source="assembled finite elements", M=M, q=q, covering=covering, traits=frozenset({"contact"})
    )
