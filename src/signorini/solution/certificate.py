# SPDX-License-Identifier: BSD-3-Clause
"""Whether a state is a solution: measured on the problem as posed, with nothing from the solver but its answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array
from signorini.fem.internal_forces import internal_forces
from signorini.interface.interface import Interface
from signorini.plasticity.measure import FlowViolation, violation
from signorini.plasticity.state import PlasticState
from signorini.short import Short
from signorini.solution.discrete_model import DiscreteModel
from signorini.solution.state import State

TOLERANCE = 1e-8
"""Every number of a certificate is at most this, or the answer is no solution."""

NUMBERS = ("equilibrium", "penetration", "tension", "cone", "complementarity")
"""What a certificate measures."""

FLOW_NUMBERS = ("excess", "flow", "consistency", "dissipation")
"""What it measures besides where bodies yield."""

_MOST_ROUNDING = 1e-6  # of the data: where digits beyond are lost, of forces or of displacements, nothing is certified
_MAX_LENGTHS = 1e9  # lengths of the data: a body that has left is no solution


@dataclass(frozen=True, kw_only=True, repr=False)
class Certificate(Short):
    """Violations of equilibrium and of the law of contact, dimensionless, 0 where satisfied.

    Attributes
    ----------
    equilibrium : largest nodal ``|K u - f - B^T r|`` and largest resultant on a rigid motion of any part
    penetration : largest overlap
    tension : largest pulling normal force
    cone : largest excess of friction over its bound, ``mu p`` in Coulomb's law
    complementarity : largest ``min(gap, normal force)``, ``min(|slip|, mu p - |t|)``, and friction along the slip; on
        an ellipse how far friction is from what dissipates most, on a polygon how much more it could dissipate
    rounding : what the rounding of displacements alone may add to `equilibrium`, see `_rounding`; looked at only where
        that number is beyond 1e-8, otherwise 0
    facets : most corners of a section of the friction cone on which this was measured; 0: the exact cone everywhere
    plastic : what points of bodies that yield lack of the flow rule; None where no body yields
    """

    equilibrium: float
    penetration: float
    tension: float
    cone: float
    complementarity: float
    rounding: float = 0.0
    facets: int = 0
    plastic: FlowViolation | None = None

    @property
    def imbalance(self) -> float:
        """Equilibrium less what rounding explains."""
        return float(np.maximum(self.equilibrium - self.rounding, 0.0))

    @property
    def worst(self) -> float:
        """The largest number, of equilibrium the `imbalance`; NaN, which passes nothing, where any is."""
        flow = [] if self.plastic is None else [getattr(self.plastic, name) for name in FLOW_NUMBERS]
        return float(np.max([self.imbalance, *(getattr(self, name) for name in NUMBERS[1:]), *flow]))

    @property
    def passed(self) -> bool:
        """All at most 1e-8."""
        return bool(self.worst <= TOLERANCE)

    def __str__(self) -> str:
        words = ", ".join(f"{name} {getattr(self, name):.1e}" for name in NUMBERS)
        words += f" (equilibrium: {self.rounding:.1e} may be rounding)" if self.rounding else ""
        if self.plastic is not None:
            words += ", yield " + ", ".join(f"{name} {getattr(self.plastic, name):.1e}" for name in FLOW_NUMBERS)
        return f"{words}, on a cone of {self.facets} facets" if self.facets else words


def worst_of(certificates: Sequence[Certificate]) -> Certificate:
    """The largest of every number of several certificates."""
    flows = [each.plastic for each in certificates if each.plastic is not None]
    numbers = [name for name in Certificate.__dataclass_fields__ if name != "plastic"]
    flow = {name: max(getattr(each, name) for each in flows) for name in FLOW_NUMBERS} if flows else None
    return Certificate(
        **{name: max(getattr(each, name) for each in certificates) for name in numbers},
        plastic=None if flow is None else FlowViolation(**flow),
    )


def certify(
    system: DiscreteModel,
    state: State,
    *,
    loads: Array,
    before: Array,
    yielding: Callable[[Array], Array] | None = None,
    origin: PlasticState | None = None,
) -> Certificate:
    """Measure a state.

    Parameters
    ----------
    system : the problem as posed
    state : its displacement and pair forces are the answer to be measured
    loads : (dofs,) nodal forces
    before : (d - 1, n) tangential displacement at which the slip increment began
    yielding : displacements under forces on the free displacements: what slender bodies lack of equilibrium is many
        roundings of the load, and may be so where it moves them by no more than the last digits of their displacements
    origin : what points of bodies that yield remembered before the increment; None: the flow rule is not asked

    Returns
    -------
    Certificate; every number infinite where something is not finite or a body has left
    """
    interface, constraints, scale, rigid = system.interface, system.constraints, system.scale, system.rigid
    (u, external), r = state.nodal, state.forces
    if not (np.isfinite(u).all() and np.isfinite(r).all()) or np.abs(u).max(initial=0.0) > _MAX_LENGTHS * scale.length:
        return Certificate(equilibrium=np.inf, penetration=np.inf, tension=np.inf, cone=np.inf, complementarity=np.inf)
    of_pairs = system.pushed(r)
    applied = loads + of_pairs
    if state.plastic is not None:
        applied = applied + state.plastic.forces
    residual = constraints.on_free(system.K @ u - applied)
    balance = constraints.resultants(rigid, external + constraints.foundation_forces(u) + of_pairs)
    moved = (interface.motion(u) + interface.give(r, state.borne)) / scale.length
    gap = state.point.gap / scale.length + moved[0]
    normal, tangential = r[0] / scale.force, r[1:] / scale.force
    sliding = moved[1:] - before / scale.length
    pressing, held, free = r[0], interface.tied, np.zeros_like(interface.tied)
    if interface.cohesion is not None and state.bonds is not None:
        pressing = r[0] + interface.cohesion.tension(state.bonds, scale.length * gap)
        sticks = interface.cohesion.sticking(state.bonds)
        normal, held, free = pressing / scale.force, held | sticks, interface.cohesion.holds(state.bonds) & ~sticks
    gap, tension = np.where(interface.tied, -np.abs(gap), gap), np.where(interface.tied, 0.0, normal)
    bound = np.where(held, np.inf, np.where(free, 0.0, interface.most(pressing) / scale.force))
    room = bound - interface.effort(tangential)
    friction = _friction(interface, bound, tangential, sliding, room)
    gap, normal, tension, room, friction = (
        np.where(system.absent, 0.0, part) for part in (gap, normal, tension, room, friction)
    )
    equilibrium = float(np.maximum(_largest(np.abs(residual)), _largest(np.abs(balance)))) / scale.force
    rounding = 0.0
    if equilibrium > TOLERANCE:
        rounding = _rounding(system.K, u, rigid.matrix, scale.force)
        # the forces of slender bodies cancel but for digits that the terms of K u have lost
        residual = constraints.on_free(internal_forces(system.K, u) - applied)
        if yielding is None or not np.abs(yielding(residual)).max(initial=0.0) <= _MOST_ROUNDING * scale.length:
            rounding = min(rounding, _MOST_ROUNDING)
    return Certificate(
        equilibrium=equilibrium,
        penetration=_largest(-gap),
        tension=_largest(-tension),
        cone=_largest(-room),
        complementarity=_largest(np.concatenate([np.minimum(gap, normal), friction])),
        rounding=rounding,
        facets=int(interface.facets.max(initial=0)),
        plastic=_flow(system, state, origin),
    )


def _flow(system: DiscreteModel, state: State, origin: PlasticState | None) -> FlowViolation | None:
    """What the points of bodies that yield lack of the flow rule from where the increment began."""
    bodies = system.yielding
    if bodies is None or origin is None or state.plastic is None:
        return None
    return violation(bodies, state.displacement, origin, state.plastic, bodies.heat(state.point.factors))


def _rounding(K: sp.csr_array, u: Array, motions: sp.csr_array, force: float) -> float:
    """Forces that the rounding of displacements alone causes, ``2 eps |K| |u|``, and their resultants if random.

    No solver leaves less: very long or very flat cells far from a small contact make |K| |u| large beside the loads.

    References
    ----------
    Oettli, Prager (1964), Compatibility of approximate solution of linear equations with given error bounds for
    coefficients and right-hand sides, Numer. Math. 6:405.
    """
    forces = 2.0 * np.finfo(np.float64).eps * (abs(K) @ np.abs(u))
    resultants = np.sqrt(motions.multiply(motions).T @ forces**2)
    return _largest(np.concatenate([forces, resultants])) / force


def _friction(interface: Interface, bound: Array, tangential: Array, sliding: Array, room: Array) -> Array:
    """(n,) How far friction is from opposing the slip as its law says; all arguments dimensionless.

    Where a pair is open, slip is free: its section is a point and has no room.
    """
    r, s = tangential, sliding
    slip, size = np.linalg.norm(s, axis=0), np.linalg.norm(r, axis=0)
    # 0 where friction opposes the slip, 2 where it goes with it
    turned = np.linalg.norm(_directions(r, size) + _directions(s, slip), axis=0)
    found = np.maximum(np.minimum(slip, np.maximum(room, 0.0)), 0.5 * turned * np.minimum(size, slip))
    polygon = (interface.facets > 0) & np.isfinite(bound)
    special = polygon | (interface.anisotropy != 1.0).any(axis=1)
    if special.any():
        r, s = r[:, special], s[:, special]
        most = -bound[special] * interface.section.among(special).farthest(s)
        off = np.minimum(slip[special], np.linalg.norm(r - most, axis=0))
        more = np.sum((r - most) * s, axis=0)
        more = more / np.maximum(np.maximum(slip, bound)[special], 1e-300)
        found[special] = np.where(polygon[special], np.maximum(more, 0.0), off)
    return found


def _directions(vectors: Array, length: Array) -> Array:
    """(d - 1, n) Tangential vectors over their length, (n,); 0 where there is none."""
    unit: Array = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
    return unit


def _largest(violation: Array) -> float:
    return float(np.maximum(violation.max(initial=0.0), 0.0)) + 0.0  # NaN stays NaN, -0 becomes 0
