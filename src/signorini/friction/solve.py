# SPDX-License-Identifier: BSD-3-Clause
"""Solve the condensed Coulomb problem: the methods in their order.

1. Newton from the previous states (see `newton`), then from every pair sticking. Nearly always enough.
2. Floating bodies: proof that the loads pull them away (see `rigid`).
3. Paths (see `path`); of many pairs first among those that Newton found touching (see `release`); then of all, with a
   budget of 10 pivots a pair, then of 100. Held bodies: open, then press; one of them
   ends in a solution. Floating bodies: press, then "open" with springs of falling stiffness at every pair.
4. Up to 25 pairs: proof or solution by a tree of linear programs (see `tree`).

Whatever a method finds is polished by Newton and certified (see `certify`) before it is believed. The order is fixed,
and the previous states come first: where several solutions exist the history decides, not accident.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array, BoolArray, IntArray
from signorini.attempt import MethodRun
from signorini.errors import InputError
from signorini.friction.answer import impossible, not_found, solved
from signorini.friction.candidate import Candidate
from signorini.friction.law import OPEN, SLIP_MINUS, UNDECIDED, split
from signorini.friction.newton import newton
from signorini.friction.plane.covering import Covering, PathEnd, follow
from signorini.friction.plane.restricted import released
from signorini.friction.plane.state_tree import search
from signorini.friction.problem import CoulombProblem
from signorini.friction.pull_away import pulled_away
from signorini.friction.result import CoulombResult


@dataclass(frozen=True, kw_only=True)
class CoulombSettings:
    """How long each method may try.

    Attributes
    ----------
    tolerance : of `certify`, relative to the data
    newton_steps : most linear systems of one Newton run
    pivots_per_pair : most pivots of a path, in rounds
    springs : stiffness of the springs, falling, in units of the interface stiffness
    many_pairs : pairs from which a path is first followed among the pairs alone that Newton found touching
    tree_pairs, tree_programs : most pairs and most linear programs of the tree
    """

    tolerance: float = 1e-10
    newton_steps: int = 200
    pivots_per_pair: tuple[int, ...] = (10, 100)
    springs: tuple[float, ...] = (1e-3, 1e-6, 1e-9)
    many_pairs: int = 200
    tree_pairs: int = 25
    tree_programs: int = 2000


def solve_coulomb(
    problem: CoulombProblem, start: IntArray | None = None, *, settings: CoulombSettings | None = None
) -> CoulombResult:
    """Solve ``G h - W r = b`` in Coulomb's law: a certified solution, a proof that there is none, or the escape motion.

    Parameters
    ----------
    problem : the problem
    start : (n,) states of the previous solution, or None to start with every pair sticking
    settings : how long each method may try

    Raises
    ------
    InputError
        Where ``start`` does not fit, or W has a rigid motion that the problem does not name.

    Examples
    --------
    >>> problem = CoulombProblem.of(
    ...     W=np.diag([0.5, 0.5]), b=np.array([-1.0, 0.5]), friction=[0.3], motions=np.zeros((2, 0)), scale=1.0
    ... )
    >>> result = solve_coulomb(problem)
    >>> result.outcome, result.normal_force.round(12).tolist(), result.tangential_force.round(12).tolist()
    ('solved', [2.0], [-0.6])
    """
    settings = settings or CoulombSettings()
    _check_start(problem, start)
    if problem.pairs == 0:
        return solved(problem, Candidate.nothing(), ())
    trace: list[MethodRun] = []
    escape: Array | None = None
    for found in _candidates(problem, start, settings):
        trace.append(found.attempt)
        if found.residual <= settings.tolerance:
            return solved(problem, found, tuple(trace))
        escape = found.escape if found.escape is not None else escape
        if found.proof is not None:
            return impossible(problem, replace(found, escape=escape), tuple(trace))
    return not_found(problem, escape, tuple(trace))


def _check_start(problem: CoulombProblem, start: IntArray | None) -> None:
    if start is None:
        return
    found = np.asarray(start)
    last = SLIP_MINUS + 2 * (problem.bound.branches - 1)
    if found.shape != (problem.pairs,) or not np.isin(found, range(UNDECIDED, last + 1)).all():
        raise InputError(f"expected {problem.pairs} states between {UNDECIDED} and {last}", where=("start",))


def _candidates(problem: CoulombProblem, start: IntArray | None, settings: CoulombSettings) -> Iterator[Candidate]:
    """What the methods find, one after the other, each tried only when it is asked for."""
    if start is not None:
        yield newton(problem, start, limit=settings.newton_steps, tolerance=settings.tolerance)
    plain = newton(problem, limit=settings.newton_steps, tolerance=settings.tolerance)
    yield plain
    if problem.floating:
        yield _proof_by_rigid_motion(problem)
    if plain.touched is not None and 2 * np.count_nonzero(plain.touched) < problem.pairs >= settings.many_pairs:
        yield _among_touched(problem, plain.touched, settings)
    for round_, per_pair in enumerate(settings.pivots_per_pair):
        budget = per_pair * max(problem.pairs, 5)
        if not problem.floating:
            yield _along_path(problem, "open", budget, round_, settings)
        yield _along_path(problem, "press", budget, round_, settings)
        if problem.floating:
            yield from _with_springs(problem, budget, round_, settings)
    if problem.pairs <= settings.tree_pairs:
        yield _in_tree(problem, settings)


def _proof_by_rigid_motion(problem: CoulombProblem) -> Candidate:
    pull = pulled_away(problem)
    if pull is None:
        return Candidate.without(problem, MethodRun(method="rigid motions", iterations=1, end="nothing proved"))
    attempt = MethodRun(method="rigid motions", iterations=1, end="pulled away")
    return replace(Candidate.without(problem, attempt), proof="rigid motion", margin=pull.share, escape=pull.motion)


def _among_touched(problem: CoulombProblem, touched: BoolArray, settings: CoulombSettings) -> Candidate:
    """The end of a path of the touching pairs alone, made exact with all pairs."""
    few = released(problem, touched)
    if few is None:
        attempt = MethodRun(method="path among touching", iterations=0, end="touching pairs do not hold the bodies")
        return Candidate.without(problem, attempt)
    budget = settings.pivots_per_pair[0] * max(few.pairs, 5)
    path = follow(few, "press" if problem.floating else "open", budget=budget)
    state = np.full(problem.pairs, OPEN)
    state[touched] = path.state
    exact = newton(problem, state, limit=settings.newton_steps, tolerance=settings.tolerance)
    return replace(exact, attempt=MethodRun(method="path among touching", iterations=path.pivots, end=path.end))


def _along_path(
    problem: CoulombProblem, covering: Covering, budget: int, seed: int, settings: CoulombSettings
) -> Candidate:
    path = follow(problem, covering, budget=budget, seed=seed)
    return _polished(problem, path, f"path {covering}", settings)


def _polished(problem: CoulombProblem, path: PathEnd, method: str, settings: CoulombSettings) -> Candidate:
    """The end of a path made exact on the problem as posed: no perturbation, no springs."""
    attempt = MethodRun(method=method, iterations=path.pivots, end=path.end)
    if path.end == "singular":
        return Candidate.without(problem, attempt)
    near = None if path.end == "ray" else path.y
    exact = newton(problem, path.state, near=near, limit=settings.newton_steps, tolerance=settings.tolerance)
    return replace(exact, attempt=attempt)


def _with_springs(problem: CoulombProblem, budget: int, seed: int, settings: CoulombSettings) -> Iterator[Candidate]:
    """Held by springs a path always ends; in an answer that stays as the springs weaken, or in one that runs away."""
    before = np.inf
    for springs in settings.springs:
        path = follow(problem, "open", budget=budget, seed=seed, springs=springs)
        found = _polished(problem, path, "springs", settings)
        motion = split(path.y, problem.bound)[0]
        size = float(np.abs(motion).max(initial=0.0))
        grows = path.end == "solution" and size > 10.0 * max(before, problem.scale)
        yield replace(found, escape=motion / size if grows else None)
        before = size


def _in_tree(problem: CoulombProblem, settings: CoulombSettings) -> Candidate:
    tree = search(problem, budget=settings.tree_programs)
    attempt = MethodRun(method="tree", iterations=tree.programs, end=tree.end)
    if tree.state is None:
        proved = tree.end == "impossible" and problem.floating  # held bodies have a solution: refusals are rounding
        return replace(Candidate.without(problem, attempt), proof="tree" if proved else None, margin=tree.margin)
    exact = newton(problem, tree.state, limit=settings.newton_steps, tolerance=settings.tolerance)
    return replace(exact, attempt=attempt)
