# SPDX-License-Identifier: BSD-3-Clause
"""The timed benchmark reports what its contract says."""

import importlib
import math
import time

import pytest

from signorini.bench.suite import benchmark_rows
from signorini.solution.certificate import certify

KEYS = {
    "name",
    "dofs",
    "contact_pairs",
    "friction",
    "path",
    "backend",
    "default",
    "assembly_seconds",
    "contact_seconds",
    "linear_seconds",
    "ratio",
    "cpu_seconds",
    "peak_memory_bytes",
    "iterations",
    "phases",
}


def test_rows_of_the_contract() -> None:
    rows = list(benchmark_rows(["cylinder"], 600))
    assert [row["friction"] for row in rows] == [0.0, 0.4]
    for row in rows:
        assert set(row) == KEYS
        assert (row["name"], row["path"], row["default"]) == ("cylinder", "single", True)
        assert row["contact_pairs"] == 21  # 10 cells along the paper's arc, each cut in two
        assert 0.7 * 600 < row["dofs"] < 1.3 * 600
        assert math.isclose(row["ratio"], row["contact_seconds"] / row["linear_seconds"])
        assert row["assembly_seconds"] > 0


@pytest.mark.slow
def test_cubes_in_space() -> None:
    rows = list(benchmark_rows(["cubes"], 1500))
    assert [row["name"] for row in rows] == 2 * ["cubes"] + 2 * ["cubes, not matching"]
    assert [row["default"] for row in rows] == [True, False, True, False]
    for row in rows:
        assert set(row) == KEYS
        assert 0.6 * 1500 < row["dofs"] < 1.2 * 1500
        assert math.isclose(row["ratio"], row["contact_seconds"] / row["linear_seconds"])
        phases = {"factorisation", "condensation", "complementarity", "recovery"}
        assert set(row["phases"]) == (phases if row["default"] else set())


@pytest.mark.slow
def test_contact_seconds_leave_nothing_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """The certificate is in no phase of the clock, and is still paid for."""

    def slow(*arguments: object, **named: object) -> object:
        time.sleep(0.1)
        return certify(*arguments, **named)  # type: ignore[arg-type]

    monkeypatch.setattr(importlib.import_module("signorini.engine.increments"), "certify", slow)
    assert all(row["contact_seconds"] > 0.1 for row in benchmark_rows(["cylinder"], 300))
