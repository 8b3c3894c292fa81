# SPDX-License-Identifier: BSD-3-Clause
"""Random small histories of bodies that yield beside elements and a flow rule that share no line with them (a sample).

Hundreds more, of any seed: `python benchmarks/plastic_histories.py 500 --seed 17`.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))
import plastic_histories as histories


@pytest.mark.parametrize("seed", [1, 2, 3, 5, 9, 20, 58])
def test_answers_obey_the_laws(seed):
    case = histories.make(seed)
    verdict = histories.judge(case)
    assert verdict.outcome == "right", (sorted(case.kinds), verdict)


@pytest.mark.parametrize("seed", [106, 183])
def test_first_yield_is_found_where_increments_curve_the_path(seed):
    """In space the load of first yield moves with the increments up to it: there no point is beyond yield."""
    verdict = histories.judge(histories.make(seed))
    assert verdict.outcome == "right", verdict


def test_the_slow_solver_finds_the_same_answers():
    verdict = histories.judge(histories.make(2), solve=True)
    assert verdict.outcome == "right", verdict


def test_the_judge_sees_a_wrong_answer():
    case = histories.make(2)
    softer = [replace(law, rows=law.rows * [1.0, 0.999]) for law in case.structure.laws]
    wrong = replace(case, structure=replace(case.structure, laws=softer))
    assert histories.judge(wrong).outcome == "WRONG"
