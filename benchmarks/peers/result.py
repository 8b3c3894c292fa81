# SPDX-License-Identifier: BSD-3-Clause
"""What a code took for the cylinder, and the pressures it found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from signorini.arrays import Array

REPEATS, LONG = 3, 20.0


@dataclass(frozen=True, kw_only=True)
class Result:
    """CPU seconds by phase, of the wall from assembly on, iterations, bytes, pressures of the arc from the pole up."""

    code: str
    input_seconds: float
    assembly_seconds: float
    solve_seconds: float
    wall_seconds: float
    iterations: int
    memory: float
    pressure: Array


def middle(run: Callable[[], Result]) -> Result:
    """The run in the middle of REPEATS, of fewer where they are long."""
    runs = [run()]
    while len(runs) < REPEATS and sum(result.solve_seconds for result in runs) < LONG:
        runs.append(run())
    return sorted(runs, key=lambda result: result.solve_seconds)[(len(runs) - 1) // 2]
