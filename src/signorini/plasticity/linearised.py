# SPDX-License-Identifier: BSD-3-Clause
"""Compiled loops of the linearised flow rule at points: consistent, or primal-dual with the stress as an unknown."""

from __future__ import annotations

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.compilation import kernel, part
from signorini.plasticity.laws import YieldLaws, stress_in_tables
from signorini.plasticity.radial_return import ROOT23, Points


@part()
def taken(laws: YieldLaws, body: int, point: Points, i: int, dual: Array, left: float, M: Array) -> None:
    """M, what yielding takes off the elastic law at point i: ``2 G (1 - left) (a I_dev + b sym(s n^T))``.

    With s = n it is that of the consistent tangent. In plane stress of both what is left once the strain across has
    made the stress across vanish.

    Parameters
    ----------
    laws, body : material data, and the body of the point
    point : the states
    dual : (n,) s, a tensor of size at most 1
    left : part of the elastic law that yielding leaves in place, 0 .. 1
    M : (n, n), written
    """
    n, G2 = len(dual), 2.0 * laws.shear[body] * (1.0 - left)
    a, b, way = point.slack[i, 0], point.slack[i, 1], point.direction[i]
    for r in range(n):
        for c in range(n):
            value = 0.5 * b * (way[r] * dual[c] + dual[r] * way[c])
            if r == c:
                value += a * (1.0 if r < 3 else 0.5)
            if r < 3 and c < 3:
                value -= a / 3.0
            M[r, c] = G2 * value
    if not laws.thin:
        return
    # the stress across vanishes with the elastic law D, and with the tangent D - M: both lose the strain across
    G, K = laws.shear[body], laws.bulk[body]
    lame, stiff = K - 2.0 / 3.0 * G, K + 4.0 / 3.0 * G
    rest = stiff - M[2, 2]
    for r in range(n):
        for c in range(n):
            if r != 2 and c != 2:
                one, two = (lame if r < 3 else 0.0), (lame if c < 3 else 0.0)
                M[r, c] += (one - M[r, 2]) * (two - M[2, c]) / rest - one * two / stiff
    for r in range(n):
        M[r, 2], M[2, r] = 0.0, 0.0


@kernel()
def dual_stress(
    laws: YieldLaws, body: IntArray, level: Array, old: Points, model: Points, dual: Array, new: Points, out: Array
) -> None:
    """The relative stress of the last linear model at the new strains, over the radius, pulled back into the unit ball.

    In place of the direction of the flow it linearises the flow rule with the stress as an unknown of its own: states
    of points do not flip from side to side near the limit load.

    Parameters
    ----------
    laws, body, level : of the bodies; body of every point and place of its temperature, (p,)
    old : committed states
    model, dual : the states that the linear model was made at, and its relative stresses (p, n)
    new : the states at the strains that its solution reaches
    out : (p, n) the new relative stresses

    References
    ----------
    Chan, Golub, Mulet (1999), A nonlinear primal-dual method for total variation-based image restoration, SIAM J. Sci.
    Comput. 20:1964; Hager, Wohlmuth (2009), Comput. Methods Appl. Mech. Eng. 198:3411.
    """
    n, M = out.shape[1], new.back.shape[1]
    start, step = np.empty(n), np.empty(n)
    rows, strain, table, beyond = laws.rows, laws.strain, laws.stress, laws.beyond
    for i in range(len(body)):
        j = body[i]
        G2 = 2.0 * laws.shear[j]
        one, two = model.strain[i], new.strain[i]
        mean_one, mean_two = (one[0] + one[1] + one[2]) / 3.0, (two[0] + two[1] + two[2]) / 3.0
        dp = new.equivalent[i] - old.equivalent[i]
        along, beside, stiff = 0.0, 0.0, 0.0
        for k in range(M):
            stiff += laws.back[j, k] / (1.0 + laws.recovery[j, k] * dp)
        for c in range(n):
            weight = 1.0 if c < 3 else 2.0
            scale = G2 if c < 3 else 0.5 * G2
            start[c] = scale * (one[c] - (mean_one if c < 3 else 0.0) - old.plastic[i, c])
            step[c] = scale * (two[c] - one[c] - (mean_two - mean_one if c < 3 else 0.0))
            along += weight * model.direction[i, c] * step[c]
            beside += weight * dual[i, c] * step[c]
        a, b = model.slack[i, 0], model.slack[i, 1]
        if not model.yields[i]:
            a, b = 0.0, 0.0
        stress, _ = stress_in_tables(rows[j], strain, table, beyond[j], j, new.equivalent[i], level[i])
        norm = 0.0
        for c in range(n):
            back = 0.0
            for k in range(M):
                back += old.back[i, k, c] / (1.0 + laws.recovery[j, k] * dp)
            taken = a * (start[c] - back + step[c]) + 0.5 * b * (dual[i, c] * along + model.direction[i, c] * beside)
            value = (start[c] + step[c] - back - (1.0 + 2.0 / 3.0 * stiff / G2) * taken) / (ROOT23 * stress)
            out[i, c] = value
            norm += (1.0 if c < 3 else 2.0) * value * value
        if norm > 1.0:
            for c in range(n):
                out[i, c] /= np.sqrt(norm)
