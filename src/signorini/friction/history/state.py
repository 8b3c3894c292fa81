# SPDX-License-Identifier: BSD-3-Clause
"""Where a load history stands: load, motions, forces, and the little that Coulomb friction remembers."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, IntArray, frozen
from signorini.errors import InputError, SolveFailed
from signorini.friction.problem import ContactProblem
from signorini.friction.solve import solve_contact
from signorini.law.states import OPEN

AT_REST = "nothing has moved"
PRESSED = "the load presses: one increment from zero slip"
"""What a first state says of itself."""


@dataclass(frozen=True, kw_only=True)
class PathState:
    """One instant of a history, in the scaled units of the problem; in space with 3n and 2n instead of 2n and n rows.

    Attributes
    ----------
    b : (2n,) load, with the slip of no step before in it
    h : (2n,) gap >= 0, then the total tangential displacement
    r : (2n,) normal force >= 0, then the tangential force on body 1
    state : (n,) codes of `signorini.law.states`; SLIP_PLUS: friction along +t, slip rate <= 0. Within a path with the
        branch of the bound that a pair slips on, see `signorini.law.bound`
    anchor : (n,) tangential displacement at which a sticking pair is held; of others, where they last stuck
    slip : (n,) slip accumulated while closed, with its sign
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


def initial_state(problem: ContactProblem, b: Array, *, motion: Array | None = None) -> PathState:
    """The start of a history: every pair open, forces zero, unless the load presses already.

    Parameters
    ----------
    problem : the problem; its own b is not used
    b : (2n,) load at the start; ``G h0`` for h0 = (initial gap, 0) where nothing acts yet
    motion : (2n,) h0. Where it is not given and b is not in equilibrium without forces, or bodies float (b does not
        tell where), one Coulomb problem with zero slip as anchor is solved, and the note says so

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
    ([0.2, 0.0], [0], 'nothing has moved')
    """
    n = problem.pairs
    load = np.asarray(b, dtype=np.float64)
    if load.shape != (2 * n,):
        raise InputError(f"has shape {load.shape}; expected {(2 * n,)}", where=("b",))
    posed = replace(problem, b=frozen(load))
    tolerance = 1e-10 * (problem.scale or 1.0)
    if motion is not None:
        h = np.asarray(motion, dtype=np.float64)
        if h.shape != (2 * n,) or (h[:n] < 0).any():
            raise InputError("expected a gap >= 0 and a tangential displacement for each pair", where=("motion",))
        if np.abs(posed.misfit(h, np.zeros(2 * n))).max(initial=0.0) > tolerance:
            raise InputError("is not in equilibrium with b without forces", where=("motion",))
        return _still(load, h)
    h = posed.free_motion(load)
    if not problem.floating and h[:n].min(initial=0.0) >= -tolerance:
        return _still(load, np.concatenate([np.maximum(h[:n], 0.0), h[n:]]))
    return _pressed(posed)


def _still(b: Array, h: Array) -> PathState:
    n = len(b) // 2
    none = np.zeros(n)
    return PathState(
        b=b,
        h=h,
        r=np.zeros(2 * n),
        state=np.full(n, OPEN),
        anchor=h[n:],
        slip=none,
        dissipation=none,
        note=AT_REST,
    )


def _pressed(problem: ContactProblem) -> PathState:
    result = solve_contact(problem)
    if not result.solved:
        raise SolveFailed(f"at the start of the history: {result.message}", status=result.outcome)
    slip = np.where(result.state == OPEN, 0.0, result.slip)
    return PathState(
        b=problem.b,
        h=result.h.ravel(),
        r=result.r.ravel(),
        state=result.state,
        anchor=result.slip,
        slip=slip,
        dissipation=np.maximum(-result.tangential_force * slip, 0.0),
        note=PRESSED,
    )
