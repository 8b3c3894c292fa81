# SPDX-License-Identifier: BSD-3-Clause
"""Semismooth Newton of Alart and Curnier: linearise the law of every pair, solve, read the law off the answer, repeat.

Two ways of a step. In the plane, with a bound of straight branches, the law of a pair has a few states: guess them,
solve, read the states off the answer (the primal-dual active set method). Three steps are usual; in 2-3 % of hard
problems the states repeat in a cycle, and the path method takes over. Many closed pairs are iterated as long as that
leads to states not tried before: of an edge that moves by a pair a step, as that of a long sticking zone does, the next
state is all that a step has to tell. The last system is factorised.

With any other law iterates are in equilibrium and break the law, by ``r - P(r - h)``, a force. A step is shortened
where no part of the last violations is reached; nearly always the whole of it is taken, and five or six are usual.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.attempt import MethodRun
from signorini.friction.candidate import NewtonEnd
from signorini.friction.certificate import certify
from signorini.friction.krylov import ITERATED_UNKNOWNS, iterate
from signorini.friction.linear import Balance, Equilibrium, LinearSystem, linear_system
from signorini.friction.problem import ContactProblem
from signorini.law.bound import plain
from signorini.law.pair import Tangent
from signorini.law.states import OPEN, STICK, UNDECIDED
from signorini.settings import MAX_TOLERANCE

MEMORY = 5
"""Last violations of which a step must undercut the largest."""

RESIDUAL_ROUNDING = 1e-13
"""What an iterate may lack, relative, without one more step."""

SHORTEST_STEP = 2.0**-6
"""Part of a Newton step that is tried last; then the best part is taken, whatever it lacks."""

DECREASE = 1e-4
"""Of the violation that a step must undercut, times its length: by how much, so that progress is no rounding."""

_STATES_FORWARD = 1e-3  # of what the last states lack in the next ones: enough for the states that follow
_FORWARD = 1e-2, 1e-4  # of what the last iterate lacks: what may be left while states change, and once none does
_MISFIT_TOL = 1e-11  # of the data: what states that leave forces undetermined may lack of equilibrium


def by_states(
    problem: ContactProblem,
    start: IntArray | None = None,
    *,
    near: Array | None = None,
    limit: int = 200,
    tolerance: float = 1e-10,
) -> NewtonEnd:
    """Newton from given states of the plane; ends at a solution, a repeated state, a singular state or the limit.

    Parameters
    ----------
    problem : the problem, piecewise linear
    start : (n,) states to begin with; every pair sticking where not given
    near : (2, n) a y from which an undetermined motion departs least; 0 where not given
    limit : most systems solved
    tolerance : of `certify`

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> end = by_states(problem)
    >>> end.y.round(12).tolist(), end.attempt.end, end.attempt.changes
    ([[2.0], [-1.0]], 'certified', (1,))
    """
    state = admissible(problem, start)
    y = np.zeros((2, problem.pairs)) if near is None else near
    r, rigid = np.zeros_like(y), np.zeros(problem.motions.shape[1])
    seen: dict[bytes, IntArray] = {}
    changes: list[int] = []
    end, index, residual = "limit reached", 0, np.inf
    for _ in range(limit):
        seen[state.tobytes()] = state
        found, following, index = _next_states(problem, state, y, seen)
        if found is None:
            end = "singular state"
            break
        r, rigid, h = found
        y = r - h
        residual = certify(problem, y)
        changes.append(int(np.count_nonzero(following != state)))
        if residual <= tolerance:
            index = index or in_states(problem, state).index  # an iterated answer knows none
            end = "certified"
            break
        state = following
        if state.tobytes() in seen:
            end = "states repeat"
            break
    late = list(seen.values())[len(seen) // 2 :] + [state]
    return NewtonEnd(
        y=y,
        force=r,
        rigid=rigid,
        state=state,
        residual=residual,
        index=index,
        attempt=MethodRun(method="newton", iterations=len(changes), changes=tuple(changes), end=end),
        touched=np.any([tried != OPEN for tried in late], axis=0),
        converged=residual <= tolerance,
    )


def in_states(problem: ContactProblem, state: IntArray) -> LinearSystem:
    """The system of one state of the pairs of a piecewise linear problem.

    Parameters
    ----------
    problem : the problem
    state : (n,) OPEN, STICK, SLIP_PLUS or SLIP_MINUS, or the code of slip on another branch

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.2]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> y_in_states(in_states(problem, np.array([STICK])), np.zeros((2, 1))).round(12).tolist()
    [[2.0], [-0.4]]
    """
    return linear_system(Equilibrium(problem=problem), Tangent.of_states(problem.pieces, state))


def y_in_states(system: LinearSystem, near: Array) -> Array | None:
    """The y = r - h, (2, n), that is in equilibrium in a state; None where nothing is.

    Parameters
    ----------
    system : of the state
    near : (2, n) a y: where the system is singular, the one of least change from it
    """
    found = _in_states(system, near)
    return None if found is None else found[0] - found[2]


def _in_states(system: LinearSystem, near: Array) -> Balance | None:
    problem = system.equilibrium.problem
    if not system.singular:
        return system.solve(near, np.zeros(problem.motions.shape[1]))
    h, r = problem.law.split(near)
    found = system.solve(r, problem.image.R.T @ h.ravel())
    if found is None:
        return None
    r, a, h = found
    missing = [system.unknowns.seen(h), system.equilibrium.lacking(r, a)]
    if np.abs(np.concatenate(missing)).max(initial=0.0) > _MISFIT_TOL * problem.scale:
        return None
    return r, a, system.unknowns.prescribed(h)


def _next_states(
    problem: ContactProblem, state: IntArray, y: Array, seen: dict[bytes, IntArray]
) -> tuple[Balance | None, IntArray, int]:
    """What balances in given states, the states that follow and the index of their system.

    Parameters
    ----------
    y : (2, n) the last one
    seen : states tried before
    """
    law = problem.law
    tangent = Tangent.of_states(problem.pieces, state)
    if _many(tangent):
        h, r = law.split(y)
        nearly = iterate(problem, tangent, r, problem.image.R.T @ h.ravel(), forward=_STATES_FORWARD)
        if nearly is not None:
            following = law.states(nearly[0] - nearly[2])
            if following.tobytes() not in seen:
                return nearly, following, 0
    system = linear_system(Equilibrium(problem=problem), tangent)
    found = _in_states(system, y)
    if found is None:
        return None, state, 0
    return found, law.states(found[0] - found[2]), system.index


def admissible(problem: ContactProblem, start: IntArray | None) -> IntArray:
    """States to start from that each pair can take; all closed (sticking where they can) where none are given."""
    state = np.full(problem.pairs, STICK, dtype=np.int64) if start is None else np.array(start, dtype=np.int64)
    state[state == UNDECIDED] = STICK
    closed = problem.law.closed
    forced = (state != OPEN) & (closed != UNDECIDED) & (plain(state) != closed)
    return np.where(forced, closed, state).astype(np.int64)


def searched(
    equilibrium: Equilibrium,
    law: Tangent,
    *,
    force: Array | None = None,
    rigid: Array | None = None,
    limit: int = 25,
    tolerance: float = 1e-10,
    method: str = "newton",
) -> NewtonEnd:
    """Newton's method with a line search, from a linear law.

    Parameters
    ----------
    equilibrium : the problem as posed, or with a proximal layer
    law : the law of every pair, linear: `PairLaw.sticking`, or `PairLaw.tangent` at the last solution
    force, rigid : (d, n) and (k,) that forces left undetermined depart least from; 0 where not given
    limit : most systems solved
    tolerance : of `certify`; with a layer of the violation of the law
    method : its name in the trace

    References
    ----------
    Alart, Curnier (1991), Computer Methods in Applied Mechanics and Engineering 92:353-375. Grippo, Lampariello,
    Lucidi (1986), SIAM Journal on Numerical Analysis 23:707-716 (the search).

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.3, 0.4]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> end = searched(Equilibrium(problem=problem), problem.law.sticking)
    >>> problem.law.split(end.y)[1].round(12).tolist(), end.attempt.end, end.attempt.iterations
    ([[2.0], [-0.12], [-0.16]], 'certified', 1)
    """
    problem = equilibrium.problem
    r = np.zeros((problem.directions, problem.pairs)) if force is None else force
    a = np.zeros(problem.motions.shape[1]) if rigid is None else rigid
    h, history = r, [np.inf]
    changes: list[int] = []
    best, end, converged = (np.inf, r, a, r - h), "limit reached", False
    for _ in range(limit):
        found = _balanced(equilibrium, law, r, a, settled=changes[-1:] == [0])
        if found is None:
            end = "singular system"
            break
        r, a, h, violation = _shortened(equilibrium, (r, a, h), found, max(history[-MEMORY:]))
        history.append(violation)
        following = problem.law.tangent(r - h)
        changes.append(int(np.count_nonzero((following.closed != law.closed) | (following.left != law.left))))
        law = following
        done = converged or tolerance > MAX_TOLERANCE  # the step after the first certified one squares its error
        lacking = _lacking(equilibrium, r, h, violation)
        if lacking < best[0]:
            best = lacking, r, a, r - h
        converged = converged or lacking <= tolerance
        if (done and converged) or lacking <= RESIDUAL_ROUNDING:
            break
    if converged:
        end = "certified" if equilibrium.as_posed else "converged"
    _, r, a, y = best
    if not equilibrium.as_posed:
        y = r - replace(equilibrium, alpha=0.0, beta=0.0, force=None, motion=None).moved(r, a)
    return NewtonEnd(
        y=y,
        force=r,
        rigid=a,
        residual=certify(problem, y) if np.isfinite(best[0]) else np.inf,
        attempt=MethodRun(method=method, iterations=len(changes), changes=tuple(changes), end=end),
        converged=converged,
    )


def _many(law: Tangent) -> bool:
    """Whether the unknowns of a law are so many that a factorisation costs more than an iteration."""
    return bool(np.count_nonzero(law.closed) + law.left.sum() >= ITERATED_UNKNOWNS)


def _balanced(equilibrium: Equilibrium, law: Tangent, r: Array, a: Array, *, settled: bool) -> Balance | None:
    """What balances under a linear law; None where nothing does."""
    if equilibrium.as_posed and _many(law):
        found = iterate(equilibrium.problem, law, r, a, forward=_FORWARD[settled])
        if found is not None:
            return found
    return linear_system(equilibrium, law).solve(r, a)


def _shortened(
    equilibrium: Equilibrium, before: Balance, found: Balance, reference: float
) -> tuple[Array, Array, Array, float]:
    """The whole step, or the first part of it that undercuts the reference, or the best part tried."""
    best, length = None, 1.0
    while True:
        r, a, h = (old + length * (new - old) if length < 1.0 else new for old, new in zip(before, found, strict=True))
        violation = _violation(equilibrium, r, h)
        if best is None or violation < best[3]:
            best = r, a, h, violation
        if violation <= (1.0 - DECREASE * length) * reference or length <= SHORTEST_STEP:
            return best
        length /= 2.0


def _violation(equilibrium: Equilibrium, r: Array, h: Array) -> float:
    """Size of what the law lacks, a scaled force."""
    return float(np.linalg.norm(r - equilibrium.problem.law.split(r - h)[1]))


def _lacking(equilibrium: Equilibrium, r: Array, h: Array, violation: float) -> float:
    """What the iterate lacks, relative: `certify`, or with a layer the violation of the law."""
    if equilibrium.as_posed:
        return certify(equilibrium.problem, r - h)
    return violation / max(float(np.linalg.norm(r)), equilibrium.problem.scale, 1e-300)
