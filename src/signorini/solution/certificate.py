# SPDX-License-Identifier: BSD-3-Clause
"""Whether a state is a solution: measured on the problem as posed, with nothing from the solver but its answer."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.solution.scale import Scale
from signorini.solution.state import State

TOLERANCE = 1e-8
"""Every number of a certificate is at most this, or the answer is no solution."""

_FARTHEST = 1e9  # lengths of the data: a body that has left is no solution


@dataclass(frozen=True, kw_only=True)
class Certificate:
    """Violations of equilibrium and of the law of contact, dimensionless, 0 where satisfied.

    Attributes
    ----------
    equilibrium : largest nodal ``|K u - f - B^T r|`` and largest resultant on a rigid motion of any part
    penetration : largest overlap
    tension : largest pulling normal force
    cone : largest excess of friction over its bound, ``mu p`` in Coulomb's law
    complementarity : largest ``min(gap, normal force)``, ``min(|slip|, mu p - |t|)``, and friction along the slip
    """

    equilibrium: float
    penetration: float
    tension: float
    cone: float
    complementarity: float

    @property
    def worst(self) -> float:
        """The largest of the five; NaN, which passes nothing, where any is."""
        return float(np.max([getattr(self, field.name) for field in fields(self)]))

    @property
    def passed(self) -> bool:
        """All at most 1e-8."""
        return bool(self.worst <= TOLERANCE)

    def __str__(self) -> str:
        return ", ".join(f"{field.name} {getattr(self, field.name):.1e}" for field in fields(self))


def certify(
    K: sp.csr_array,
    loads: Array,
    motions: sp.csr_array,
    constraints: Constraints,
    interface: Interface,
    state: State,
    before: Array,
    scale: Scale,
    absent: BoolArray | None = None,
) -> Certificate:
    """Measure a state.

    Parameters
    ----------
    K : (dofs, dofs) stiffness, supports not applied
    loads : (dofs,) nodal forces
    motions : (dofs, k) rigid motions of all parts, see :func:`signorini.fem.rigid.rigid_motions`
    state : its displacement and pair forces are the answer to be measured
    before : ((d - 1) n,) tangential displacement at which the slip increment began
    scale : sizes of forces and lengths
    absent : (n,) pairs whose contact is switched off: the law of contact is not asked of them

    Returns
    -------
    Certificate; every number infinite where something is not finite or a body has left
    """
    u, r, n = state.displacement, state.forces, len(interface)
    if not (np.isfinite(u).all() and np.isfinite(r).all()) or np.abs(u).max(initial=0.0) > _FARTHEST * scale.length:
        return Certificate(**{field.name: np.inf for field in fields(Certificate)})
    applied = loads + interface.B.T @ r
    residual = constraints.transform.T @ (K @ u - applied)
    balance = motions.T @ (state.external + constraints.foundation_forces(u) + interface.B.T @ r)
    moved = interface.B @ u
    moved = (moved + interface.compliance * r / interface.areas) / scale.length
    gap = state.point.gap / scale.length + moved[:n]
    normal, tangential = r[:n] / scale.force, interface.across(r[n:]) / scale.force
    sliding = moved[n:] - before / scale.length
    slip = interface.across(sliding)
    gap, tension = np.where(interface.tied, -np.abs(gap), gap), np.where(interface.tied, 0.0, normal)
    room = np.where(interface.tied, np.inf, interface.most(r[:n]) / scale.force) - tangential
    # 0 where friction opposes the slip, 2 where it goes with it
    turned = interface.across(_directions(r[n:], n) + _directions(sliding, n))
    along = 0.5 * turned * np.minimum(tangential, slip)
    # where a pair is open, slip is free: the cone is a point and its room 0
    friction = np.maximum(np.minimum(slip, np.maximum(room, 0.0)), along)
    if absent is not None:
        gap, normal, room, friction = (np.where(absent, 0.0, part) for part in (gap, normal, room, friction))
        tension = np.where(absent, 0.0, tension)
    return Certificate(
        equilibrium=_largest(np.abs(np.concatenate([residual, balance]))) / scale.force,
        penetration=_largest(-gap),
        tension=_largest(-tension),
        cone=_largest(-room),
        complementarity=_largest(np.concatenate([np.minimum(gap, normal), friction])),
    )


def _directions(vectors: Array, n: int) -> Array:
    """Of tangential vectors row by row, ((d - 1) n,); 0 where there is none."""
    rows = vectors.reshape(-1, n) if n else np.zeros((1, 0))
    length = np.linalg.norm(rows, axis=0)
    unit: Array = np.divide(rows, length, out=np.zeros_like(rows), where=length > 0).ravel()
    return unit


def _largest(violation: Array) -> float:
    return float(np.maximum(violation.max(initial=0.0), 0.0)) + 0.0  # NaN stays NaN, -0 becomes 0
