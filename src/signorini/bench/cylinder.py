# SPDX-License-Identifier: BSD-3-Clause
"""The price of contact: the paper's cylinder against one plain linear solve of the same matrix."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from signorini.bench.price import Timer, price, warm_up
from signorini.gallery.cylinder import zhu_cylinder


def cylinder(dofs: int, *, timer: Timer = time.perf_counter) -> Iterator[dict[str, Any]]:
    """Time the cylinder with about ``dofs`` unknowns, mu = 0 and 0.4, one increment; by default on the wall.

    Yields
    ------
    rows of the contract, see :func:`signorini.bench.price.price`
    """
    refine = max(1, round(np.sqrt(dofs / (2 * 76))))
    warm_up(zhu_cylinder(refine=refine), timer)
    for friction in (0.0, 0.4):
        yield price("cylinder", zhu_cylinder(friction=friction, refine=refine), timer)
