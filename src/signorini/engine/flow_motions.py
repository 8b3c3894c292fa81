# SPDX-License-Identifier: BSD-3-Clause
"""The nearest motions that bodies can flow in: what no stress within the yield stress resists does not strain.

Flow that ran away is nearly such a motion: volumes change a little, bodies that do not yield strain a little, and any
pressure could work on that. With H the stiffness of all this, the nearest motion to v_0 in energy without it minimises

    1/2 (v - v_0)^T K (v - v_0)    where    H v = 0,

by multipliers g of an augmented stiffness, ``(K + s H) v = K v_0 - g,  g <- g + s H v``: one factorisation, and some
digits a round.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from signorini.arrays import Array, BoolArray
from signorini.engine.increment import Mechanism
from signorini.engine.multipliers import MAX_ENTRIES
from signorini.engine.prepare import Prepared
from signorini.fem.kinematics import of_bodies, straining_groups
from signorini.fem.stiffness import stiffness
from signorini.linalg import NotPositiveDefinite, factorise
from signorini.plasticity.volume import volume_rows

_STIFFER = 1e6  # times the elastic law: what is not to strain, so that a round gains up to six digits
_WEAK_SPRING = 1e-9  # of the stiffness of every unknown: what holds bodies that float, and moves no motion
_ROUNDS = 6  # of multipliers: two or three are the rule, more where cells hardly resist a pattern of pressures
_KEPT = 1e-10  # of what the largest velocity could do to it anywhere: more than that is not rounding
_STUCK = 1e-6  # of the largest velocity: pairs that slip less in the motion that was found stick


@dataclass(frozen=True, kw_only=True, eq=False)
class FlowMotions:
    """What must not strain where bodies flow.

    Attributes
    ----------
    prepared : the model
    stiff : (dofs, dofs) stiffness of springs and of the bodies that do not flow without end
    volume : (rows, dofs) volume strain of cells that yield, see `volume_rows`
    """

    prepared: Prepared
    stiff: sp.csr_array
    volume: sp.csr_array

    @staticmethod
    def of(prepared: Prepared) -> FlowMotions | None:
        """What must not strain; None where no body flows without end, or where no factor fits."""
        bodies = prepared.yielding
        if bodies is None or (prepared.solver.paths is None and prepared.K.nnz > MAX_ENTRIES):
            return None
        flows = np.array([body.material.yields for body in prepared.model.bodies]) & ~bodies.laws.endless
        if not flows.any():
            return None
        stiff = stiffness(
            prepared.space, prepared.model, of_bodies(straining_groups(prepared.space, prepared.model), ~flows)
        )
        for springs in prepared.constraints.springs.values():
            stiff = sp.csr_array(stiff + springs.T @ springs)
        return FlowMotions(prepared=prepared, stiff=stiff, volume=volume_rows(bodies))

    def nearest(self, mechanism: Mechanism) -> Array | None:
        """(dofs,) The nearest motion, largest entry 1; None where there is none but rest, up to rounding.

        Pairs that press neither open nor close in it, and stick if they do.
        """
        prepared = self.prepared
        T, B = prepared.constraints.transform, prepared.interface.B
        start = mechanism.free / (float(np.abs(mechanism.free).max(initial=0.0)) or 1.0)
        held = B[self._held(T @ start, mechanism.forces)]
        pairs = sp.csr_array(held @ T)
        K = sp.csr_array(T.T @ prepared.K @ T)
        diagonal = K.diagonal()
        mean = float(diagonal.mean()) or 1.0
        metric = sp.csr_array(K + sp.diags_array(_WEAK_SPRING * np.where(diagonal > 0.0, diagonal, mean)))
        bulk = float(prepared.yielding.laws.bulk.max()) if prepared.yielding is not None else 0.0
        rows = sp.csr_array(self.volume @ T)
        H = sp.csr_array(T.T @ self.stiff @ T + bulk * (rows.T @ rows) + mean * (pairs.T @ pairs))
        space, nodes = prepared.space, prepared.constraints.nodes
        none = np.zeros(0, dtype=np.int64)
        try:
            factor = factorise(sp.csr_array(metric + _STIFFER * H), none, nodes=nodes, points=space.places)
        except NotPositiveDefinite:
            return None
        given, pull = metric @ start, np.zeros(len(start))
        for _ in range(_ROUNDS):
            free = factor.reduce(given - pull).expand(np.zeros(0))
            largest = float(np.abs(free).max(initial=0.0))
            if largest == 0.0:
                return None
            v = T @ (free / largest)
            if self._holds(v, held):
                return np.asarray(v, dtype=np.float64)
            pull += _STIFFER * (H @ free)
        return None

    def _held(self, v: Array, forces: Array) -> BoolArray:
        """(d n,) Rows of B that do not move: of pairs that press, of those that stick, and of ties."""
        interface, absent = self.prepared.interface, self.prepared.absent
        pressed = (forces[0] > 0.0) & ~absent
        moved = interface.motion(v)
        stuck = pressed & (interface.most(forces[0]) > 0.0) & (np.linalg.norm(moved[1:], axis=0) <= _STUCK)
        whole = stuck | (interface.tied & ~absent)
        return np.concatenate([pressed | whole, *[whole] * (interface.directions - 1)])

    def _holds(self, v: Array, held: sp.csr_array) -> bool:
        """Whether a motion (dofs,) leaves all that must not strain alone, up to rounding."""
        return all(
            np.abs(rows @ v).max(initial=0.0) <= _KEPT * abs(rows).sum(axis=1).max(initial=0.0)
            for rows in (self.volume, self.stiff, held)
        )
