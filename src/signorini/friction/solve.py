# SPDX-License-Identifier: BSD-3-Clause
"""Solve a condensed contact problem with friction: the methods in their order.

1. Newton from the previous solution, then from every pair sticking (see `newton`). Nearly always enough.
2. Floating bodies: proof that the loads pull them away (see `pull_away`).
3. Piecewise linear problems, those of the plane: covering paths (see `plane.covering`); of many pairs first among those
   that Newton found touching (see `plane.restricted`); then of all, with a budget of 10 pivots a pair, then of 100.
   Held bodies: open, then press; one of them ends in a solution. Floating bodies: press, then "open" with springs of
   falling stiffness at every pair. Up to 25 pairs: proof or solution by a tree of linear programs (`plane.state_tree`).
4. Others: sweeps and proximal Newton in rounds, then proximal Newton alone (see `space.proximal`); floating bodies are
   held by ever weaker springs, to see along which motion they run away.

Whatever a method finds is certified (see `certify`) before it is believed, in the plane polished by Newton first. The
order is fixed, and the previous solution comes first: where several solutions exist the history decides, not accident.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun, Spent
from signorini.errors import InputError
from signorini.friction.answer import impossible, not_found, nothing_to_solve, solved
from signorini.friction.candidate import Candidate
from signorini.friction.linear import Equilibrium
from signorini.friction.newton import by_states, searched
from signorini.friction.plane.covering import Covering, PathEnd, follow_covering
from signorini.friction.plane.restricted import restrict_to
from signorini.friction.plane.state_tree import search_states
from signorini.friction.problem import ContactProblem
from signorini.friction.pull_away import Pull, pulled_away
from signorini.friction.space.proximal import proximal_rounds
from signorini.law.result import ContactAnswer
from signorini.law.states import OPEN, SLIP_MINUS, UNDECIDED
from signorini.settings import DEFAULT_SETTINGS, SolverSettings

_SWEEPS = 20  # of one round, before proximal Newton
_RUNAWAY_GROWTH = 10.0  # of motions between two stiffnesses of springs, a thousandth of each other


def solve_contact(
    problem: ContactProblem,
    start: ArrayLike | None = None,
    *,
    settings: SolverSettings | None = None,
    allowed: float = 0.0,
) -> ContactAnswer:
    """Solve ``G h - W r = b`` in a law of friction: a certified solution, a proof that there is none, or an escape.

    Parameters
    ----------
    problem : the problem
    start : (d, n) ``y`` of the previous solution, in the plane also its states (n,); None to start with every pair
        sticking
    settings : how long each method may try
    allowed : residual of `certify` that will do for an answer that others follow; no less than the tolerance is asked

    Raises
    ------
    InputError
        Where ``start`` does not fit, or W has a rigid motion that the problem does not name.

    Examples
    --------
    >>> problem = ContactProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> answer = solve_contact(problem)
    >>> answer.outcome, answer.normal_force.round(12).tolist(), answer.tangential_force.round(12).tolist()
    ('solved', [2.0], [[-0.6]])
    >>> problem = ContactProblem.of(
    ...     W=0.5 * np.eye(3), b=np.array([-1.0, 0.3, 0.4]), friction=[0.1], motions=np.zeros((3, 0)), scale=1.0
    ... )
    >>> answer = solve_contact(problem)
    >>> answer.outcome, answer.r.round(12).tolist()
    ('solved', [[2.0], [-0.12], [-0.16]])
    """
    settings, first = settings or DEFAULT_SETTINGS, _checked(problem, start)
    if problem.pairs == 0:
        return nothing_to_solve(problem)
    tolerance, tried = max(settings.tolerance, allowed), list[Candidate]()
    for method in METHODS:
        if method.piecewise_linear not in (None, problem.piecewise_linear):
            continue
        task = Task(problem=problem, start=first, settings=settings, tolerance=tolerance, tried=tried)
        for found in method.run(task):
            tried.append(found)
            if found.residual <= tolerance:
                return solved(problem, tried)
            if found.proof is not None:
                return impossible(problem, tried)
    return not_found(problem, tried)


def _checked(problem: ContactProblem, start: ArrayLike | None) -> Array | IntArray | None:
    if start is None:
        return None
    found, shape = np.asarray(start), (problem.directions, problem.pairs)
    if not problem.piecewise_linear or found.ndim == 2:
        if found.shape != shape:
            raise InputError(f"has shape {found.shape}; expected {shape}", where=("start",))
        return problem.law.states(found) if problem.piecewise_linear else found
    last = SLIP_MINUS + 2 * (problem.pieces.branches - 1)
    fits = found.shape == (problem.pairs,) and found.dtype.kind in "iu"
    if not fits or found.min(initial=last) < UNDECIDED or found.max(initial=UNDECIDED) > last:
        raise InputError(f"expected {problem.pairs} states between {UNDECIDED} and {last}", where=("start",))
    return found.astype(np.int64)


@dataclass(frozen=True, kw_only=True, eq=False)
class Task:
    """What a method is given.

    Attributes
    ----------
    problem, settings : as of `solve_contact`
    start : (n,) states in the plane, otherwise (d, n) y, of the previous solution
    tolerance : of `certify`
    tried : what methods before it found
    """

    problem: ContactProblem
    start: Array | IntArray | None
    settings: SolverSettings
    tolerance: float
    tried: Sequence[Candidate]

    def polish(self, state: IntArray, *, near: Array | None = None) -> Candidate:
        """A candidate made exact by Newton's method, from its states, (n,), or a y, (2, n)."""
        steps, tolerance = self.settings.newton_steps, self.tolerance
        return by_states(self.problem, state, near=near, limit=steps, tolerance=tolerance)


