# SPDX-License-Identifier: BSD-3-Clause
"""Blocks on blocks in space, of hexahedra that match or not."""

from __future__ import annotations

import numpy as np

from signorini.meshing.solid import box
from signorini.model.body import Body
from signorini.model.conditions import Support
from signorini.model.contact import Contact
from signorini.model.material import Elastic
from signorini.model.mesh import join
from signorini.model.model import Model
from signorini.model.step import Step


def cubes(lower: int, upper: int | None = None, *, friction: float = 0.3) -> Model:
    """A unit cube on another, its top moved down and aside in one increment: some pairs stick, some slip.

    Parameters
    ----------
    lower, upper : cells along every edge; as many of the upper one where not given
    friction : Coulomb's coefficient
    """
    grids = {name: np.linspace(0.0, 1.0, n + 1) for name, n in (("lower", lower), ("upper", upper or lower))}
    parts = {name: box(x=x, y=x, z=x - (name == "lower")) for name, x in grids.items()}
    return Model(
        join(parts),
        title="A cube on a cube",
        bodies=[Body(name, Elastic(E=1.0, nu=0.3)) for name in parts],
        supports=[Support("lower.bottom", u=(0.0, 0.0, 0.0)), Support("upper.top", u=(0.018, 0.006, -0.01))],
        contacts=[Contact("upper.bottom", "lower.top", friction=friction, name="contact")],
        steps=[Step(name="press and push", increments=1)],
    )


def cube_on_block(n: int, m: int, layers: int, *, friction: float = 0.2) -> Model:
    """A unit cube on a block 2 x 2 x 1, its top lowered by 0.01 and held sideways: other codes solve the same.

    Parameters
    ----------
    n : cells along every edge of the cube
    m, layers : cells of the block along x and y, and along z
    friction : Coulomb's coefficient
    """
    x, wide = np.linspace(0.0, 1.0, n + 1), np.linspace(-0.5, 1.5, m + 1)
    return Model(
        join({"cube": box(x=x, y=x, z=x), "block": box(x=wide, y=wide, z=np.linspace(-1.0, 0.0, layers + 1))}),
        title="A cube on a block",
        bodies=[Body(name, Elastic(E=200.0, nu=0.3)) for name in ("cube", "block")],
        supports=[Support("block.bottom", u=(0.0, 0.0, 0.0)), Support("cube.top", u=(0.0, 0.0, -0.01))],
        contacts=[Contact("cube.bottom", "block.top", friction=friction, name="contact")],
        steps=[Step(name="press", increments=1)],
    )
