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