def _newton(task: Task) -> Iterator[Candidate]:
    """From the start given, then from sticking."""
    problem, settings = task.problem, task.settings
    if problem.piecewise_linear:
        for state in (None,) if task.start is None else (np.asarray(task.start, dtype=np.int64), None):
            yield by_states(problem, state, limit=settings.newton_steps, tolerance=task.tolerance)
        return
    form, steps, tolerance = Equilibrium(problem=problem), settings.searched_steps, task.tolerance
    if task.start is not None:
        y = np.asarray(task.start, dtype=np.float64)
        h, r = problem.law.split(y)
        a = problem.image.R.T @ h.ravel()
        yield searched(form, problem.law.tangent(y), force=r, rigid=a, limit=steps, tolerance=tolerance)
    yield searched(form, problem.law.sticking, limit=steps, tolerance=tolerance)


def _proof_by_rigid_motion(task: Task) -> Iterator[Candidate]:
    if not task.problem.floating:
        return
    pull = pulled_away(task.problem)
    end = "nothing proved" if pull is None else str(pull) if isinstance(pull, Spent) else "pulled away"
    found = Candidate.without(task.problem, MethodRun(method="rigid motions", iterations=1, end=end))
    if isinstance(pull, Pull):
        found = replace(found, proof="rigid motion", margin=pull.share, escape=pull.motion)
    yield found


def _paths(task: Task) -> Iterator[Candidate]:
    problem, settings = task.problem, task.settings
    plain = next(found for found in reversed(task.tried) if found.touched is not None)
    if plain.touched is not None and 2 * np.count_nonzero(plain.touched) < problem.pairs >= settings.many_pairs:
        yield _among_touched(task, plain.touched)
    for round_, per_pair in enumerate(settings.pivots_per_pair):
        budget = per_pair * max(problem.pairs, 5)
        if not problem.floating:
            yield _along_path(task, "open", budget, round_)
        yield _along_path(task, "press", budget, round_)
        if problem.floating:
            yield from _with_springs(task, budget, round_)


def _among_touched(task: Task, touched: BoolArray) -> Candidate:
    """The end of a path of the touching pairs alone, made exact with all pairs."""
    problem = task.problem
    few = restrict_to(problem, touched)
    if few is None:
        attempt = MethodRun(method="path among touching", iterations=0, end="touching pairs do not hold the bodies")
        return Candidate.without(problem, attempt)
    budget = task.settings.pivots_per_pair[0] * max(few.pairs, 5)
    path = follow_covering(few, "press" if problem.floating else "open", budget=budget)
    state = np.full(problem.pairs, OPEN)
    state[touched] = path.state
    attempt = MethodRun(method="path among touching", iterations=path.pivots, end=path.end)
    return replace(task.polish(state), attempt=attempt)


