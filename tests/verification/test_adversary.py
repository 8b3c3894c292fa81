# SPDX-License-Identifier: BSD-3-Clause
"""Random small models beside elements, a law and an enumeration that share no line with the package (a sample).

Thousands more, of any seed: `python -m benchmarks.adversary 5000 --seed 17`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import signorini as sg
from benchmarks import adversary, independent

ENUMERATED = pytest.param(6, marks=pytest.mark.slow)  # 4096 linear programs prove that nothing goes on


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(6), ENUMERATED, *range(7, 40)])
def test_answers_proofs_and_restarts(seed):
    case = adversary.make(seed)
    verdict = adversary.judge(case)
    assert not verdict.failed, (sorted(case.kinds), verdict)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "kinds"),
    [
        *((seed, ("thin", "space")) for seed in (76, 132, 40057)),
        (20235, ()),
        (209, ("thin", "space", "driven")),
    ],
)
def test_thin_bodies_in_space_lose_no_digits(seed, kinds):
    """Two that the condensed interface does not find, and one that it finds a little above the tolerance.

    Two where forces and displacements differ by rounding.

    And one driven through the air that hardly touches: its forces are 1e-9 of what the motion might cause.
    """
    verdict = adversary.judge(adversary.make(seed, frozenset(kinds)))
    assert verdict.outcome == "right", verdict


@pytest.mark.parametrize(
    ("seed", "kinds", "outcome"),
    [
        (59, ("exact",), "right"),  # gone on with to the last bit behind a search of all states
        (70026, (), "proved"),  # near gross sliding, in units in which the data are 1e-13
        (50199, ("rigid", "stack", "restart", "exact"), "jump"),  # a pair that never slips lets go at once
    ],
)
def test_what_was_missed_once(seed, kinds, outcome):
    verdict = adversary.judge(adversary.make(seed, frozenset(kinds)))
    assert verdict.outcome == outcome, verdict.words


def slipping():
    """An increment where one pair of five slips, and its answer."""
    case = adversary.make(599)
    step = sg.solve(replace(case.model, steps=case.model.steps[:1])).last
    assert (step.contacts[0].count("slip"), step.contacts[0].count("stick")) == (1, 4)
    return (
        case.structure,
        adversary.increment(case, case.factors[0], np.zeros_like(step.displacement)),
        step.displacement,
    )


def test_the_adversary_sees_what_is_wrong():
    structure, increment, u = slipping()
    assert max(independent.violations(structure, increment, u).values()) < 1e-10
    pairs, K = structure.pairs, structure.K
    for wrong, what in (
        (replace(structure, K=K + 1e-5 * np.diag(np.diag(K))), "equilibrium"),
        (replace(structure, pairs=replace(pairs, friction=0.99999 * pairs.friction)), "cone"),
        (replace(structure, pairs=replace(pairs, friction=1.00001 * pairs.friction)), "slip"),
        (replace(structure, pairs=replace(pairs, gap=pairs.gap - 1e-5 * np.abs(u).max())), "penetration"),
        (replace(structure, pairs=replace(pairs, gap=pairs.gap + 1e-5 * np.abs(u).max())), "complementarity"),
    ):
        assert independent.violations(wrong, increment, u)[what] > 1e-7, what


def test_of_all_states_the_one_that_was_found_is_in_equilibrium():
    structure, increment, u = slipping()
    found = independent.equilibria(structure, increment)
    motion = structure.relative(u)
    motion[~structure.pairs.tied, 1] += structure.pairs.gap[~structure.pairs.tied]
    apart = [np.abs(h - motion.T.ravel()).max() for h, _ in found]
    assert min(apart) < 1e-9 * np.abs(motion).max()
    pulled = replace(increment, force=-increment.force, moved=-increment.moved)
    away = [h for h, _ in independent.equilibria(structure, pulled)]
    assert all(h[len(h) // 2 :].max() > 0 for h in away)
    searched = independent.searched(structure, increment, np.random.default_rng(0))
    assert searched is not None
