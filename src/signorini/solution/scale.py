# SPDX-License-Identifier: BSD-3-Clause
"""The sizes that dimensionless residuals refer to: from the data, never from the solution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from signorini.arrays import Array
from signorini.fem.supports import Constraints
from signorini.interface.interface import Interface
from signorini.model.model import Model
from signorini.model.stage import stages


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Sizes of forces and displacements, both > 0.

    Attributes
    ----------
    force : the largest load of the history, or what the largest imposed displacement or overlap causes
    length : the displacement that goes with it
    """

    force: float
    length: float


def data_scale(model: Model, loads: Mapping[str, Array], constraints: Constraints, interface: Interface) -> Scale:
    """Sizes over the whole load history: ``length = force / (E thickness)`` of the body where that is softest.

    Of axisymmetric bodies half the largest radius stands for the thickness: contact bears on a part of it.

    Parameters
    ----------
    loads : nodal forces at factor 1 by name, each (dofs,)
    """
    history = list(stages(model))
    ends = [end for stage in history for end in stage.ends]
    largest = {name: max(abs(end[name]) for end in ends) for name in model.scaled_names}
    force = sum(largest[name] * float(np.abs(f).sum()) for name, f in loads.items())
    moved = [largest[name] * float(np.abs(u).max()) for name, u in constraints.prescribed.items()]
    overlaps = [overlap for stage in history for overlap in stage.interference.values()]
    length = max([*moved, *overlaps, float(np.max(-interface.gap, initial=0.0))])
    radius = 0.5 * float(model.mesh.points[:, 0].max())
    across = [radius] * len(model.bodies) if model.axisymmetric else model.thicknesses
    stiffness = min(body.material.smallest_modulus * width for body, width in zip(model.bodies, across, strict=True))
    force = max(force, stiffness * length) or stiffness
    return Scale(force=force, length=force / stiffness)
