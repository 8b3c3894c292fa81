# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb's law with a load history, by trying every combination of states in every increment: for a few pairs.

Independent of the solver and of the condensation: dense equations in all displacements and pair forces.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from signorini.engine.prepare import prepare

SLIPS = {"slip+": 1.0, "slip-": -1.0}


@dataclass(frozen=True)
class Instant:
    displacement: np.ndarray
    normal: np.ndarray
    tangential: np.ndarray
    slip: np.ndarray
    anchor: np.ndarray
    states: tuple


def follow(model):
    """The end of every step."""
    prepared = prepare(model)
    interface, constraints = prepared.interface, prepared.constraints
    K, B, T = prepared.K.toarray(), interface.B.toarray(), constraints.transform.toarray()
    n = len(interface)
    factors = model.factors()
    zero = np.zeros(n)
    now, ends = Instant(np.zeros(len(K)), zero, zero, zero, zero, ()), []
    for step, start, end in zip(model.steps, factors[:-1], factors[1:], strict=True):
        for k in range(1, step.increments + 1):
            at = {name: start[name] + (end[name] - start[name]) * k / step.increments for name in end}
            loads = sum((at[name] * f for name, f in prepared.loads.items()), np.zeros(len(K)))
            imposed = sum((at[name] * u for name, u in constraints.prescribed.items()), np.zeros(len(K)))
            now = _increment(K, B, T, loads, imposed, interface.gap, interface.friction.steepest, now)
        ends.append(now)
    return ends


def _increment(K, B, T, loads, imposed, gap, friction, before):
    found = []
    n, z = len(gap), T.shape[1]
    # friction cannot act on a pair that supports guide along its normal (a symmetry plane): none is reported
    guided = ~(B[n:] @ T).any(axis=1)
    friction = np.where(guided, 0.0, friction)
    size = max(np.abs(loads).max(), np.abs(T.T @ K @ imposed).max(), 1e-12)
    for states in itertools.product(("open", "stick", "slip+", "slip-"), repeat=n):
        if any(state in ("stick", "slip-") for state, alone in zip(states, guided, strict=True) if alone):
            continue
        # unknown: free displacements z, normal forces, tangential forces
        matrix, right = np.zeros((z + 2 * n, z + 2 * n)), np.zeros(z + 2 * n)
        matrix[:z, :z], matrix[:z, z:] = T.T @ K @ T, -(B @ T).T
        right[:z] = T.T @ (loads - K @ imposed)
        offset = B @ imposed
        for i, state in enumerate(states):
            normal, tangent = z + i, z + n + i
            if state == "open":
                matrix[normal, normal] = matrix[tangent, tangent] = 1.0
                continue
            matrix[normal, :z], right[normal] = B[i] @ T, -gap[i] - offset[i]
            if state == "stick":
                matrix[tangent, :z], right[tangent] = B[n + i] @ T, before.anchor[i] - offset[n + i]
            else:
                matrix[tangent, tangent], matrix[tangent, normal] = 1.0, -SLIPS[state] * friction[i]
        if np.linalg.cond(matrix) > 1e10:  # a state that leaves a motion or a force undetermined
            continue
        x = np.linalg.solve(matrix, right)
        u, p, t = T @ x[:z] + imposed, x[z : z + n], x[z + n :]
        moved = B @ u
        g, s = gap + moved[:n], moved[n:] - before.anchor
        fits = (g > -1e-12).all() and (p > -1e-9 * size).all() and (np.abs(t) <= friction * p + 1e-9 * size).all()
        # friction opposes the slip
        if fits and all(
            SLIPS[state] * s[i] <= 1e-12 for i, state in enumerate(states) if state in SLIPS and p[i] > 1e-9 * size
        ):
            closed = np.array([state != "open" for state in states])
            found.append(Instant(u, p, t, before.slip + np.where(closed, s, 0.0), moved[n:], states))
    assert found, "no combination of states fits"
    for other in found[1:]:
        np.testing.assert_allclose(other.normal, found[0].normal, rtol=0, atol=1e-7 * size)
    return found[0]
