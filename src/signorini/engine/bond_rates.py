# SPDX-License-Identifier: BSD-3-Clause
"""Which bonds go on to open, which hold and which close again, as loads go on; and how their tensions change.

Bonds that open are springs between the sides, of which those that soften have a negative stiffness. While the states of
all other pairs stay what they are, tensions, motions and forces are linear in the load, and one dense system of the
pairs that are closed and the springs gives their rates. Springs that soften are in stable equilibrium with the bodies
as long as that system has as many negative eigenvalues as springs that soften and rigid motions (Sylvester's law). In a
motion that has not that some springs may close: those do not soften but unload, so the others are looked at alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg

from signorini.arrays import Array, BoolArray, IntArray
from signorini.engine.path_states import path_state, right_hand_side
from signorini.engine.prepare import Prepared
from signorini.friction.history import PathState
from signorini.friction.problem import ContactProblem
from signorini.law.bound import plain
from signorini.law.cohesion import Bonds, PairCohesion
from signorini.law.states import OPEN, SLIP, STICK
from signorini.solution.state import LoadPoint, State

_TRIALS = 100
"""Sets of bonds that soften which are tried at one load, at most: two or three are usual."""

_TRIALS_TOGETHER = 20  # trials in which all bonds that belong elsewhere change at once, before one by one
_AT_LIMIT = 1e-9  # of the strength, or of the largest opening so far: how near to it a bond is at its limit
_CLOSED = 1e-10  # of the opening at which a bond is gone: less is none
_ALIKE = 1e-6  # of the largest part in a motion: bonds that take the same part in it
_STILL = 1e-9  # of the largest rate: one that is none
_RESERVE = 2.0  # times the strength: with what a bond holds beside the law, so that no pair of its is on the verge


@dataclass(frozen=True, kw_only=True, eq=False)
class Posed:
    """A state as the law of contact sees it, with what bonds pull beside it.

    Attributes
    ----------
    prepared : with pairs that stick where bonds hold
    state : with its pull
    held, soft, back, driven : (n,) bonds that hold, that soften, that are on the way back or up it again, and whose
        forces are given
    """

    prepared: Prepared
    state: State
    held: BoolArray
    soft: BoolArray
    back: BoolArray
    driven: BoolArray

    @property
    def springs(self) -> BoolArray:
        """(n,) Bonds that have begun to open and are open."""
        return self.soft | self.back

    def moved_on(self, change: Array) -> Array:
        """(d, n) Pull behind a change of it."""
        assert self.state.point.pull is not None
        return self.state.point.pull + change


def bonds_of(prepared: Prepared, state: State) -> tuple[PairCohesion, Bonds]:
    """The bonds of a model that has some, and what they remember."""
    cohesion, bonds = prepared.interface.cohesion, state.bonds
    assert cohesion is not None
    assert bonds is not None
    return cohesion, bonds


def pose(
    prepared: Prepared,
    state: State,
    soft: BoolArray,
    driven: BoolArray,
    sheared: BoolArray,
    codes: IntArray | None = None,
) -> Posed:
    """A state as the law sees it; bonds that are not told go on as their damage says.

    Parameters
    ----------
    prepared, state : condensed, and where the history stands
    soft, driven, sheared : (n,) bonds that soften, whose forces are given, and of which those along the sides are
    codes : as of `course`
    """
    cohesion, bonds = bonds_of(prepared, state)
    asked = prepared.solver.active & ~prepared.absent
    held = cohesion.holds(bonds) & ~soft & ~driven & asked
    begun = (cohesion.most > 0.0) & (bonds.damage > 0.0) & (bonds.damage < 1.0)
    opens = state.gap > _CLOSED * cohesion.opening
    if codes is not None:
        opens[prepared.solver.active] |= plain(codes) == OPEN
    back = begun & opens & ~soft & ~driven & asked
    given = soft | back | driven
    pull = np.where(given, state.forces, 0.0)
    pull[1:, sheared] = state.forces[1:, sheared]
    pull[0] -= np.where(held, _RESERVE * cohesion.most, 0.0)
    sticks = cohesion.sticking(bonds) & ~sheared
    status = np.where(held, np.where(sticks, STICK, SLIP), np.where(given, OPEN, state.status))
    gap = np.where(held, np.minimum(state.gap, 0.0), state.gap)  # overlaps press first
    interface = prepared.interface
    sticking = replace(interface, friction=interface.friction.bonded(held, sticks)) if held.any() else interface
    solver = prepared.solver.under(sticking, prepared.scale, np.zeros(len(held), np.bool_))
    return Posed(
        prepared=replace(prepared, interface=sticking, solver=solver),
        state=replace(state, point=state.point.changed(pull=pull), status=status, gap=gap),
        held=held,
        soft=soft,
        back=back,
        driven=driven,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class BondCourse:
    """How bonds go on from a state.

    Attributes
    ----------
    posed : the state with the bonds that soften
    pull : (d, n) change of what bonds pull up to the end of the way, if nothing happens
    breaking : (n,) bonds that cannot go on gradually: they let go at this load; none where all can
    """

    posed: Posed
    pull: Array
    breaking: BoolArray


def course(
    prepared: Prepared,
    state: State,
    end: LoadPoint,
    driven: BoolArray,
    sheared: BoolArray,
    codes: IntArray | None = None,
) -> BondCourse:
    """How bonds go on from a state towards a load.

    Parameters
    ----------
    prepared, state : condensed, and where the history stands
    end : of the way
    driven, sheared : (n,) bonds whose forces go to zero on it, and of which only those along the sides do
    codes : (a,) states of the active pairs from here on, where they are known; as the state says where not
    """
    cohesion, bonds = bonds_of(prepared, state)
    full = cohesion.holds(bonds) & (state.forces[0] <= -(1.0 - _AT_LIMIT) * cohesion.most)
    soft, none = sheared & ~driven & full, np.zeros_like(driven)
    together: BondCourse | None = None
    shut = letting_go = none
    for trial in range(_TRIALS):
        posed = pose(prepared, state, soft, driven, sheared, codes)
        start = path_state(posed.prepared, posed.state)
        change = np.zeros_like(state.forces)
        change[:, driven] = -state.forces[:, driven]
        change[1:, sheared] = -state.forces[1:, sheared]
        b = right_hand_side(posed.prepared, end.changed(pull=posed.moved_on(change)))
        rates = _rates(posed, start, b - start.b, codes)
        if rates is None:
            return BondCourse(posed=posed, pull=change, breaking=none)
        motion, force, stable = rates
        torn, closes = _turning(posed, motion, force)
        settled = not (torn | closes).any()
        if not stable and together is None:
            opening = _unresisted(posed, start, codes)
            letting_go, shut = np.abs(opening) >= (1.0 - _ALIKE) * np.abs(opening).max(), soft & (opening < 0.0)
        if not stable and together is None and settled and shut.any():
            # bonds that close unload, and resist: those that open alone have to be stable, and not to go on alone
            together = _gone_on(posed, change, motion)
            soft = soft & ~shut
            continue
        if not stable:
            return BondCourse(posed=posed, pull=change, breaking=letting_go)
        brittle = (torn | _slipping_off(posed, force)) & (cohesion.opening == 0.0)
        if brittle.any():
            return BondCourse(posed=posed, pull=change, breaking=brittle)
        if together is not None and (torn & shut).any():
            return together
        if settled:
            return _gone_on(posed, change, motion)
        if trial >= _TRIALS_TOGETHER:
            first = np.arange(len(soft)) == int(np.argmax(torn | closes))
            torn, closes = torn & first, closes & first
        soft = (soft | torn) & ~closes
    return BondCourse(posed=posed, pull=change, breaking=soft)


def _gone_on(posed: Posed, change: Array, motion: Array) -> BondCourse:
    """Bonds that go on gradually; ``change`` (d, n) of given forces and ``motion`` (n,) up to the end of the way."""
    pull = change.copy()
    pull[0] -= np.where(posed.springs, stiffness(posed) * motion, 0.0)
    return BondCourse(posed=posed, pull=pull, breaking=np.zeros_like(posed.soft))


def _turning(posed: Posed, motion: Array, force: Array) -> tuple[BoolArray, BoolArray]:
    """(n,) each: bonds at their limit that the rates (n,), (d, n) open farther, and that soften and close."""
    (cohesion, bonds), state = bonds_of(posed.prepared, posed.state), posed.state
    still, least = (_STILL * float(np.abs(rate).max(initial=0.0)) for rate in (motion, force))
    torn = posed.held & (state.forces[0] <= -(1.0 - _AT_LIMIT) * cohesion.most) & (force[0] < -least)
    edge = bonds.damage * cohesion.opening
    torn |= posed.back & (state.gap >= (1.0 - _AT_LIMIT) * edge) & (motion > still)
    return np.asarray(torn), np.asarray(posed.soft & (motion < -still))


def _slipping_off(posed: Posed, force: Array) -> BoolArray:
    """(n,) Bonds that bear as much along the sides as they can, and more at rates (d, n) of forces."""
    grows = (posed.state.forces[1:] * force[1:]).sum(axis=0) > 0.0
    return np.asarray(full_along(posed.prepared, posed.state) & posed.held & grows)


def left_shear(prepared: Prepared, state: State) -> BoolArray:
    """(n,) Bonds at their strength, or open, with forces along the sides that they no longer bear."""
    cohesion, bonds = bonds_of(prepared, state)
    full = cohesion.holds(bonds) & (state.forces[0] <= -(1.0 - _AT_LIMIT) * cohesion.most) & (cohesion.opening > 0.0)
    opens = (bonds.damage > 0.0) & (bonds.damage < 1.0) & (state.gap > _CLOSED * cohesion.opening)
    along = np.abs(state.forces[1:]).max(axis=0)
    return np.asarray((full | opens) & (along > _AT_LIMIT * cohesion.most))


def full_along(prepared: Prepared, state: State) -> BoolArray:
    """(n,) Bonds that bear as much along the sides as they can."""
    cohesion, bonds = bonds_of(prepared, state)
    bears = np.linalg.norm(state.forces[1:], axis=0) >= (1.0 - _AT_LIMIT) * cohesion.along
    return np.asarray(cohesion.sticking(bonds) & bears)


def stiffness(posed: Posed) -> Array:
    """(n,) Growth of the tension of springs with their opening, force per length."""
    cohesion, bonds = bonds_of(posed.prepared, posed.state)
    span = np.where(cohesion.opening > 0.0, cohesion.opening, 1.0)
    up = np.divide(1.0 - bonds.damage, bonds.damage, out=np.zeros_like(span), where=bonds.damage > 0.0)
    return cohesion.most / span * np.where(posed.soft, -1.0, up)


def _rates(posed: Posed, start: PathState, b: Array, codes: IntArray | None) -> tuple[Array, Array, bool] | None:
    """(n,) Normal motions and (d, n) forces of pairs that a change of the load b causes, and whether that is stable.

    None where the bodies are not held by what is closed.
    """
    system = _System.of(posed, start, codes)
    image, rows = system.law.image, system.rows
    free, resultant = image.free_motion(b), image.R.T @ b
    solved = system.solve(np.concatenate([-free[rows], -resultant]))
    if solved is None:
        return None
    r = system.forces @ solved[: len(rows)]
    h = free + image.A @ r + image.R @ solved[len(rows) :]
    root, active, n = posed.prepared.paths.condensed.root, posed.prepared.paths.condensed.active, len(start.state)
    motion, force = np.zeros(len(active)), np.zeros_like(posed.state.forces)
    motion[active], force[:, active] = h[:n] / root, root * system.law.by_pair(r)
    return motion, force, system.stable


def _unresisted(posed: Posed, start: PathState, codes: IntArray | None) -> Array:
    """(n,) Opening of bonds that soften in the motion that springs resist least, the largest positive; 0 of others."""
    system = _System.of(posed, start, codes)
    condensed, cohesion = posed.prepared.paths.condensed, bonds_of(posed.prepared, posed.state)[0]
    own, root, found = np.flatnonzero(condensed.active)[system.springs], condensed.root, np.zeros(len(posed.soft))
    weights = np.diag(cohesion.most[own] / root[system.springs] ** 2)
    motion = scipy.linalg.eigh(system.seen, weights)[1][:, 0] / root[system.springs]
    found[own] = motion * posed.soft[own]
    return found if found.max() >= -found.min() else -found


@dataclass(frozen=True, kw_only=True, eq=False)
class _System:
    """Closed pairs and springs, in the scaled units of the law.

    Attributes
    ----------
    law : of the active pairs
    rows : of normals of closed pairs and springs, then of tangents of pairs that stick
    springs : numbers of active pairs that are springs
    forces : (d a, rows) forces of all pairs by those of the rows: friction goes with the normal force where pairs slip
    matrix : compliance of the rows, and rigid motions
    symmetric : the same without friction of pairs that slip
    soft : how many springs soften
    """

    law: ContactProblem
    rows: IntArray
    springs: IntArray
    forces: Array
    matrix: Array
    symmetric: Array
    soft: int

    @staticmethod
    def of(posed: Posed, start: PathState, codes: IntArray | None) -> _System:
        """Of a state of the path."""
        paths = posed.prepared.paths
        law, condensed, n = paths.law, paths.condensed, paths.law.pairs
        active, image = condensed.active, paths.law.image
        held, open_now = posed.held[active], (posed.springs | posed.driven)[active]
        known = _with_branches(law, start) if codes is None else codes
        status = plain(known)
        opens = open_now if codes is None else posed.springs[active]
        status = np.where(held, start.state, np.where(opens, OPEN, status))
        spring = posed.springs[active]
        normal = np.flatnonzero((status != OPEN) | spring)
        tangents = [n * (k + 1) + np.flatnonzero((status == STICK) & ~law.locked[k]) for k in range(law.directions - 1)]
        rows = np.concatenate([normal, *tangents])
        plainly = np.zeros((len(law.b), len(rows)))
        plainly[rows, np.arange(len(rows))] = 1.0
        forces = plainly.copy()
        for i in np.flatnonzero(status > STICK):
            column = int(np.searchsorted(normal, i))
            forces[n + i :: n, column] = _slope(law, start, int(i), known)
        own = np.flatnonzero(spring[normal])
        by_force = np.zeros(len(rows))
        scaled = stiffness(posed)[active][normal[own]] / condensed.root[normal[own]] ** 2
        by_force[own] = 1.0 / scaled
        R, k = image.R, image.R.shape[1]

        def whole(forces: Array) -> Array:
            compliance = image.A[rows] @ forces + np.diag(by_force)
            return np.block([[compliance, R[rows]], [R.T @ forces, np.zeros((k, k))]])

        symmetric = whole(plainly)
        slides = bool((status > STICK).any())
        return _System(
            law=law,
            rows=rows,
            springs=normal[own],
            forces=forces,
            matrix=whole(forces) if slides else symmetric,
            symmetric=symmetric,
            soft=int((scaled < 0.0).sum()),
        )

    def solve(self, right: Array) -> Array | None:
        """Forces of the rows, and rigid motions; None where nothing is determined."""
        if not len(right):
            return right
        try:
            with np.errstate(all="ignore"):
                found = scipy.linalg.solve(self.matrix, right)
        except (np.linalg.LinAlgError, scipy.linalg.LinAlgWarning):
            return None
        return np.asarray(found) if np.isfinite(found).all() else None

    @property
    def stable(self) -> bool:
        """Whether equilibrium with the springs that soften is stable."""
        if not self.soft:
            return True
        blocks = scipy.linalg.ldl(self.symmetric)[1]
        return int((np.linalg.eigvalsh(blocks) < 0.0).sum()) == self.soft + self.law.image.R.shape[1]

    @property
    def seen(self) -> Array:
        """(s, s) Stiffness of the bodies as springs see them, with that of the springs."""
        own = np.flatnonzero(np.isin(self.rows, self.springs))
        springs = np.zeros(len(self.symmetric), np.bool_)
        springs[own] = True
        bare = self.symmetric.copy()
        added = np.diag(self.symmetric)[own] - np.diag(self.law.image.A)[self.rows[own]]
        bare[own, own] -= added
        rest = bare[np.ix_(~springs, ~springs)]
        across = bare[np.ix_(~springs, springs)]
        compliance = bare[np.ix_(springs, springs)] - across.T @ np.linalg.lstsq(rest, across, rcond=None)[0]
        return np.linalg.pinv(compliance) + np.diag(1.0 / added)


def _with_branches(law: ContactProblem, start: PathState) -> IntArray:
    """(n,) States of pairs, of those that slip with the branch of their bound."""
    return law.pieces.coded(start.state, start.r[0]) if law.directions == 2 else start.state


def _slope(law: ContactProblem, start: PathState, i: int, states: IntArray) -> Array:
    """(d - 1,) Friction per normal force of a pair that slips."""
    if law.directions == 2:
        return law.pieces.slope(states)[i : i + 1]
    p = float(start.r[0, i])
    return start.r[1:, i] / p if p > 0.0 else np.zeros(law.directions - 1)
