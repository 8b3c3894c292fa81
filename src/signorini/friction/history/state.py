# SPDX-License-Identifier: BSD-3-Clause
"""Where a load history stands: load, motions, forces, and the little that Coulomb friction remembers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray, frozen
from signorini.errors import InputError, SolveFailed
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN
from signorini.settings import SolverSettings

AT_REST = "nothing has moved"
PRESSED = "the load presses: one increment from zero slip"
"""What a first state says of itself."""

_IDLE = 1e-12  # of the data: a force that rounding leaves


@dataclass(frozen=True, kw_only=True)
class PathState:
    """One instant of a history, in the scaled units of the problem.

    Attributes
    ----------
    b : (d n,) load, with the slip of no step before in it
    h : (d, n) gap >= 0, then the total tangential displacement
    r : (d, n) normal force >= 0, then the tangential force on body 1
    state : (n,) codes of `signorini.law.states`; SLIP_PLUS in the plane: friction along +t, slip rate <= 0. Within a
        path there with the branch of the bound that a pair slips on, see `signorini.law.bound`
    anchor : (d - 1, n) tangential displacement at which a sticking pair is held; of others, where they last stuck
    slip : (d - 1, n) slip accumulated while closed, with its sign
    dissipation : (n,) work that friction has consumed
    note : how the first state was found
    """

    b: Array
    h: Array
    r: Array
    state: IntArray
    anchor: Array
    slip: Array
    dissipation: Array
    note: str = ""

    def __post_init__(self) -> None:
        for name in ("b", "h", "r", "anchor", "slip", "dissipation"):
            object.__setattr__(self, name, frozen(getattr(self, name)))
        object.__setattr__(self, "state", frozen(self.state, dtype=np.int64))

    @property
    def pairs(self) -> int:
        """Number of pairs n."""
        return len(self.state)

    def bears(self, r: Array, scale: float) -> BoolArray:
        """(n,) Pairs that more than rounding presses or rubs here or later, under forces r (d, n): their slip counts.

        ``scale`` is the size of the data.
        """
        return np.asarray(np.maximum(np.abs(r), np.abs(self.r)).max(axis=0) > _IDLE * (scale or 1.0), dtype=np.bool_)


def initial_state(
    problem: ContactProblem, b: Array, *, motion: Array | None = None, settings: SolverSettings | None = None
) -> PathState:
    """The start of a history: every pair open, forces zero, unless the load presses already.

    Parameters
    ----------
    problem : the problem; its own b is not used
    b : (d n,) load at the start; ``G h0`` for h0 = (initial gap, 0) where nothing acts yet
    motion : (d, n) h0. Where it is not given and b is not in equilibrium without forces, or bodies float (b does not
        tell where), one Coulomb problem with zero slip as anchor is solved, and the note says so
    settings : limits of the methods that solve it

    Raises
    ------
    InputError
        Where shapes do not fit, or ``motion`` has negative gaps or is not in equilibrium with b.
    SolveFailed
        Where the load presses and no equilibrium was found.

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.zeros(2), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> state = initial_state(problem, np.array([0.1, 0.0]))
    >>> state.h.round(12).tolist(), state.state.tolist(), state.note
    ([[0.2], [0.0]], [0], 'nothing has moved')
    """
    n = problem.pairs
    load = np.asarray(b, dtype=np.float64)
    if load.shape != problem.b.shape:
        raise InputError(f"has shape {load.shape}; expected {problem.b.shape}", where=("b",))
    posed = replace(problem, b=frozen(load))
    tolerance = 1e-10 * (problem.scale or 1.0)
    h = problem.by_pair(posed.free_motion(load)) if motion is None else np.asarray(motion, dtype=np.float64)
    if motion is not None:
        if h.shape != (problem.directions, n) or (h[0] < 0).any():
            raise InputError("expected a gap >= 0 and a tangential displacement for each pair", where=("motion",))
        if np.abs(posed.misfit(h, np.zeros_like(h))).max(initial=0.0) > tolerance:
            raise InputError("is not in equilibrium with b without forces", where=("motion",))
    elif problem.floating or h[0].min(initial=0.0) < -tolerance:
        return _pressed(posed, settings)
    h = np.concatenate([np.maximum(h[:1], 0.0), h[1:]])
    none = np.zeros_like(h)
    return PathState(
        b=load, h=h, r=none, state=np.full(n, OPEN), anchor=h[1:], slip=none[1:], dissipation=none[0], note=AT_REST
    )


def _pressed(problem: ContactProblem, settings: SolverSettings | None) -> PathState:
    result = solve_contact(problem, settings=settings)
    if not result.solved:
        raise SolveFailed(f"at the start of the history: {result.message}", status=result.outcome)
    slip = np.where(result.state == OPEN, 0.0, result.h[1:])
    return PathState(
        b=problem.b,
        h=result.h,
        r=result.r,
        state=result.state,
        anchor=result.h[1:],
        slip=slip,
        dissipation=np.maximum(-(result.r[1:] * slip).sum(axis=0), 0.0),
        note=PRESSED,
    )
