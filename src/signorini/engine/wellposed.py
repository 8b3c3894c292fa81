# SPDX-License-Identifier: BSD-3-Clause
"""Ask of a model, or of the end of a history, whether its solution is the only one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array, IntArray
from signorini.engine.increments import advance
from signorini.engine.path_states import right_hand_side
from signorini.engine.prepare import Prepared
from signorini.engine.report import contacts_of
from signorini.errors import SolveFailed
from signorini.friction.problem import ContactProblem
from signorini.friction.uniqueness import all_solutions, always_unique, countable, mu_low, search_solutions, starts
from signorini.law.bound import ADHESION_SLOPE
from signorini.solution.results import ContactResult
from signorini.solution.state import State
from signorini.solution.wellposedness import WellPosedness


def assess(prepared: Prepared, state: State | None = None) -> WellPosedness:
    """What is known of uniqueness: a cheap bound; of few pairs a proof; above the bound other solutions, by search.

    Friction that pairs hold without pressure, because they stick or adhere, lets them be open or closed under one load:
    it counts as infinite. In space nothing is tried state by state.

    Parameters
    ----------
    prepared : under the law that is asked about
    state : at whose loads, and from whose slips, other equilibria are looked for; None asks about the model alone
    """
    if prepared.solver.paths is None or prepared.yielding is not None:
        friction = _without_pressure(float(prepared.interface.friction.steepest.max(initial=0.0)))
        words = "not examined: that needs the condensed interface, and this model is solved by iteration"
        if prepared.yielding is not None:
            words = "not examined: what is known of uniqueness is of elastic bodies, and of this model some may yield"
        return WellPosedness(friction=friction, bound=None, verdict="not decided", words=words)
    if prepared.limited:  # other loads, and other solutions, may close pairs that are far apart
        prepared = replace(prepared.widened(), absent=prepared.absent)
    law = prepared.paths.law
    slope = float(law.mu[~law.locked.all(axis=0)].max(initial=0.0))
    friction, bound = _without_pressure(slope), mu_low(law)
    if bound is not None and friction < bound:
        words = _unique(friction, bound, law.floating)
        return WellPosedness(friction=friction, bound=bound, verdict="unique", words=words)
    few = countable(law)
    proved = few and not law.floating
    if proved and always_unique(law):
        words = f"the states of all {law.pairs} pairs, tried one by one, prove one solution for every load and history"
        return WellPosedness(friction=friction, bound=bound, verdict="unique", words=words)
    above = _above(friction, bound)
    if state is None:
        words = (
            f"{above}; some load has several solutions or none" if proved else f"{above}: uniqueness is not guaranteed"
        )
        return WellPosedness(friction=friction, bound=bound, verdict="not decided", words=words)
    others = _others(prepared, law, state)
    if others:
        words = f"{above}; {len(others)} other equilibria at these loads, from these slips, were found"
        words = words if few else f"{words} from {starts(law)} starts"
        return WellPosedness(friction=friction, bound=bound, verdict="several", words=words, others=others)
    if few:
        words = f"{above}, but no other state of the {law.pairs} pairs is in equilibrium at these loads and slips"
        return WellPosedness(friction=friction, bound=bound, verdict="one", words=words)
    words = f"{above}; a search from {starts(law)} starts found no other equilibrium, which proves nothing"
    return WellPosedness(friction=friction, bound=bound, verdict="not decided", words=words)


def _without_pressure(slope: float) -> float:
    """Friction per pressure; infinite where pairs hold it without pressure, because they stick or adhere."""
    return np.inf if slope >= ADHESION_SLOPE else slope


def _unique(friction: float, bound: float, floating: bool) -> str:
    said = f"friction {friction:g} is below {bound:.4g}" if np.isfinite(bound) else "no pair slips against friction"
    if floating:
        return f"{said}: the contact forces of every load and history are unique, where there are any"
    return f"{said}: every load and history has exactly one solution"


def _above(friction: float, bound: float | None) -> str:
    said = "friction without pressure" if np.isinf(friction) else f"friction {friction:g}"
    if bound is None:
        return f"{said}; a body that contact alone holds can slide as a whole, for which no bound is known"
    return f"{said} is above {bound:.4g}, up to which uniqueness is proved"


def _others(prepared: Prepared, law: ContactProblem, state: State) -> tuple[tuple[ContactResult, ...], ...]:
    """The contacts in other equilibria than the state itself, each solved for and certified like any increment."""
    size = prepared.scale.force
    results: list[tuple[ContactResult, ...]] = []
    known = [state.forces]
    for start in _starts(_posed(prepared, law, state)):
        try:
            other, _, _ = advance(prepared, state, state.point, "another equilibrium", start=start)
        except SolveFailed:
            continue
        same = [np.abs(other.forces - forces).max(initial=0.0) <= 1e-8 * size for forces in known]
        moved = np.abs(other.displacement - state.displacement).max(initial=0.0) > 1e-8 * prepared.scale.length
        if any(same[1:]) or (same[0] and not moved):
            continue
        known.append(other.forces)
        results.append(contacts_of(prepared, state, other))
    return tuple(results)


def _starts(problem: ContactProblem) -> list[Array | IntArray]:
    """What leads the law's solver to every solution that was found: states, in space y itself."""
    found = all_solutions(problem) if countable(problem) else search_solutions(problem)
    return [problem.law.states(y) for y in found] if problem.piecewise_linear else list(found)


def _posed(prepared: Prepared, law: ContactProblem, state: State) -> ContactProblem:
    """The law at the loads of a state, slips counted from where it stands."""
    return replace(law, b=right_hand_side(prepared, state.point, state.tangential))
