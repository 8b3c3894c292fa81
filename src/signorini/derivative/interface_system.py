# SPDX-License-Identifier: BSD-3-Clause
"""The condensed interface to first order, in states of its pairs: how motions and forces answer, and the transpose.

While pairs keep their states, motions h and forces r are linear in what drives them (see `friction.linear`)::

    h = A r + c + R a,    R'r + q = 0,    h_t = m where a pair sticks,    r_t = s F(p) where it slips

with c the motion of the loads, q their resultants, m the memory of the pair: its tangential displacement at the end of
the piece before. Nothing else is remembered. In space a pair that slips may turn, ``tau . (h - m) = -kappa r_tau``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from types import MappingProxyType

import numpy as np
from scipy.linalg import lapack

from signorini.arrays import Array, BoolArray, IntArray
from signorini.derivative.state_blocks import LONGEST_BLOCK, StateBlocks
from signorini.engine.increments import moved_by_supports
from signorini.engine.prepare import Prepared
from signorini.friction.history.plane.state_inverse import SingularState
from signorini.friction.linear import Equilibrium, LinearSystem, Unknowns, linear_system
from signorini.law.bound import SIGN
from signorini.law.pair import Tangent
from signorini.law.states import OPEN, SLIP_PLUS, STICK
from signorini.solution.state import LoadPoint

_SAME_WAY = 1e-6  # of a unit vector, and of friction over its bound: edges and corners of polygons that are one


@dataclass(frozen=True, kw_only=True, eq=False)
class PairStates:
    """The states of all pairs in one piece, as far as its tangent needs them.

    Attributes
    ----------
    held : (d - 1, n) tangential motions that are what is remembered of them
    unit : (d - 1, n) friction per size of its bound, of pairs that slip; 0 of others
    branch : (n,) of the bound that they slip on
    codes : (n,) in the plane, with the branch
    tangent : in space, the law to first order
    """

    held: BoolArray
    unit: Array
    branch: IntArray
    codes: IntArray | None = None
    tangent: Tangent | None = None

    def same(self, other: PairStates) -> bool:
        """Whether states of the same pairs are the same ones."""
        if self.codes is not None and other.codes is not None:
            return np.array_equal(self.codes, other.codes)
        one, two = self.tangent, other.tangent
        assert one is not None
        assert two is not None
        edge, corner = one.left == 1, one.left == 0  # along an edge friction differs, a corner has no way
        ways = [(one.tau - two.tau)[:, edge], (self.unit - other.unit)[:, corner]]
        return (
            np.array_equal(self.branch, other.branch)
            and all(np.array_equal(getattr(one, name), getattr(two, name)) for name in ("closed", "left"))
            and max(float(np.abs(way).max(initial=0.0)) for way in ways) <= _SAME_WAY
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class UnitLoad:
    """A load or a moving support at factor 1.

    Attributes
    ----------
    forces : (dofs,) nodal forces, with those of what a support prescribes
    offset : (d, a) motions of the active pairs that it prescribes, length
    load, fixed : condensed, all of it and without what a support prescribes
    motion : (d, a) motions of the active pairs where no force acts on them, length
    resultant : (k,) work on the rigid motions
    """

    forces: Array
    offset: Array
    load: Array
    fixed: Array
    motion: Array
    resultant: Array


class InterfaceSystem:
    """The condensed interface of a prepared model to first order; motions and forces are scaled inside, (d, a).

    Parameters
    ----------
    prepared : condensed
    friction : by contact whose friction some step has changed, the name of the coefficient that it has
    locked : by name, the dof of the shortening of every bolt that has locked; its constraints prescribe them
    """

    def __init__(self, prepared: Prepared, friction: Mapping[str, str], locked: Mapping[str, int]) -> None:
        paths = prepared.paths
        self.prepared, self.condensed, self.law = prepared, paths.condensed, paths.law
        self.friction, self.locked = friction, locked
        self.active = np.flatnonzero(self.condensed.active)
        self.root: Array = self.condensed.root
        self.directions, self.pairs = prepared.interface.directions, len(self.active)
        self.motions = self.law.image.R.shape[1]
        self._blocks = StateBlocks(self.law) if self.law.piecewise_linear else None
        self._units: dict[str, UnitLoad] = {}
        self._inside: dict[str, Array] = {}
        self._tangent: tuple[Tangent, LinearSystem] | None = None

    @property
    def bodies(self) -> tuple[int, ...]:
        """Names the bodies, loads and supports under it, which several systems share."""
        return tuple(id(part) for part in (self.condensed.response, self.prepared.loads, self.prepared.constraints))

    def alike(self, other: InterfaceSystem) -> bool:
        """Whether it is that of the same pairs on the same bodies, with the same friction."""
        same = self.bodies == other.bodies and (self.friction, self.locked) == (other.friction, other.locked)
        return same and np.array_equal(self.active, other.active)

    def posed(self, point: LoadPoint) -> LoadPoint:
        """A point of the load history, with the shortenings of locked bolts among its factors."""
        if not self.locked:
            return point
        factors = {**point.factors, **{name: float(point.offset[dof]) for name, dof in self.locked.items()}}
        return replace(point, factors=MappingProxyType(factors), reaction=np.zeros(0), offset=np.zeros(0))

    def states_of_codes(self, codes: IntArray) -> PairStates:
        """The states of codes (n,) with branches, in the plane."""
        slips = codes > STICK
        return PairStates(
            held=(codes == STICK)[None],
            unit=(SIGN[codes] * slips)[None],
            branch=np.where(slips, (codes - SLIP_PLUS) // 2, 0),
            codes=codes,
        )

    def states_without_friction(self, codes: IntArray) -> PairStates:
        """States of open pairs and of such that slip without a force, by codes (n,)."""
        if self.directions == 2:
            return self.states_of_codes(codes)
        none, closed = np.zeros((2, self.pairs)), codes != OPEN
        left = np.zeros(self.pairs, dtype=np.int64)
        tangent = Tangent(closed=closed, left=left, share=none, fixed=none, tau=none, kappa=none[0])
        return PairStates(held=np.zeros((2, self.pairs), dtype=np.bool_), unit=none, branch=left, tangent=tangent)

    def states_of_increment(self, codes: IntArray, h: Array, r: Array) -> PairStates:
        """The states at the end of an increment.

        Parameters
        ----------
        codes : (n,) without branches
        h, r : (d, n) gaps and slips in the increment, forces
        """
        if self._blocks is not None:
            return self.states_of_codes(self.law.pieces.coded(codes, r[0]))
        return self.states_of_law(r - h, r)

    def states_of_law(self, y: Array, r: Array) -> PairStates:
        """The states in space of y, and of forces r, (3, n), see `law.pair`."""
        law = self.law.law
        tangent = law.tangent(y)
        size = law.bound.at(np.maximum(r[0], 0.0))
        slips = tangent.closed & (tangent.left < 2) & (size > 0.0)
        unit = np.divide(r[1:], size, out=np.zeros_like(r[1:]), where=slips)
        held = np.broadcast_to(tangent.closed & (tangent.left == 2), unit.shape)
        return PairStates(held=held, unit=unit, branch=self.law.pieces.branch(r[0]), tangent=tangent)

    def unit(self, name: str) -> UnitLoad:
        """A load or a moving support at factor 1, kept."""
        if name not in self._units:
            prepared, condensed, K = self.prepared, self.condensed, self.prepared.K
            forces = prepared.loads.get(name, prepared.constraints.zeros)
            fixed = load = condensed.reduce(prepared.constraints.on_free(forces)).load
            offset = np.zeros((self.directions, self.pairs))
            if name in prepared.constraints.prescribed:
                u = prepared.constraints.prescribed[name]
                forces, offset = forces - K @ u, moved_by_supports(prepared, u)[:, self.active]
                load = condensed.reduce(prepared.constraints.on_free(forces)).load
            self._units[name] = UnitLoad(
                forces=forces,
                offset=offset,
                load=load,
                fixed=fixed,
                motion=condensed.response.moved(load).reshape(offset.shape) + offset,
                resultant=condensed.response.resultant(load),
            )
        return self._units[name]

    def inside(self, name: str) -> Array:
        """(z,) Free displacements under a load at factor 1 while what is kept of the bodies is held, kept."""
        if name not in self._inside:
            reduced = self.condensed.reduce(self.prepared.constraints.on_free(self.unit(name).forces))
            self._inside[name] = reduced.expand(np.zeros(self.condensed.factorisation.m))
        return self._inside[name]

    def free(self, b: Array) -> Array:
        """(d n + k,) What the equations see of a load b, (d n,), scaled."""
        return np.concatenate([self.law.free_motion(b), self.law.image.R.T @ b])

    def imposed(self, h: Array, r: Array) -> Array:
        """(d n + k,) What motions and forces, (d, n), are worth that come on top of what the states allow."""
        image, flat = self.law.image, r.ravel()
        acting = np.flatnonzero(flat)
        given = flat[acting]
        return np.concatenate([given @ image.A[acting] - h.ravel(), given @ image.R[acting]])

    def ahead(self, points: Iterable[tuple[InterfaceSystem, PairStates]]) -> None:
        """Prepare for states that are asked for next, in order, where that is cheaper than one by one: in the plane.

        Parameters
        ----------
        points : systems and states of the points that come; those of other systems do not matter
        """
        if self._blocks is None:
            return
        coming = (states.codes for system, states in points if system is self and states.codes is not None)
        first = next(coming, None)
        if first is not None and not self._blocks.covers(first):
            self._blocks.ahead([first, *islice(coming, LONGEST_BLOCK)])

    def respond(self, states: PairStates, free: Array) -> tuple[Array, Array]:
        """Motions and forces, (d, n), of what the equations see of a load, (d n + k,).

        Raises
        ------
        SingularState
            Where the states have no unique response.
        """
        if self._blocks is not None and states.codes is not None:
            return self._blocks.respond(states.codes, free)
        system, (A, R) = self._system(states), (self.law.image.A, self.law.image.R)
        unknowns, rows = system.unknowns, len(A)
        x = _back(system, -np.concatenate([unknowns.seen(free[:rows].reshape(self.directions, -1)), free[rows:]]), 0)
        r = unknowns.forces(x[: unknowns.size])
        h = A @ r.ravel() + free[:rows] + R @ x[unknowns.size :]
        return unknowns.prescribed(h.reshape(r.shape)), r

    def respond_transposed(self, states: PairStates, h: Array, r: Array) -> Array:
        """(d n + k,) The transpose of `respond`: what a functional h, r (d, n) of its results is of the load.

        Raises
        ------
        SingularState
            Where the states have no unique response.
        """
        if self._blocks is not None and states.codes is not None:
            return self._blocks.respond_transposed(states.codes, h, r)
        system, (A, R) = self._system(states), (self.law.image.A, self.law.image.R)
        unknowns, flat = system.unknowns, system.unknowns.prescribed(h).ravel()
        pushed = _forces_transposed(unknowns, r + (A @ flat).reshape(r.shape))
        x = _back(system, np.concatenate([pushed, R.T @ flat]), 1)
        return np.concatenate([flat - unknowns.seen_by(x[: unknowns.size]).ravel(), -x[unknowns.size :]])

    def _system(self, states: PairStates) -> LinearSystem:
        """The factorised system of states in space; that of the last ones is kept."""
        assert states.tangent is not None
        if self._tangent is None or self._tangent[0] is not states.tangent:
            self._tangent = states.tangent, linear_system(Equilibrium(problem=self.law), states.tangent)
        if self._tangent[1].singular:
            raise SingularState
        return self._tangent[1]


def _forces_transposed(unknowns: Unknowns, r: Array) -> Array:
    """(size,) The transpose of `Unknowns.forces`, of a functional r (d, n) of forces."""
    law, flat = unknowns.law, r.ravel()
    x = flat[unknowns.rows]
    pairs = unknowns.closed[unknowns.slips]
    x[unknowns.slips] += (law.share[:, pairs] * r[1:, pairs]).sum(axis=0)
    return np.concatenate([x, (unknowns.tau * r[1:, unknowns.one]).sum(axis=0)])


def _back(system: LinearSystem, rhs: Array, transposed: int) -> Array:
    """The solution of a factorised system, or of its transpose."""
    if not len(rhs):
        return rhs
    return np.asarray(lapack.dgetrs(system.lu, system.pivots, rhs, trans=transposed)[0], dtype=np.float64)