def _along_path(task: Task, covering: Covering, budget: int, seed: int) -> Candidate:
    path = follow_covering(task.problem, covering, budget=budget, seed=seed)
    return _at_the_end(task, path, f"path {covering}")


def _at_the_end(task: Task, path: PathEnd, method: str) -> Candidate:
    """The end of a path made exact on the problem as posed: no perturbation, no springs."""
    attempt = MethodRun(method=method, iterations=path.pivots, end=path.end)
    if path.end == "singular":
        return Candidate.without(task.problem, attempt)
    return replace(task.polish(path.state, near=None if path.end == "ray" else path.y), attempt=attempt)


def _with_springs(task: Task, budget: int, seed: int) -> Iterator[Candidate]:
    """Held by springs a path always ends; in an answer that stays as the springs weaken, or in one that runs away."""
    problem, before = task.problem, np.inf
    for springs in task.settings.springs:
        path = follow_covering(problem, "open", budget=budget, seed=seed, springs=springs)
        found = _at_the_end(task, path, "springs")
        motion, size = _runaway(problem, path.y, before)
        yield replace(found, escape=motion if path.end == "solution" else None)
        before = size


def _runaway(problem: ContactProblem, y: Array, before: float) -> tuple[Array | None, float]:
    """The motion of a y, (d, n), largest entry 1, where it has grown much from a size before, and its size."""
    motion = problem.law.split(y)[0].ravel()
    size = float(np.abs(motion).max(initial=0.0))
    return motion / size if size > _RUNAWAY_GROWTH * max(before, problem.scale) else None, size


def _tree(task: Task) -> Iterator[Candidate]:
    problem = task.problem
    if problem.pairs > task.settings.tree_pairs:
        return
    tree = search_states(problem, budget=task.settings.tree_programs)
    attempt = MethodRun(method="tree", iterations=tree.programs, end=tree.end)
    if tree.state is not None:
        yield replace(task.polish(tree.state), attempt=attempt)
        return
    proved = tree.end == "impossible" and problem.floating  # held bodies have a solution: refusals are rounding
    yield replace(Candidate.without(problem, attempt), proof="tree" if proved else None, margin=tree.margin)


def _rounds(task: Task) -> Iterator[Candidate]:
    """Sweeps and proximal Newton, then that alone."""
    problem, settings = task.problem, task.settings
    steps, tolerance = settings.searched_steps, task.tolerance
    if problem.directions == 3 and problem.straight:
        rounds = settings.swept_rounds
        yield from proximal_rounds(problem, rounds=rounds, steps=steps, tolerance=tolerance, sweeps=_SWEEPS)
    yield from proximal_rounds(problem, rounds=settings.proximal_rounds, steps=steps, tolerance=tolerance)


def _escape(task: Task) -> Iterator[Candidate]:
    """The motion that grows as springs on the rigid motions weaken, where one does."""
    problem = task.problem
    if not problem.floating:
        return
    law, escape, before, count, end = problem.law.sticking, None, np.inf, 0, "found nothing that runs away"
    for beta in task.settings.springs:
        held = Equilibrium(problem=problem, beta=beta)
        found = searched(held, law, limit=task.settings.searched_steps, method="springs")
        count += found.attempt.iterations
        if not found.converged:
            escape, end = None, found.attempt.end
            break
        y = found.force - held.moved(found.force, found.rigid)
        escape, before = _runaway(problem, y, before)
        law = problem.law.tangent(y)
    attempt = MethodRun(method="springs", iterations=count, end=end if escape is None else "runs away")
    yield replace(Candidate.without(problem, attempt), escape=escape)


class ContactMethod(NamedTuple):
    """A method of the cascade, and whether it is for problems that are piecewise linear, for others, or for any."""

    run: Callable[[Task], Iterator[Candidate]]
    piecewise_linear: bool | None = None


METHODS = (
    ContactMethod(_newton),
    ContactMethod(_proof_by_rigid_motion),
    ContactMethod(_paths, piecewise_linear=True),
    ContactMethod(_tree, piecewise_linear=True),
    ContactMethod(_rounds, piecewise_linear=False),
    ContactMethod(_escape, piecewise_linear=False),
)
