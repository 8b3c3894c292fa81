# SPDX-License-Identifier: BSD-3-Clause
"""The performance suite: ratios to one linear solve, and what answers the hard set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from signorini.bench.cubes import blocks
from signorini.bench.cylinder import cylinder
from signorini.bench.equilibria import equilibria
from signorini.bench.hard import hard
from signorini.errors import InputError, one_of

NAMES = ("cylinder", "cubes", "hard")
DOFS = (5_000, 50_000)
"""Sizes where none is asked for."""


def run(names: Sequence[str], dofs: int | None) -> list[dict[str, Any]]:
    """Run benchmarks by name, by default the timed one.

    Parameters
    ----------
    names : of NAMES
    dofs : about how many unknowns; by default some sizes

    Raises
    ------
    InputError
        For an unknown name, or a size that is not positive.
    """
    for name in names:
        if name not in NAMES:
            raise InputError(one_of(name, NAMES, "benchmark"))
    if dofs is not None and dofs < 1:
        raise InputError(f"is {dofs}; expected a positive number", where=("--dofs",))
    rows: list[dict[str, Any]] = []
    for name in names or ("cylinder",):
        if name == "hard":
            report = hard()
            for bodies, counts in (("held", report.held), ("floating", report.floating)):
                rows.append({"name": "hard", "bodies": bodies, "counts": counts})
            found = equilibria(report.certified)
            rows.append({"name": "hard", "words": str(found), **asdict(found)})
        else:
            for size in DOFS if dofs is None else (dofs,):
                rows.extend(blocks(size) if name == "cubes" else cylinder(size))
    return rows
