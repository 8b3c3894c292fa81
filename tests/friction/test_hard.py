# SPDX-License-Identifier: BSD-3-Clause
"""A part of the hard set: everything is answered."""

import numpy as np

from benchmarks.hard import table
from signorini.bench.equilibria import equilibria
from signorini.bench.hard import hard
from signorini.gallery.hard import hard_problem


def test_every_step_is_answered():
    report = hard(range(39))
    assert report.problems == 39
    assert not report.unanswered
    assert report.held["steps"] == sum(report.held.get(m, 0) for m in ("newton", "path open", "path press"))
    assert "| held |" in table(report)


def test_the_set_is_the_same_each_time():
    first, again = hard_problem(0), hard_problem(0)
    assert first.name == again.name
    assert (first.first.W == again.first.W).all()


def test_several_solutions_are_listed():
    """A peg of 4 pairs that floats between walls has three equilibria; a block that is hardly rubbed has one."""
    peg, block = hard_problem(296), hard_problem(3)
    steps = [(each.name, each.step(0, np.zeros(each.first.pairs))) for each in (peg, block)]
    found = equilibria(steps)
    assert found.several == ((3, "peg, floating, pull, fit, 4 pairs, friction 3"),)
    assert found.unique + found.single + found.alone == 1
    assert "- 3 solutions: peg" in str(found)
