# SPDX-License-Identifier: BSD-3-Clause
"""Models whose contact is timed: the paper's cylinder, and a cube pressed and pushed on another in space."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from signorini.bench.price import REPEATS, Timer, iterated, price, warm_up
from signorini.engine.prepare import prepare
from signorini.engine.solve import solve_prepared
from signorini.gallery.cubes import cubes
from signorini.gallery.cylinder import zhu_cylinder
from signorini.iterative.bodies import ITERATIVE

_ENTRIES = 40.0
"""Numbers held at the worst time of the contact solve, of z^(4/3): their pages are touched before a long run."""


def cylinder_ratios(
    dofs: int,
    *,
    timer: Timer = time.perf_counter,
    frictions: Sequence[float] = (0.0, 0.4),
    other: str | None = None,
) -> Iterator[dict[str, Any]]:
    """Time the cylinder with about ``dofs`` unknowns, mu = 0 and 0.4, one increment; by default on the wall.

    Parameters
    ----------
    dofs : unknowns, about
    timer : tells seconds
    frictions : mu of each row
    other : a back end whose plain solve is timed, too

    Yields
    ------
    rows of the contract, see :func:`signorini.bench.price.price`
    """
    refine = max(1, round(np.sqrt(dofs / (2 * 76))))
    warm_up(zhu_cylinder(refine=refine), timer)
    for friction in frictions:
        yield price("cylinder", zhu_cylinder(friction=friction, refine=refine), timer, other=other)


def cube_ratios(dofs: int, *, timer: Timer = time.perf_counter, repeats: int = REPEATS) -> Iterator[dict[str, Any]]:
    """Time two cubes with about ``dofs`` unknowns, mu = 0.3, one increment.

    Parameters
    ----------
    timer : tells seconds, by default on the wall
    repeats : of the condensed solves

    Yields
    ------
    rows of the contract, see :func:`signorini.bench.price.price`: "cubes" and "cubes, not matching", each condensed and
    then iterated
    """
    n = max(2, round(np.cbrt(dofs / 6.0)) - 1)
    upper = max(1, round(0.92 * n))  # the coarser side carries the pairs
    lower = max(2, round(np.cbrt(dofs / 3.0 - (upper + 1) ** 3)) - 1)
    solve_prepared(prepare(cubes(2), backend=ITERATIVE))  # loads what the rows after it find loaded
    for name, model in (("cubes", cubes(n)), ("cubes, not matching", cubes(lower, upper))):
        if repeats > 1:
            warm_up(model, timer)
        else:  # of long runs only the compiled code and the memory
            warm_up(cubes(2, 2 if name == "cubes" else 3), timer)
            np.ones(int(_ENTRIES * dofs ** (4.0 / 3.0)))
        condensed = price(name, model, timer, repeats=repeats)
        yield condensed
        yield iterated(condensed, model, timer)
