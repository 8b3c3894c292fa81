# SPDX-License-Identifier: BSD-3-Clause
"""What a code took for the cylinder, and the pressures it found."""

from __future__ import annotations

from dataclasses import dataclass

from signorini.arrays import Array


@dataclass(frozen=True, kw_only=True)
class Result:
    """CPU seconds by phase, iterations, peak memory in bytes, pressures at the nodes of the arc from the pole up."""

    code: str
    input_seconds: float
    assembly_seconds: float
    solve_seconds: float
    iterations: int
    memory: float
    pressure: Array
