# SPDX-License-Identifier: BSD-3-Clause
"""The load beyond which bodies flow plastically without end, from the motion in which they do: an upper bound.

A motion v dissipates ``D(v) = sum w Y sqrt(2/3 eps(v) : eps(v))`` at most; loads that do more work on it have no
equilibrium, whatever the history was.

References
----------
Drucker, Prager, Greenberg (1952), Extended limit design theorems for continuous media, Quart. Appl. Math. 9:381.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, frozen
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.engine.solver import Mechanism
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.laws import Heat
from signorini.plasticity.measure import size
from signorini.solution.state import LoadPoint

_MAX_DILATATION = 1e-2  # of the size of the strain rate: flow keeps the volume, what is left is not the mechanism yet
_MAX_ELASTIC = 1e-4  # of the work that the loads do: what bodies that only strain elastically may take up
_OPENING_TOL = 1e-6  # of the largest velocity: by which pairs may approach, or slip where friction would resist


@dataclass(frozen=True, kw_only=True, eq=False)
class Collapse:
    """A motion in which bodies flow without end.

    Attributes
    ----------
    part : of the way from one point of the load history to another, beyond which there is no equilibrium; at most
    motion : (nodes, d) velocity, largest entry 1
    rubs : whether pairs slip with friction in it, which makes the bound evidence and no proof
    """

    part: float
    motion: Array
    rubs: bool


def collapse(prepared: Prepared, start: LoadPoint, end: LoadPoint, mechanisms: Sequence[Mechanism]) -> Collapse | None:
    """The least bound that motions give; None where none is a mechanism, or loads do no more work than flow takes.

    Parameters
    ----------
    prepared : the model
    start, end : points of the load history
    mechanisms : motions in which plastic flow ran away
    """
    bounds = [bound for one in mechanisms if (bound := _bound(prepared, start, end, one)) is not None]
    return min(bounds, key=lambda bound: bound.part, default=None)


def _bound(prepared: Prepared, start: LoadPoint, end: LoadPoint, mechanism: Mechanism) -> Collapse | None:
    """The bound that a motion gives; None where it is no mechanism, or loads do no more work on it than flow takes.

    Parameters
    ----------
    prepared : the model
    start, end : points of the load history
    mechanism : the motion, and forces of the pairs for whether they press
    """
    bodies, T = prepared.yielding, prepared.constraints.transform
    free, forces = mechanism
    largest = float(np.abs(free).max(initial=0.0))
    if bodies is None or largest == 0.0:
        return None
    v = T @ (free / largest)
    heat = bodies.heat(start.factors), bodies.heat(end.factors)
    rate = bodies.flow_strains(v, heat[1])
    if bodies.laws.thin:  # the thickness gives way
        rate[:, 2] = -(rate[:, 0] + rate[:, 1])
    dilatation = bodies.weights @ np.abs(bodies.dilatation(rate))
    rate[:, :3] -= rate[:, :3].mean(axis=1)[:, None]
    rate[:, 3:] *= 0.5
    strain = size(rate)
    limit = _final_yield_stress(bodies, *heat)
    flowing = strain > 0.0
    if not np.isfinite(limit[flowing]).all() or dilatation > _MAX_DILATATION * float(bodies.weights @ strain):
        return None
    taken = float(np.sqrt(2.0 / 3.0) * (bodies.weights[flowing] * limit[flowing]) @ strain[flowing])
    before, after = (float(applied(prepared, point)[0] @ v) for point in (start, end))
    rubs = False
    if len(prepared.interface):
        moved = prepared.interface.motion(v)
        near = (forces[0] > 0.0) & ~prepared.absent
        if (moved[0, near] < -_OPENING_TOL).any():
            return None
        slip = np.linalg.norm(moved[1:], axis=0)
        bound = prepared.interface.most(forces[0])
        rubs = bool((near & (bound > 0.0) & (slip > _OPENING_TOL)).any())
        taken += float(np.where(near & np.isfinite(bound), bound, 0.0) @ slip)
    elastic = float(v @ (prepared.K @ v)) * _elastic_share(prepared, bodies, v)
    if after <= before or elastic > _MAX_ELASTIC * taken:
        return None
    part = (taken - before) / (after - before)
    if not part < 1.0:
        return None
    motion = v[: prepared.model.dimension * len(prepared.model.mesh.points)].reshape(-1, prepared.model.dimension)
    return Collapse(part=part, motion=frozen(motion / (np.abs(motion).max() or 1.0)), rubs=rubs)


def _final_yield_stress(bodies: YieldingBodies, cold: Heat, warm: Heat) -> Array:
    """(p,) Yield stress in tension once everything has hardened that can; infinite where hardening never ends.

    The largest at any temperature between two, on the way between which the load is that bodies flow at.
    """
    laws, own = bodies.laws, bodies.body
    final, points, count = laws.stress[own, :, -1], np.arange(len(own)), laws.stress.shape[1]
    low, high = np.minimum(cold.level, warm.level), np.maximum(cold.level, warm.level)
    table = np.arange(count)
    between = (table > low[:, None]) & (table < high[:, None])
    last = np.where(between, final, 0.0).max(axis=1)
    for level in (low, high):
        below = level.astype(np.int64)
        one, two = final[points, below], final[points, np.minimum(below + 1, count - 1)]
        last = np.maximum(last, one + (level - below) * (two - one))
    grows = laws.beyond > 0.0
    grows |= ((laws.back > 0.0) & (laws.recovery == 0.0)).any(axis=1)
    saturated = np.divide(laws.back, laws.recovery, out=np.zeros_like(laws.back), where=laws.recovery > 0.0).sum(axis=1)
    limit: Array = np.where(grows[own], np.inf, last + saturated[own])
    return limit


def _elastic_share(prepared: Prepared, bodies: YieldingBodies, v: Array) -> float:
    """Of the elastic energy of a motion, what is not in bodies that yield."""
    energy = float(v @ (prepared.K @ v))
    own = bodies.strains(v)
    inside = float(bodies.weights @ (own * bodies.eigenstress(own)).sum(axis=1))
    return max(0.0, 1.0 - inside / energy) if energy > 0.0 else 0.0
