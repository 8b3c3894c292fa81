# SPDX-License-Identifier: BSD-3-Clause
"""The sizes that dimensionless residuals refer to: from the data, never from the solution."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from signorini.arrays import Array
from signorini.fem.space import Space
from signorini.interface.interface import Interface
from signorini.model.model import Model
from signorini.model.stage import Stage
from signorini.model.varying import NodeValues, Varying


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Sizes of forces and displacements, both > 0.

    Attributes
    ----------
    force : the largest load of the history, or what the largest imposed displacement or overlap causes
    length : the displacement that goes with it
    stiffness : of the softest body where it is compressed and does not bend, force per length
    imposed : the largest displacement that is imposed, and overlap
    squeezed : in space, the largest load over the smallest modulus, area
    loaded : the largest load of the history
    size : of the mesh, length: displacements beyond it excuse nothing
    """

    force: float
    length: float
    stiffness: float
    imposed: float = 0.0
    squeezed: float = 0.0
    loaded: float = 0.0
    size: float = 0.0

    @property
    def compressed(self) -> float:
        """The displacement that goes with `force` where bodies are compressed and do not bend."""
        return self.force / self.stiffness

    def bent(self, softness: float) -> Scale:
        """Sizes for slender bodies, which loads move farther than they compress them; softness: length per force."""
        return replace(self, length=max(self.length, min(self.loaded * softness, self.size)))


@dataclass(frozen=True, kw_only=True)
class Loading:
    """The most that a history has imposed so far.

    Attributes
    ----------
    force : sum of all nodal forces at the worst load
    imposed : largest displacement of supports and obstacles, and overlap, length
    """

    force: float = 0.0
    imposed: float = 0.0

    def and_then(self, other: Loading) -> Loading:
        """The most of both."""
        return Loading(force=max(self.force, other.force), imposed=max(self.imposed, other.imposed))

    def times(self, factor: float) -> Loading:
        """Of a history that imposes more of everything."""
        return Loading(force=factor * self.force, imposed=factor * self.imposed)


def loading_of(
    stage: Stage, loads: Mapping[str, Array], prescribed: Mapping[str, Array], before: Loading | None = None
) -> Loading:
    """The most that a history has imposed up to the end of a step.

    Parameters
    ----------
    stage : the step
    loads : nodal forces at factor 1 by name, each (dofs,)
    prescribed : what supports prescribe at factor 1 by name, each (dofs,)
    before : what it had imposed before the step
    """
    largest = {name: max(abs(end[name]) for end in stage.ends) for name in stage.ends[0]}
    force = sum((largest[name] * float(np.abs(f).sum()) for name, f in loads.items()), 0.0)
    moved = [largest[name] * float(np.abs(u).max()) for name, u in prescribed.items()]
    overlaps = [value if isinstance(value, float) else _most(value) for value in stage.interference.values()]
    own = Loading(force=force, imposed=max([*moved, *overlaps], default=0.0))
    return own.and_then(before or Loading())


def _most(overlap: Varying) -> float:
    """The largest of values at nodes, which steps have of what varies over sides."""
    assert isinstance(overlap, NodeValues)
    return float(overlap.values.max())


def data_scale(space: Space, model: Model, loading: Loading, interface: Interface) -> Scale:
    """Sizes of what was imposed: ``length = force / (E thickness)`` where that is largest, see `Scale.bent`.

    Of axisymmetric bodies half the largest radius stands for the thickness: contact bears on a part of it. In space it
    is the edge of a cube as large as all bodies.

    Parameters
    ----------
    space, model : the mesh and what is on it
    loading : the most that was imposed
    interface : the pairs, whose overlaps are imposed too
    """
    loaded, imposed = loading.force, max(loading.imposed, float(np.max(-interface.gap, initial=0.0)))
    bodies = zip(model.bodies, _across(space, model), strict=True)
    stiffness = min(body.material.smallest_modulus * width for body, width in bodies)
    squeezed = loaded / min(body.material.smallest_modulus for body in model.bodies) if model.dimension == 3 else 0.0
    force = max(loaded, stiffness * imposed) or stiffness
    return Scale(
        force=force,
        length=force / stiffness,
        stiffness=stiffness,
        imposed=imposed,
        squeezed=squeezed,
        loaded=loaded,
        size=float(space.mesh.extent.max()),
    )


def _across(space: Space, model: Model) -> list[float]:
    """What stands for the thickness of every body, length."""
    if model.dimension == 3:
        return [math.cbrt(space.volume)] * len(model.bodies)
    if model.axisymmetric:
        return [0.5 * float(model.mesh.points[:, 0].max())] * len(model.bodies)
    return model.thicknesses
