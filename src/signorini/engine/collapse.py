# SPDX-License-Identifier: BSD-3-Clause
"""The load beyond which bodies flow plastically without end, from the motion in which they do: an upper bound.

A motion v dissipates ``D(v) = sum w Y sqrt(2/3 eps(v) : eps(v))`` at most; loads that do more work on it have no
equilibrium, whatever the history was. Where temperature changes Y on the way, so does what flow takes.

References
----------
Drucker, Prager, Greenberg (1952), Extended limit design theorems for continuous media, Quart. Appl. Math. 9:381.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array, frozen
from signorini.engine.flow_motions import FlowMotions
from signorini.engine.increment import Mechanism
from signorini.engine.increments import applied
from signorini.engine.prepare import Prepared
from signorini.interface.interface import Interface
from signorini.plasticity.bodies import YieldingBodies
from signorini.plasticity.laws import Heat
from signorini.plasticity.measure import size
from signorini.plasticity.volume import flow_strains
from signorini.solution.state import LoadPoint

_OPENING_TOL = 1e-9  # of the largest velocity: by which pairs may approach, or slip where friction would resist
_RESISTS = 1e30  # friction per pressure: of pairs that resist slip without any pressure, or without a bound


@dataclass(frozen=True, kw_only=True, eq=False)
class Collapse:
    """A motion in which bodies flow without end.

    Attributes
    ----------
    part : of the way from one point of the load history to another, right beyond which there is no equilibrium
    motion : (nodes, d) velocity, largest entry 1
    rubs : whether pairs slip with friction in it, which makes the bound evidence and no proof
    """

    part: float
    motion: Array
    rubs: bool


def collapse(prepared: Prepared, start: LoadPoint, end: LoadPoint, mechanisms: Sequence[Mechanism]) -> Collapse | None:
    """The least bound that motions give; None where none is near a mechanism, or loads do no more work than flow takes.

    Parameters
    ----------
    prepared : the model
    start, end : points of the load history
    mechanisms : motions in which plastic flow ran away
    """
    motions = FlowMotions.of(prepared)
    if motions is None:
        return None
    bounds = [
        _bound(prepared, start, end, v, one.forces) for one in mechanisms if (v := motions.nearest(one)) is not None
    ]
    return min((bound for bound in bounds if bound is not None), key=lambda bound: bound.part, default=None)


def _bound(prepared: Prepared, start: LoadPoint, end: LoadPoint, v: Array, forces: Array) -> Collapse | None:
    """The bound that a motion gives; None where pairs close in it, or loads do no more work on it than flow takes.

    Parameters
    ----------
    prepared : the model
    start, end : points of the load history
    v : (dofs,) the motion, largest entry 1, in which nothing strains but what flows
    forces : (d, n) of the pairs meanwhile
    """
    bodies = prepared.yielding
    assert bodies is not None
    heat = bodies.heat(start.factors), bodies.heat(end.factors)
    rate = flow_strains(bodies, v, heat[1])
    rate[:, :3] -= rate[:, :3].mean(axis=1)[:, None]
    rate[:, 3:] *= 0.5
    parts, taken = _taken(bodies, np.sqrt(2.0 / 3.0) * bodies.weights * size(rate), *heat)
    before, after = (_power(prepared, point, v) for point in (start, end))
    rubs = False
    if len(prepared.interface):
        interface, decided = prepared.interface, prepared.absent | prepared.interface.tied
        moved = interface.motion(v)
        if (moved[0, ~decided] < -_OPENING_TOL).any():
            return None
        slip = np.linalg.norm(moved[1:], axis=0)
        rubs = bool((~decided & (slip > _OPENING_TOL) & (slip * _steepest(interface) > moved[0] + _OPENING_TOL)).any())
        bound = np.where(decided | (forces[0] <= 0.0), 0.0, interface.most(forces[0]))
        taken += float(np.where(np.isfinite(bound), bound, 0.0) @ slip)
    part = _first_beyond(parts, before + (after - before) * parts - taken)
    if part is None:
        return None
    motion = prepared.space.at_nodes(v)
    return Collapse(part=part, motion=frozen(motion / (np.abs(motion).max() or 1.0)), rubs=rubs)


def _steepest(interface: Interface) -> Array:
    """(n,) Friction per pressure at most: a pair that opens faster than it slips times this takes no work."""
    resists = interface.friction.sticks | (interface.most(np.zeros(len(interface))) > 0.0)
    return np.where(resists, _RESISTS, np.minimum(interface.friction.steepest, _RESISTS))


def _power(prepared: Prepared, point: LoadPoint, v: Array) -> float:
    """What loads do on a motion (dofs,); thermal forces are the bodies' own, whose stresses are in what flow takes."""
    warm = [load.label for load in prepared.model.loads if load.temperature is not None]
    loads = applied(prepared, point)[0] - sum((point.factors[name] * prepared.loads[name] for name in warm), 0.0)
    return float((loads + prepared.interface.on_bodies(point.given)) @ v)


def _taken(bodies: YieldingBodies, flow: Array, cold: Heat, warm: Heat) -> tuple[Array, Array]:
    """What flow takes on the way between two temperatures, once all has hardened that can: piecewise linear.

    Returns (k,) the parts of the way at which its slope changes, both ends among them, and what it takes there.

    Parameters
    ----------
    bodies : whose flow it is
    flow : (p,) volumes of the points times equivalent strain rates
    cold, warm : at the ends of the way
    """
    laws, own = bodies.laws, bodies.body
    final = laws.stress[:, :, -1]
    ends = np.array([flow @ (_between(final[own], heat.level) + laws.saturated[own]) for heat in (cold, warm)])
    way, table = warm.temperature - cold.temperature, laws.temperature
    rise = np.diff(table, axis=1)
    slopes = np.divide(np.diff(final, axis=1), rise, out=np.zeros_like(rise), where=rise > 0.0)
    bends = np.diff(slopes, axis=1, prepend=0.0, append=0.0)[own] * (flow * np.abs(way))[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = (table[own] - cold.temperature[:, None]) / way[:, None]
    inside = (at > 0.0) & (at < 1.0) & (bends != 0.0)
    order = np.argsort(at[inside])
    at, bends = at[inside][order], bends[inside][order]
    first = ends[1] - ends[0] - float(bends @ (1.0 - at))
    parts = np.concatenate([[0.0], at, [1.0]])
    steps = np.diff(parts) * (first + np.concatenate([[0.0], np.cumsum(bends)]))
    return parts, ends[0] + np.concatenate([[0.0], np.cumsum(steps)])


def _between(stress: Array, level: Array) -> Array:
    """(p,) Yield stresses between those at temperatures, (p, t), see `Heat.level`."""
    below, points = level.astype(np.int64), np.arange(len(level))
    one, two = stress[points, below], stress[points, np.minimum(below + 1, stress.shape[1] - 1)]
    found: Array = one + (level - below) * (two - one)
    return found


def _first_beyond(parts: Array, excess: Array) -> float | None:
    """Where a piecewise linear function becomes positive; None where it does not.

    >>> _first_beyond(np.array([0.0, 0.5, 1.0]), np.array([-1.0, 1.0, -3.0]))
    0.25
    """
    rises = np.flatnonzero((excess[1:] > 0.0) & (excess[1:] > excess[:-1]))
    if not len(rises):
        return None
    i = rises[0]
    return float(parts[i] - excess[i] * (parts[i + 1] - parts[i]) / (excess[i + 1] - excess[i]))
