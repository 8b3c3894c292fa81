# SPDX-License-Identifier: BSD-3-Clause
"""The performance suite: ratios to one linear solve, and what answers the hard set."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from typing import Any

from signorini.bench.equilibria import equilibria
from signorini.bench.hard import hard, spread
from signorini.bench.models import cube_ratios, cylinder_ratios
from signorini.errors import InputError, one_of

NAMES = ("cylinder", "cubes", "hard")
DOFS = (5_000, 50_000)
"""Sizes where none is asked for."""


def benchmark_rows(
    names: Sequence[str],
    dofs: int | None,
    sample: int | None = None,
    begin: Callable[[str, int, int], None] = lambda *_: None,
) -> Iterator[dict[str, Any]]:
    """Run benchmarks by name, by default the timed one: their rows, each as soon as it is known.

    Parameters
    ----------
    names : of NAMES
    dofs : about how many unknowns; by default some sizes
    sample : of the hard set so many problems, spread over it; by default all
    begin : told before every problem of the hard set what it is, how many are done and how many there are

    Raises
    ------
    InputError
        For an unknown name, or a size or sample that is not positive.
    """
    for name in names:
        if name not in NAMES:
            raise InputError(one_of(name, NAMES, "benchmark"))
    if dofs is not None and dofs < 1:
        raise InputError(f"is {dofs}; expected a positive number", where=("--dofs",))
    if sample is not None and sample < 1:
        raise InputError(f"is {sample}; expected a positive number", where=("--sample",))
    return _rows(names or ("cylinder",), DOFS if dofs is None else (dofs,), sample, begin)


def _rows(
    names: Sequence[str], sizes: Sequence[int], sample: int | None, begin: Callable[[str, int, int], None]
) -> Iterator[dict[str, Any]]:
    for name in names:
        if name == "hard":
            report = hard(spread(sample), begin=begin)
            for bodies, counts in (("held", report.held), ("floating", report.floating)):
                yield {"name": "hard", "bodies": bodies, "problems": report.problems, "counts": counts}
            found = equilibria(report.certified, begin)
            yield {"name": "hard", "words": str(found), **asdict(found)}
        else:
            for size in sizes:
                yield from cube_ratios(size) if name == "cubes" else cylinder_ratios(size)
