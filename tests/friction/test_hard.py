# SPDX-License-Identifier: BSD-3-Clause
"""A part of the hard set: everything is answered."""

from signorini.bench.hard import hard, hard_set


def test_every_step_is_answered():
    report = hard(39)
    assert report.problems == 39
    assert not report.unanswered
    assert report.held["steps"] == sum(report.held.get(m, 0) for m in ("newton", "path open", "path press"))
    assert "| held |" in str(report)


def test_the_set_is_the_same_each_time():
    first, again = next(hard_set(1)), next(hard_set(1))
    assert first.name == again.name
    assert (first.first.W == again.first.W).all()
