# SPDX-License-Identifier: BSD-3-Clause
"""Patch tests: uniform stress goes through contacts exactly, whatever the meshes, the cells and their direction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from signorini.arrays import Array
from signorini.engine.solve import solve
from signorini.fem.generators import Cells, rectangle
from signorini.fem.space import make_space
from signorini.fem.stress import body_stresses
from signorini.gallery.blocks import block_on_foundation, four_blocks, stacked_blocks
from signorini.gallery.turned import turned
from signorini.model.body import Body
from signorini.model.conditions import Load, Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step
from signorini.solution.history import History
from signorini.verify.check import Check

_EXACT = 1e-9
_MESHES: tuple[tuple[Cells, tuple[int, int]], ...] = (
    ("quad", (4, 4)),
    ("triangle", (4, 4)),
    ("quad", (4, 7)),
    ("triangle", (5, 3)),
    ("quad8", (5, 3)),
    ("quad9", (3, 4)),
    ("triangle6", (4, 7)),
)
"""Cells, and how many of either side are along the interface."""


def patch_p1() -> Iterator[Check]:
    """P1: two blocks pressed together."""
    for cells, across in _MESHES:
        history = solve(stacked_blocks(friction=0.3, cells=cells, across=across))
        contact = history.contact("interface")
        case = f"P1 two blocks, {_say(cells, across)}"
        yield _farthest(case, "contact pressure", contact.pressure, 1e5, "exact")
        yield _farthest(case, "u_y on the interface", history.last.displacement[contact.node, 1], -0.05, "exact")


def patch_p2() -> Iterator[Check]:
    """P2: block on a foundation under one pressure."""
    for cells, across in _MESHES:
        yield from _p2(block_on_foundation(friction=0.3, cells=cells, across=across), f"P2, {_say(cells, across)}")


def patch_p2_turned() -> Iterator[Check]:
    """P2 turned by 30 degrees."""
    for cells, across in (("quad", (4, 7)), ("quad8", (5, 3)), ("triangle6", (4, 7))):
        model = turned(block_on_foundation(friction=0.3, cells=cells, across=across), np.radians(30.0))
        yield from _p2(model, f"P2 turned by 30 degrees, {_say(cells, across)}")
