# SPDX-License-Identifier: BSD-3-Clause
"""Ask of a model, or of the end of a history, whether its solution is the only one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.bound import STEEP, plain
from signorini.engine.increments import advance, applied, free_load
from signorini.engine.prepare import Prepared
from signorini.engine.report import contacts_of
from signorini.errors import SolveFailed
from signorini.friction.law import states
from signorini.friction.problem import CoulombProblem
from signorini.friction.several import all_solutions, always_unique, countable, search_solutions
from signorini.friction.spatial import SpatialProblem
from signorini.friction.uniqueness import mu_low
from signorini.solution.results import ContactResult
from signorini.solution.state import State
from signorini.solution.wellposedness import WellPosedness


def assess(prepared: Prepared, state: State | None = None) -> WellPosedness:
    """What is known of uniqueness: a cheap bound; of few pairs a proof; above the bound other solutions, by search.

    Friction that pairs hold without pressure, because they stick or adhere, lets them be open or closed under one load:
    it counts as infinite.

    Parameters
    ----------
    prepared : under the law that is asked about
    state : at whose loads, and from whose slips, other equilibria are looked for; None asks about the model alone
    """
    law = prepared.law
    if isinstance(law, SpatialProblem):
        friction = float(law.friction[np.isfinite(law.friction)].max(initial=0.0))
        words = f"friction {friction:g}: uniqueness is examined in two dimensions only"
        return WellPosedness(friction=friction, bound=None, verdict="not decided", words=words)
    slope = float(law.mu[~law.locked].max(initial=0.0))
    friction, bound = np.inf if slope >= STEEP else slope, mu_low(law)
    if bound is not None and friction < bound:
        words = f"friction {friction:g} is below {bound:.4g}: every load and history has exactly one solution"
        return WellPosedness(friction=friction, bound=bound, verdict="unique", words=words)
    few = countable(law)
    if bound is not None and few and always_unique(law):
        words = f"the states of all {law.pairs} pairs, tried one by one, prove one solution for every load and history"
        return WellPosedness(friction=friction, bound=bound, verdict="unique", words=words)
    above = _above(friction, bound)
    if state is None:
        proved = bound is not None and few
        words = (
            f"{above}; some load has several solutions or none" if proved else f"{above}: uniqueness is not guaranteed"
        )
        return WellPosedness(friction=friction, bound=bound, verdict="not decided", words=words)
    others = _others(prepared, law, state)
    if others:
        words = f"{above}; {len(others)} other equilibria at these loads, from these slips, were found"
        return WellPosedness(friction=friction, bound=bound, verdict="several", words=words, others=others)
    if few:
        words = f"{above}, but no other state of the {law.pairs} pairs is in equilibrium at these loads and slips"
        return WellPosedness(friction=friction, bound=bound, verdict="one", words=words)
    words = f"{above}; a search from many starts found no other equilibrium, which proves nothing"
    return WellPosedness(friction=friction, bound=bound, verdict="not decided", words=words)


def _above(friction: float, bound: float | None) -> str:
    said = "friction without pressure" if np.isinf(friction) else f"friction {friction:g}"
    if bound is None:
        return f"{said}; contact alone holds a body, for which no bound is known"
    return f"{said} is above {bound:.4g}, up to which uniqueness is proved"


def _others(prepared: Prepared, law: CoulombProblem, state: State) -> tuple[tuple[ContactResult, ...], ...]:
    """The contacts in other equilibria than the state itself, each solved for and certified like any increment."""
    problem = _posed(prepared, law, state)
    found = all_solutions(problem) if countable(problem) else search_solutions(problem)
    active, size = prepared.condensed.active, prepared.scale.force
    results: list[tuple[ContactResult, ...]] = []
    known = [state.forces]
    for y in found:
        codes = state.status.copy()
        codes[active] = plain(states(y, problem.bound, problem.closed))
        try:
            other, _, _ = advance(prepared, replace(state, status=codes), state.point, "another equilibrium")
        except SolveFailed:
            continue
        same = [np.abs(other.forces - forces).max(initial=0.0) <= 1e-8 * size for forces in known]
        moved = np.abs(other.displacement - state.displacement).max(initial=0.0) > 1e-8 * prepared.scale.length
        if any(same[1:]) or (same[0] and not moved):
            continue
        known.append(other.forces)
        results.append(contacts_of(prepared, state, other))
    return tuple(results)


def _posed(prepared: Prepared, law: CoulombProblem, state: State) -> CoulombProblem:
    """The law at the loads of a state, slips counted from where it stands."""
    condensed, interface = prepared.condensed, prepared.interface
    _, imposed = applied(prepared, state.point)
    offset = np.concatenate([state.point.gap, -state.tangential]) + interface.B @ imposed
    load: Array = condensed.reduce(free_load(prepared, state.point)).load
    b = condensed.right_hand_side(load, offset[condensed.active_rows], law.motions)
    return replace(law, b=b)
